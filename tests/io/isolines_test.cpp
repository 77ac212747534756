#include <gnomon/io/isolines.h>
#include <gnomon/profile/hour_classes.h>
#include <gtest/gtest.h>
#include <io/write_limits.h>
#include <io/write_test_files.h>
#if __has_include(<gdal/gdal.h>)
#include <gdal/gdal.h>
#include <gdal/ogr_api.h>
#include <gdal/ogr_srs_api.h>
#else
#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>
#endif

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

using testing::TestFolder;

// GDAL moves values that equal the level by a millionth, at the level's side.
constexpr double kNudge = 1e-5;
constexpr std::uint64_t kHour = 3'600'000;

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

// Hours as f(column, row); negative: no sample.
template <class F>
Profile profile(int width, int height, F hours) {
  Profile p;
  p.width = width;
  p.height = height;
  p.daylight_ticks = 8 * kHour;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double h = hours(column, row);
      p.valid.push_back(h < 0 ? 0 : 1);
      p.shadow_ticks.push_back(h < 0 ? 0 : static_cast<std::uint32_t>(h * kHour));
    }
  }
  return p;
}

Frame vienna() {
  Frame frame;
  frame.origin = {983, 340433, 27};
  frame.crs = "EPSG:31256";
  return frame;
}

TEST(Isolines, OfAStraightEdgeLieOnTheEdgeHoweverFarTheHoursJump) {
  for (const double high : {1.0, 2.0, 8.0}) {
    const Profile p = profile(40, 30, [&](int x, int) { return x < 17 ? 0.0 : high; });
    const std::vector<Isoline> lines = find_isolines(p, plan(40, 30, 0.5), kHour);
    ASSERT_EQ(lines.size(), static_cast<std::size_t>(high));
    for (const Isoline& line : lines) {
      for (const Vec2& q : line.points) EXPECT_NEAR(q.x, -20 + 17 * 0.5, kNudge);
      EXPECT_NEAR(std::abs(line.points.front().y - line.points.back().y), 29 * 0.5, 0.5 + 1e-9);
    }
  }
}

TEST(Isolines, OfASlantingEdgeAreStraight) {
  const Profile p = profile(200, 100, [](int x, int y) { return x < 60 + 0.3 * y ? 0.0 : 3.0; });
  const std::vector<Isoline> lines = find_isolines(p, plan(200, 100, 1), kHour);
  ASSERT_EQ(lines.size(), 3u);
  for (const Isoline& line : lines) {
    EXPECT_LE(line.points.size(), 4u);
    for (const Vec2& q : line.points) {
      const double x = q.x + 20, y = 50 - q.y;  // samples; centres at + 1/2
      EXPECT_NEAR(x - 0.5, 60 + 0.3 * (y - 0.5), 1.0);
    }
  }
}

TEST(Isolines, SeparateWhatReachesTheLevelFromWhatDoesNotAndKeepWithinTwoSamples) {
  const auto hours = [](int x, int y) {
    return x > 70 && y > 60 ? -1.0
                            : std::floor(4 * (4 + 4 * std::sin(x / 9.0) * std::cos(y / 7.0))) / 4;
  };
  const int width = 120, height = 90;
  const Profile p = profile(width, height, hours);
  const View view = plan(width, height, 1);
  const std::vector<Isoline> lines = find_isolines(p, view, kHour, 1);
  EXPECT_GT(lines.size(), 20u);
  for (const Isoline& line : lines) {
    ASSERT_GE(line.points.size(), 2u);
    for (const Vec2& q : line.points) {
      bool below = false, above = false;
      const double x = q.x + 20, y = 50 - q.y;
      for (int row = std::max(0, static_cast<int>(y - 2));
           row < std::min(height, static_cast<int>(y + 2) + 1); ++row) {
        for (int column = std::max(0, static_cast<int>(x - 2));
             column < std::min(width, static_cast<int>(x + 2) + 1); ++column) {
          const std::size_t k = static_cast<std::size_t>(row * width + column);
          if (p.valid[k] == 0) continue;
          (p.shadow_ticks[k] >= line.level_ms ? above : below) = true;
        }
      }
      EXPECT_TRUE(below && above) << line.level_ms << " " << x << " " << y;
    }
  }
  const std::vector<Isoline> same = find_isolines(p, view, kHour, 3);
  ASSERT_EQ(same.size(), lines.size());
  for (std::size_t k = 0; k < same.size(); ++k) {
    EXPECT_EQ(same[k].level_ms, lines[k].level_ms);
    EXPECT_EQ(same[k].points, lines[k].points);
  }
}

TEST(Isolines, NoneAlongSamplesWithoutASurface) {
  const Profile p = profile(30, 30, [](int x, int) { return x < 10 ? 5.0 : -1.0; });
  EXPECT_TRUE(find_isolines(p, plan(30, 30, 1), kHour).empty());
}

TEST(Isolines, ReachTheDaylightItselfAndCountPerDay) {
  Profile p = profile(30, 30, [](int x, int) { return x < 10 ? 8.0 : 4.0; });
  EXPECT_EQ(find_isolines(p, plan(30, 30, 1), 8 * kHour).size(), 1u);
  p.days = 2;  // 4 and 2 hours a day of 4
  const std::vector<Isoline> lines = find_isolines(p, plan(30, 30, 1), kHour);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].level_ms, 3 * kHour);
  EXPECT_EQ(lines[1].level_ms, 4 * kHour);
}

struct Close {
  void operator()(void* dataset) const { GDALClose(dataset); }
};

TEST(Isolines, BothFilesGiveLevelsCrsAndPlaceBack) {
  const TestFolder folder;
  const Profile p = profile(40, 30, [](int x, int) { return x < 17 ? 0.0 : 2.0; });
  const std::vector<Isoline> lines = find_isolines(p, plan(40, 30, 0.5), kHour / 2);
  ASSERT_EQ(lines.size(), 4u);
  ::testing::internal::CaptureStderr();
  ASSERT_TRUE(write_isolines_geojson(folder / "isolines.geojson", lines, 7, vienna()));
  ASSERT_TRUE(write_isolines_gpkg(folder / "isolines.gpkg", lines, 7, vienna()));
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(folder.names().size(), 2u) << "no temporaries";
  GDALAllRegister();
  for (const char* name : {"isolines.geojson", "isolines.gpkg"}) {
    const std::unique_ptr<void, Close> file(
        GDALOpenEx((folder / name).c_str(), GDAL_OF_VECTOR, nullptr, nullptr, nullptr));
    ASSERT_TRUE(file) << name;
    const OGRLayerH layer = GDALDatasetGetLayer(file.get(), 0);
    EXPECT_STREQ(OGR_L_GetName(layer), "shadow hours isolines");
    ASSERT_NE(OGR_L_GetSpatialRef(layer), nullptr);
    EXPECT_STREQ(OSRGetAuthorityCode(OGR_L_GetSpatialRef(layer), nullptr), "31256");
    const OGRFeatureDefnH fields = OGR_L_GetLayerDefn(layer);
    const std::pair<const char*, OGRFieldType> expected[] = {
        {"hours", OFTReal}, {"minutes", OFTInteger}, {"days", OFTInteger}};
    for (const auto& [field, type] : expected) {
      const int at = OGR_FD_GetFieldIndex(fields, field);
      ASSERT_GE(at, 0) << field;
      EXPECT_EQ(OGR_Fld_GetType(OGR_FD_GetFieldDefn(fields, at)), type) << field;
    }
    ASSERT_EQ(OGR_L_GetFeatureCount(layer, 1), 4);
    for (int k = 1; k <= 4; ++k) {
      const OGRFeatureH f = OGR_L_GetNextFeature(layer);
      EXPECT_EQ(OGR_F_GetFieldAsDouble(f, OGR_F_GetFieldIndex(f, "hours")), k / 2.0);
      EXPECT_EQ(OGR_F_GetFieldAsInteger(f, OGR_F_GetFieldIndex(f, "minutes")), 30 * k);
      EXPECT_EQ(OGR_F_GetFieldAsInteger(f, OGR_F_GetFieldIndex(f, "days")), 7);
      EXPECT_NEAR(OGR_G_GetX(OGR_F_GetGeometryRef(f), 0), 983 - 20 + 8.5, 1e-3);
      OGR_F_Destroy(f);
    }
  }
}

TEST(Isolines, WithoutCrsOrLinesAreStillFiles) {
  const TestFolder folder;
  ASSERT_TRUE(write_isolines_geojson(folder / "isolines.geojson", {}, 1, Frame{}));
  ASSERT_TRUE(write_isolines_gpkg(folder / "isolines.gpkg", {}, 1, Frame{}));
  const auto json = nlohmann::json::parse(testing::content(folder / "isolines.geojson"));
  EXPECT_TRUE(json["features"].empty());
  EXPECT_FALSE(json.contains("crs"));
}

TEST(Isolines, LeaveTheOlderFileWhereTheDiskIsFull) {
  const TestFolder folder;
  const Profile p = profile(300, 300, [](int x, int y) { return (x / 4 + y / 4) % 2 * 4.0; });
  const std::vector<Isoline> lines = find_isolines(p, plan(300, 300, 1), kHour);
  for (const char* name : {"isolines.geojson", "isolines.gpkg"}) {
    ASSERT_TRUE(write_text_file(folder / name, "older result"));
    ::testing::internal::CaptureStderr();
    {
      const testing::FileSizeLimit limit(30'000);
      const auto written = std::string(name) == "isolines.gpkg"
                               ? write_isolines_gpkg(folder / name, lines, 1, vienna())
                               : write_isolines_geojson(folder / name, lines, 1, vienna());
      EXPECT_FALSE(written) << name;
    }
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(testing::content(folder / name), "older result");
  }
  EXPECT_EQ(folder.names().size(), 2u) << "no temporaries, no journals";
}

}  // namespace
}  // namespace gnomon
