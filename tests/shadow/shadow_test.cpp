#include <gtest/gtest.h>

#include "soup.h"

#include <gnomon/gnomon.h>

namespace gnomon {
namespace {

Scene tower() {
  TriMesh m;
  test::add_ground(m, 60);
  test::add_box(m, {-2, -2, 0}, {2, 2, 10});
  Scene s = test::scene_of(m);
  s.frame.place = Place{48.2 * kDegree, 16.4 * kDegree, 170};
  return s;
}

TEST(CastShadows, MaskOfATowerIsTheStripBehindIt) {
  const Scene s = tower();
  const View v = plan_view({-50, -50, 50, 50}, 1, 0);
  const ShadowMask mask =
      cast_shadows(s, Light(0, -1, 1, 0), v);  // from the south: shadow from y = 2 to 12
  int shadow = 0;
  for (const std::uint8_t m : mask.state) shadow += m == ShadowMask::kShadow ? 1 : 0;
  EXPECT_EQ(shadow, 4 * 10);
  EXPECT_EQ(mask.state[static_cast<std::size_t>(39 * 100 + 50)], ShadowMask::kShadow);  // y = 10.5
  EXPECT_EQ(mask.state[static_cast<std::size_t>(37 * 100 + 50)], ShadowMask::kLit);     // y = 12.5
}

TEST(CastShadows, PixelsWithoutReceiverAreMarked) {
  const Scene s = tower();
  const ShadowMask mask = cast_shadows(s, Light(0, -1, 1, 0), plan_view({-70, -70, 70, 70}, 10, 0));
  EXPECT_EQ(mask.state.front(), ShadowMask::kNoSample);
}

TEST(ShadowProfile, EveryMillisecondOfDaylightIsShadowOrSun) {
  const Scene s = tower();
  const View v = plan_view({-50, -50, 50, 50}, 1, 0);
  const Profile p = shadow_profile(s, v,
                                   {.date = "2024-09-18",
                                    .from = "05:00",
                                    .to = "21:00",
                                    .every = "30min",
                                    .zone = "Europe/Vienna"})
                        .value();
  EXPECT_LT(p.daylight_ticks, 16u * 3600000u);  // the sun was down at both ends
  EXPECT_GT(p.daylight_ticks, 11u * 3600000u);
  std::uint32_t most = 0;
  for (std::size_t k = 0; k < p.shadow_ticks.size(); ++k) {
    ASSERT_LE(p.shadow_ticks[k], p.daylight_ticks);
    ASSERT_EQ(p.shadow_ticks[k] % 1800000u, 0u);
    most = std::max(most, p.shadow_ticks[k]);
  }
  EXPECT_GT(most, 4u * 3600000u);
  EXPECT_EQ(p.shadow_ticks[static_cast<std::size_t>(50 * 100 + 50)], 0u);  // the roof
}

TEST(ShadowProfile, IsTheSumOfItsMasks) {
  const Scene s = tower();
  const View v = plan_view({-50, -50, 50, 50}, 1, 0);
  const Samples t =
      study_samples(
          {.date = "2024-09-18", .from = "09:00", .to = "17:00", .every = "1h", .zone = "UTC"},
          *s.frame.place, 0)
          .value();
  const Casters casters = prepare_casters(s);
  const Receivers r = visible_surfaces(s, v);
  const Profile p = shadow_profile(casters, r, t.midpoints);
  std::vector<std::uint32_t> sum(p.shadow_ticks.size(), 0);
  for (const TimeSample& m : t.midpoints) {
    if (!m.up) continue;
    const ShadowMask mask = cast_shadows(casters, r, m.light);
    for (std::size_t k = 0; k < sum.size(); ++k)
      sum[k] += mask.state[k] == ShadowMask::kShadow ? m.weight_ms : 0;
  }
  EXPECT_EQ(sum, p.shadow_ticks);
}

// Many lights at once find their silhouettes in a tree, single ones by brute force.
TEST(CountShaded, ManyLightsAtOnceShadeWhatEachShadesAlone) {
  for (const bool all_receive : {true, false}) {
    TriMesh m;
    test::add_ground(m, 12);
    test::add_soup(m, 60, 8, 0, 4);
    for (int k = 0; k < 12; ++k)
      test::add_box(m, {k - 6.0, 2 * (k % 5) - 5.0, 0}, {k - 5.5, 2 * (k % 5) - 4.0, 1.0 + k % 4});
    Scene s = test::scene_of(m);
    if (!all_receive) {
      s.surfaces.push_back(s.surfaces[0]);
      s.surfaces[1].receives = false;
      for (std::size_t t = 20; t < 60; ++t) s.surface_of[t] = 1;
    }
    const View view = plan_view({-10, -10, 10, 10}, 0.5, 0);
    const Casters casters = prepare_casters(s);
    const Receivers receivers = visible_surfaces(s, view);
    std::vector<Light> lights;
    for (int k = 0; k < 520; ++k)
      lights.push_back(Light(std::cos(0.1 * k), std::sin(0.1 * k), 0.02 + 0.01 * (k % 40), 0));
    std::vector<std::uint32_t> sums(receivers.triangle.size(), 0);
    for (const Light& light : lights) {
      const ShadowMask mask = cast_shadows(casters, receivers, light);
      for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += mask.state[k] == ShadowMask::kShadow;
    }
    EXPECT_EQ(count_shaded(casters, receivers, lights), sums);
  }
}

TEST(ShadowProfile, SceneWithoutPlaceIsAnErrorThatSaysSo) {
  Scene s = tower();
  s.frame.place.reset();
  const auto p =
      shadow_profile(s, plan_view({-5, -5, 5, 5}, 1, 0),
                     {.date = "2024-09-18", .from = "09:00", .to = "10:00", .zone = "UTC"});
  ASSERT_FALSE(p);
  EXPECT_NE(p.error().message.find("place"), std::string::npos);
}

}  // namespace
}  // namespace gnomon
