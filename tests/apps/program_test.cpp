// The program as a user runs it: exit codes, messages, files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include <apps/program.h>

namespace {

namespace fs = std::filesystem;
using gnomon::testing::Program;

TEST_F(Program, ProfileWritesItsFourFilesAndNothingElse) {
  ASSERT_EQ(run(profile(day_ + " --pixel 4")), 0) << err_;
  std::vector<std::string> names;
  for (const auto& f : fs::directory_iterator(results()))
    names.push_back(f.path().filename().string());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names,
            (std::vector<std::string>{"plan.png", "profile.tif", "summary.json", "view.png"}));
}

TEST_F(Program, SummaryTellsMidpointsWithDirectionsTowardsTheSun) {
  ASSERT_EQ(run(profile(day_ + " --pixel 8")), 0) << err_;
  const auto json = nlohmann::json::parse(text(results() + "/summary.json"));
  ASSERT_EQ(json["samples"].size(), 8u);
  EXPECT_EQ(json["samples"][0]["utc"], "2024-09-18T07:30:00Z");
  EXPECT_EQ(json["instants"].size(), 9u);
  const double north = json["scene"]["true_north_deg"].get<double>();
  for (const auto& s : json["samples"]) {
    const double degree = 3.14159265358979323846 / 180,
                 azimuth = (s["azimuth_deg"].get<double>() + north) * degree,
                 altitude = s["altitude_deg"].get<double>() * degree;
    EXPECT_NEAR(s["direction"][0].get<double>(), std::sin(azimuth) * std::cos(altitude), 1e-9);
    EXPECT_NEAR(s["direction"][1].get<double>(), std::cos(azimuth) * std::cos(altitude), 1e-9);
    EXPECT_NEAR(s["direction"][2].get<double>(), std::sin(altitude), 1e-9);
  }
  for (const char* key : {"inputs", "timings", "counts", "warnings", "version", "view", "scene"})
    EXPECT_TRUE(json.contains(key)) << key;
}

TEST_F(Program, NoZoneIsAnErrorThatSaysWhatToAddAndNothingIsWritten) {
  EXPECT_NE(run(profile("--date 2024-09-18 --from 09:00 --to 17:00")), 0);
  EXPECT_NE(err_.find("--tz"), std::string::npos);
  EXPECT_FALSE(fs::exists(results()));
}

TEST_F(Program, ModelWithoutPlaceIsAnErrorThatSaysWhatToAdd) {
  EXPECT_NE(run("profile " GNOMON_SCENES "/vienna/vienna.city.jsonl " + day_ + " -o " + results()),
            0);
  EXPECT_NE(err_.find("--crs"), std::string::npos);
  EXPECT_FALSE(fs::exists(results() + "/summary.json"));
}

TEST_F(Program, OnlyWhatCastsCastsAndOnlyWhatReceivesReceives) {
  ASSERT_EQ(run(profile(day_ + " --pixel 8 --cast RoofSurface --receive Ground")), 0) << err_;
  const auto json = nlohmann::json::parse(text(results() + "/summary.json"));
  const auto& scene = json["scene"];
  EXPECT_LT(scene["triangles_casting"], scene["triangles"]);
  EXPECT_EQ(scene["triangles_receiving"], scene["ground"]["triangles"]);
  EXPECT_GT(json["result"]["mean_shadow_h"], 0.1);
}

TEST_F(Program, CameraGivesHoursAndAViewWithoutAMap) {
  ASSERT_EQ(run(profile(day_ + " --view camera --size 160x100")), 0) << err_;
  EXPECT_TRUE(fs::exists(results() + "/hours.png"));
  EXPECT_TRUE(fs::exists(results() + "/view.png"));
  EXPECT_FALSE(fs::exists(results() + "/plan.png"));
}

TEST_F(Program, VerifyFindsNoDifference) {
  EXPECT_EQ(run("verify " + vienna_ + " --size 32 --suns 3 --points 2"), 0) << err_;
  EXPECT_NE(out_.find("equal the exact ones"), std::string::npos);
}

TEST_F(Program, SunAndInspectSpeakJson) {
  ASSERT_EQ(run("sun --site 48.2,16.37 --date 2024-09-18 --from 09:00 --to 17:00 --tz "
                "Europe/Vienna --json"),
            0)
      << err_;
  const auto sun = nlohmann::json::parse(out_);
  ASSERT_EQ(sun["positions"].size(), 9u);
  for (const char* key :
       {"utc", "azimuth_deg", "altitude_geometric_deg", "altitude_apparent_deg"}) {
    EXPECT_TRUE(sun["positions"][0].contains(key)) << key;
  }
  ASSERT_EQ(run("inspect " + vienna_ + " --json"), 0) << err_;
  EXPECT_TRUE(nlohmann::json::parse(out_).is_object());
}

TEST_F(Program, MissingFileIsNamed) {
  EXPECT_NE(run("inspect nowhere.city.json"), 0);
  EXPECT_NE(err_.find("nowhere.city.json"), std::string::npos);
}

}  // namespace
