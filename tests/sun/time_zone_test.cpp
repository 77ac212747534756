#include <gnomon/sun/sun.h>
#include <gnomon/sun/time_zone.h>
#include <gtest/gtest.h>

#include <cmath>

namespace gnomon {
namespace {

using namespace std::chrono_literals;
using std::chrono::days;
using std::chrono::sys_days;
using std::chrono::year_month_day;

const Place kVienna{48.2 * kDegree, 16.37 * kDegree, 0};

ClockTime clock(year_month_day date, std::chrono::milliseconds time) {
  return ClockTime(sys_days{date}.time_since_epoch() + time);
}

std::string utc_of(const char* zone, year_month_day date, std::chrono::milliseconds time) {
  return iso_text(clock_to_utc(zone, kVienna, clock(date, time)).value().utc);
}

TEST(TimeZone, KnowsSummerAndWinterInVienna) {
  EXPECT_EQ(utc_of("Europe/Vienna", 2024y / 9 / 18, 9h), "2024-09-18T07:00:00Z");
  EXPECT_EQ(utc_of("Europe/Vienna", 2024y / 12 / 18, 9h), "2024-12-18T08:00:00Z");
  EXPECT_EQ(utc_of("UTC", 2024y / 12 / 18, 9h), "2024-12-18T09:00:00Z");
}

TEST(TimeZone, FollowsTodaysRulesBeyondTheSystemsTables) {
  EXPECT_EQ(utc_of("Europe/Vienna", 2050y / 7 / 1, 9h), "2050-07-01T07:00:00Z");
  EXPECT_EQ(utc_of("Europe/Vienna", 2050y / 1 / 1, 9h), "2050-01-01T08:00:00Z");
  EXPECT_EQ(utc_of("America/New_York", 2100y / 7 / 1, 9h), "2100-07-01T13:00:00Z");
  // The last Sunday of March 2050 is the 27th.
  EXPECT_EQ(utc_of("Europe/Vienna", 2050y / 3 / 26, 12h), "2050-03-26T11:00:00Z");
  EXPECT_EQ(utc_of("Europe/Vienna", 2050y / 3 / 27, 12h), "2050-03-27T10:00:00Z");
  EXPECT_TRUE(
      clock_to_utc("Europe/Vienna", kVienna, clock(2050y / 3 / 27, 2h + 30min)).value().skipped);
  EXPECT_EQ(utc_of("Europe/Vienna", 2048y / 2 / 29, 12h), "2048-02-29T11:00:00Z");
}

TEST(TimeZone, MarksReadingsThatTheClockSkipsOrShowsTwice) {
  const ClockInstant spring =
      clock_to_utc("Europe/Vienna", kVienna, clock(2024y / 3 / 31, 2h + 30min)).value();
  EXPECT_TRUE(spring.skipped);
  EXPECT_EQ(iso_text(spring.utc), "2024-03-31T01:00:00Z");
  const ClockInstant autumn =
      clock_to_utc("Europe/Vienna", kVienna, clock(2024y / 10 / 27, 2h + 30min)).value();
  EXPECT_TRUE(autumn.ambiguous);
  EXPECT_EQ(iso_text(autumn.utc), "2024-10-27T00:30:00Z");
}

TEST(TimeZone, SaysWhatToAddWhenThereIsNone) {
  const auto none = clock_to_utc("", kVienna, clock(2024y / 9 / 18, 9h));
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("--tz Europe/Vienna"), std::string::npos);
  EXPECT_NE(none.error().message.find("--tz solar"), std::string::npos);
  const auto unknown = utc_to_clock("Europe/Wien", kVienna, sys_days{2024y / 9 / 18});
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("'Europe/Wien'"), std::string::npos);
}

TEST(SolarClock, ShowsTheHourAngleToAMillisecond) {
  for (double latitude : {-77.0, -33.0, 0.0, 35.0, 60.0})
    for (double longitude : {-179.9, -75.0, 0.0, 16.37, 139.0, 179.9})
      for (int k = 0; k < 366; k += 30)
        for (int hour : {0, 1, 8, 12, 17, 24}) {
          const Place place{latitude * kDegree, longitude * kDegree, 0};
          const ClockTime reading =
              clock(sys_days{2024y / 1 / 1} + days(k), std::chrono::hours(hour));
          const Instant utc = clock_to_utc("solar", place, reading).value().utc;
          const double angle = sun_position(utc, place).hour_angle / kDegree;
          EXPECT_NEAR(std::remainder(angle - (hour - 12) * 15.0, 360), 0, 15 / 3.6e6);
          // The date is the place's own: within a day and a half of Greenwich's.
          EXPECT_LT(std::abs((utc.time_since_epoch() - reading.time_since_epoch() +
                              std::chrono::milliseconds(std::llround(longitude * 240000)))
                                 .count()),
                    17 * 60000);
          const ClockTime back = utc_to_clock("solar", place, utc).value();
          EXPECT_LE(std::chrono::abs(back - reading), 1ms);
        }
}

TEST(IsoText, ShowsMillisecondsOnlyWhereThereAreSome) {
  EXPECT_EQ(iso_text(Instant(sys_days{2024y / 2 / 29} + 1h + 2min + 3s)), "2024-02-29T01:02:03Z");
  EXPECT_EQ(iso_text(Instant(sys_days{1969y / 12 / 31} + 23h + 45ms)), "1969-12-31T23:00:00.045Z");
  EXPECT_EQ(iso_text(ClockTime(0ms)), "1970-01-01T00:00:00");
}

}  // namespace
}  // namespace gnomon
