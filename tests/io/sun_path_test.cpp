#include <gnomon/io/sun_path.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <glm/geometric.hpp>

namespace gnomon {
namespace {

using namespace std::chrono_literals;
using std::chrono::sys_days;

Place place(double latitude, double longitude) {
  return {latitude * kDegree, longitude * kDegree, 0};
}
const Place kVienna = place(48.2, 16.37), kTromso = place(69.65, 18.95),
            kSydney = place(-33.9, 151.2), kSingapore = place(1.3, 103.8);

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

std::string drawn(const Place& at, const std::string& date, const std::string& from,
                  const std::string& to, const std::string& zone, double north = 0) {
  const Samples s = study_samples({date, from, to, "1h", zone}, at, north).value();
  return sun_path_svg({at, north, zone, {}, {{date, s.begin, s.end, s.midpoints}}}).value();
}

TEST(SunPath, PutsTheZenithInTheCentreNorthUpAndEastAtTheRight) {
  EXPECT_NEAR(glm::length(sun_path_point(1.0, kPi / 2)), 0, 1e-15);
  const Vec2 north = sun_path_point(0, 0), east = sun_path_point(kPi / 2, 0);
  EXPECT_NEAR(north.x, 0, 1e-15);
  EXPECT_NEAR(north.y, -1, 1e-15);
  EXPECT_NEAR(east.x, 1, 1e-15);
  EXPECT_NEAR(east.y, 0, 1e-15);
  EXPECT_NEAR(glm::length(sun_path_point(2.0, 30 * kDegree)), 2.0 / 3, 1e-15);
}

TEST(SunPath, ProjectsTheExampleOfThePublication) {
  // NREL/TP-560-34302, appendix A.5: azimuth 194.34024, zenith 50.11162 degrees.
  const Place golden{39.742476 * kDegree, -105.1786 * kDegree, 1830.14};
  const SunPosition sun = sun_position(sys_days{2003y / 10 / 17} + 19h + 30min + 30s, golden,
                                       {820, 11, 0.5667 * kDegree}, 67.0);
  const Vec2 p = sun_path_point(sun.azimuth, sun.altitude_apparent);
  EXPECT_NEAR(glm::length(p), 50.11162 / 90, 1e-6);
  EXPECT_NEAR(std::atan2(p.x, -p.y) + 2 * kPi, 194.34024 * kDegree, 1e-6);
}

TEST(SunPath, ArcsStayInsideTheHorizonAndEndOnIt) {
  for (const Place& at : {kVienna, kSydney, kSingapore}) {
    const auto arcs = day_arcs(sys_days{2024y / 9 / 18} + 12h, at);
    ASSERT_EQ(arcs.size(), 1U);
    EXPECT_FALSE(arcs[0].closed);
    for (const Vec2& p : arcs[0].points) EXPECT_LT(glm::length(p), 1.0);
    // Within what the sun climbs in two milliseconds, far below a pixel.
    EXPECT_NEAR(glm::length(arcs[0].points.front()), 1, 1e-6);
    EXPECT_NEAR(glm::length(arcs[0].points.back()), 1, 1e-6);
    EXPECT_GT(arcs[0].points.front().x, 0.9);  // rises in the east
    EXPECT_LT(arcs[0].points.back().x, -0.9);
  }
}

TEST(SunPath, CulminatesTowardsTheEquatorAndInTheTropicsOnEitherSide) {
  const auto highest = [](const Place& at) {
    const auto arcs = day_arcs(sys_days{2024y / 6 / 21} + 12h, at);
    return *std::min_element(
        arcs[0].points.begin(), arcs[0].points.end(),
        [](const Vec2& a, const Vec2& b) { return glm::length(a) < glm::length(b); });
  };
  EXPECT_GT(highest(kVienna).y, 0);     // south
  EXPECT_LT(highest(kSydney).y, 0);     // north
  EXPECT_LT(highest(kSingapore).y, 0);  // north of the zenith in June, seen from 1.3 N
}

TEST(SunPath, MidnightSunDrawsAClosedCurve) {
  const auto arcs = day_arcs(sys_days{2024y / 6 / 21} + 12h, kTromso);
  ASSERT_EQ(arcs.size(), 1U);
  EXPECT_TRUE(arcs[0].closed);
  EXPECT_EQ(arcs[0].end - arcs[0].begin, 24h);
  EXPECT_LT(glm::length(arcs[0].points.front() - arcs[0].points.back()), 0.005);
  EXPECT_NE(drawn(kTromso, "2024-06-21", "", "", "Europe/Oslo").find("Z\" fill"),
            std::string::npos);
}

TEST(SunPath, AWindowAcrossANightGivesTwoArcs) {
  const auto arcs =
      sky_arcs(sys_days{2024y / 9 / 18} + 12h, sys_days{2024y / 9 / 19} + 12h, kVienna);
  ASSERT_EQ(arcs.size(), 2U);
  EXPECT_GT(arcs[1].begin - arcs[0].end, 11h);
}

TEST(SunPath, PolarNightHasNoArcAndSaysSo) {
  EXPECT_TRUE(day_arcs(sys_days{2024y / 12 / 21} + 12h, kTromso).empty());
  const std::string svg = drawn(kTromso, "2024-12-21", "09:00", "15:00", "Europe/Oslo");
  EXPECT_EQ(count(svg, "class=\"day\""), 0U);
  EXPECT_NE(svg.find("2024-12-21: the sun stays below the horizon"), std::string::npos);
  EXPECT_NE(svg.find("December solstice: the sun stays below the horizon"), std::string::npos);
  EXPECT_EQ(count(svg, "class=\"season\""), 2U);
}

TEST(SunPath, DrawsTheDayItsWindowEveryStepAndThreeSeasons) {
  const std::string svg = drawn(kVienna, "2024-09-18", "09:00", "17:00", "Europe/Vienna");
  EXPECT_EQ(count(svg, "class=\"day\""), 1U);
  EXPECT_EQ(count(svg, "class=\"window\""), 1U);
  EXPECT_EQ(count(svg, "class=\"season\""), 3U);
  EXPECT_EQ(count(svg, "r=\"2.20\" fill=\"#1c1b20\""), 8U + 1U);  // and the legend's
  for (const char* hour : {">7<", ">13<", ">18<"}) EXPECT_EQ(count(svg, hour), 1U) << hour;
  EXPECT_EQ(count(svg, ">6<"), 0U);  // sunrise is at 6:38
  EXPECT_EQ(count(svg, ">19<"), 0U);
}

TEST(SunPath, MarksHoursOnTheZonesClock) {
  // The sun sets at 20:58 in summer time: 18:58 UTC.
  EXPECT_EQ(count(drawn(kVienna, "2024-06-21", "09:00", "17:00", "Europe/Vienna"), ">20<"), 1U);
  EXPECT_EQ(count(drawn(kVienna, "2024-06-21", "09:00", "17:00", "UTC"), ">20<"), 0U);
  EXPECT_EQ(count(drawn(kVienna, "2024-06-21", "09:00", "17:00", "solar"), ">12<"), 1U);
}

TEST(SunPath, HourLabelsStayInsideTheRim) {
  // A low midnight sun: outside of the arc, labels would lie on those of the rim.
  const std::string svg = drawn(place(78.2, 15.6), "2024-05-01", "09:00", "15:00", "solar");
  for (std::size_t at = svg.find("font-size=\"10\" text-anchor=\"middle\" fill=\"#1c1b20\"");
       at != std::string::npos;
       at = svg.find("font-size=\"10\" text-anchor=\"middle\" fill=\"#1c1b20\"", at + 1)) {
    const std::size_t tag = svg.rfind("<text", at);
    double x = 0, y = 0;
    ASSERT_EQ(std::sscanf(svg.c_str() + tag, "<text x=\"%lf\" y=\"%lf\"", &x, &y), 2);
    EXPECT_LT(std::hypot(x - 200, y - 3.5 - 190), 162 - 4);
  }
  EXPECT_EQ(count(svg, "font-size=\"10\" text-anchor=\"middle\" fill=\"#1c1b20\""), 24U);
}

TEST(SunPath, MarksGridNorthWhereItIsOff) {
  const std::string same = drawn(kVienna, "2024-09-18", "09:00", "17:00", "UTC");
  const std::string off = drawn(kVienna, "2024-09-18", "09:00", "17:00", "UTC", 2 * kDegree);
  EXPECT_EQ(count(off, "stroke-width=\"2\""), count(same, "stroke-width=\"2\"") + 1);
}

TEST(SunPath, EscapesLabels) {
  const Instant noon = sys_days{2024y / 9 / 18} + 12h;
  const std::string svg =
      sun_path_svg({kVienna, 0, "UTC", {}, {{"<script>\"&\xff", noon - 1h, noon, {}}}}).value();
  EXPECT_EQ(svg.find("<script"), std::string::npos);
  EXPECT_NE(svg.find("&lt;script&gt;&quot;&amp;\xEF\xBF\xBD"), std::string::npos);
}

TEST(SunPath, RefusesNoDayAnEmptyWindowAndAnUnknownZone) {
  const Instant noon = sys_days{2024y / 9 / 18} + 12h;
  EXPECT_FALSE(sun_path_svg({kVienna, 0, "UTC", {}, {}}));
  EXPECT_FALSE(sun_path_svg({kVienna, 0, "UTC", {}, {{"x", noon, noon, {}}}}));
  EXPECT_FALSE(sun_path_svg({kVienna, 0, "Europe/Wien", {}, {{"x", noon, noon + 1h, {}}}}));
}

}  // namespace
}  // namespace gnomon
