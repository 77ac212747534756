// Level ground needs no holes under the buildings (docs/ground.md, step 5).
#include <gnomon/gnomon.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

namespace gnomon {
namespace {

ShadowMask mask_of(const std::string& ground, const Light& sun) {
  LoadOptions options;
  options.ground = ground;
  auto loaded = load_scene({GNOMON_SCENES "/footprints/quarter.geojson"}, options);
  EXPECT_TRUE(loaded) << loaded.error().message;
  const Scene& scene = loaded.value().scene;
  return cast_shadows(scene, sun, plan_view({-120, -100, 120, 100}, 0.5, 0));
}

TEST(LevelGround, GivesTheSameMaskWithHolesUnderTheBuildingsAndWithout) {
  const double c = std::sqrt(0.5);
  std::ptrdiff_t shadows = 0;
  for (const Light& sun : {Light(0.5, -0.3, 0.4, 0), Light(1, 0, 0.1, 0), Light(-c, -c, 1, 0),
                           Light(0, 0, 1, 0), Light(3, 7, 30, 1)}) {
    const ShadowMask holes = mask_of("auto", sun), none = mask_of("0", sun);
    EXPECT_EQ(holes.state, none.state);
    shadows += std::count(holes.state.begin(), holes.state.end(), ShadowMask::kShadow);
  }
  EXPECT_GT(shadows, 10000);
}

}  // namespace
}  // namespace gnomon
