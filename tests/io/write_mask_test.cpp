#include <gnomon/io/mask_picture.h>
#include <gnomon/io/outlines.h>
#include <gnomon/io/picture_map.h>
#include <gnomon/io/write_mask.h>
#include <gtest/gtest.h>
#include <io/write_test_files.h>
// GDAL's headers stand in a folder of their own on Debian; the test target does not name it.
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
#include <random>

namespace gnomon {
namespace {

using testing::content;
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

Frame vienna() {
  Frame frame;
  frame.origin = {983, 340433, 27};
  frame.crs = "EPSG:31256";
  return frame;
}

// Shadow with the given probability; every 7th sample is missing.
ShadowMask random_mask(int width, int height, unsigned seed, double probability) {
  std::mt19937 random(seed);
  ShadowMask mask{width, height, {}};
  for (int k = 0; k < width * height; ++k) {
    const bool shadow = static_cast<double>(random() % 1000) < 1000 * probability;
    mask.state.push_back(k % 7 == 3 ? ShadowMask::kNoSample
                         : shadow   ? ShadowMask::kShadow
                                    : ShadowMask::kLit);
  }
  return mask;
}

std::uint64_t shadows(const ShadowMask& mask) {
  return static_cast<std::uint64_t>(
      std::count(mask.state.begin(), mask.state.end(), ShadowMask::kShadow));
}

struct Close {
  void operator()(void* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, Close>;

TEST(WriteMask, ReadsBackTheSameBytesInTheSamePlaceWithNodataDeclared) {
  const TestFolder folder;
  const ShadowMask mask = random_mask(300, 270, 1, 0.4);
  const View view = plan(300, 270, 0.5);
  const auto written = write_mask_geotiff(folder / "mask.tif", mask, view, vienna(),
                                          {{"TIFFTAG_SOFTWARE", "gnomon test"}});
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(folder.names(), std::vector<std::string>{"mask.tif"});
  GDALAllRegister();
  const Dataset dataset(GDALOpen((folder / "mask.tif").c_str(), GA_ReadOnly));
  ASSERT_TRUE(dataset);
  ASSERT_EQ(GDALGetRasterCount(dataset.get()), 1);
  const GDALRasterBandH band = GDALGetRasterBand(dataset.get(), 1);
  std::vector<std::uint8_t> read(mask.state.size());
  ASSERT_EQ(GDALRasterIO(band, GF_Read, 0, 0, 300, 270, read.data(), 300, 270, GDT_Byte, 0, 0),
            CE_None);
  EXPECT_EQ(read, mask.state);
  int declared = 0;
  EXPECT_EQ(GDALGetRasterNoDataValue(band, &declared), 255);
  EXPECT_TRUE(declared);
  double t[6];
  ASSERT_EQ(GDALGetGeoTransform(dataset.get(), t), CE_None);
  EXPECT_EQ(t[0], 963);
  EXPECT_EQ(t[3], 340483);
  EXPECT_EQ(t[1], 0.5);
  EXPECT_EQ(t[5], -0.5);
  EXPECT_STREQ(OSRGetAuthorityCode(GDALGetSpatialRef(dataset.get()), nullptr), "31256");
}

TEST(WriteMask, BytesDoNotDependOnThreads) {
  const TestFolder folder;
  const ShadowMask mask = random_mask(700, 600, 2, 0.3);
  const View view = plan(700, 600, 1);
  ASSERT_TRUE(write_mask_geotiff(folder / "1.tif", mask, view, vienna(), {}, 1));
  ASSERT_TRUE(write_mask_geotiff(folder / "2.tif", mask, view, vienna(), {}, 2));
  EXPECT_EQ(content(folder / "1.tif"), content(folder / "2.tif"));
}

TEST(WriteMask, UnknownCrsIsAnErrorAndLeavesNothing) {
  const TestFolder folder;
  Frame frame = vienna();
  frame.crs = "EPSG:999999";
  const ShadowMask mask = random_mask(4, 4, 1, 0.5);
  const auto written = write_mask_geotiff(folder / "mask.tif", mask, plan(4, 4, 1), frame, {});
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("EPSG:999999"), std::string::npos);
  EXPECT_TRUE(folder.names().empty());
}

TEST(MaskPicture, PaintsLitShadowAndNoSurfaceInTheLegendsColours) {
  ShadowMask mask{3, 1, {ShadowMask::kLit, ShadowMask::kShadow, ShadowMask::kNoSample}};
  const Picture map = draw_mask(mask);
  const int third = map.width / 3;
  EXPECT_EQ(at(map, third / 2, 0), kLitColour);
  EXPECT_EQ(at(map, third + third / 2, 0), kShadowColour);
  EXPECT_EQ(at(map, 2 * third + third / 2, 0), kNoDataColour);
}

// Nested rings, diagonal neighbours, holes that touch: all that 4-connected outlines must get
// right.
TEST(Outlines, AreValidPolygonsWhoseAreasAddUpToTheShadow) {
  GDALAllRegister();
  std::size_t polygons = 0, holes = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const ShadowMask mask = random_mask(23, 17, seed, 0.2 + 0.01 * seed);
    const View view = plan(23, 17, 0.25);
    const auto outlines = shadow_outlines(mask, view, vienna());
    ASSERT_TRUE(outlines) << outlines.error().message;
    std::uint64_t samples = 0;
    for (const Outline& outline : outlines.value()) {
      OGRGeometryH polygon = OGR_G_CreateGeometry(wkbPolygon);
      for (std::size_t r = 0; r < outline.rings.size(); ++r) {
        const auto& ring = outline.rings[r];
        ASSERT_EQ(ring.front(), ring.back());
        OGRGeometryH line = OGR_G_CreateGeometry(wkbLinearRing);
        double twice = 0;
        for (std::size_t k = 0; k < ring.size(); ++k) {
          OGR_G_AddPoint_2D(line, ring[k].x, ring[k].y);
          if (k > 0) {
            const Vec2 a = ring[k - 1] - ring[0], b = ring[k] - ring[0];
            twice += a.x * b.y - a.y * b.x;
          }
        }
        EXPECT_EQ(twice > 0, r == 0) << "outer rings run counter-clockwise, holes clockwise";
        OGR_G_AddGeometryDirectly(polygon, line);
      }
      EXPECT_TRUE(OGR_G_IsValid(polygon)) << "seed " << seed;
      EXPECT_EQ(OGR_G_Area(polygon), static_cast<double>(outline.samples) * 0.0625);
      OGR_G_DestroyGeometry(polygon);
      samples += outline.samples;
      ++polygons;
      holes += outline.rings.size() - 1;
    }
    EXPECT_EQ(samples, shadows(mask)) << "seed " << seed;
  }
  EXPECT_GT(polygons, 1000u);
  EXPECT_GT(holes, 100u);
}

TEST(Outlines, FollowThePixelsEdgesInTheModelsCoordinates) {
  // A frame of shadow around one lit sample.
  ShadowMask mask{4, 3, std::vector<std::uint8_t>(12, ShadowMask::kShadow)};
  mask.state[5] = ShadowMask::kLit;
  for (const std::size_t k : {3u, 7u, 11u}) mask.state[k] = ShadowMask::kNoSample;
  const auto outlines = shadow_outlines(mask, plan(4, 3, 2), vienna());
  ASSERT_TRUE(outlines) << outlines.error().message;
  ASSERT_EQ(outlines.value().size(), 1u);
  const Outline& o = outlines.value()[0];
  EXPECT_EQ(o.samples, 8u);
  ASSERT_EQ(o.rings.size(), 2u);
  const auto box = [](const std::vector<Vec2>& ring) {
    Vec2 low = ring[0], high = ring[0];
    for (const Vec2& p : ring) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    return std::array<Vec2, 2>{low, high};
  };
  EXPECT_EQ(box(o.rings[0]), (std::array<Vec2, 2>{Vec2(963, 340477), Vec2(969, 340483)}));
  EXPECT_EQ(box(o.rings[1]), (std::array<Vec2, 2>{Vec2(965, 340479), Vec2(967, 340481)}));
}

TEST(Outlines, GeoJsonAndGeoPackageCarryCrsAreasAndProperties) {
  const TestFolder folder;
  const ShadowMask mask = random_mask(40, 30, 5, 0.5);
  const View view = plan(40, 30, 0.5);
  const auto outlines = shadow_outlines(mask, view, vienna());
  ASSERT_TRUE(outlines);
  const std::vector<OutlineProperty> properties{
      {"instant", "2024-09-18T12:00:00Z"}, {"sun_azimuth_deg", 203.923043058}, {"note", ""}};
  ASSERT_TRUE(write_outlines(folder / "o.geojson", OutlineFormat::geojson, outlines.value(), 0.25,
                             view, vienna(), properties));
  ASSERT_TRUE(write_outlines(folder / "o.gpkg", OutlineFormat::geopackage, outlines.value(), 0.25,
                             view, vienna(), properties));
  const auto json = nlohmann::json::parse(content(folder / "o.geojson"));
  EXPECT_EQ(json["crs"]["properties"]["name"], "urn:ogc:def:crs:EPSG::31256");
  ASSERT_EQ(json["features"].size(), outlines.value().size());
  double area = 0;
  for (const auto& f : json["features"]) area += f["properties"]["area_m2"].get<double>();
  EXPECT_EQ(area, static_cast<double>(shadows(mask)) * 0.25);
  EXPECT_EQ(json["features"][0]["properties"]["sun_azimuth_deg"].dump(), "203.923043058");
  EXPECT_EQ(json["features"][0]["properties"]["instant"], "2024-09-18T12:00:00Z");
  EXPECT_TRUE(json["features"][0]["properties"]["note"].is_null());

  GDALAllRegister();
  for (const char* name : {"o.geojson", "o.gpkg"}) {
    const Dataset dataset(
        GDALOpenEx((folder / name).c_str(), GDAL_OF_VECTOR, nullptr, nullptr, nullptr));
    ASSERT_TRUE(dataset) << name;
    const OGRLayerH layer = GDALDatasetGetLayer(dataset.get(), 0);
    EXPECT_STREQ(OSRGetAuthorityCode(OGR_L_GetSpatialRef(layer), nullptr), "31256") << name;
    double sum = 0;
    while (OGRFeatureH f = OGR_L_GetNextFeature(layer)) {
      EXPECT_TRUE(OGR_G_IsValid(OGR_F_GetGeometryRef(f))) << name;
      sum += OGR_G_Area(OGR_F_GetGeometryRef(f));
      OGR_F_Destroy(f);
    }
    EXPECT_EQ(sum, static_cast<double>(shadows(mask)) * 0.25) << name;
  }
}

TEST(Outlines, NoShadowIsAnEmptyCollection) {
  const TestFolder folder;
  const ShadowMask mask{2, 2, std::vector<std::uint8_t>(4, ShadowMask::kLit)};
  const View view = plan(2, 2, 1);
  const auto outlines = shadow_outlines(mask, view, vienna());
  ASSERT_TRUE(outlines);
  EXPECT_TRUE(outlines.value().empty());
  for (const OutlineFormat format : {OutlineFormat::geojson, OutlineFormat::geopackage}) {
    const auto path = folder / (format == OutlineFormat::geojson ? "o.geojson" : "o.gpkg");
    const auto written = write_outlines(path, format, outlines.value(), 1, view, vienna(), {});
    ASSERT_TRUE(written) << written.error().message;
    EXPECT_GT(written.value().bytes, 0u);
  }
  EXPECT_TRUE(nlohmann::json::parse(content(folder / "o.geojson"))["features"].empty());
}

}  // namespace
}  // namespace gnomon
