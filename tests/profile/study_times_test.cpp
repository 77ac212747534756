#include <gnomon/profile/study_times.h>
#include <gnomon/sun/time_zone.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace gnomon {
namespace {

using namespace std::chrono_literals;

const Place kVienna{48.2 * kDegree, 16.37 * kDegree, 0};
const Place kSvalbard{78.22 * kDegree, 15.65 * kDegree, 0};

StudyTimes times(std::string date, std::string from, std::string to, std::string every,
                 std::string zone) {
  return {std::move(date), std::move(from), std::move(to), std::move(every), std::move(zone)};
}

Samples samples(const StudyTimes& t, const Place& place = kVienna, double true_north = 0) {
  return study_samples(t, place, true_north).value();
}

std::string error(const StudyTimes& t, const Place& place = kVienna) {
  const auto result = study_samples(t, place, 0);
  return result ? "" : result.error().message;
}

std::uint64_t total_weight(const Samples& s) {
  return std::accumulate(s.midpoints.begin(), s.midpoints.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const TimeSample& t) { return sum + t.weight_ms; });
}

bool warns(const Samples& s, const std::string& part) {
  for (const Warning& w : s.warnings)
    if (w.what.find(part) != std::string::npos) return true;
  return false;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(StudyTimes, CutTheViennaDayOfThePaperIntoEightHours) {
  const Samples s = samples(times("2024-09-18", "09:00", "17:00", "1h", "Europe/Vienna"));
  ASSERT_EQ(s.midpoints.size(), 8u);
  ASSERT_EQ(s.instants.size(), 9u);
  EXPECT_EQ(iso_text(s.begin), "2024-09-18T07:00:00Z");
  EXPECT_EQ(iso_text(s.end), "2024-09-18T15:00:00Z");
  EXPECT_EQ(iso_text(s.midpoints.front().utc), "2024-09-18T07:30:00Z");
  EXPECT_EQ(iso_text(s.midpoints.back().utc), "2024-09-18T14:30:00Z");
  EXPECT_EQ(iso_text(s.instants.front().utc), "2024-09-18T07:00:00Z");
  EXPECT_EQ(iso_text(s.instants.back().utc), "2024-09-18T15:00:00Z");
  for (const TimeSample& t : s.midpoints) EXPECT_EQ(t.weight_ms, 3600000u);
  for (const TimeSample& t : s.instants) EXPECT_EQ(t.weight_ms, 0u);
  for (const TimeSample& t : s.midpoints) EXPECT_TRUE(t.up);
  EXPECT_TRUE(s.warnings.empty());
}

TEST(StudyTimes, PointTheLightTowardsTheApparentSun) {
  const double north = 0.2;
  const Samples s =
      samples(times("2024-09-18", "09:00", "17:00", "1h", "Europe/Vienna"), kVienna, north);
  for (const TimeSample& t : s.midpoints) {
    EXPECT_EQ(t.light.w, 0);
    EXPECT_NEAR(std::hypot(t.light.x, t.light.y, t.light.z), 1, 1e-15);
    EXPECT_NEAR(std::asin(t.light.z), t.sun.altitude_apparent, 1e-12);
    EXPECT_NEAR(std::remainder(std::atan2(t.light.x, t.light.y) - t.sun.azimuth - north, 2 * kPi),
                0, 1e-12);
  }
}

TEST(StudyTimes, MakeTheLastStepShorterAndSaySo) {
  const Samples s = samples(times("2024-09-18", "09:00", "10:10", "30min", "Europe/Vienna"));
  ASSERT_EQ(s.midpoints.size(), 3u);
  EXPECT_EQ(s.midpoints[2].weight_ms, 600000u);
  EXPECT_EQ(iso_text(s.midpoints[2].utc), "2024-09-18T08:05:00Z");
  EXPECT_EQ(s.instants.size(), 4u);
  EXPECT_EQ(iso_text(s.instants.back().utc), "2024-09-18T08:10:00Z");
  EXPECT_TRUE(warns(s, "last step is shorter"));
}

TEST(StudyTimes, WeighTheWholeWindowExactlyOnce) {
  for (const char* every : {"1s", "7s", "90s", "5min", "37m", "1h", "1h30min", "24h"})
    for (const char* zone : {"Europe/Vienna", "UTC", "solar"}) {
      const Samples s = samples(times("2024-12-21", "08:00", "10:00:01", every, zone));
      EXPECT_EQ(total_weight(s), static_cast<std::uint64_t>((s.end - s.begin).count()))
          << every << zone;
    }
}

TEST(StudyTimes, BeginAtSunriseAndEndAtSunsetWhereNotTold) {
  const Samples s = samples(times("2024-09-18", "", "", "1h", "Europe/Vienna"));
  const SunDay day = sun_day(std::chrono::sys_days{std::chrono::year(2024) / 9 / 18}, kVienna);
  EXPECT_LT(std::chrono::abs(s.begin - *day.sunrise), 50ms);
  EXPECT_LT(std::chrono::abs(s.end - *day.sunset), 50ms);
  EXPECT_EQ(s.midpoints.size(), 13u);
  for (const TimeSample& t : s.midpoints) EXPECT_TRUE(t.up);
}

// Reykjavik in June: the sun sets at 00:04 of the next day.
TEST(StudyTimes, FollowTheDaylightBeyondMidnight) {
  const Place reykjavik{64.1466 * kDegree, -21.9426 * kDegree, 0};
  const Samples s = samples(times("2024-06-21", "", "", "1h", "Atlantic/Reykjavik"), reykjavik);
  EXPECT_EQ(iso_text(s.begin).substr(0, 16), "2024-06-21T02:55");
  EXPECT_EQ(iso_text(s.end).substr(0, 16), "2024-06-22T00:04");
  const LocalDay day = local_day("2024-06-21", "Atlantic/Reykjavik", reykjavik).value();
  EXPECT_EQ(iso_text(*day.sun.sunset).substr(0, 16), "2024-06-21T00:03");
  EXPECT_EQ(iso_text(*day.arc.sunset).substr(0, 16), "2024-06-22T00:04");
}

TEST(StudyTimes, TakeTheWholePolarDayAndRefuseThePolarNight) {
  const Samples s = samples(times("2024-06-21", "", "", "1h", "Europe/Oslo"), kSvalbard);
  EXPECT_EQ(s.midpoints.size(), 24u);
  EXPECT_TRUE(warns(s, "does not set"));
  EXPECT_TRUE(warns(s, "already up"));
  EXPECT_TRUE(contains(error(times("2024-12-21", "", "", "1h", "Europe/Oslo"), kSvalbard),
                       "does not rise"));
  const Samples dark =
      samples(times("2024-12-21", "11:00", "13:00", "1h", "Europe/Oslo"), kSvalbard);
  EXPECT_FALSE(dark.midpoints[0].up || dark.midpoints[1].up);
  ASSERT_TRUE(warns(dark, "the sun is down"));
  EXPECT_EQ(dark.warnings[0].count, 2u);
  EXPECT_TRUE(local_day("2024-12-21", "Europe/Oslo", kSvalbard).value().sun.polar_night);
  EXPECT_TRUE(local_day("2024-06-21", "Europe/Oslo", kSvalbard).value().sun.polar_day);
}

TEST(StudyTimes, AreUpExactlyWhereTheApparentCentreIsAboveTheHorizon) {
  const Samples s = samples(times("2024-09-18", "06:00", "08:00", "1s", "Europe/Vienna"));
  int up = 0;
  for (const TimeSample& t : s.midpoints) {
    EXPECT_EQ(t.up, t.sun.altitude_apparent > 0);
    up += t.up;
  }
  EXPECT_GT(up, 0);
  EXPECT_LT(up, 7200);
}

// Japan's rule: 8 to 16 in true solar time; the shadow of one metre at the winter solstice.
TEST(StudyTimes, StandOnTheJapaneseSolarClock) {
  const Place place{35 * kDegree, 139 * kDegree, 0};
  const Samples s = samples(times("2024-12-21", "08:00", "16:00", "1h", "solar"), place);
  ASSERT_EQ(s.instants.size(), 9u);
  EXPECT_TRUE(s.warnings.empty());
  const double azimuth[9] = {126.547, 137.092, 149.590, 164.110, 180,
                             195.890, 210.410, 222.908, 233.453};
  const double length[5] = {6.6998, 3.1420, 2.1439, 1.7423, 1.6280};
  for (int k = 0; k < 9; ++k) {
    EXPECT_NEAR(s.instants[k].sun.hour_angle / kDegree, (k - 4) * 15, 15 / 3.6e6);
    EXPECT_NEAR(s.instants[k].sun.azimuth / kDegree, azimuth[k], 0.001);
    // The table holds the declination at the solstice's and leaves out the parallax of 0.0024
    // degrees.
    EXPECT_NEAR(1 / std::tan(s.instants[k].sun.altitude_geometric), length[k <= 4 ? k : 8 - k],
                0.003);
  }
}

TEST(StudyTimes, CrossTheClockChangeInElapsedTime) {
  const Samples autumn = samples(times("2024-10-27", "00:00", "24:00", "1h", "Europe/Vienna"));
  EXPECT_EQ(autumn.midpoints.size(), 25u);
  const Samples spring = samples(times("2024-03-31", "00:00", "24:00", "1h", "Europe/Vienna"));
  EXPECT_EQ(spring.midpoints.size(), 23u);
}

TEST(StudyTimes, RefuseATimeThatTheClockSkipsAndTakeTheEarlierOfTwo) {
  const std::string skipped = error(times("2024-03-31", "02:30", "12:00", "1h", "Europe/Vienna"));
  EXPECT_TRUE(contains(skipped, "2024-03-31 02:30:00")) << skipped;
  EXPECT_TRUE(contains(skipped, "03:00:00 or later")) << skipped;
  const Samples twice = samples(times("2024-10-27", "02:30", "12:00", "30min", "Europe/Vienna"));
  EXPECT_EQ(iso_text(twice.begin), "2024-10-27T00:30:00Z");
  EXPECT_TRUE(warns(twice, "twice"));
  // Beirut's clock went from 0:00 to 1:00: the day has 23 hours.
  const Place beirut{33.9 * kDegree, 35.5 * kDegree, 0};
  const Samples midnight =
      samples(times("2024-03-31", "00:00", "24:00", "1h", "Asia/Beirut"), beirut);
  EXPECT_EQ(midnight.midpoints.size(), 23u);
  EXPECT_TRUE(warns(midnight, "skips this midnight"));
}

TEST(StudyTimes, HoursMayBeWrittenWithOneDigit) {
  const Place vienna{48.2 * kDegree, 16.37 * kDegree, 171};
  const auto one = study_samples({"2024-09-18", "9:00", "17:00", "1h", "UTC"}, vienna, 0).value();
  const auto two = study_samples({"2024-09-18", "09:00", "17:00", "1h", "UTC"}, vienna, 0).value();
  EXPECT_EQ(one.begin, two.begin);
}

TEST(StudyTimes, SayWhatIsMissingOrUnreadable) {
  EXPECT_TRUE(
      contains(error(times("2024-09-18", "09:00", "17:00", "1h", "")), "--tz Europe/Vienna"));
  EXPECT_TRUE(contains(error(times("", "09:00", "17:00", "1h", "UTC")), "--date YYYY-MM-DD"));
  for (const char* date : {"18.9.2024", "2024-9-18", "2024-09-31", "2023-02-29", "2024-13-01",
                           "2024-09-18 ", "0000-01-01", "9999-01-01"})
    EXPECT_TRUE(
        contains(error(times(date, "09:00", "17:00", "1h", "UTC")), std::string("'") + date + "'"));
  for (const char* time :
       {"9", "09", "09:60", "24:01", "09:00:60", "09:00 ", "-9:00", "+9:00", "noon"}) {
    EXPECT_TRUE(contains(error(times("2024-09-18", time, "24:00", "1h", "UTC")),
                         std::string("--from '") + time + "'"));
    EXPECT_TRUE(contains(error(times("2024-09-18", "00:00", time, "1h", "UTC")),
                         std::string("--to '") + time + "'"));
  }
  for (const char* step :
       {"", "0h", "0s", "-1h", "1.5h", "h", "60", "1h1h", "30min1h", "1 h", "99999999999h", "1d"})
    EXPECT_TRUE(
        contains(error(times("2024-09-18", "00:00", "24:00", step, "UTC")), "cannot be read"))
        << step;
  EXPECT_TRUE(
      contains(error(times("2024-09-18", "00:00", "24:00", "24h1s", "UTC")), "at most 24h"));
  EXPECT_TRUE(contains(error(times("2024-09-18", "12:00", "12:00", "1h", "UTC")), "empty"));
  EXPECT_TRUE(contains(error(times("2024-09-18", "12:00", "09:00", "1h", "UTC")), "empty"));
  EXPECT_EQ(error(times("2024-09-18", "00:00", "24:00", "24h", "UTC")), "");
  EXPECT_EQ(error(times("2024-02-29", "00:00", "24:00", "1h30m5s", "UTC")), "");
}

TEST(StudyTimes, DoubtAClockThatDoesNotSuitThePlace) {
  const Place mongolia{48.2 * kDegree, 116.37 * kDegree, 0};
  EXPECT_TRUE(warns(samples(times("2024-09-18", "01:00", "12:00", "1h", "Europe/Vienna"), mongolia),
                    "check --tz"));
  EXPECT_FALSE(
      warns(samples(times("2024-09-18", "01:00", "12:00", "1h", "UTC"), mongolia), "check --tz"));
  const Place kashgar{39.47 * kDegree, 75.99 * kDegree, 0};
  EXPECT_FALSE(warns(samples(times("2024-09-18", "09:00", "12:00", "1h", "Asia/Shanghai"), kashgar),
                     "check --tz"));
}

}  // namespace
}  // namespace gnomon
