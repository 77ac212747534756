#include <gnomon/io/png.h>
#include <gtest/gtest.h>
#include <io/write_limits.h>
#include <io/write_test_files.h>
#if __has_include(<gdal/gdal.h>)
#include <gdal/gdal.h>
#else
#include <gdal.h>
#endif

#include <random>

namespace gnomon {
namespace {

using testing::TestFolder;

// GDAL reads PNG through libpng, which checks sums and structure.
Picture decode(const std::filesystem::path& path) {
  GDALAllRegister();
  GDALDatasetH file = GDALOpen(path.c_str(), GA_ReadOnly);
  if (!file) return {};
  Picture out{GDALGetRasterXSize(file), GDALGetRasterYSize(file), {}};
  EXPECT_EQ(GDALGetRasterCount(file), 3);
  out.pixels.resize(static_cast<std::size_t>(out.width * out.height));
  int bands[] = {1, 2, 3};
  EXPECT_EQ(GDALDatasetRasterIO(file, GF_Read, 0, 0, out.width, out.height, out.pixels.data(),
                                out.width, out.height, GDT_Byte, 3, bands, 3, 3 * out.width, 1),
            CE_None);
  GDALClose(file);
  return out;
}

// Flat areas, gradients and noise, so that every filter is chosen for some row.
Picture varied(int width, int height) {
  Picture p{width, height, {}};
  std::mt19937 noise(7);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto random = static_cast<std::uint8_t>(noise());
      const auto slope = static_cast<std::uint8_t>(x + 2 * y);
      if (y % 4 == 0) p.pixels.push_back({random, static_cast<std::uint8_t>(noise()), random});
      if (y % 4 == 1) p.pixels.push_back({slope, slope, 0});
      if (y % 4 == 2)
        p.pixels.push_back(p.pixels[p.pixels.size() - static_cast<std::size_t>(width)]);
      if (y % 4 == 3) p.pixels.push_back({0, 0, 255});
    }
  }
  return p;
}

TEST(Png, GivesBackEveryPixel) {
  const TestFolder folder;
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {317, 40}, {1024, 3}}) {
    const Picture picture = varied(width, height);
    ASSERT_TRUE(write_png(folder / "a.png", picture));
    const Picture back = decode(folder / "a.png");
    ASSERT_EQ(back.width, width);
    ASSERT_EQ(back.height, height);
    EXPECT_TRUE(back.pixels == picture.pixels) << width << " x " << height;
  }
}

TEST(Png, IsTheSameForAnyNumberOfThreads) {
  const Picture picture = varied(200, 100);
  const std::string one = encode_png(picture, 3, 1).value();
  EXPECT_TRUE(encode_png(picture, 3, 2).value() == one);
  EXPECT_TRUE(encode_png(picture, 3, 7).value() == one);
}

TEST(Png, LeavesNoHalfFileWhenTheDiskIsFull) {
  const TestFolder folder;
  const testing::FileSizeLimit limit(500);
  const Result<FileWritten> written = write_png(folder / "a.png", varied(200, 100));
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("a.png"), std::string::npos);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace gnomon
