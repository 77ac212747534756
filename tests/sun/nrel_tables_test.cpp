// NREL's reference implementation, as tabulated by the project solarpositioning (delta T 0, 1000
// mbar, 10 C, refraction at the horizon 0.5667 degrees, height 0). Its zenith is refracted; its
// times are cut to whole seconds.
#include <gnomon/sun/sun.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using std::chrono::sys_days;

const fs::path kTables = fs::path(GNOMON_DATA) / "reference/sun/solarpositioning";
const Atmosphere kAir{1000, 10, 0.5667 * kDegree};

struct Stamp {
  sys_days day;
  Instant time;
  Place place;
};

// The first three columns: "1910-03-15T00:30:00Z,-36.840556,174.740000,"; `rest` is what follows.
bool read_stamp(const std::string& line, Stamp& stamp, std::string& rest) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0, length = 0;
  double latitude = 0, longitude = 0;
  if (std::sscanf(line.c_str(), "%d-%d-%dT%d:%d:%dZ,%lf,%lf,%n", &year, &month, &day, &hour,
                  &minute, &second, &latitude, &longitude, &length) != 8)
    return false;
  stamp.day = std::chrono::year(year) / month / day;
  stamp.time = stamp.day + std::chrono::hours(hour) + std::chrono::minutes(minute) +
               std::chrono::seconds(second);
  stamp.place = {latitude * kDegree, longitude * kDegree, 0};
  rest = line.substr(static_cast<std::size_t>(length));
  return true;
}

TEST(NrelTables, PositionsAgreeToTheLastPrintedDigit) {
  std::ifstream file(kTables / "azimuth_zenith/spa_reference_testdata.csv");
  if (!file) GTEST_SKIP() << "skipped: no reference tables below " << GNOMON_DATA;
  int rows = 0;
  double worst = 0;
  std::string line, rest;
  for (Stamp stamp; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    double azimuth = 0, zenith = 0;
    ASSERT_TRUE(read_stamp(line, stamp, rest)) << line;
    ASSERT_EQ(std::sscanf(rest.c_str(), "%lf,%lf", &azimuth, &zenith), 2) << line;
    const SunPosition sun = sun_position(stamp.time, stamp.place, kAir, 0);
    const double error_azimuth = std::abs(std::remainder(sun.azimuth / kDegree - azimuth, 360));
    const double error_zenith = std::abs(90 - sun.altitude_apparent / kDegree - zenith);
    // The algorithm's own bound is 0.0003; the tables have six decimals.
    EXPECT_LT(error_azimuth, 0.51e-6) << line;
    EXPECT_LT(error_zenith, 0.51e-6) << line;
    worst = std::max({worst, error_azimuth, error_zenith});
    ++rows;
  }
  EXPECT_EQ(rows, 512);
  RecordProperty("worst_degrees", std::to_string(worst));
}

TEST(NrelTables, SunriseTransitSunsetAgreeToTheSecond) {
  std::ifstream file(kTables / "sunrise/spa_reference_testdata.csv");
  if (!file) GTEST_SKIP() << "skipped: no reference tables below " << GNOMON_DATA;
  int normal = 0, polar = 0;
  std::string line, rest;
  for (Stamp stamp; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    ASSERT_TRUE(read_stamp(line, stamp, rest)) << line;
    const SunDay day = sun_day(stamp.day, stamp.place, kAir, 0);
    if (rest.starts_with(",,")) {  // 78 degrees north
      EXPECT_FALSE(day.sunrise || day.sunset) << line;
      const auto month = std::chrono::year_month_day(stamp.day).month();
      EXPECT_EQ(day.polar_day, month == std::chrono::June) << line;
      EXPECT_EQ(day.polar_night, month == std::chrono::December) << line;
      ++polar;
      continue;
    }
    ASSERT_TRUE(day.sunrise && day.sunset) << line;
    int t[9];
    ASSERT_EQ(std::sscanf(rest.c_str(), "%d:%d:%d,%d:%d:%d,%d:%d:%d", t, t + 1, t + 2, t + 3, t + 4,
                          t + 5, t + 6, t + 7, t + 8),
              9)
        << line;
    const Instant events[3] = {*day.sunrise, day.transit, *day.sunset};
    for (int i = 0; i < 3; ++i) {
      const int seconds = t[3 * i] * 3600 + t[3 * i + 1] * 60 + t[3 * i + 2];
      const auto ours = std::chrono::floor<std::chrono::seconds>(events[i] - stamp.day);
      EXPECT_EQ(ours.count(), seconds) << line << " event " << i;
    }
    ++normal;
  }
  EXPECT_EQ(normal, 112);
  EXPECT_EQ(polar, 16);
}

}  // namespace
}  // namespace gnomon
