// gnomon shadow as a user runs it.
#include <gtest/gtest.h>

#include <algorithm>

#include <nlohmann/json.hpp>

#include <apps/program.h>

namespace {

namespace fs = std::filesystem;

class ShadowCommand : public gnomon::testing::Program {
 protected:
  std::string shadow(const std::string& more) const {
    return "shadow " + vienna_ + " " + more + " -o " + results();
  }
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& f : fs::directory_iterator(results()))
      found.push_back(f.path().filename().string());
    std::sort(found.begin(), found.end());
    return found;
  }
  nlohmann::json summary() const {
    return nlohmann::json::parse(text(results() + "/summary.json"));
  }
  void refuses(const std::string& arguments, const std::string& word) {
    EXPECT_NE(run(shadow(arguments)), 0) << arguments;
    EXPECT_NE(err_.find(word), std::string::npos) << arguments << ": " << err_;
    EXPECT_FALSE(fs::exists(results())) << arguments;
  }
  const std::string instant_ = "--date 2024-09-18 --at 14:00 --tz Europe/Vienna";
};

TEST_F(ShadowCommand, PlanWritesMaskPictureOutlinesAndSummaryAndNothingElse) {
  ASSERT_EQ(run(shadow(instant_ + " --pixel 4")), 0) << err_;
  EXPECT_EQ(names(), (std::vector<std::string>{"mask.png", "mask.tif", "outlines.geojson",
                                               "outlines.gpkg", "summary.json"}));
  const auto json = summary();
  EXPECT_EQ(json["light"]["utc"], "2024-09-18T12:00:00Z");
  EXPECT_NEAR(json["light"]["azimuth_deg"].get<double>(), 203.92, 0.01);
  EXPECT_NEAR(json["light"]["altitude_deg"].get<double>(), 40.90, 0.01);
  const auto& result = json["result"];
  EXPECT_EQ(result["shadow_m2"].get<double>(), 16 * result["shadow"].get<double>());
  EXPECT_EQ(result["lit"].get<int>() + result["shadow"].get<int>() + result["nodata"].get<int>(),
            json["view"]["width"].get<int>() * json["view"]["height"].get<int>());
  const auto outlines = nlohmann::json::parse(text(results() + "/outlines.geojson"));
  double area = 0;
  for (const auto& f : outlines["features"]) area += f["properties"]["area_m2"].get<double>();
  EXPECT_EQ(area, result["shadow_m2"].get<double>());
  EXPECT_EQ(outlines["features"].size(), result["outlines"].get<std::size_t>());
  EXPECT_NE(out_.find("outlines.gpkg"), std::string::npos);
}

TEST_F(ShadowCommand, CameraGivesAPictureAndTakesOldOutlinesAway) {
  ASSERT_EQ(run(shadow(instant_ + " --pixel 8")), 0) << err_;
  ASSERT_EQ(run(shadow(instant_ + " --view camera --size 160x100")), 0) << err_;
  EXPECT_EQ(names(), (std::vector<std::string>{"mask.png", "mask.tif", "summary.json"}));
  EXPECT_FALSE(summary()["result"].contains("shadow_m2"));
}

TEST_F(ShadowCommand, TheSunsDirectionGivesTheSameMaskAsItsInstant) {
  ASSERT_EQ(run(shadow(instant_ + " --pixel 4")), 0) << err_;
  const auto first = summary();
  const auto& d = first["light"]["direction"];
  ASSERT_EQ(run(shadow("--pixel 4 --light " + d[0].dump() + "," + d[1].dump() + "," + d[2].dump() +
                       ",sun")),
            0)
      << err_;
  const auto second = summary();
  EXPECT_EQ(second["result"], first["result"]);
  EXPECT_NEAR(second["light"]["azimuth_deg"].get<double>(),
              first["light"]["azimuth_deg"].get<double>(), 1e-8);
  EXPECT_TRUE(second["light"]["utc"].is_null());
}

TEST_F(ShadowCommand, APointLightStandsInTheModelsCoordinatesAndNeedsNoPlace) {
  ASSERT_EQ(run("shadow " GNOMON_SCENES "/vienna/vienna.city.jsonl --pixel 8 --light "
                "1249,340770,200 -o " +
                results()),
            0)
      << err_;
  const auto json = summary();
  EXPECT_EQ(json["light"]["position"], (nlohmann::json{1249.0, 340770.0, 200.0}));
  EXPECT_TRUE(json["scene"]["place"].is_null());
  EXPECT_GT(json["result"]["shadow"], 0);
  EXPECT_GT(json["result"]["lit"], 0);
}

TEST_F(ShadowCommand, NightIsAnErrorThatSaysWhenTheSunIsUp) {
  refuses("--date 2024-09-18 --at 21:00 --tz Europe/Vienna",
          "on that day it is up from 06:36:06 to 19:00:07 Europe/Vienna");
  EXPECT_NE(run("shadow " + house() + " --site 80,16 --date 2024-12-21 --at 12:00 --tz UTC -o " +
                results()),
            0);
  EXPECT_NE(err_.find("does not rise at all"), std::string::npos) << err_;
}

TEST_F(ShadowCommand, WhatCannotBeReadOrContradictsIsAnErrorThatSaysWhatToDo) {
  refuses("", "--light");
  refuses(instant_ + " --light 1,2,3", "cannot be combined");
  refuses("--at 14:00 --tz UTC", "--date");
  refuses("--date 2024-09-18 --tz UTC", "--at");
  refuses("--date 2024-09-18 --at 14:00", "--tz");
  refuses("--date 2024-09-18 --at 14 --tz UTC", "HH:MM");
  refuses("--date 2024-09-18 --at 14:60 --tz UTC", "HH:MM");
  refuses("--date 2024-09-31 --at 14:00 --tz UTC", "2024-09-31");
  refuses("--date 2024-09-18 --at 14:00 --tz Europe/Wien", "Europe/Wien");
  refuses("--date 2024-03-31 --at 02:30 --tz Europe/Vienna", "does not exist");
  refuses("--light 1,2", "X,Y,Z");
  refuses("--light 1,2,x", "X,Y,Z");
  refuses("--light 1,2,nan", "X,Y,Z");
  refuses("--light 1,2,3,moon", "X,Y,Z");
  refuses("--light 0,0,0,sun", "no direction");
  refuses("--light 1e13,0,0", "too far away");
  refuses(instant_ + " --view plan --eye 1,2,3", "--view plan");
}

TEST_F(ShadowCommand, ASunBelowTheHorizonThatIsGivenAsADirectionIsAWarning) {
  ASSERT_EQ(run(shadow("--pixel 16 --light 1,0,-0.1,sun")), 0) << err_;
  EXPECT_NE(err_.find("not above the horizon"), std::string::npos);
}

TEST_F(ShadowCommand, ATimeThatTheClockShowsTwiceIsTakenAtItsFirst) {
  const std::string house_at = "shadow " + house() + " -o " + results() + " --site ";
  ASSERT_EQ(run(house_at + "70,-150 --date 2024-05-20 --at 02:30 --tz UTC"), 0) << err_;
  EXPECT_EQ(summary()["warnings"].dump().find("twice"), std::string::npos);
  ASSERT_EQ(run(house_at + "48,-170 --date 2024-10-27 --at 02:30 --tz Europe/Vienna"), 0) << err_;
  EXPECT_EQ(summary()["light"]["utc"], "2024-10-27T00:30:00Z");
  EXPECT_NE(summary()["warnings"].dump().find("twice"), std::string::npos);
}

}  // namespace
