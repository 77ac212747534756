// CityJSON, GLB, GeoTIFF and GeoJSON in one scene: each piece where it should be, and shadows
// exact.
#include <gtest/gtest.h>

#include "cross/differences.h"
#include "soup.h"

#if __has_include(<gdal/gdal.h>)
#include <gdal/gdal.h>
#include <gdal/ogr_srs_api.h>
#else
#include <gdal.h>
#include <ogr_srs_api.h>
#endif

#include <fmt/format.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/load_scene.h>
#include <gnomon/io/write_gltf.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace gnomon {
namespace {

const std::string kCrs = "EPSG:31256";
constexpr double kWest = 1000, kNorth = 341000;  // of the terrain's upper left corner
constexpr int kCells = 50;                       // of 2 m

double terrain_at(double x) { return 30 + 0.125 * (x - kWest); }  // a plane that rises to the east

void write_terrain(const std::filesystem::path& path) {
  GDALAllRegister();
  const GDALDatasetH file = GDALCreate(GDALGetDriverByName("GTiff"), path.c_str(), kCells, kCells,
                                       1, GDT_Float64, nullptr);
  ASSERT_NE(file, nullptr);
  double transform[6] = {kWest, 2, 0, kNorth, 0, -2};
  GDALSetGeoTransform(file, transform);
  const OGRSpatialReferenceH srs = OSRNewSpatialReference(nullptr);
  ASSERT_EQ(OSRImportFromEPSG(srs, 31256), OGRERR_NONE);
  ASSERT_EQ(GDALSetSpatialRef(file, srs), CE_None);
  OSRDestroySpatialReference(srs);
  std::vector<double> z;
  for (int k = 0; k < kCells * kCells; ++k) z.push_back(terrain_at(kWest + 2 * (k % kCells) + 1));
  ASSERT_EQ(GDALRasterIO(GDALGetRasterBand(file, 1), GF_Write, 0, 0, kCells, kCells, z.data(),
                         kCells, kCells, GDT_Float64, 0, 0),
            CE_None);
  GDALClose(file);
}

// A box of 10 x 10 x 20 m with its south-west corner at (1020, 340920), its foot at 28 m.
constexpr const char* kBlock =
    R"({"type":"CityJSON","version":"2.0",
"metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/31256"},
"transform":{"scale":[1,1,1],"translate":[1020,340920,28]},
"CityObjects":{"block":{"type":"Building","geometry":[{"type":"Solid","lod":"2","boundaries":[[
[[3,2,1,0]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]]}]}},
"vertices":[[0,0,0],[10,0,0],[10,10,0],[0,10,0],[0,0,20],[10,0,20],[10,10,20],[0,10,20]]})";

const Vec2 kSite(1060, 340950);                              // of the house, in kCrs
const Vec2 kShopLow(1040, 340910), kShopHigh(1050, 340918);  // 9 m high

struct MixedScene : testing::Test {
  std::filesystem::path folder = std::filesystem::path(testing::TempDir()) /
                                 (std::string("gnomon_mixed_") +
                                  testing::UnitTest::GetInstance()->current_test_info()->name());
  std::vector<std::filesystem::path> files;
  Vec2 site{0, 0};  // longitude, latitude
  LoadedScene loaded;

  void SetUp() override {
    std::filesystem::create_directories(folder);
    files = {folder / "block.city.json", folder / "house.glb", folder / "terrain.tif",
             folder / "shop.geojson"};
    std::ofstream(files[0]) << kBlock;

    TriMesh house;  // its middle at the origin, 4 m east, 6 m north, 3 m high
    test::add_box(house, {-2, -3, 0}, {2, 3, 3});
    Scene scene = test::scene_of(std::move(house));
    scene.surfaces[0].object = "house";
    ASSERT_TRUE(write_gltf(files[1], scene, GltfForm::binary, "test"));

    write_terrain(files[2]);

    const auto degrees =
        reproject(
            kCrs, "EPSG:4326",
            {kSite, kShopLow, {kShopHigh.x, kShopLow.y}, kShopHigh, {kShopLow.x, kShopHigh.y}})
            .value();
    site = degrees[0];
    std::string ring;
    for (const std::size_t k : {1, 2, 3, 4, 1}) {
      ring +=
          fmt::format("{}[{:.12f},{:.12f}]", ring.empty() ? "" : ",", degrees[k].x, degrees[k].y);
    }
    std::ofstream(files[3])
        << R"({"type":"FeatureCollection","features":[{"type":"Feature","id":"shop",)"
        << R"("properties":{"building":"yes","height":"9"},"geometry":{"type":"Polygon",)"
        << R"("coordinates":[[)" << ring << "]]}}]}";

    LoadOptions options;
    Site at(Place{.latitude = site.y * kDegree, .longitude = site.x * kDegree}, true);
    options.for_files.push_back({.file = "house.glb", .site = at});
    auto all = load_scene(files, options);
    ASSERT_TRUE(all) << all.error().message;
    loaded = std::move(all).value();
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  // Corners of an object, in the CRS.
  std::vector<Vec3> corners(const std::string& object) const {
    const Scene& s = loaded.scene;
    std::vector<Vec3> found;
    for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) {
      if (s.surfaces[s.surface_of[t]].object != object) continue;
      for (const std::uint32_t v : s.mesh.triangles[t])
        found.push_back(s.mesh.positions[v] + s.frame.origin);
    }
    return found;
  }
};

// Metres from the nearest of the points.
double nearest(const std::vector<Vec3>& points, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& q : points) least = std::min(least, std::hypot(q.x - p.x, q.y - p.y, q.z - p.z));
  return least;
}

TEST_F(MixedScene, PiecesStandWhereProjPutsThemOnTheTerrain) {
  EXPECT_EQ(loaded.scene.frame.crs, kCrs);
  EXPECT_EQ(loaded.files.size(), 4u);

  const std::vector<Vec3> block = corners("block");
  EXPECT_EQ(block.size(), 36u);
  EXPECT_EQ(nearest(block, {1020, 340920, 28}), 0);
  EXPECT_EQ(nearest(block, {1030, 340930, 48}), 0);

  const std::vector<Vec3> house = corners("house");
  EXPECT_EQ(house.size(), 36u);
  const Vec2 at = reproject("EPSG:4326", kCrs, {site}).value()[0];
  const double turn = locate(kCrs, {at.x, at.y, 0}).value().true_north;
  const double foot = terrain_at(at.x);
  for (const double x : {-2.0, 2.0}) {
    for (const double y : {-3.0, 3.0}) {
      const Vec2 p(at.x + x * std::cos(turn) + y * std::sin(turn),
                   at.y - x * std::sin(turn) + y * std::cos(turn));
      EXPECT_LT(nearest(house, {p.x, p.y, foot}), 0.01);
      EXPECT_LT(nearest(house, {p.x, p.y, foot + 3}), 0.01);
    }
  }

  const std::vector<Vec3> shop = corners("shop");
  EXPECT_EQ(shop.size(), 36u);
  const double lowest = terrain_at(kShopLow.x);  // under its western corners
  EXPECT_LT(nearest(shop, {kShopLow.x, kShopLow.y, lowest}), 0.01);
  EXPECT_LT(nearest(shop, {kShopHigh.x, kShopHigh.y, lowest + 9}), 0.01);

  const std::vector<Vec3> terrain = corners("terrain");
  EXPECT_EQ(terrain.size(), 6u * (kCells - 1) * (kCells - 1));
  EXPECT_EQ(nearest(terrain, {kWest + 1, kNorth - 1, terrain_at(kWest + 1)}), 0);
  EXPECT_EQ(loaded.ground.triangles, 0u) << "the raster is the ground";
}

TEST_F(MixedScene, CountsEqualTheExactOnes) {
  EXPECT_EQ(test::differences(loaded.scene, 48, 6, 4), 0u);
}

}  // namespace
}  // namespace gnomon
