#include <gnomon/sun/spa.h>
#include <gnomon/sun/sun.h>
#include <gtest/gtest.h>

#include <cmath>

namespace gnomon {
namespace {

using namespace std::chrono_literals;
using std::chrono::days;
using std::chrono::sys_days;

Place at(double latitude, double longitude) { return {latitude * kDegree, longitude * kDegree, 0}; }

// The publication's example, to the second that NREL prints (fractions cut off), UTC-7.
TEST(SunDay, RisesAndSetsAsThePublishedExample) {
  const Place place{39.742476 * kDegree, -105.1786 * kDegree, 1830.14};
  const SunDay day = sun_day(2003y / 10 / 17, place, {820, 11, 0.5667 * kDegree}, 67);
  // The UTC day's sunset is that of the evening before on the local clock; NREL prints it as the
  // day's.
  const auto clock = [](Instant t) {
    return std::chrono::floor<std::chrono::seconds>(t + 17h - std::chrono::floor<days>(t)) % 24h;
  };
  ASSERT_TRUE(day.sunrise && day.sunset);
  EXPECT_EQ(clock(*day.sunrise), 6h + 12min + 43s);
  EXPECT_EQ(clock(*day.sunset), 17h + 20min + 19s);
  EXPECT_FALSE(day.polar_day || day.polar_night);
}

TEST(SunDay, RisesNowhereInPolarNightAndSetsNowhereInPolarDay) {
  const Place svalbard = at(78.22, 15.65);
  const SunDay winter = sun_day(2024y / 12 / 21, svalbard),
               summer = sun_day(2024y / 6 / 21, svalbard);
  EXPECT_FALSE(winter.sunrise || winter.sunset);
  EXPECT_TRUE(winter.polar_night);
  EXPECT_FALSE(winter.polar_day);
  EXPECT_FALSE(summer.sunrise || summer.sunset);
  EXPECT_TRUE(summer.polar_day);
  EXPECT_FALSE(summer.polar_night);
}

TEST(SunDay, HasNoSunriseAtThePoles) {
  for (double latitude : {90.0, -90.0}) {
    int up = 0;
    for (int k = 0; k < 366; ++k) {
      const SunDay day = sun_day(sys_days{2024y / 1 / 1} + days(k), at(latitude, 0));
      EXPECT_FALSE(day.sunrise || day.sunset);
      EXPECT_NE(day.polar_day, day.polar_night);
      up += day.polar_day;
    }
    EXPECT_NEAR(up, 187, 5);  // half a year, and the days that refraction adds at both ends
  }
}

// 3720.9 h: the sum over 2021 of the hours from sunrise to sunset, less two a day (San Francisco's
// ordinance).
TEST(SunDay, AddsUpToSanFranciscosYear) {
  const Place place = at(37.7749, -122.4194);
  double hours = 0;
  for (int k = 0; k < 365; ++k) {
    const SunDay arc = sun_arc(sys_days{2021y / 1 / 1} + days(k) + 20h, place);
    ASSERT_TRUE(arc.sunrise && arc.sunset);
    hours += static_cast<double>((*arc.sunset - *arc.sunrise).count()) / 3.6e6 - 2;
  }
  EXPECT_NEAR(hours, 3720.9, 0.05);
}

TEST(SunDay, FallsWithinItsUtcDay) {
  for (double latitude : {-68.0, -33.0, 0.0, 48.2, 66.0, 70.0})
    for (double longitude : {-179.9, -90.0, -0.01, 0.01, 90.0, 179.9})
      for (int k = 0; k < 366; k += 3) {
        const sys_days date = sys_days{2024y / 1 / 1} + days(k);
        const SunDay day = sun_day(date, at(latitude, longitude));
        for (const auto& event : {day.sunrise, day.sunset})
          if (event) {
            EXPECT_GE(*event, date);
            EXPECT_LT(*event, date + days(1));
          }
      }
}

// How far appendix A.2 is from the instant at which sun_position() crosses the same altitude:
// docs/sun.md states it.
TEST(SunDay, IsASecondFromTheTopocentricCrossingBelow50Degrees) {
  double worst = 0;
  for (double latitude : {-50.0, -30.0, 0.0, 30.0, 48.2, 50.0}) {
    for (int k = 0; k < 366; k += 2) {
      const Place place = at(latitude, 16);
      const SunDay arc = sun_arc(sys_days{2024y / 1 / 1} + days(k) + 11h, place);
      ASSERT_TRUE(arc.sunrise && arc.sunset);
      const double limit = -(spa::kSunRadius + Atmosphere().horizon_refraction);
      for (const Instant event : {*arc.sunrise, *arc.sunset}) {
        const auto above = [&](Instant t) {
          return sun_position(t, place).altitude_geometric - limit;
        };
        const double rate = (above(event + 1s) - above(event - 1s)) / 2;  // radians a second
        worst = std::max(worst, std::abs(above(event) / rate));
      }
    }
  }
  RecordProperty("worst_seconds", std::to_string(worst));
  EXPECT_LT(worst, 1.3);
}

TEST(SunArc, GivesWhatSunDayGives) {
  for (double latitude : {-60.0, -36.8, 1.3, 48.2, 64.0})
    for (double longitude : {-150.0, -60.0, 0.0, 16.4, 174.74})
      for (int k = 0; k < 366; k += 11) {
        const Instant noon = sys_days{2024y / 1 / 1} + days(k) +
                             std::chrono::milliseconds(std::llround(43200000 - longitude * 240000));
        const Place place = at(latitude, longitude);
        const double dt = 69;
        const SunDay arc = sun_arc(noon, place, {}, dt);
        ASSERT_TRUE(arc.sunrise && arc.sunset);
        EXPECT_LT(*arc.sunrise, arc.transit);
        EXPECT_LT(arc.transit, *arc.sunset);
        EXPECT_LT(std::chrono::abs(arc.transit - noon), 20min);
        const auto day_of = [&](Instant t) {
          return sun_day(std::chrono::floor<days>(t), place, {}, dt);
        };
        // A UTC day with two sunrises, minutes after its beginning and before its end, has one in
        // SunDay.
        const auto same = [](const std::optional<Instant>& a, Instant b) {
          return !a || std::chrono::abs(*a - b) < 50ms || std::chrono::abs(*a - b) > 23h + 50min;
        };
        EXPECT_TRUE(same(day_of(*arc.sunrise).sunrise, *arc.sunrise))
            << latitude << " " << longitude;
        EXPECT_TRUE(same(day_of(*arc.sunset).sunset, *arc.sunset)) << latitude << " " << longitude;
      }
}

}  // namespace
}  // namespace gnomon
