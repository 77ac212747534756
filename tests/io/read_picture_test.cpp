#include <gnomon/io/read_picture.h>

#include <cstdlib>

#include "looks_files.h"

namespace gnomon {
namespace {

using namespace testing_files;

TEST(ReadPicture, PngComesRowByRowFromTheTop) {
  const auto t = read_picture(png(four_colours()), "four.png");
  ASSERT_TRUE(t) << t.error().message;
  EXPECT_EQ(t.value().width, 2);
  EXPECT_EQ(t.value().height, 2);
  EXPECT_EQ(t.value().name, "four.png");
  const std::vector<std::uint8_t> wanted = {255, 0, 0,   255, 0,   255, 0,   255,
                                            0,   0, 255, 255, 255, 255, 255, 255};
  EXPECT_EQ(t.value().rgba, wanted);
}

TEST(ReadPicture, GreyAndAlphaAreKeptApart) {
  const auto t = read_picture(picture_by_gdal("PNG", 2, 1, {{10, 200}, {0, 77}}), "g");
  ASSERT_TRUE(t) << t.error().message;
  EXPECT_EQ(t.value().rgba, (std::vector<std::uint8_t>{10, 10, 10, 0, 200, 200, 200, 77}));
}

TEST(ReadPicture, JpegBmpAndGifAreRead) {
  const std::vector<std::uint8_t> red(64, 250), green(64, 100), blue(64, 30);
  for (const char* driver : {"JPEG", "BMP"}) {
    const auto t = read_picture(picture_by_gdal(driver, 8, 8, {red, green, blue}), "p");
    ASSERT_TRUE(t) << driver << ": " << t.error().message;
    ASSERT_EQ(t.value().rgba.size(), 256u);
    for (std::size_t k = 0; k < 256; k += 4) {
      EXPECT_LE(std::abs(t.value().rgba[k] - 250), 3) << driver;
      EXPECT_LE(std::abs(t.value().rgba[k + 1] - 100), 3) << driver;
      EXPECT_LE(std::abs(t.value().rgba[k + 2] - 30), 3) << driver;
      EXPECT_EQ(t.value().rgba[k + 3], 255) << driver;
    }
  }
  const auto gif = read_picture(picture_by_gdal("GIF", 2, 1, {{7, 9}}), "g");  // has a palette
  ASSERT_TRUE(gif) << gif.error().message;
  EXPECT_EQ(gif.value().rgba, (std::vector<std::uint8_t>{7, 7, 7, 255, 9, 9, 9, 255}));
}

TEST(ReadPicture, WhatIsNoPictureOrCutOffSaysWhy) {
  EXPECT_FALSE(read_picture("", "p"));
  EXPECT_FALSE(read_picture("no picture at all", "p"));
  std::string noise;
  for (int k = 0; k < 64 * 64; ++k) noise += static_cast<char>(k * k * 31 >> 3);
  const std::vector<std::uint8_t> band(noise.begin(), noise.end());
  for (const char* driver : {"PNG", "JPEG", "BMP"}) {
    const std::string whole = picture_by_gdal(driver, 64, 64, {band, band, band});
    const auto t = read_picture(whole.substr(0, whole.size() / 2), "p");
    ASSERT_FALSE(t) << driver;
    EXPECT_FALSE(t.error().message.empty());
  }
}

}  // namespace
}  // namespace gnomon
