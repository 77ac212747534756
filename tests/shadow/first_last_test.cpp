// First and last sun, and means over days.
#include <gtest/gtest.h>

#include <random>

#include <hwy/targets.h>

#include "soup.h"

#include <gnomon/gnomon.h>
#include <gnomon/raster/add_in_shadow.h>
#include <gnomon/raster/first_and_last_lit.h>

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

Samples samples_of(const Scene& s, const char* date, const char* every) {
  return study_samples({date, "05:00", "21:00", every, "Europe/Vienna"}, *s.frame.place, 0).value();
}

TEST(FirstAndLastLit, KernelEqualsTheSpecificationOnEachInstructionSet) {
  std::mt19937 random(5);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (int n = 0; n < 200; ++n) {
      std::vector<std::uint8_t> mask(static_cast<std::size_t>(n));
      std::vector<std::uint16_t> first(mask.size()), last(mask.size());
      for (std::size_t k = 0; k < mask.size(); ++k) {
        mask[k] = static_cast<std::uint8_t>(random() % 2);
        first[k] = static_cast<std::uint16_t>(random());
        last[k] = static_cast<std::uint16_t>(random());
      }
      std::vector<std::uint16_t> first_too = first, last_too = last;
      const auto begin = static_cast<std::uint16_t>(random());
      const auto end = static_cast<std::uint16_t>(random());
      keep_first_and_last_lit(mask.data(), n, begin, end, first.data(), last.data());
      keep_first_and_last_lit_reference(mask.data(), n, begin, end, first_too.data(),
                                        last_too.data());
      ASSERT_EQ(first, first_too) << instruction_set() << " " << n;
      ASSERT_EQ(last, last_too) << instruction_set() << " " << n;
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(ShadowProfile, FirstAndLastSunAreThoseOfItsMasks) {
  const Scene s = tower();
  const Receivers r = visible_surfaces(s, plan_view({-70, -50, 50, 50}, 1, 0));
  const Casters casters = prepare_casters(s);
  const Samples t = samples_of(s, "2024-03-21..2024-09-21/92d", "30min");
  for (const int threads : {1, 3}) {
    const Profile p = shadow_profile(casters, r, t, {threads, {}, nullptr, true});
    EXPECT_EQ(p.days, 3);
    const std::size_t n = p.valid.size();
    std::vector<std::int32_t> first(n, 0x7fffffff), last(n, -1);
    for (const TimeSample& m : t.midpoints) {
      if (!m.up) continue;
      const ShadowMask mask = cast_shadows(casters, r, m.light);
      for (std::size_t k = 0; k < n; ++k) {
        if (mask.state[k] != ShadowMask::kLit) continue;
        first[k] = std::min(first[k], m.clock_begin_ms);
        last[k] = std::max(last[k], m.clock_end_ms);
      }
    }
    std::size_t never = 0, missing = 0;
    for (std::size_t k = 0; k < n; ++k) {
      if (p.valid[k] == 0) {
        ++missing;
        continue;
      }
      if (last[k] < 0) {
        ++never;
        ASSERT_EQ(p.first_lit[k], kNeverLit);
      } else {
        ASSERT_EQ(first_sun_clock(p, k), first[k] / 3.6e6);
        ASSERT_EQ(last_sun_clock(p, k), last[k] / 3.6e6);
      }
    }
    EXPECT_EQ(never, 0u) << "every spot of this scene sees the sun in summer";
    EXPECT_GT(missing, 0u);
  }
}

TEST(ShadowProfile, NeverLitSamplesHaveNoFirstSun) {
  const Scene s = tower();
  const Receivers r = visible_surfaces(s, plan_view({-10, -10, 10, 10}, 1, 0));
  const Samples t = samples_of(s, "2024-12-21", "1h");
  const Profile p = shadow_profile(prepare_casters(s), r, t, {1, {}, nullptr, true});
  std::size_t never = 0;
  for (std::size_t k = 0; k < p.valid.size(); ++k) {
    const bool dark = p.shadow_ticks[k] == p.daylight_ticks;
    EXPECT_EQ(p.first_lit[k] == kNeverLit, dark);
    never += dark ? 1 : 0;
  }
  EXPECT_GT(never, 0u) << "north of the tower";
  EXPECT_TRUE(shadow_profile(prepare_casters(s), r, t).first_lit.empty()) << "only where asked for";
}

TEST(ShadowProfile, HoursOfARangeAreTheMeanOfItsDays) {
  const Scene s = tower();
  const Receivers r = visible_surfaces(s, plan_view({-50, -50, 50, 50}, 2, 0));
  const Casters casters = prepare_casters(s);
  const Profile all = shadow_profile(casters, r, samples_of(s, "2024-03-21..2024-03-24", "1h"));
  EXPECT_EQ(all.days, 4);
  EXPECT_EQ(all.tick_ms, 1u);
  std::vector<std::uint32_t> sum(all.valid.size(), 0);
  for (const char* date : {"2024-03-21", "2024-03-22", "2024-03-23", "2024-03-24"}) {
    const Profile day = shadow_profile(casters, r, samples_of(s, date, "1h"));
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += day.shadow_ticks[k];
  }
  EXPECT_EQ(sum, all.shadow_ticks);
  EXPECT_NEAR(daylight_hours(all), 12.25, 1.0);
}

// 2^32 ms of daylight are 49.7 days; one sample less and one more.
TEST(ShadowProfile, TicksBecomeSecondsWhereMillisecondsWouldOverflow) {
  const Scene s = tower();
  const Receivers r = visible_surfaces(s, plan_view({-50, -50, 50, 50}, 2, 0));
  const Casters casters = prepare_casters(s);
  TimeSample one = samples_of(s, "2024-06-21", "1h").midpoints[6];
  ASSERT_TRUE(one.up);
  one.weight_ms = 0x7fffffff;
  std::vector<TimeSample> samples{one, one};
  samples.push_back(one);
  samples.back().weight_ms = 1;
  const Profile fits = shadow_profile(casters, r, samples);
  EXPECT_EQ(fits.tick_ms, 1u);
  EXPECT_EQ(fits.daylight_ticks, 0xffffffffu);
  samples.back().weight_ms = 2;
  const Profile coarse = shadow_profile(casters, r, samples);
  EXPECT_EQ(coarse.tick_ms, 1000u);
  EXPECT_EQ(coarse.daylight_ticks, 2u * 2147484u) << "rounded weights, added";
  std::size_t shadow = 0;
  for (std::size_t k = 0; k < coarse.valid.size(); ++k) {
    ASSERT_EQ(coarse.shadow_ticks[k] == coarse.daylight_ticks,
              fits.shadow_ticks[k] == fits.daylight_ticks);
    shadow += coarse.shadow_ticks[k] != 0 ? 1 : 0;
  }
  EXPECT_GT(shadow, 0u);
  EXPECT_NEAR(daylight_hours(coarse), daylight_hours(fits), 0.5 * 3 / 3600);
}

}  // namespace
}  // namespace gnomon
