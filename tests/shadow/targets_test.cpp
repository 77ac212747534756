#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <hwy/targets.h>

#include "soup.h"

#include <gnomon/raster/add_in_shadow.h>
#include <gnomon/shadow/cast_shadows.h>

namespace gnomon {
namespace {

TEST(InstructionSets, CountsAreTheSameBitsOnEachThatTheMachineOffers) {
  const auto offered = hwy::SupportedAndGeneratedTargets();
  if (offered.size() < 2) GTEST_SKIP() << "skipped: this machine offers one instruction set only";
  TriMesh m;
  test::add_soup(m, 400, 20, 0, 21);
  test::add_soup(m, 200, 20, 1, 22);
  test::add_ground(m, 30, -20);
  const Scene scene = test::scene_of(m);
  const Casters casters = prepare_casters(scene);
  std::vector<Light> lights = {{-0.4, 0.3, 0.5, 0}, {1, 0, 1, 0}, {3, 4, 25, 1}, {1, 2, 3, 1}};
  for (const View& view : {plan_view({-25, -25, 25, 25}, 0.25, 0),
                           perspective_view({33, -35, 20}, {0, 0, -5}, {0, 0, 1}, 0.9, 160, 120)}) {
    const Receivers r = visible_surfaces(scene, view);
    std::vector<std::uint32_t> first;
    for (const std::int64_t target : offered) {
      hwy::SetSupportedTargetsForTest(target);
      const std::vector<std::uint32_t> counts = count_shaded(casters, r, lights);
      if (first.empty()) first = counts;
      EXPECT_EQ(counts, first) << instruction_set();
    }
    hwy::SetSupportedTargetsForTest(0);
  }
}

}  // namespace
}  // namespace gnomon
