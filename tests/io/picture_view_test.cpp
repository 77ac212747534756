#include <gnomon/io/view_picture.h>
#include <gtest/gtest.h>
#include <io/write_test_files.h>

#include <algorithm>
#include <cmath>

namespace gnomon {
namespace {

// A level patch of ground, lit alike, `shadows` of 8 upon it.
ViewSamples ground(int width, int height, int downsample, std::uint16_t shadows) {
  ViewSamples s;
  s.width = width;
  s.height = height;
  s.downsample = downsample;
  s.instants = 8;
  const std::size_t samples = static_cast<std::size_t>(width * height);
  s.shadows.assign(samples, shadows);
  s.valid.assign(samples, 1);
  s.shading.shade.assign(samples, 1.0F);
  s.shading.colour.assign(samples, Rgb{220, 217, 209});
  return s;
}

const ViewCaption kCaption{"Vienna", {"18 September 2024"}, "gnomon", "Stadt Wien"};

TEST(LightLeft, IsTakenInEqualSharesByEachShadow) {
  EXPECT_EQ(light_left(0, 8).g, 1.0F);
  for (int n = 1; n <= 8; ++n) {
    EXPECT_LT(light_left(n, 8).g, light_left(n - 1, 8).g);
    EXPECT_NEAR(light_left(n, 8).g / light_left(n - 1, 8).g, light_left(1, 8).g, 1e-5);
  }
  EXPECT_EQ(light_left(8, 8).g, light_left(96, 96).g) << "all shadows are as dark for any number";
  EXPECT_EQ(light_left(0, 0).g, 1.0F);
}

TEST(DrawView, KeepsTheColourOfGroundWithoutShadow) {
  const Picture picture = draw_view(ground(600, 400, 1, 0), kCaption);
  EXPECT_EQ(at(picture, 300, 200), (Rgb{220, 217, 209}));
}

TEST(DrawView, IsDarkerTheMoreShadowsLieThere) {
  int before = 256;
  for (std::uint16_t n = 0; n <= 8; ++n) {
    const int now = at(draw_view(ground(600, 400, 1, n), kCaption), 300, 200).g;
    EXPECT_LE(now, before - 10) << n << " shadows cannot be told from " << n - 1;
    before = now;
  }
  EXPECT_GT(before, 40) << "even the darkest place shows what stands there";
}

TEST(DrawView, AveragesSupersamplesInLinearLight) {
  ViewSamples s = ground(8, 8, 2, 0);
  for (std::size_t k = 0; k < 64; k += 2) s.shading.colour[k] = {0, 0, 0};
  for (std::size_t k = 1; k < 64; k += 2) s.shading.colour[k] = {255, 255, 255};
  const Picture picture = draw_view(s, kCaption);
  const int x = (picture.width - 4) / 2;
  EXPECT_EQ(at(picture, x, 0), (Rgb{188, 188, 188})) << "half the light of white in sRGB";
}

TEST(DrawView, ShowsSkyThatPalesTowardsTheHorizon) {
  ViewSamples s = ground(600, 400, 1, 0);
  std::fill(s.valid.begin(), s.valid.end(), std::uint8_t{0});
  const Picture picture = draw_view(s, kCaption);
  EXPECT_GT(at(picture, 10, 0).b, at(picture, 10, 0).r);
  EXPECT_GT(at(picture, 10, 399).r, at(picture, 10, 0).r);
}

TEST(DrawView, DrawsEdgesDark) {
  ViewSamples s = ground(600, 400, 1, 0);
  s.shading.edge.assign(s.valid.size(), 0);
  s.shading.edge[200 * 600 + 300] = 1;
  const Picture picture = draw_view(s, kCaption);
  EXPECT_LT(at(picture, 300, 200).g, at(picture, 301, 200).g - 30);
}

TEST(DrawView, HasTheSizeOfTheSamplesAndAStripBelow) {
  const Picture picture = draw_view(ground(1200, 800, 2, 3), kCaption);
  EXPECT_EQ(picture.width, 600);
  EXPECT_GT(picture.height, 400);
  EXPECT_LT(picture.height, 600);
  EXPECT_EQ(at(picture, 1, picture.height - 1), (Rgb{255, 255, 255}));
}

TEST(DrawView, DrawsTinyViewsAndNoShadowsAtAll) {
  ViewSamples s = ground(2, 2, 2, 0);
  s.instants = 0;
  const Picture picture = draw_view(s, kCaption);
  EXPECT_GT(picture.width, 200) << "the caption needs room";
  EXPECT_TRUE(draw_view(ground(400, 300, 1, 8), {}).height > 300) << "without any words";
}

TEST(DrawView, IsTheSameForAnyNumberOfThreads) {
  ViewSamples s = ground(640, 480, 2, 0);
  for (std::size_t k = 0; k < s.shadows.size(); ++k)
    s.shadows[k] = static_cast<std::uint16_t>(k % 9);
  EXPECT_TRUE(draw_view(s, kCaption, 1).pixels == draw_view(s, kCaption, 5).pixels);
}

TEST(WriteViewPicture, NamesTheFileItCannotWrite) {
  const testing::TestFolder folder;
  const Result<FileWritten> written =
      write_view_picture(folder.path() / "missing" / "view.png", ground(4, 4, 1, 0), kCaption);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("missing/view.png"), std::string::npos);
}

}  // namespace
}  // namespace gnomon
