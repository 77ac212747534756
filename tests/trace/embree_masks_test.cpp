#include <gnomon/trace/embree_masks.h>

#include <gtest/gtest.h>

#include "small_scenes.h"

namespace gnomon {
namespace {

using namespace test;

Scene boxes() {
  Scene s = empty_scene();
  add_ground(s, 60, 0);
  for (int k = 0; k < 9; ++k) {
    const double x = -30 + 20 * (k % 3) + 0.3 * k, y = -30 + 20 * (k / 3) - 0.7 * k;
    add_box(s, Vec3(x, y, 0), Vec3(x + 8 + 0.1 * k, y + 7, 6 + 2.3 * k));
  }
  return finished(std::move(s));
}

std::size_t differences(const std::vector<std::uint8_t>& mask,
                        const std::vector<std::int32_t>& counts) {
  std::size_t n = 0;
  for (std::size_t k = 0; k < mask.size(); ++k) n += (mask[k] != 0) != (counts[k] > 0) ? 1u : 0u;
  return n;
}

TEST(EmbreeMask, AgreesWithTheExactCountExceptAtShadowBorders) {
  const Scene s = boxes();
  const EmbreeScene casters = EmbreeScene::build(s, {}).value();
  const View views[] = {
      plan_view({-50, -50, 50, 50}, 0.5, 0),
      perspective_view(Vec3(70, -90, 60), Vec3(0, 0, 5), Vec3(0, 0, 1), 0.8, 203, 150)};
  for (const View& view : views) {
    const Receivers r = see(s, view);
    const RayOrigins origins = ray_origins(s, r, 1e-3);
    for (const Light& light :
         {Light(0.41, 0.3, 0.5, 0), Light(-0.7, 0.2, 0.1, 0), Light(1.5, 2.5, 40, 1)}) {
      const std::vector<std::int32_t> counts = exact_counts(s, r, light, 1);
      for (const int packet : {8, 16}) {
        const std::vector<std::uint8_t> mask = embree_mask(casters, origins, light, packet);
        EXPECT_LT(differences(mask, counts), mask.size() / 2000);
      }
    }
  }
}

TEST(EmbreeMask, IsTheSameForBothPacketWidths) {
  const Scene s = boxes();
  const EmbreeScene casters = EmbreeScene::build(s, {.robust = true, .threads = 0}).value();
  const RayOrigins origins = ray_origins(s, see(s, plan_view({-50, -50, 50, 50}, 0.5, 0)), 1e-3);
  const Light light(0.41, 0.3, 0.5, 0);
  EXPECT_EQ(embree_mask(casters, origins, light, 8, 1),
            embree_mask(casters, origins, light, 16, 2));
}

TEST(EmbreeMask, DoesNotHitWhatLiesBehindAPointLight) {
  Scene s = empty_scene();
  add_ground(s, 10, 0);
  add_ground(s, 1, 5, kCastsOnly);
  s = finished(std::move(s));
  const EmbreeScene casters = EmbreeScene::build(s, {}).value();
  const RayOrigins origins =
      ray_origins(s, see(s, plan_view({-0.5, -0.5, 0.5, 0.5}, 0.1, 0)), 1e-3);
  EXPECT_EQ(embree_mask(casters, origins, Light(0, 0, 4, 1)), std::vector<std::uint8_t>(100, 0));
  EXPECT_EQ(embree_mask(casters, origins, Light(0, 0, 6, 1)), std::vector<std::uint8_t>(100, 1));
}

TEST(EmbreeMask, IsAllLitOrTurnedAwayWithoutCasters) {
  Scene s = empty_scene();
  add_ground(s, 10, 0);
  s = finished(std::move(s));
  const EmbreeScene casters = EmbreeScene::build(s, {}).value();
  const RayOrigins origins = ray_origins(s, see(s, plan_view({-0.5, -0.5, 0.5, 0.5}, 0.1, 0)), 0);
  EXPECT_EQ(embree_mask(casters, origins, Light(0, 0, 1, 0)), std::vector<std::uint8_t>(100, 0));
  EXPECT_EQ(embree_mask(casters, origins, Light(0, 0, -1, 0)), std::vector<std::uint8_t>(100, 1));
}

}  // namespace
}  // namespace gnomon
