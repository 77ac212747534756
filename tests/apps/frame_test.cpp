// The default map: what it holds, and what is said where shadows go on beyond it.
#include <gtest/gtest.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include <apps/program.h>

namespace {

class Frame : public gnomon::testing::Program {
 protected:
  // 20 m x 20 m, 80 m high, its foot from 0,0 to 20,20.
  std::string tower() const {
    std::ofstream(folder_ / "tower.obj")
        << "v 0 0 0\nv 20 0 0\nv 20 20 0\nv 0 20 0\n"
           "v 0 0 80\nv 20 0 80\nv 20 20 80\nv 0 20 80\n"
           "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 5 6 7 8\n";
    return (folder_ / "tower.obj").string() + " --up z --site 48.2,16.37 ";
  }
  int shadow(const std::string& more) {
    return run("shadow " + tower() + more + " -o " + results());
  }
  int profile_of_tower(const std::string& more) {
    return run("profile " + tower() + more + " -o " + results());
  }
  nlohmann::json summary() const {
    return nlohmann::json::parse(text(results() + "/summary.json"));
  }
  const std::string noon_ = "--date 2024-12-21 --at 12:00 --tz Europe/Vienna";
  const std::string note_ = "Shadows reach the border of the map";
};

TEST_F(Frame, HoldsTheWholeShadowOfATower) {
  ASSERT_EQ(shadow(noon_), 0) << err_;
  EXPECT_EQ(out_.find(note_), std::string::npos) << out_;
  EXPECT_NE(out_.find("in 1 outline,"), std::string::npos) << out_;
  const auto framed = summary();
  EXPECT_EQ(framed["result"]["shadows_reach_border"], false);
  EXPECT_EQ(framed["result"]["nodata"], 0) << "the ground reaches as far as the map";
  ASSERT_EQ(shadow(noon_ + " --pixel 0.2 --bounds=-600,-600,600,600"), 0) << err_;
  EXPECT_NEAR(framed["result"]["shadow_m2"].get<double>(),
              summary()["result"]["shadow_m2"].get<double>(), 5);
}

TEST_F(Frame, SaysWhereShadowsGoOnBeyondIt) {
  ASSERT_EQ(shadow(noon_ + " --bounds=-50,-50,70,100"), 0) << err_;
  EXPECT_NE(out_.find(note_), std::string::npos) << out_;
  EXPECT_EQ(err_, "") << "a fact and no warning";
  EXPECT_EQ(summary()["result"]["shadows_reach_border"], true);
}

TEST_F(Frame, OfADayHoldsTheSunsOfTenDegreesAndMore) {
  const std::string day = "--date 2024-03-21 --tz Europe/Vienna --every 15min --pixel 2 ";
  ASSERT_EQ(profile_of_tower(day), 0) << err_;
  const auto bounds = summary()["view"]["bounds"];
  // Of 10.0 degrees 454 m; the quarter of an hour before is 2.4 degrees lower.
  EXPECT_LT(bounds[0], -340);
  EXPECT_GT(bounds[0], -6 * 80);
  EXPECT_GT(bounds[2], 20 + 340);
  EXPECT_LT(bounds[2], 20 + 6 * 80);
  EXPECT_NEAR(bounds[1].get<double>(), -20, 2) << "the sun is never in the north";
  EXPECT_EQ(summary()["result"]["nodata"].is_null(), true);
  EXPECT_EQ(summary()["result"]["shadows_reach_border"], true) << "at sunrise";
  EXPECT_NE(out_.find(note_), std::string::npos) << out_;
  EXPECT_NE(text(results() + "/report.html").find(note_), std::string::npos);
  ASSERT_EQ(profile_of_tower(day + "--from 10:00 --to 14:00"), 0) << err_;
  EXPECT_EQ(summary()["result"]["shadows_reach_border"], false);
  EXPECT_EQ(text(results() + "/report.html").find(note_), std::string::npos);
}

TEST_F(Frame, OfSunsThatAreAllLowHoldsWhatTenDegreesWouldThrow) {
  ASSERT_EQ(shadow("--date 2024-12-21 --at 08:30 --tz Europe/Vienna --pixel 2"), 0) << err_;
  const auto json = summary();
  ASSERT_LT(json["light"]["altitude_deg"], 10);
  const auto bounds = json["view"]["bounds"];
  const double west = -bounds[0].get<double>(), north = bounds[3].get<double>() - 20;
  EXPECT_NEAR(std::hypot(west, north), 80 * (5.671 + 0.1), 20);
  EXPECT_EQ(json["result"]["shadows_reach_border"], true);
}

TEST_F(Frame, IsTheSameForAllDatesOfARun) {
  ASSERT_EQ(profile_of_tower("--date 2024-06-21 --date 2024-12-21 --from 11:00 --to 13:00 --tz "
                             "Europe/Vienna --pixel 2"),
            0)
      << err_;
  const auto one = nlohmann::json::parse(text(results() + "/2024-06-21/summary.json"));
  const auto two = nlohmann::json::parse(text(results() + "/2024-12-21/summary.json"));
  EXPECT_EQ(one["view"], two["view"]);
  EXPECT_EQ(two["result"]["shadows_reach_border"], false);
}

TEST_F(Frame, OfACityHasAMarginOfFiftyMetres) {
  ASSERT_EQ(run(profile(day_ + " --pixel 4")), 0) << err_;
  const auto bounds = summary()["view"]["bounds"];
  EXPECT_NEAR(bounds[2].get<double>() - bounds[0].get<double>(), 523.7 + 100, 8);
  EXPECT_NEAR(bounds[3].get<double>() - bounds[1].get<double>(), 556.4 + 100, 8);
}

TEST_F(Frame, OfACameraOnALongDayLooksFromWhereTheSunIsHigh) {
  ASSERT_EQ(profile_of_tower("--date 2024-06-21 --tz Europe/Vienna --view camera --size 80x50"), 0)
      << err_;
  const auto eye = summary()["view"]["definition"]["eye"];
  EXPECT_LT(eye[1].get<double>() / eye[3].get<double>(), -20) << "south of the tower";
  EXPECT_GT(eye[2].get<double>() / eye[3].get<double>(), 140) << "with ground around it";
}

TEST_F(Frame, OfALampIsThreeHeightsWide) {
  ASSERT_EQ(shadow("--light 0,-50,100 --pixel 1"), 0) << err_;
  EXPECT_EQ(summary()["view"]["bounds"], (nlohmann::json{-240.0, -240.0, 260.0, 260.0}));
}

}  // namespace
