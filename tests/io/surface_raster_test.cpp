#include <gnomon/io/surface_raster.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "write_test_files.h"

#if __has_include(<gdal/gdal.h>)
#include <gdal/gdal.h>
#include <gdal/ogr_spatialref.h>
#else
#include <gdal.h>
#include <ogr_spatialref.h>
#endif

#include <gnomon/io/crs.h>

namespace gnomon {
namespace {

using testing::TestFolder;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// North up, cells of 1 m, upper left corner (1000, 2000).
RasterGrid grid_of(int columns, int rows, std::vector<double> z) {
  RasterGrid g;
  g.columns = columns;
  g.rows = rows;
  g.transform = {1000, 1, 0, 2000, 0, -1};
  g.z = std::move(z);
  g.format = "memory";
  return g;
}

Result<Model> meshed(RasterGrid g, RasterMesh mesh, bool above = false,
                     const GroundAt& ground = nullptr) {
  return surface_of_grid(std::move(g), "dir/name.tif", {.mesh = mesh, .above_ground = above}, "",
                         "", ground);
}

std::vector<std::array<Vec3, 3>> triangles_of(const Model& m) {
  std::vector<std::array<Vec3, 3>> out;
  for (const ModelPolygon& p : m.polygons) {
    EXPECT_EQ(p.last_ring, p.first_ring + 1);
    std::array<Vec3, 3> t{};
    for (std::size_t k = 0; k < 3; ++k) {
      t[k] = m.vertices[m.corners[m.ring_begin[p.first_ring] + k]] * m.scale + m.translate;
    }
    out.push_back(t);
  }
  return out;
}

double up_area(const std::array<Vec3, 3>& t) {
  const Vec3 a = t[1] - t[0], b = t[2] - t[0];
  return (a.x * b.y - a.y * b.x) / 2;
}

// Area of all tops, which must look up.
double covered(const Model& m) {
  double sum = 0;
  for (const auto& t : triangles_of(m)) {
    EXPECT_GE(up_area(t), 0);
    sum += up_area(t);
  }
  return sum;
}

// Number of directed edges that no triangle has the other way round.
std::size_t open_edges(const Model& m) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> seen;
  for (std::size_t k = 0; k < m.corners.size(); k += 3) {
    for (std::size_t e = 0; e < 3; ++e) {
      const auto a = m.corners[k + e], b = m.corners[k + (e + 1) % 3];
      ++seen[{a, b}];
      --seen[{b, a}];
    }
  }
  std::size_t open = 0;
  for (const auto& [edge, n] : seen) open += n > 0 ? static_cast<std::size_t>(n) : 0;
  return open;
}

// Area of the triangles seen from east or west, those looking east positive.
double looking_east(const Model& m) {
  double sum = 0;
  for (const auto& t : triangles_of(m)) {
    const Vec3 a = t[1] - t[0], b = t[2] - t[0];
    const double x = (a.y * b.z - a.z * b.y) / 2;
    sum += x > 0 ? x : 0;
  }
  return sum;
}

std::size_t warned(const Model& m, const std::string& word) {
  std::size_t n = 0;
  for (const Warning& w : m.warnings) n += w.what.find(word) != std::string::npos ? w.count : 0;
  return n;
}

TEST(SurfaceRaster, LevelCellsAreSquaresWithWallsDownToTheLowerNeighbour) {
  const Model m = meshed(grid_of(2, 1, {5, 2}), RasterMesh::cells).value();
  EXPECT_EQ(m.polygons.size(), 6u);  // two squares, one wall
  EXPECT_EQ(covered(m), 2.0);
  EXPECT_EQ(looking_east(m), 3.0);
  EXPECT_EQ(open_edges(m), 6u + 2u);  // the outline, and the wall's two upright edges at the border
  EXPECT_EQ(m.surfaces[0].object, "name");
  EXPECT_EQ(m.surfaces[0].group, "TINRelief");
  EXPECT_EQ(m.report.crs, "");
}

TEST(SurfaceRaster, WallsOfDifferentHeightsMeetInSharedVertices) {
  // Around the inner corners there are up to four heights; but for the outline no edge is open.
  std::vector<double> z;
  for (int k = 0; k < 25; ++k) z.push_back((k * 7) % 11);
  for (int j = 0; j < 5; ++j) {
    for (int i = 0; i < 5; ++i) {
      if (i == 0 || j == 0 || i == 4 || j == 4) z[static_cast<std::size_t>(5 * j + i)] = 0;
    }
  }
  const Model m = meshed(grid_of(5, 5, z), RasterMesh::cells).value();
  EXPECT_EQ(covered(m), 25.0);
  EXPECT_EQ(open_edges(m), 20u);
}

TEST(SurfaceRaster, NoDataLeavesHolesWithoutWallsAndIsCounted) {
  const Model m = meshed(grid_of(3, 3, {1, 1, 1, 1, kNan, 1, 1, 1, 1}), RasterMesh::cells).value();
  EXPECT_EQ(covered(m), 8.0);
  EXPECT_EQ(m.polygons.size(), 16u);
  EXPECT_EQ(warned(m, "without data"), 1u);
}

TEST(SurfaceRaster, TrianglesHaveTheirVerticesAtTheMiddlesOfCells) {
  const Model m = meshed(grid_of(3, 2, {1, 2, 3, 4, 5, 6}), RasterMesh::triangles).value();
  EXPECT_EQ(m.polygons.size(), 4u);
  EXPECT_EQ(covered(m), 2.0);
  ASSERT_EQ(m.vertices.size(), 6u);
  EXPECT_EQ(m.vertices[0] + m.translate, Vec3(1000.5, 1999.5, 1));
  EXPECT_EQ(m.vertices[5] + m.translate, Vec3(1002.5, 1998.5, 6));
}

TEST(SurfaceRaster, SquaresAreSplitBetweenTheMiddlesThatDifferLess) {
  // A ridge from lower left to upper right must not become a valley.
  const Model m = meshed(grid_of(2, 2, {0, 9, 9, 1}), RasterMesh::triangles).value();
  for (const auto& t : triangles_of(m)) {
    EXPECT_EQ(std::count_if(t.begin(), t.end(), [](const Vec3& p) { return p.z == 9; }), 2);
  }
}

TEST(SurfaceRaster, AMissingMiddleLeavesOneTriangleAndALonelyCellIsCounted) {
  const Model one = meshed(grid_of(2, 2, {1, 2, kNan, 3}), RasterMesh::triangles).value();
  EXPECT_EQ(one.polygons.size(), 1u);
  EXPECT_EQ(covered(one), 0.5);
  const Model lonely =
      meshed(grid_of(4, 2, {1, 2, kNan, 7, 3, 4, kNan, kNan}), RasterMesh::triangles).value();
  EXPECT_EQ(lonely.vertices.size(), 4u);
  EXPECT_EQ(warned(lonely, "got no triangle"), 1u);
}

TEST(SurfaceRaster, SouthUpMirroredAndRotatedGridsLookUpToo) {
  for (const RasterMesh mesh : {RasterMesh::cells, RasterMesh::triangles}) {
    for (const std::array<double, 6> t : {std::array<double, 6>{0, 1, 0, 0, 0, 1},
                                          {0, -1, 0, 0, 0, -1},
                                          {5, -1, 0, 0, 0, 1},
                                          {0, 0.6, -0.8, 0, -0.8, -0.6},
                                          {0, 0, 1, 0, 1, 0}}) {
      RasterGrid g = grid_of(3, 3, {1, 2, 3, 4, 9, 6, 7, 8, 1});
      g.transform = t;
      const Model m = meshed(g, mesh).value();
      EXPECT_NEAR(covered(m), mesh == RasterMesh::cells ? 9 : 4, 1e-12);
    }
  }
}

TEST(SurfaceRaster, BlocksStandOnTheLowestGroundAround) {
  const GroundAt slope = [](double x, double) { return std::optional(x - 1000); };
  std::vector<double> z(25, 0);
  z[12] = 10;  // the middle, (1002.5, 1997.5)
  z[13] = 4;   // east of it
  z[0] = -3;
  const Model m = meshed(grid_of(5, 5, z), RasterMesh::cells, true, slope).value();
  EXPECT_EQ(m.surfaces[0].group, "HeightAboveGround");
  EXPECT_EQ(covered(m), 2.0);
  double lowest = 1e9, highest = -1e9;
  for (const Vec3& v : m.vertices) {
    lowest = std::min(lowest, v.z);
    highest = std::max(highest, v.z);
  }
  EXPECT_EQ(highest, 2.5 + 10);
  EXPECT_EQ(lowest, 1.5);
  // Between the two blocks from 12.5 down to 3.5 + 4; the east end from there down to 2.5.
  EXPECT_EQ(looking_east(m), 5.0 + 5.0);
  EXPECT_EQ(warned(m, "no ground"), 0u);
}

TEST(SurfaceRaster, BlocksAreClosedDownToTheGround) {
  std::vector<double> z;
  for (int k = 0; k < 36; ++k) z.push_back((k * 5) % 7 < 3 ? 0 : (k * 11) % 5 + 1);
  const GroundAt level = [](double, double) { return std::optional(100.0); };
  for (const RasterMesh mesh : {RasterMesh::cells, RasterMesh::triangles}) {
    const Model m = meshed(grid_of(6, 6, z), mesh, true, level).value();
    for (std::size_t k = 0; k < m.corners.size(); k += 3) {
      for (std::size_t e = 0; e < 3; ++e) ASSERT_GE(m.vertices[m.corners[k + e]].z, 100.0);
    }
    // With each open edge at the ground, all of it is closed but for the bottom.
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> seen;
    for (std::size_t k = 0; k < m.corners.size(); k += 3) {
      for (std::size_t e = 0; e < 3; ++e) {
        ++seen[{m.corners[k + e], m.corners[k + (e + 1) % 3]}];
        --seen[{m.corners[k + (e + 1) % 3], m.corners[k + e]}];
      }
    }
    for (const auto& [edge, n] : seen) {
      if (n == 0) continue;
      EXPECT_EQ(m.vertices[edge.first].z, 100.0);
      EXPECT_EQ(m.vertices[edge.second].z, 100.0);
    }
    EXPECT_EQ(covered(m), static_cast<double>(
                              std::count_if(z.begin(), z.end(), [](double h) { return h > 0; })));
  }
}

TEST(SurfaceRaster, SlopedBlocksKeepTheHeightsOfTheirMiddlesAndNeedNoInnerWalls) {
  const GroundAt level = [](double, double) { return std::optional(0.0); };
  const Model m = meshed(grid_of(2, 1, {4, 8}), RasterMesh::triangles, true, level).value();
  EXPECT_EQ(m.polygons.size(), 4u + 4u + 2u * 6u);
  std::vector<double> middles;
  for (const Vec3& v : m.vertices) {
    if (v.y == -0.5) middles.push_back(v.z);
  }
  EXPECT_EQ(middles, (std::vector<double>{4, 8}));
}

TEST(SurfaceRaster, BlocksBesideUnknownGroundKeepTheirWallsUpright) {
  // A block without ground of its own takes lower ground than its neighbour knows of.
  const GroundAt holes = [](double x, double y) {
    const int k = static_cast<int>(x) * 7 + static_cast<int>(y) * 13;
    return k % 3 == 0 ? std::optional<double>() : std::optional<double>((k * 31) % 100);
  };
  std::vector<double> z;
  for (int k = 0; k < 400; ++k) z.push_back((k * 5) % 7 < 3 ? 0 : (k * 11) % 5 + 0.25);
  for (const RasterMesh mesh : {RasterMesh::cells, RasterMesh::triangles}) {
    const Model m = meshed(grid_of(20, 20, z), mesh, true, holes).value();
    for (const auto& t : triangles_of(m)) {
      const auto [west, east] = std::minmax({t[0].x, t[1].x, t[2].x});
      const auto [south, north] = std::minmax({t[0].y, t[1].y, t[2].y});
      ASSERT_LE(east - west, 1);
      ASSERT_LE(north - south, 1);
    }
    EXPECT_EQ(covered(m), static_cast<double>(
                              std::count_if(z.begin(), z.end(), [](double h) { return h > 0; })));
    EXPECT_GT(warned(m, "no ground"), 0u);
  }
}

TEST(SurfaceRaster, WhereNoGroundIsKnownBlocksStandAtZeroAndItIsCounted) {
  const Model m = meshed(grid_of(2, 1, {4, 0}), RasterMesh::cells, true).value();
  EXPECT_EQ(warned(m, "no ground"), 1u);
  double highest = 0;
  for (const Vec3& v : m.vertices) highest = std::max(highest, v.z);
  EXPECT_EQ(highest, 4.0);
}

TEST(SurfaceRaster, EmptyRastersAreRefused) {
  EXPECT_FALSE(meshed(grid_of(2, 2, {kNan, kNan, kNan, kNan}), RasterMesh::cells));
  EXPECT_FALSE(meshed(grid_of(2, 2, {0, 0, -1, 0}), RasterMesh::cells, true));
  const auto row = meshed(grid_of(3, 1, {1, 2, 3}), RasterMesh::triangles);
  ASSERT_FALSE(row);
  EXPECT_NE(row.error().message.find("as cells"), std::string::npos);
}

TEST(SurfaceRaster, DegreesGoToTheirUtmZoneCornerByCorner) {
  RasterGrid g = grid_of(3, 2, {1, 2, 3, 4, 5, 6});
  g.transform = {16.3, 0.001, 0, 48.2, 0, -0.001};
  g.crs = "EPSG:4326";
  const Model m = meshed(g, RasterMesh::cells).value();
  EXPECT_EQ(m.report.crs, "EPSG:32633");
  const Vec2 expected = reproject("EPSG:4326", "EPSG:32633", {{16.302, 48.199}}).value()[0];
  EXPECT_TRUE(std::any_of(m.vertices.begin(), m.vertices.end(), [&](const Vec3& v) {
    return std::hypot(v.x + m.translate.x - expected.x, v.y + m.translate.y - expected.y) < 1e-8;
  }));
  EXPECT_NEAR(covered(m), 6 * 74.2 * 111.2, 6 * 74.2 * 111.2 * 0.01);
}

TEST(SurfaceRaster, TwoNamesOfOneCrsMoveNothing) {
  RasterGrid g = grid_of(2, 2, {1, 2, 3, 4});
  g.transform = {84900.1, 0.3, 0, 447600.7, 0, -0.3};
  g.crs = "EPSG:28992";
  const auto m = surface_of_grid(g, "x", {.mesh = RasterMesh::cells}, "EPSG:7415", "", nullptr);
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_EQ(m.value().report.crs, "EPSG:7415");
  EXPECT_EQ(m.value().translate, Vec3(84900.1, 447600.7, 0));
}

// ---- files ----

struct Close {
  void operator()(void* d) const { GDALClose(d); }
};

struct FileOf {
  GDALDataType type = GDT_Float32;
  std::string crs = "EPSG:25830";
  bool placed = true;
  std::optional<double> nodata = {};
  double scale = 1, offset = 0;
  std::string unit = {};
  int bands = 1;
};

std::filesystem::path write(const std::filesystem::path& path, int columns, int rows,
                            std::vector<double> z, const FileOf& f = {}) {
  GDALAllRegister();
  const std::unique_ptr<void, Close> d(GDALCreate(GDALGetDriverByName("GTiff"), path.c_str(),
                                                  columns, rows, f.bands, f.type, nullptr));
  double t[6] = {500000, 2, 0, 4800000, 0, -2};
  if (f.placed) GDALSetGeoTransform(d.get(), t);
  OGRSpatialReference crs;
  if (!f.crs.empty()) {
    EXPECT_EQ(crs.SetFromUserInput(f.crs.c_str()), OGRERR_NONE);
    GDALSetSpatialRef(d.get(), OGRSpatialReference::ToHandle(&crs));
  }
  const GDALRasterBandH band = GDALGetRasterBand(d.get(), f.bands);
  if (f.nodata) GDALSetRasterNoDataValue(band, *f.nodata);
  if (f.scale != 1) GDALSetRasterScale(band, f.scale);
  if (f.offset != 0) GDALSetRasterOffset(band, f.offset);
  if (!f.unit.empty()) GDALSetRasterUnitType(band, f.unit.c_str());
  EXPECT_EQ(
      GDALRasterIO(band, GF_Write, 0, 0, columns, rows, z.data(), columns, rows, GDT_Float64, 0, 0),
      CE_None);
  return path;
}

Result<Model> read(const std::filesystem::path& path, RasterOptions o = {RasterMesh::cells},
                   const std::string& target = "", const std::string& fallback = "") {
  return read_surface_raster(path, o, target, fallback, nullptr);
}

std::string refusal(const std::filesystem::path& path, RasterOptions o = {RasterMesh::cells}) {
  ::testing::internal::CaptureStderr();
  const auto m = read(path, o);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_FALSE(m);
  return m ? "" : m.error().message;
}

bool has(const std::string& text, const std::string& word) {
  return text.find(word) != std::string::npos;
}

TEST(SurfaceRasterFile, ReadsEveryRealTypeScaleOffsetAndUnit) {
  const TestFolder dir;
  for (const GDALDataType type :
       {GDT_Byte, GDT_UInt16, GDT_Int16, GDT_UInt32, GDT_Int32, GDT_Float32, GDT_Float64}) {
    FileOf f;
    f.type = type;
    f.scale = 0.5;
    f.offset = 100;
    f.unit = "ft";
    const auto m = read(write(dir / "a.tif", 2, 1, {7, 9}, f));
    ASSERT_TRUE(m) << m.error().message;
    double high = 0;
    for (const Vec3& v : m.value().vertices) high = std::max(high, v.z);
    EXPECT_DOUBLE_EQ(high, 104.5 * 0.3048);
    EXPECT_EQ(m.value().report.crs, "EPSG:25830");
    EXPECT_EQ(covered(m.value()), 8.0);
  }
}

TEST(SurfaceRasterFile, DeclaredNoDataAndNanAreHoles) {
  const TestFolder dir;
  FileOf f;
  f.nodata = -9999;
  const Model m = read(write(dir / "a.tif", 3, 1, {1, -9999, kNan}, f)).value();
  EXPECT_EQ(covered(m), 4.0);
  EXPECT_EQ(warned(m, "without data"), 2u);
  f.nodata = -3.4028234663852886e38;  // the lowest float, which tools round differently
  EXPECT_EQ(covered(read(write(dir / "b.tif", 2, 1, {1, -3.4028234663852886e38}, f)).value()), 4.0);
}

TEST(SurfaceRasterFile, ValuesThatAreNoHeightsNameTheirCell) {
  const TestFolder dir;
  for (const double odd : {-9999.0, 1e30, std::numeric_limits<double>::infinity()}) {
    const std::string why = refusal(write(dir / "a.tif", 2, 2, {1, 2, odd, 3}));
    EXPECT_TRUE(has(why, "column 0, row 1")) << why;
    EXPECT_TRUE(has(why, "a_nodata")) << why;
  }
}

TEST(SurfaceRasterFile, AnotherCrsAndAMissingOneAreTakenCareOf) {
  const TestFolder dir;
  const auto path = write(dir / "a.tif", 2, 2, {1, 2, 3, 4});
  const Model moved = read(path, {RasterMesh::cells}, "EPSG:25829").value();
  EXPECT_EQ(moved.report.crs, "EPSG:25829");
  EXPECT_EQ(moved.report.placed, "moved from EPSG:25830 to EPSG:25829");
  EXPECT_EQ(read(path).value().report.placed, "");
  EXPECT_NEAR(covered(moved), 16.0, 0.1);
  FileOf f;
  f.crs = "";
  const auto bare = write(dir / "b.tif", 2, 2, {1, 2, 3, 4}, f);
  EXPECT_EQ(read(bare).value().report.crs, "");
  EXPECT_EQ(read(bare, {RasterMesh::cells}, "", "EPSG:25830").value().report.crs, "EPSG:25830");
}

TEST(SurfaceRasterFile, TheCrsThatAFileNamesIsToldWithoutReadingIt) {
  const TestFolder dir;
  FileOf f;
  EXPECT_EQ(crs_of_raster_file(write(dir / "a.tif", 1, 1, {1}, f)).value(), "EPSG:25830");
  f.crs = "EPSG:7415";  // with heights; a CRS names the horizontal part
  EXPECT_EQ(crs_of_raster_file(write(dir / "b.tif", 1, 1, {1}, f)).value(), "EPSG:28992");
  f.crs = "";
  EXPECT_EQ(crs_of_raster_file(write(dir / "c.tif", 1, 1, {1}, f)).value(), "");
  EXPECT_FALSE(crs_of_raster_file(dir / "none.tif"));
}

TEST(SurfaceRasterFile, RefusalsSayWhatToDo) {
  const TestFolder dir;
  FileOf f;
  EXPECT_TRUE(has(refusal(dir / "none.tif"), "no such file"));
  EXPECT_TRUE(has(refusal("/vsicurl/http://localhost/a.tif"), "no such file"));
  std::ofstream(dir / "text.tif") << "hello";
  EXPECT_TRUE(has(refusal(dir / "text.tif"), "cannot be read as a raster"));
  std::ofstream(dir / "a.vrt") << "<VRTDataset rasterXSize=\"1\" rasterYSize=\"1\"></VRTDataset>";
  EXPECT_TRUE(has(refusal(dir / "a.vrt"), "gdal_translate"));
  std::filesystem::copy_file(dir / "a.vrt", dir / "b.tif");
  EXPECT_TRUE(has(refusal(dir / "b.tif"), "cannot be read as a raster"));
  f.type = GDT_CFloat32;
  EXPECT_TRUE(has(refusal(write(dir / "d.tif", 1, 1, {1}, f)), "complex"));
  f = {};
  f.placed = false;
  EXPECT_TRUE(has(refusal(write(dir / "e.tif", 1, 1, {1}, f)), "no georeference"));
  f = {};
  f.type = GDT_Byte;
  f.bands = 3;  // GDAL calls three bands of bytes red, green and blue
  const std::string why = refusal(write(dir / "f.tif", 1, 1, {1}, f));
  EXPECT_TRUE(has(why, "picture") && has(why, "gdal_translate -b N")) << why;
}

TEST(SurfaceRasterFile, OfSeveralBandsTheFirstIsReadAndTheWayToAnotherIsTold) {
  const TestFolder dir;
  FileOf f;
  f.bands = 2;  // the second one gets the values, the first one is 0
  const Model m = read(write(dir / "a.tif", 1, 1, {7}, f)).value();
  EXPECT_EQ(m.vertices[0].z, 0.0);
  EXPECT_EQ(warned(m, "gdal_translate -b N"), 1u);
}

TEST(SurfaceRasterFile, ATruncatedFileIsAnErrorNotAHole) {
  const TestFolder dir;
  const auto path = write(dir / "a.tif", 300, 300, std::vector<double>(90000, 5.0));
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const std::string why = refusal(path);
  EXPECT_TRUE(has(why, "cannot be read")) << why;
}

TEST(SurfaceRasterFile, ReadsAnAsciiGridAndRefusesUnnamedDegrees) {
  const TestFolder dir;
  std::ofstream(dir / "a.asc") << "ncols 2\nnrows 1\nxllcorner 100\nyllcorner 200\ncellsize 5\n"
                                  "NODATA_value -9999\n3 -9999\n";
  const Model m = read(dir / "a.asc").value();
  EXPECT_EQ(covered(m), 25.0);
  EXPECT_EQ(m.report.format, "Arc/Info ASCII Grid");
  std::ofstream(dir / "b.asc") << "ncols 1\nnrows 1\nxllcorner 16\nyllcorner 48\n"
                                  "cellsize 0.000277\n3\n";
  EXPECT_TRUE(has(refusal(dir / "b.asc"), "EPSG:4326"));
  EXPECT_EQ(read(dir / "b.asc", {RasterMesh::cells}, "", "EPSG:4326").value().report.crs,
            "EPSG:32633");
}

TEST(SurfaceRasterFile, MeshesBeyondTheMachinesMemoryAreRefusedBeforeTheyAreRead) {
  const TestFolder dir;
  GDALAllRegister();
  const char* const sparse[] = {"SPARSE_OK=TRUE", "TILED=YES", nullptr};
  const auto path = dir / "a.tif";
  {
    const std::unique_ptr<void, Close> d(GDALCreate(GDALGetDriverByName("GTiff"), path.c_str(),
                                                    1000000, 1000000, 1, GDT_Byte,
                                                    const_cast<char**>(sparse)));
    ASSERT_TRUE(d);
    double t[6] = {500000, 2, 0, 4800000, 0, -2};
    GDALSetGeoTransform(d.get(), t);
  }
  EXPECT_TRUE(has(refusal(path), "-projwin"));
}

TEST(SurfaceRasterFile, IsKnownByItsFirstBytes) {
  using namespace std::string_view_literals;
  EXPECT_TRUE(is_raster_file("x", "II*\0abcd"sv));
  EXPECT_TRUE(is_raster_file("x", "MM\0+abcd"sv));
  EXPECT_TRUE(is_raster_file("x", "NCOLS 4\nNROWS 5"));
  EXPECT_TRUE(is_raster_file("N47E011.hgt", ""));
  EXPECT_TRUE(is_raster_file("a.VRT", "<VRT"));
  EXPECT_FALSE(is_raster_file("x.obj", "v 0 0 0"));
  EXPECT_FALSE(is_raster_file("x.json", "{\"type\": \"CityJSON\"}"));
}

TEST(SurfaceRasterFile, ReadsBilbaosBuildingsOnTheirGroundAndGothenburg) {
  const std::filesystem::path data = std::string(GNOMON_DATA) + "/dsm";
  if (!std::filesystem::exists(data / "bilbao")) GTEST_SKIP() << "skipped: no " << data;
  RasterOptions above{RasterMesh::cells};
  above.above_ground = true;
  const GroundAt level = [](double, double) { return std::optional(20.0); };
  const Model b = read_surface_raster(data / "bilbao/BDSM.tif", above, "", "", level).value();
  EXPECT_EQ(b.report.crs, "EPSG:25830");
  EXPECT_EQ(warned(b, "no ground"), 0u);
  const Model g = read(data / "goteborg/DSM_KRbig.tif").value();
  EXPECT_EQ(g.report.crs, "EPSG:3007");
  EXPECT_NEAR(covered(g), 234 * 223, 1e-6);
}

}  // namespace
}  // namespace gnomon
