#include <gnomon/io/write_geotiff.h>
#include <gtest/gtest.h>
#include <io/write_limits.h>
#include <io/write_test_files.h>
// GDAL's headers stand in a folder of their own on Debian; the test target does not name it.
#if __has_include(<gdal/gdal.h>)
#include <gdal/gdal.h>
#include <gdal/ogr_spatialref.h>
#else
#include <gdal.h>
#include <ogr_spatialref.h>
#endif

#include <memory>
#include <random>

namespace gnomon {
namespace {

using testing::FileSizeLimit;
using testing::TestFolder;

View plan(int width, int height, double pixel) {
  View view;
  view.eye = {0, 0, 1, 0};
  view.origin = {-20, 50, 0, 1};
  view.right = {pixel, 0, 0, 0};
  view.down = {0, -pixel, 0, 0};
  view.width = width;
  view.height = height;
  return view;
}

View camera(int width, int height) {
  View view;
  view.eye = {0, -100, 50, 1};
  view.origin = {-0.5, 1, 0.3, 0};
  view.right = {1.0 / width, 0, 0, 0};
  view.down = {0, 0, -1.0 / height, 0};
  view.width = width;
  view.height = height;
  return view;
}

// Every 7th sample is missing; the others have k quarter hours of 8 hours of daylight.
Profile quarters(int width, int height) {
  Profile p;
  p.width = width;
  p.height = height;
  p.daylight_ticks = 8 * 3'600'000;
  for (int k = 0; k < width * height; ++k) {
    p.valid.push_back(k % 7 != 0);
    p.shadow_ticks.push_back(k % 7 != 0 ? static_cast<std::uint32_t>(k % 33) * 900'000 : 0);
  }
  return p;
}

Frame vienna() {
  Frame frame;
  frame.origin = {983.16, 340433.878, 27.861};
  frame.crs = "EPSG:31256";
  return frame;
}

struct Close {
  void operator()(void* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, Close>;

Dataset open(const std::filesystem::path& path) {
  GDALAllRegister();
  return Dataset(GDALOpen(path.c_str(), GA_ReadOnly));
}

std::vector<float> read(GDALRasterBandH band, int width, int height) {
  std::vector<float> values(static_cast<std::size_t>(width * height));
  EXPECT_EQ(GDALRasterIO(band, GF_Read, 0, 0, width, height, values.data(), width, height,
                         GDT_Float32, 0, 0),
            CE_None);
  return values;
}

std::string item(GDALMajorObjectH object, const char* key, const char* domain) {
  const char* value = GDALGetMetadataItem(object, key, domain);
  return value ? value : "";
}

TEST(WriteGeotiff, GivesBackEveryValue) {
  const TestFolder folder;
  const Profile p = quarters(300, 270);  // more than one tile each way, the last ones not full
  const Result<FileWritten> written =
      write_profile_geotiff(folder / "profile.tif", p, plan(300, 270, 0.5), vienna(), {});
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(written.value().bytes, std::filesystem::file_size(folder / "profile.tif"));
  const Dataset file = open(folder / "profile.tif");
  ASSERT_TRUE(file);
  ASSERT_EQ(GDALGetRasterCount(file.get()), 2);
  const std::vector<float> shadow = read(GDALGetRasterBand(file.get(), 1), 300, 270);
  const std::vector<float> sun = read(GDALGetRasterBand(file.get(), 2), 300, 270);
  for (std::size_t k = 0; k < shadow.size(); ++k) {
    if (!p.valid[k]) {
      ASSERT_EQ(shadow[k], kNoDataHours) << k;
      ASSERT_EQ(sun[k], kNoDataHours) << k;
    } else {  // quarters of an hour are exact in float
      ASSERT_EQ(shadow[k], shadow_hours(p, k)) << k;
      ASSERT_EQ(sun[k], sun_hours(p, k)) << k;
    }
  }
}

TEST(WriteGeotiff, NamesBandsUnitAndNodata) {
  const TestFolder folder;
  ASSERT_TRUE(write_profile_geotiff(folder / "profile.tif", quarters(40, 30), plan(40, 30, 1),
                                    vienna(), {}));
  const Dataset file = open(folder / "profile.tif");
  ASSERT_TRUE(file);
  const char* names[] = {"hours in shadow", "hours of sun"};
  for (int k = 0; k < 2; ++k) {
    const GDALRasterBandH band = GDALGetRasterBand(file.get(), k + 1);
    EXPECT_STREQ(GDALGetDescription(band), names[k]);
    EXPECT_STREQ(GDALGetRasterUnitType(band), "h");
    EXPECT_EQ(GDALGetRasterDataType(band), GDT_Float32);
    int has = 0;
    EXPECT_EQ(GDALGetRasterNoDataValue(band, &has), -9999.0);
    EXPECT_TRUE(has);
  }
}

TEST(WriteGeotiff, FirstAndLastSunAreClockTimesAndNodataWhereTheSunNeverComes) {
  const TestFolder folder;
  Profile p = quarters(40, 30);
  p.days = 3;
  p.first_lit.assign(p.valid.size(), 1);
  p.last_lit.assign(p.valid.size(), 0);
  p.lit_from_ms = {32'400'000, 33'300'000};  // 9:00, 9:15
  p.lit_to_ms = {61'200'000};                // 17:00
  p.first_lit[1] = kNeverLit;
  ASSERT_TRUE(write_profile_geotiff(folder / "profile.tif", p, plan(40, 30, 1), vienna(), {}));
  const Dataset file = open(folder / "profile.tif");
  ASSERT_TRUE(file);
  ASSERT_EQ(GDALGetRasterCount(file.get()), 4);
  EXPECT_EQ(item(file.get(), "DAYS", nullptr), "3");
  const char* names[] = {"hours in shadow per day", "hours of sun per day", "first sun",
                         "last sun"};
  for (int k = 0; k < 4; ++k) {
    const GDALRasterBandH band = GDALGetRasterBand(file.get(), k + 1);
    EXPECT_STREQ(GDALGetDescription(band), names[k]);
    EXPECT_STREQ(GDALGetRasterUnitType(band), "h");
  }
  const std::vector<float> hours = read(GDALGetRasterBand(file.get(), 1), 40, 30);
  const std::vector<float> first = read(GDALGetRasterBand(file.get(), 3), 40, 30);
  const std::vector<float> last = read(GDALGetRasterBand(file.get(), 4), 40, 30);
  EXPECT_EQ(hours[2], static_cast<float>(0.5 / 3));
  EXPECT_EQ(first[0], kNoDataHours) << "no sample";
  EXPECT_EQ(first[1], kNoDataHours) << "never lit";
  EXPECT_EQ(last[1], kNoDataHours);
  EXPECT_EQ(first[2], 9.25F);
  EXPECT_EQ(last[2], 17.0F);
}

TEST(WriteGeotiff, IsTiledAndDeflated) {
  const TestFolder folder;
  ASSERT_TRUE(write_profile_geotiff(folder / "profile.tif", quarters(600, 600), plan(600, 600, 1),
                                    vienna(), {}));
  const Dataset file = open(folder / "profile.tif");
  ASSERT_TRUE(file);
  int x = 0, y = 0;
  GDALGetBlockSize(GDALGetRasterBand(file.get(), 1), &x, &y);
  EXPECT_EQ(x, 256);
  EXPECT_EQ(y, 256);
  EXPECT_EQ(item(file.get(), "COMPRESSION", "IMAGE_STRUCTURE"), "DEFLATE");
}

TEST(WriteGeotiff, LiesWhereTheModelLies) {
  const TestFolder folder;
  ASSERT_TRUE(write_profile_geotiff(folder / "profile.tif", quarters(40, 30), plan(40, 30, 0.5),
                                    vienna(), {}));
  const Dataset file = open(folder / "profile.tif");
  ASSERT_TRUE(file);
  double t[6] = {};
  ASSERT_EQ(GDALGetGeoTransform(file.get(), t), CE_None);
  EXPECT_DOUBLE_EQ(t[0], 983.16 - 20);      // upper left corner: east
  EXPECT_DOUBLE_EQ(t[3], 340433.878 + 50);  // and north
  EXPECT_DOUBLE_EQ(t[1], 0.5);
  EXPECT_DOUBLE_EQ(t[5], -0.5);  // rows go south
  EXPECT_EQ(t[2], 0);
  EXPECT_EQ(t[4], 0);
  const auto* crs = OGRSpatialReference::FromHandle(GDALGetSpatialRef(file.get()));
  ASSERT_NE(crs, nullptr);
  EXPECT_STREQ(crs->GetAuthorityCode(nullptr), "31256");
}

TEST(WriteGeotiff, TakesTheHorizontalPartOfACompoundCrs) {
  const TestFolder folder;
  Frame frame;
  frame.crs = "EPSG:7415";  // Amersfoort / RD New + NAP height
  ASSERT_TRUE(
      write_profile_geotiff(folder / "profile.tif", quarters(4, 3), plan(4, 3, 1), frame, {}));
  const Dataset file = open(folder / "profile.tif");
  ASSERT_TRUE(file);
  const auto* crs = OGRSpatialReference::FromHandle(GDALGetSpatialRef(file.get()));
  ASSERT_NE(crs, nullptr);
  EXPECT_STREQ(crs->GetAuthorityCode(nullptr), "28992");
}

TEST(WriteGeotiff, HasNoCrsWhereTheModelHasNone) {
  const TestFolder folder;
  ASSERT_TRUE(
      write_profile_geotiff(folder / "profile.tif", quarters(4, 3), plan(4, 3, 1), Frame{}, {}));
  const Dataset file = open(folder / "profile.tif");
  ASSERT_TRUE(file);
  EXPECT_EQ(GDALGetSpatialRef(file.get()), nullptr);
  double t[6] = {};
  ASSERT_EQ(GDALGetGeoTransform(file.get(), t), CE_None) << "local metres are georeferenced alike";
  EXPECT_DOUBLE_EQ(t[0], -20);
}

TEST(WriteGeotiff, LeavesCameraViewsWithoutPlace) {
  const TestFolder folder;
  ASSERT_TRUE(write_profile_geotiff(folder / "profile.tif", quarters(40, 30), camera(40, 30),
                                    vienna(), {}));
  const Dataset file = open(folder / "profile.tif");
  ASSERT_TRUE(file);
  double t[6] = {};
  EXPECT_EQ(GDALGetGeoTransform(file.get(), t), CE_Failure);
  EXPECT_EQ(GDALGetSpatialRef(file.get()), nullptr);
}

TEST(WriteGeotiff, CarriesStatisticsAndMetadataInTheFileItself) {
  const TestFolder folder;
  Profile p = quarters(4, 2);
  p.valid = {0, 1, 1, 1, 1, 0, 0, 0};
  p.shadow_ticks = {0, 3'600'000, 7'200'000, 10'800'000, 14'400'000, 0, 0, 0};  // 1 2 3 4 hours
  ASSERT_TRUE(write_profile_geotiff(folder / "profile.tif", p, plan(4, 2, 1), vienna(),
                                    {{"date", "2024-09-18"}, {"TIFFTAG_SOFTWARE", "gnomon"}}));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"profile.tif"}) << "no .aux.xml, no temporary";
  const Dataset file = open(folder / "profile.tif");
  ASSERT_TRUE(file);
  EXPECT_EQ(item(file.get(), "date", nullptr), "2024-09-18");
  EXPECT_EQ(item(file.get(), "TIFFTAG_SOFTWARE", nullptr), "gnomon");
  double min = 0, max = 0, mean = 0, deviation = 0;
  ASSERT_EQ(GDALGetRasterStatistics(GDALGetRasterBand(file.get(), 2), true, false, &min, &max,
                                    &mean, &deviation),
            CE_None);
  EXPECT_EQ(min, 4);
  EXPECT_EQ(max, 7);
  EXPECT_EQ(mean, 5.5);
  EXPECT_NEAR(deviation, std::sqrt(1.25), 1e-8);
}

TEST(WriteGeotiff, IsTheSameFileForAnyNumberOfThreads) {
  const TestFolder folder;
  const Profile p = quarters(600, 500);
  std::string first;
  for (const int threads : {1, 2, 7}) {
    GeotiffPacking packing;
    packing.threads = threads;
    ASSERT_TRUE(
        write_profile_geotiff(folder / "profile.tif", p, plan(600, 500, 1), vienna(), {}, packing));
    const std::string bytes = testing::content(folder / "profile.tif");
    if (first.empty()) first = bytes;
    EXPECT_EQ(bytes == first, true) << threads << " threads";
  }
}

TEST(WriteGeotiff, RefusesAnUnknownCrsBeforeItWrites) {
  const TestFolder folder;
  Frame frame;
  frame.crs = "EPSG:999999";
  ::testing::internal::CaptureStderr();
  const Result<FileWritten> written =
      write_profile_geotiff(folder / "profile.tif", quarters(4, 3), plan(4, 3, 1), frame, {});
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("EPSG:999999"), std::string::npos);
  EXPECT_TRUE(folder.names().empty());
}

TEST(WriteGeotiff, NamesTheFolderThatIsMissing) {
  const TestFolder folder;
  const Result<FileWritten> written = write_profile_geotiff(
      folder.path() / "missing" / "profile.tif", quarters(4, 3), plan(4, 3, 1), vienna(), {});
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("missing/profile.tif"), std::string::npos);
  EXPECT_NE(written.error().message.find("make the folder first"), std::string::npos);
}

TEST(WriteGeotiff, LeavesTheOlderFileWhenTheDiskIsFull) {
  const TestFolder folder;
  ASSERT_TRUE(write_text_file(folder / "profile.tif", "older result"));
  Profile p = quarters(700, 700);
  std::mt19937 noise(1);  // does not compress
  for (std::uint32_t& ms : p.shadow_ticks)
    ms = static_cast<std::uint32_t>(noise() % p.daylight_ticks);
  // Full from the start, after some tiles, and only when the directory is written at the end.
  for (const rlim_t bytes : {rlim_t{10}, rlim_t{100'000}, rlim_t{1'500'000}}) {
    ::testing::internal::CaptureStderr();
    {
      const FileSizeLimit limit(bytes);
      const Result<FileWritten> written =
          write_profile_geotiff(folder / "profile.tif", p, plan(700, 700, 1), vienna(), {});
      EXPECT_FALSE(written) << bytes;
      if (!written) {
        EXPECT_NE(written.error().message.find("profile.tif"), std::string::npos);
      }
    }
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(testing::content(folder / "profile.tif"), "older result");
    EXPECT_EQ(folder.names().size(), 1U);
  }
}

}  // namespace
}  // namespace gnomon
