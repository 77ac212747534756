// From given light directions, masks are the same bits on every machine: one hash stands here.
#include <gtest/gtest.h>

#include <cmath>

#include <scenes/generated_city.h>

#include <gnomon/shadow/cast_shadows.h>

namespace gnomon {
namespace {

std::uint64_t hash_of(const std::vector<std::uint32_t>& values) {
  std::uint64_t h = 0xcbf29ce484222325u;  // FNV-1a
  for (const std::uint32_t v : values) {
    h ^= v;
    h *= 0x100000001b3u;
  }
  return h;
}

TEST(Determinism, MasksOfAGeneratedTownHaveThisHashForAnyNumberOfThreads) {
  scenes::CityOptions options;
  options.buildings = 100;
  const Scene town = scenes::generated_city(options);
  const Bounds2 b = scenes::city_bounds(options);
  const Receivers r = visible_surfaces(town, plan_view(b, (b.x1 - b.x0) / 300, 0), 1);
  const Casters casters = prepare_casters(town);
  const std::vector<Light> lights = {
      {0.5, -0.5, 0.25, 0}, {-0.75, 0.125, 0.5, 0}, {1, 1, 2, 0}, {0, -1, 0.0625, 0}};
  for (const int threads : {1, 2, 7}) {
    EXPECT_EQ(hash_of(count_shaded(casters, r, lights, {threads, {}, nullptr})),
              8013510332369242061u);
  }
}

}  // namespace
}  // namespace gnomon
