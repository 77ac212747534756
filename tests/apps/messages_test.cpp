// What the program says to people who write something else than it wants, or swap what they write.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <apps/program.h>

namespace {

namespace fs = std::filesystem;

class Messages : public gnomon::testing::Program {
 protected:
  bool says(const std::string& words) const { return err_.find(words) != std::string::npos; }
  // There is a place to compare with: the zone table is a part of the package tzdata.
  static bool zone_table() { return fs::exists("/usr/share/zoneinfo/zone.tab"); }
};

TEST_F(Messages, OtherNamesOfOptionsLeadToOurs) {
  for (const auto& [said, meant] : {std::pair{"--timezone", "--tz"},
                                    {"--zone", "--tz"},
                                    {"--out", "--output"},
                                    {"--resolution", "--pixel"},
                                    {"--begin", "--from"},
                                    {"--step", "--every"},
                                    {"--lat", "--site LAT,LON"},
                                    {"--location", "--site LAT,LON"}}) {
    EXPECT_EQ(run(std::string("profile a.obj ") + said + " x"), 2);
    EXPECT_TRUE(says(std::string("Did you mean ") + meant + "?")) << said << ": " << err_;
  }
}

TEST_F(Messages, ATimeOfDayIsNoTimeOfAnAnimation) {
  EXPECT_NE(run("profile a.obj --time 9:00"), 0);
  EXPECT_TRUE(says("--time '9:00' cannot be read")) << err_;
  EXPECT_TRUE(says("a time of day belongs to --at, --from and --to")) << err_;
}

TEST_F(Messages, ASlipOfTheKeysIsCorrectedAndNothingElse) {
  EXPECT_EQ(run("profile a.obj --dat 2024-01-01"), 2);
  EXPECT_TRUE(says("Did you mean --date?")) << err_;
  EXPECT_EQ(run("profile a.obj --transparency 2"), 2);
  EXPECT_TRUE(says("--transparency")) << err_;
  EXPECT_FALSE(says("Did you mean")) << err_;
}

TEST_F(Messages, AnEmptyWindowIsSaidOnTheLocalClock) {
  EXPECT_EQ(run(profile("--date 2024-06-10 --from 17:00 --to 9:00 --tz Europe/Vienna")), 1);
  EXPECT_TRUE(says("begins at 2024-06-10 17:00:00 Europe/Vienna and ends at 2024-06-10 09:00:00"))
      << err_;
}

TEST_F(Messages, ConvertWithoutAnOutputShowsOne) {
  EXPECT_EQ(run("convert a.obj"), 2);
  EXPECT_TRUE(says("--output is required, such as -o scene.glb")) << err_;
}

TEST_F(Messages, SunOfATownSaysHowAPlaceIsWritten) {
  EXPECT_EQ(run("sun Bilbao"), 2);
  EXPECT_TRUE(says("--site LAT,LON")) << err_;
}

TEST_F(Messages, AStepAtNightIsSaidOnTheLocalClock) {
  ASSERT_EQ(run(profile("--date 2024-06-10 --from 19:30 --to 21:30 --every 30min --tz "
                        "Europe/Vienna --pixel 8")),
            0)
      << err_;
  EXPECT_TRUE(says("counts as night")) << err_;
  EXPECT_TRUE(says("2024-06-10 21:15:00 Europe/Vienna")) << err_;
}

TEST_F(Messages, ThePlaceIsAlwaysSaidAndByWhom) {
  ASSERT_EQ(run(profile(day_ + " --pixel 8")), 0) << err_;
  EXPECT_TRUE(out_.starts_with("place 48.2053 N, 16.3489 E, from the CRS\n")) << out_;
  ASSERT_EQ(run("shadow " + house() +
                " --site=-33.9,18.4 --date 2024-09-18 --at 12:00 --tz "
                "Africa/Johannesburg -o " +
                results()),
            0)
      << err_;
  EXPECT_NE(out_.find("place 33.9000 S, 18.4000 E, from --site\n"), std::string::npos) << out_;
}

TEST_F(Messages, LatitudeAndLongitudeInTheWrongOrderAreAWarning) {
  if (!zone_table()) GTEST_SKIP() << "no zone.tab on this machine";
  const std::string asked =
      "lies 4600 km from Europe/Vienna's own: are latitude and longitude swapped?";
  ASSERT_EQ(run("sun --site 16.35,48.2 --date 2024-03-21 --tz Europe/Vienna"), 0) << err_;
  EXPECT_TRUE(says(asked)) << err_;
  ASSERT_EQ(run("profile " + house() + " --site 16.35,48.2 " + day_ + " -o " + results()), 0)
      << err_;
  EXPECT_TRUE(says(asked)) << err_;
  ASSERT_EQ(run("shadow " + house() + " --site 16.35,48.2 -o " + results() +
                " --date 2024-09-18 --at 12:00 --tz Europe/Vienna"),
            0)
      << err_;
  EXPECT_TRUE(says(asked)) << err_;
}

TEST_F(Messages, APlaceFarFromItsZoneIsAWarningAndOneInALargeZoneIsNot) {
  if (!zone_table()) GTEST_SKIP() << "no zone.tab on this machine";
  ASSERT_EQ(run("sun --site=-34,-64 --date 2024-03-21 --tz Europe/Vienna"), 0) << err_;
  EXPECT_TRUE(says("check the place and --tz")) << err_;
  for (const char* good : {"39.47,75.99 --tz Asia/Shanghai", "43.26,-2.93 --tz Europe/Madrid",
                           "28.1,-15.4 --tz Atlantic/Canary", "48.2,16.37 --tz UTC"}) {
    ASSERT_EQ(run(std::string("sun --date 2024-03-21 --site=") + good), 0) << err_;
    EXPECT_FALSE(says(" km from ")) << good << ": " << err_;
  }
}

}  // namespace
