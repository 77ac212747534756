// report.html of gnomon profile, in words that a stranger understands.
#include <gtest/gtest.h>

#include <apps/program.h>

namespace {

class ReportCommand : public gnomon::testing::Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    const std::string scenes = GNOMON_SCENES "/footprints/";
    ASSERT_EQ(run("profile " + scenes + "quarter.geojson " + scenes +
                  "design.obj --up design.obj=z --site design.obj=48.20337,16.35437 --north "
                  "design.obj=12 --floor-height 3.2 --receive Ground --date 2024-06-10 --tz "
                  "Europe/Vienna --pixel 4 -o " +
                  results()),
              0)
        << err_;
    html_ = text(results() + "/report.html");
  }
  bool has(const std::string& words) const { return html_.find(words) != std::string::npos; }
  std::string html_;
};

TEST_F(ReportCommand, SaysWhatResultsRestOn) {
  EXPECT_TRUE(has("no terrain was given; the ground was made through the feet of the buildings"));
  EXPECT_TRUE(has("hours at a spot are right to about one step (1 h); --every 15min is finer"));
  EXPECT_TRUE(has("others are not counted"));
  EXPECT_FALSE(has("above sea level")) << "heights are the model's own";
}

TEST_F(ReportCommand, HasOptionsInWordsAndFilesByTheirNames) {
  EXPECT_TRUE(has("<dt>design.obj</dt><dd>up z, true north 12\u00b0 clockwise of the model"));
  EXPECT_TRUE(has("+y, site 48.20337\u00b0 N, 16.35437\u00b0 E</dd>"));
  EXPECT_TRUE(has("<dt>Models</dt><dd>quarter.geojson, design.obj</dd>"));
  EXPECT_TRUE(has("<dt>Footprints: height of a floor</dt><dd>3.2 m</dd>"));
  EXPECT_TRUE(has("<dt>Receive only</dt><dd>Ground</dd>"));
  EXPECT_TRUE(has("<dt>Pixel</dt><dd>4 m</dd>"));
  EXPECT_TRUE(has(", chosen</dd>")) << "bounds";
  for (const char* raw : {"floor_height", "for_files", "no_cast", "latitude_deg"})
    EXPECT_FALSE(has(raw)) << raw;
  EXPECT_FALSE(has(GNOMON_SCENES "/footprints/quarter.geojson</td>"));
}

TEST_F(ReportCommand, ThePictureSaysWhichOfTheStepsItShows) {
  EXPECT_TRUE(
      has("shadows laid over each other, at the ends of the steps (3 of 18 without "
          "sun)"))
      << "17 steps, the last of some seconds at sunset";
}

}  // namespace
