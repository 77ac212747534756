#include <gnomon/io/colour_map.h>
#include <gnomon/io/picture_map.h>
#include <gnomon/io/plan_picture.h>
#include <gtest/gtest.h>
#include <io/write_test_files.h>

#include <algorithm>
#include <cmath>

namespace gnomon {
namespace {

constexpr std::uint32_t kHour = 3'600'000;  // ms

View plan(int width, int height) {
  View view;
  view.eye = {0, 0, 1, 0};
  view.origin = {0, 0.5 * height, 0, 1};
  view.right = {0.5, 0, 0, 0};
  view.down = {0, -0.5, 0, 0};
  view.width = width;
  view.height = height;
  return view;
}

Profile even(int width, int height, std::uint32_t shadow_ms) {
  Profile p;
  p.width = width;
  p.height = height;
  p.daylight_ticks = 8 * kHour;
  p.valid.assign(static_cast<std::size_t>(width * height), 1);
  p.shadow_ticks.assign(p.valid.size(), shadow_ms);
  return p;
}

std::size_t count(const Picture& picture, Rgb colour) {
  return static_cast<std::size_t>(std::count(picture.pixels.begin(), picture.pixels.end(), colour));
}

const PlanCaption kCaption{
    "Vienna", {"18 September 2024, 09:00\u201317:00 Europe/Vienna"}, "gnomon", "", ""};

TEST(MapSize, EnlargesByWholeFactorsAndShrinksToAPage) {
  EXPECT_EQ(map_size(40, 30).enlarged, 32);
  EXPECT_EQ(map_size(40, 30).width, 1280);
  EXPECT_EQ(map_size(40, 30).height, 960);
  EXPECT_EQ(map_size(1281, 700).enlarged, 1);
  EXPECT_EQ(map_size(1600, 1600).width, 1600);
  EXPECT_EQ(map_size(2112, 2240).height, 1600);
  EXPECT_EQ(map_size(2112, 2240).width, 1509);
  EXPECT_EQ(map_size(100000, 3).height, 1) << "never empty";
}

TEST(DrawHours, PaintsHoursInTheColoursOfTheLegend) {
  for (const int size : {20, 1300, 1700}) {  // enlarged, one to one, shrunk
    const Picture map = draw_hours(even(size, size / 2, 2 * kHour), {}, 0);
    EXPECT_EQ(count(map, hours_colour(0.25)), map.pixels.size()) << size;
  }
}

TEST(DrawHours, PaintsGreyWhereThereIsNoSample) {
  Profile p = even(10, 10, 0);
  std::fill(p.valid.begin(), p.valid.begin() + 50, std::uint8_t{0});
  const Picture map = draw_hours(p, {}, 0);
  EXPECT_EQ(count(map, kNoDataColour), map.pixels.size() / 2);
  EXPECT_EQ(at(map, 0, 0), kNoDataColour) << "row 0 is at the top";
}

TEST(DrawHours, AveragesHoursAndNotColours) {
  Profile p = even(3200, 2, 0);
  for (std::size_t k = 0; k < p.shadow_ticks.size(); k += 2) p.shadow_ticks[k] = 8 * kHour;
  const Picture map = draw_hours(p, {}, 0);  // each pixel has as much of 0 as of 8 hours
  EXPECT_EQ(count(map, hours_colour(0.5)), map.pixels.size());
}

TEST(DrawHours, LeavesLevelGroundAsItIsAndDarkensSlopes) {
  const Profile p = even(10, 10, 0);
  PlanRelief relief;
  relief.shade.assign(100, kLevelShade);
  relief.shade[0] = 20;
  const Picture map = draw_hours(p, relief, 0);
  EXPECT_LT(at(map, 0, 0).g, hours_colour(0).g);
  EXPECT_EQ(at(map, map.width - 1, 0), hours_colour(0));
}

TEST(DrawHours, DrawsALineWhereTheObjectChanges) {
  for (const int size : {64, 3200}) {
    const Profile p = even(size, size / 2, kHour);
    PlanRelief relief;
    relief.object.assign(p.valid.size(), 3);
    for (std::size_t k = 0; k < p.valid.size(); ++k) {
      if (static_cast<int>(k) % size >= size / 2) relief.object[k] = 4;
    }
    const Picture map = draw_hours(p, relief, 0);
    const std::size_t drawn = map.pixels.size() - count(map, hours_colour(0.125));
    EXPECT_GE(drawn, static_cast<std::size_t>(map.height)) << size;
    EXPECT_LE(drawn, 3 * static_cast<std::size_t>(map.height)) << size;
  }
}

TEST(DrawHours, IsTheSameForAnyNumberOfThreads) {
  Profile p = even(2000, 300, 0);
  for (std::size_t k = 0; k < p.shadow_ticks.size(); ++k) {
    p.shadow_ticks[k] = static_cast<std::uint32_t>(k * 7919 % (8 * kHour));
    p.valid[k] = k % 11 != 0;
  }
  EXPECT_TRUE(draw_hours(p, {}, 1).pixels == draw_hours(p, {}, 5).pixels);
}

TEST(DrawPlan, ShowsTheWholeMapAndEveryColourOfTheLegend) {
  const Profile p = even(400, 300, 3 * kHour);
  const Picture picture = draw_plan(p, plan(400, 300), {}, kCaption);
  const MapSize map = map_size(400, 300);
  EXPECT_GE(count(picture, hours_colour(0.375)), static_cast<std::size_t>(map.width * map.height));
  std::size_t shown = 0;
  for (const Rgb colour : hours_colours()) shown += count(picture, colour) > 0;
  EXPECT_GE(shown, 200U) << "the bar has about as many pixels as the table has colours";
  EXPECT_GT(count(picture, hours_colours().front()), 0U);
  EXPECT_GT(count(picture, hours_colours().back()), 0U);
  EXPECT_EQ(at(picture, 0, 0), (Rgb{255, 255, 255}));
}

TEST(DrawPlan, NamesTheGreyOnlyWhereThereIsSome) {
  Profile p = even(400, 300, 0);
  EXPECT_EQ(count(draw_plan(p, plan(400, 300), {}, kCaption), kNoDataColour), 0U);
  p.valid[0] = 0;
  const Picture grey = draw_plan(p, plan(400, 300), {}, kCaption);
  EXPECT_GT(count(grey, kNoDataColour), 100U);
  PlanCaption receive = kCaption;
  receive.without_sample = "not evaluated";
  EXPECT_FALSE(draw_plan(p, plan(400, 300), {}, receive).pixels == grey.pixels)
      << "surfaces that do not receive are surfaces";
}

TEST(DrawPlan, DrawsAnyShapeAndTheNight) {
  for (const auto& [width, height] :
       {std::pair{1, 1}, {40, 30}, {3000, 10}, {10, 3000}, {2400, 500}, {500, 2400}}) {
    Profile p = even(width, height, 0);
    const Picture day = draw_plan(p, plan(width, height), {}, kCaption);
    EXPECT_GE(day.width, map_size(width, height).width);
    EXPECT_GT(day.height, map_size(width, height).height);
    p.daylight_ticks = 0;
    const Picture night = draw_plan(p, plan(width, height), {}, kCaption);
    EXPECT_EQ(night.width, day.width);
  }
}

TEST(DrawPlan, TurnsTheArrowToTrueNorth) {
  const Profile p = even(400, 300, 0);
  Frame turned;
  turned.true_north = 0.5;
  EXPECT_FALSE(draw_plan(p, plan(400, 300), {}, kCaption).pixels ==
               draw_plan(p, plan(400, 300), turned, kCaption).pixels);
}

TEST(WritePlanPicture, NamesTheFileItCannotWrite) {
  const testing::TestFolder folder;
  const Result<FileWritten> written = write_plan_picture(folder.path() / "missing" / "plan.png",
                                                         even(4, 3, 0), plan(4, 3), {}, kCaption);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("missing/plan.png"), std::string::npos);
}

TEST(TickHours, AreRoundAndNotTooMany) {
  for (const double hours : {0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 7.83, 8.0, 9.0, 10.0, 16.2, 24.0}) {
    const double step = tick_hours(hours);
    EXPECT_LE(hours / step, 9.0) << hours;
    EXPECT_GE(hours / step, hours < 0.2 ? 1.0 : 3.0) << hours;
  }
  EXPECT_EQ(tick_hours(8), 1);
  EXPECT_EQ(tick_hours(12), 2);
  EXPECT_EQ(tick_hours(4), 0.5);
}

TEST(RoundLength, IsOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(round_length(57), 50);
  EXPECT_DOUBLE_EQ(round_length(50), 50);
  EXPECT_DOUBLE_EQ(round_length(49), 20);
  EXPECT_DOUBLE_EQ(round_length(19), 10);
  EXPECT_DOUBLE_EQ(round_length(0.7), 0.5);
  EXPECT_DOUBLE_EQ(round_length(2300), 2000);
}

}  // namespace
}  // namespace gnomon
