// The program as a user runs it: exit codes, messages, files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include <apps/program.h>

namespace {

namespace fs = std::filesystem;
using gnomon::testing::Program;

TEST_F(Program, ProfileWritesItsFilesAndNothingElse) {
  ASSERT_EQ(run(profile(day_ + " --pixel 4")), 0) << err_;
  std::vector<std::string> names;
  for (const auto& f : fs::directory_iterator(results()))
    names.push_back(f.path().filename().string());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"isolines.geojson", "isolines.gpkg", "objects.csv",
                                             "plan.png", "profile.tif", "report.html",
                                             "summary.csv", "summary.json", "view.png"}));
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

TEST_F(Program, SeveralDatesHaveAFolderEach) {
  ASSERT_EQ(
      run(profile("--date 2024-03-21 --date 2024-04-01..2024-04-20/7d --from 09:00 --to 12:00 "
                  "--tz Europe/Vienna --pixel 8")),
      0)
      << err_;
  for (const char* folder : {"2024-03-21", "2024-04-01..2024-04-20_7d"}) {
    for (const char* file : {"profile.tif", "plan.png", "view.png", "summary.json", "summary.csv",
                             "objects.csv", "isolines.geojson", "isolines.gpkg"}) {
      EXPECT_TRUE(fs::exists(fs::path(results()) / folder / file)) << folder << "/" << file;
    }
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(results()), fs::directory_iterator()), 3)
      << "a folder each, and one report over both";
  EXPECT_TRUE(fs::exists(results() + "/report.html"));
  const auto day = nlohmann::json::parse(text(results() + "/2024-03-21/summary.json"));
  EXPECT_EQ(day["result"]["days"], 1);
  EXPECT_EQ(day["result"]["daylight_h"], 3.0);
  const auto range =
      nlohmann::json::parse(text(results() + "/2024-04-01..2024-04-20_7d/summary.json"));
  EXPECT_EQ(range["inputs"]["date"], "2024-04-01..2024-04-20/7d");
  EXPECT_EQ(range["window"]["dates"].size(), 3u);
  EXPECT_EQ(range["samples"].size(), 9u);
  EXPECT_EQ(range["result"]["days"], 3);
  EXPECT_EQ(range["result"]["daylight_h"], 3.0) << "per day";
  EXPECT_EQ(range["outputs"].size(), 8u);
}

TEST_F(Program, DatesThatCannotBeAreRefusedBeforeAnythingIsRead) {
  const std::string rest = " --from 09:00 --to 12:00 --tz UTC --pixel 8";
  EXPECT_NE(run(profile("--date 2024-04-02..2024-04-01" + rest)), 0);
  EXPECT_NE(err_.find("ends before it begins"), std::string::npos) << err_;
  EXPECT_NE(run(profile("--date 2024-04-02 --date 2024-04-02" + rest)), 0);
  EXPECT_NE(err_.find("twice"), std::string::npos) << err_;
  EXPECT_NE(run(profile("--date 2024-04-02 --isolines often" + rest)), 0);
  EXPECT_NE(err_.find("--isolines"), std::string::npos) << err_;
  EXPECT_FALSE(fs::exists(results()));
}

TEST_F(Program, CameraRemovesWhatAPlanLeft) {
  ASSERT_EQ(run(profile(day_ + " --pixel 8 --isolines 2h")), 0) << err_;
  EXPECT_TRUE(fs::exists(results() + "/isolines.gpkg"));
  ASSERT_EQ(run(profile(day_ + " --view camera --size 80x50")), 0) << err_;
  for (const char* file :
       {"plan.png", "isolines.geojson", "isolines.gpkg", "summary.csv", "objects.csv"}) {
    EXPECT_FALSE(fs::exists(fs::path(results()) / file)) << file;
  }
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
