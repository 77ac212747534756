#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored \
    "-Wrestrict"  // GCC 12 warns of "text" + std::string (its bug 105651)
#endif

#include <fmt/format.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/load_scene.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include <io/load_files.h>

namespace gnomon {
namespace {

using namespace testing_files;

// Metres: there and back through the MGI datum shift, whose linearised rotations PROJ inverts to
// about a millimetre.
constexpr double kThereAndBack = 2e-3;

double volume(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += glm::dot(mesh.positions[a], glm::cross(mesh.positions[b], mesh.positions[c])) / 6;
  }
  return sum;
}

TEST(LoadScene, ABoxIsWeldedAndPlaced) {
  const Files file;
  const LoadedScene loaded = load({file("box.city.json", box())}, without_ground());
  const Scene& s = loaded.scene;
  EXPECT_EQ(s.mesh.positions.size(), 8u);
  EXPECT_EQ(s.mesh.triangles.size(), 12u);
  EXPECT_EQ(s.surface_of.size(), 12u);
  EXPECT_EQ(s.surfaces.size(), 3u);
  EXPECT_DOUBLE_EQ(volume(s.mesh), 10 * 10 * 20);  // outward winding is kept
  EXPECT_EQ(s.frame.origin, Vec3(1205, 340705, 50));
  EXPECT_EQ(s.mesh.positions[s.mesh.triangles[0][0]].z, -10);
  EXPECT_EQ(s.frame.crs, "EPSG:31256");
  ASSERT_TRUE(s.frame.place);
  EXPECT_NEAR(s.frame.place->latitude / kDegree, 48.2, 0.05);  // Vienna
  EXPECT_NEAR(s.frame.place->longitude / kDegree, 16.35, 0.05);
  ASSERT_EQ(loaded.files.size(), 1u);
  EXPECT_EQ(loaded.files[0].triangles, 12u);
  EXPECT_EQ(loaded.ground.kind, "none");
  EXPECT_TRUE(s.warnings.empty());
}

TEST(LoadScene, EqualIntegersGiveEqualDoublesFarFromTheOrigin) {
  // 0.001 is no binary fraction: the position must not depend on the order of additions.
  const Files file;
  std::string text = box("", "[2684572.43,1246323.059,448.126]");
  text.replace(text.find("[0.5,0.5,0.5]"), 13, "[0.001,0.001,0.001]");
  const Scene s = load({file("box.json", text)}, without_ground()).scene;
  std::set<double> xs, zs;
  for (const Vec3& p : s.mesh.positions) {
    xs.insert(p.x);
    zs.insert(p.z);
  }
  ASSERT_EQ(xs.size(), 2u);
  ASSERT_EQ(zs.size(), 2u);
  EXPECT_NEAR(*xs.rbegin() - *xs.begin(), 0.02, 1e-15);  // absolute coordinates would lose 1e-10
  EXPECT_NEAR(*zs.rbegin() - *zs.begin(), 0.04, 1e-15);
}

TEST(LoadScene, FilesShareTheFirstOnesOrigin) {
  const Files file;
  const LoadedScene loaded =
      load({file("a.json", box()), file("b.json", box("", "[1300,340700,40]"))}, without_ground());
  EXPECT_EQ(loaded.scene.frame.origin, Vec3(1205, 340705, 50));
  EXPECT_EQ(loaded.scene.mesh.triangles.size(), 24u);
  EXPECT_EQ(loaded.scene.surfaces.size(), 6u);
  double high = 0;
  for (const Vec3& p : loaded.scene.mesh.positions) high = std::max(high, p.x);
  EXPECT_EQ(high, 105);
}

TEST(LoadScene, FormatsAreToldByTheirContent) {
  const Files file;
  EXPECT_EQ(load({file("a.txt", box())}, without_ground()).files[0].format, "CityJSON 2.0");
  EXPECT_EQ(load({file("b.txt", kObj)}, without_ground()).files[0].format, "OBJ");
  EXPECT_EQ(
      load({file("c.dat", "\xEF\xBB\xBF# hello\n\n  " + kObj)}, without_ground()).files[0].format,
      "OBJ");
  expect_failure({file("d.xyz", "hello\n")}, {}, {"d.xyz", "format is not known"});
  expect_failure({file("e.json", "oops")}, {}, {"e.json", "not JSON at line 1, column 1"});
}

TEST(LoadScene, FilesThatCannotBeReadAreNamed) {
  const Files file;
  expect_failure({}, {}, {"no model file"});
  expect_failure({"nowhere/missing.json"}, {}, {"nowhere/missing.json", "no such file"});
  expect_failure({file.folder}, {}, {file.folder.string(), "is a folder"});
  expect_failure({file("empty.obj", "")}, {}, {"empty.obj", "is empty"});
  expect_failure({file("blank.obj", " \n\n")}, {}, {"blank.obj", "is empty"});
  expect_failure({file("wide.obj", std::string("\xFE\xFF\0v", 4))}, {}, {"wide.obj", "UTF-8"});
  expect_failure({file("points.obj", "v 0 0 0\np 1\n")}, {}, {"points.obj", "no surfaces"});
  expect_failure({file("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")}, {},
                 {"flat.obj", "has an area"});
}

TEST(LoadScene, ObjNeedsUpAndUnitWhereTheyDiffer) {
  const Files file;
  LoadOptions options = without_ground();
  options.up = 'z';
  options.unit = "ft";
  const LoadedScene loaded = load({file("t.obj", kObj)}, options);
  EXPECT_NEAR(loaded.scene.mesh.positions[1].x - loaded.scene.mesh.positions[0].x, 4 * 0.3048,
              1e-15);
  options.unit = "furlong";
  expect_failure({file("t.obj", kObj)}, options, {"furlong", "mm"});
  options.unit = "";
  options.up = 'x';
  expect_failure({file("t.obj", kObj)}, options, {"--up"});
}

TEST(LoadScene, MeshFilesSayWhichAxesWereAssumed) {
  const Files file;
  const auto off = file("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 0 1\n3 0 1 2\n");
  LoadOptions options = without_ground();
  EXPECT_EQ(load({off}, options).files[0].axes,
            "z (assumed; --up y if the model lies) up, unit m (assumed; --unit says otherwise)");
  options.up = 'y';
  options.unit = "mm";
  EXPECT_EQ(load({off}, options).files[0].axes, "y (--up) up, unit mm (--unit)");
}

TEST(LoadScene, UpAndUnitOfCityJsonAreNotSilentlyIgnored) {
  const Files file;
  LoadOptions options = without_ground();
  options.up = 'z';
  EXPECT_TRUE(warns(load({file("box.json", box())}, options).scene, "--up and --unit", 1));
}

TEST(LoadScene, HugeCoordinatesAreErrors) {
  const Files file;
  expect_failure({file("huge.obj", "v 0 0 0\nv 1 0 0\nv 0 1e13 0\nf 1 2 3\n")}, {},
                 {"huge.obj: line 4", "too large"});
  std::string text = box("", "[1e300,0,0]");
  expect_failure({file("huge.json", text)}, {}, {"huge.json: object \"Box\"", "too large"});
  text.replace(text.find("[0.5,0.5,0.5]"), 13, "[1e308,1,1]");
  expect_failure({file("huge.json", text)}, {}, {"huge.json", "too large"});
}

TEST(LoadScene, AnLodThatIsNowhereListsTheOnesFound) {
  const Files file;
  LoadOptions options = without_ground();
  options.lod = "3";
  expect_failure({file("a.json", box()), file("b.json", box("", "[1300,340700,40]", "1.2"))},
                 options, {"a.json", "b.json", "\"3\"", "found: 2, 1.2"});
  options.lod = "1.2";
  const LoadedScene loaded =
      load({file("a.json", box()), file("b.json", box("", "[1300,340700,40]", "1.2"))}, options);
  EXPECT_EQ(loaded.scene.mesh.triangles.size(), 12u);
  EXPECT_TRUE(warns(loaded.scene, "Files without surfaces", 1));
}

TEST(LoadScene, FilesFarApartOrACrsThatNobodyNeedsAreErrors) {
  const Files file;
  LoadOptions options = without_ground();
  const auto dutch = file("nl.json", box("EPSG:28992", "[90000,435000,0]"));
  const auto compound =
      file("nap.json", box("https://www.opengis.net/def/crs/EPSG/0/7415", "[90000,435000,0]"));
  const auto vienna = file("at.json", box());
  const auto silent = file("none.json", box("", "[1200,340700,40]"));
  expect_failure({dutch, vienna}, options, {"at.json", "946 km", "nl.json", "--site"});
  options.crs = "EPSG:31255";
  expect_failure({vienna}, options, {"at.json", "EPSG:31256", "--crs", "EPSG:31255"});
  options.crs = "epsg:31256";
  EXPECT_EQ(load({vienna}, options).scene.frame.crs, "EPSG:31256");
  EXPECT_EQ(load({silent}, options).scene.frame.crs, "EPSG:31256");
  EXPECT_TRUE(load({silent}, options).scene.frame.place);
  // EPSG:7415 is EPSG:28992 with heights.
  EXPECT_EQ(load({dutch, compound}, without_ground()).scene.frame.crs, "EPSG:28992");
  EXPECT_FALSE(load({silent}, without_ground()).scene.frame.place);
}

TEST(LoadScene, AFileInAnotherCrsIsMovedIntoTheFirstOnes) {
  const Files file;
  const auto utm = reproject("EPSG:31256", "EPSG:32633", {{1205, 340705}}).value()[0];
  const auto vienna = file("at.json", box("EPSG:31256", "[1200,340700,40]"));
  const auto other =
      file("utm.json", box("EPSG:32633", fmt::format("[{:.6f},{:.6f},40]", utm.x, utm.y)));
  const LoadedScene loaded = load({vienna, other}, without_ground());
  EXPECT_EQ(loaded.scene.frame.crs, "EPSG:31256");
  EXPECT_EQ(loaded.files[1].placed, "moved from EPSG:32633 to EPSG:31256");
  // The second box's corner stands in the middle of the first one (10 m wide).
  const Vec3 corner = Vec3(1205, 340705, 40) - loaded.scene.frame.origin;
  double nearest = 1e9;
  for (const Vec3& v : loaded.scene.mesh.positions) {
    nearest = std::min(nearest, glm::length(v - corner));
  }
  EXPECT_LT(nearest, kThereAndBack);
}

TEST(LoadScene, AModelAtASiteStandsTurnedByTheConvergenceAndItsNorth) {
  const Files file;
  const auto vienna = file("at.json", box("EPSG:31256", "[1200,340700,40]"));
  const auto stick = file("stick.obj", "v 0 0 0\nv 0 100 0\nv 0 0 10\nf 1 2 3\n");
  const auto at = locate("EPSG:31256", {1300, 340800, 0}).value();
  LoadOptions options = without_ground();
  options.for_files = {
      {.file = "stick.*", .up = 'z', .north = 30 * kDegree, .site = Site(at.place)}};
  options.for_files[0].site->place.height = 7;
  const Scene scene = load({vienna, stick}, options).scene;
  // Its +y looks 30 degrees west of true north, which is `true_north` east of the grid's.
  const double azimuth = at.true_north - 30 * kDegree;
  const Vec3 foot = Vec3(1300, 340800, 7) - scene.frame.origin;
  const Vec3 end = foot + 100.0 * Vec3(std::sin(azimuth), std::cos(azimuth), 0);
  double to_foot = 1e9, to_end = 1e9;
  for (const Vec3& v : scene.mesh.positions) {
    to_foot = std::min(to_foot, glm::length(v - foot));
    to_end = std::min(to_end, glm::length(v - end));
  }
  EXPECT_LT(to_foot, kThereAndBack);
  EXPECT_LT(to_end, kThereAndBack);
  EXPECT_NEAR(scene.frame.true_north, at.true_north, 1e-4) << "the scene's north is the CRS's";
}

TEST(LoadScene, AModelWithoutAHeightStandsOnTheFootOfItsNeighbours) {
  const Files file;
  const auto vienna = file("at.json", box("EPSG:31256", "[1200,340700,40]"));
  const auto house = file("house.obj", "v 0 0 0\nv 0 100 0\nv 0 0 10\nf 1 2 3\n");
  LoadOptions options = without_ground();
  options.up = 'z';
  options.site = Site(locate("EPSG:31256", {1300, 340800, 0}).value().place, true);
  const LoadedScene loaded = load({house, vienna}, options);
  EXPECT_NE(loaded.files[0].placed.find("height 40.00 m"), std::string::npos)
      << loaded.files[0].placed;
}

TEST(LoadScene, LocalModelsAtDifferentSitesMeetInTheirUtmZone) {
  const Files file;
  const auto a = file("a.obj", kObj), b = file("b.obj", kObj);
  LoadOptions options = without_ground();
  options.for_files = {{.file = "a.obj", .site = Site(Place{48 * kDegree, 16 * kDegree, 0})},
                       {.file = "b.obj", .site = Site(Place{48.001 * kDegree, 16 * kDegree, 0})}};
  EXPECT_EQ(load({a, b}, options).scene.frame.crs, "EPSG:32633");
  options.for_files.pop_back();
  EXPECT_EQ(load({a, b}, options).scene.frame.crs, "") << "they share their coordinates";
  options.for_files[0].file = "c.obj";
  expect_failure({a, b}, options, {"c.obj", "a.obj"});
}

TEST(LoadScene, ASiteForAFileThatHasACrsIsAnError) {
  const Files file;
  LoadOptions options = without_ground();
  options.for_files = {{.file = "at.json", .site = Site(Place{0.8, 0.3, 0})}};
  expect_failure({file("at.json", box("EPSG:31256", "[1200,340700,40]"))}, options,
                 {"at.json", "EPSG:31256", "--site"});
}

TEST(LoadScene, CrsInFeetOrDegreesOrUnknownAreErrors) {
  const Files file;
  LoadOptions options = without_ground();
  const auto path = file("t.obj", kObj);
  options.up = 'z';
  options.crs = "EPSG:2263";  // New York, US survey feet
  expect_failure(
      {file("ny.obj", "v 980000 200000 0\nv 980010 200000 0\nv 980000 200010 0\nf 1 2 3\n")},
      options, {"EPSG:2263", "not in metres"});
  options.crs = "EPSG:4326";
  expect_failure({path}, options, {"4326"});
  options.crs = "EPSG:999999";
  expect_failure({path}, options, {"999999"});
}

TEST(LoadScene, SiteAndNorthOverrideTheCrs) {
  const Files file;
  LoadOptions options = without_ground();
  options.site = Place{48.2 * kDegree, 16.3 * kDegree, 100};
  options.north = 0.125;
  for (const std::string crs : {"", "EPSG:31256"}) {
    const Frame frame = load({file("box.json", box(crs))}, options).scene.frame;
    EXPECT_EQ(frame.place->latitude, 48.2 * kDegree);
    EXPECT_EQ(frame.place->height, 100);
    EXPECT_EQ(frame.true_north, 0.125);
    EXPECT_EQ(frame.origin, Vec3(1205, 340705, 50));
  }
  options.site = Place{16.3 * kDegree, 48.2 * kDegree, 100};
  expect_failure({file("box.json", box())}, options,
                 {"box.json", "--site", "EPSG:31256", "swapped"});
  options.north = std::nan("");
  expect_failure({file("box.json", box())}, options, {"--north"});
}

TEST(LoadScene, OnlyWhatIsNamedCastsAndReceives) {
  const Files file;
  LoadOptions options;  // with a ground
  options.ground = "40";
  options.cast = {"Roof*", "Wall*"};
  options.receive = {"Ground"};
  const LoadedScene loaded = load({file("box.json", box())}, options);
  EXPECT_GT(loaded.ground.triangles, 0u);
  for (const Surface& s : loaded.scene.surfaces) {
    EXPECT_EQ(s.casts, s.semantic == "RoofSurface" || s.semantic == "WallSurface") << s.semantic;
    EXPECT_EQ(s.receives, s.semantic == "Ground") << s.semantic;
  }
  options.receive = {"Rofsurface"};
  expect_failure({file("box.json", box())}, options, {"--receive", "\"RoofSurface\""});
}

TEST(LoadScene, TheGroundReachesSixHeightsAroundTheModel) {
  const Files file;
  LoadOptions options;
  options.ground = "40";
  const auto reach = [&](const Scene& s) {
    double low = 0;
    for (const Vec3& p : s.mesh.positions) low = std::min(low, p.x);
    return low;
  };
  EXPECT_LE(reach(load({file("box.json", box())}, options).scene), -5 - 6 * 20);
  options.ground_extent = Bounds2{1100, 340600, 1310, 340810};
  EXPECT_LE(reach(load({file("box.json", box())}, options).scene), -105);
  options.ground_extent = Bounds2{1, 1, 0, 2};
  expect_failure({file("box.json", box())}, options, {"x0 < x1"});
}

TEST(LoadScene, WhatIsDroppedIsCounted) {
  const Files file;
  const LoadedScene loaded =
      load({file("t.obj",
                 "o A\nv 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 1e-40\no B\n"
                 "f 1 2 3\nf 1 2 4\nf 1 1 2\nf 1 2 5\nf 1 5 2 4\n")},
           without_ground());
  EXPECT_EQ(loaded.zero_area_triangles, 1u);
  EXPECT_TRUE(warns(loaded.scene, "without area", 1));
  EXPECT_TRUE(warns(loaded.scene, "fewer than 3 distinct", 1));
  EXPECT_TRUE(warns(loaded.scene, "are not simple", 1));
  EXPECT_TRUE(warns(loaded.scene, "smaller than an atom", 1));
  EXPECT_EQ(loaded.files[0].triangles, 5u);
  EXPECT_EQ(loaded.scene.mesh.triangles.size(), 4u);
}

// Larger models
// ------------------------------------------------------------------------------------------------

struct City {
  const char* file;
  const char* format;
  const char* crs;
  std::size_t objects, polygons, twice, triangles;  // at the highest LoD of each object
};

// SOURCES.tsv beside the files counts polygons over all LoDs, with those that are stored twice.
class Cities : public testing::TestWithParam<City> {};

TEST_P(Cities, LoadWithTheCountsTheirSourcesGive) {
  const City& city = GetParam();
  const auto path = std::filesystem::path(GNOMON_DATA) / "city" / city.file;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "skipped: " << path << " is not there";
  const LoadedScene loaded = load({path}, without_ground());
  const FileReport& report = loaded.files[0];
  EXPECT_EQ(report.format, city.format);
  EXPECT_EQ(report.crs, city.crs);
  EXPECT_EQ(report.objects, city.objects);
  EXPECT_EQ(report.surfaces, city.polygons - city.twice);
  EXPECT_EQ(report.stored_twice, city.twice);
  EXPECT_EQ(report.triangles, city.triangles);
  EXPECT_EQ(loaded.scene.mesh.triangles.size() + loaded.zero_area_triangles, report.triangles);
  EXPECT_EQ(loaded.scene.frame.place.has_value(), *city.crs != '\0');
  for (const Warning& w : loaded.scene.warnings) {
    EXPECT_EQ(w.what.find("not simple"), std::string::npos) << w.count << " " << w.first;
  }
}

INSTANTIATE_TEST_SUITE_P(
    LoadScene, Cities,
    testing::Values(
        City{"3-20-DELFSHAVEN.city.json", "CityJSON 2.0", "EPSG:28992", 853, 15482, 21, 37520},
        City{"delft.json", "CityJSON 2.0", "EPSG:7415", 570, 36271, 0, 36271},
        City{"denhaag_random_5.city.jsonl", "CityJSONSeq 1.1", "EPSG:7415", 14, 117, 0, 246},
        City{"multi_lod.json", "CityJSON 2.0", "", 10, 348, 0, 348},
        City{"tile_901_trimmed.jsonl", "CityJSONSeq 1.1", "EPSG:7415", 52, 1316, 0, 4554},
        City{"vienna.jsonl", "CityJSONSeq 1.1", "", 490, 18824, 9412, 39739},
        City{"zurich_subset_lod2.json", "CityJSON 1.1", "EPSG:2056", 161, 2039, 0, 5142}),
    [](const auto& instance) {
      std::string name = instance.param.file;
      std::replace_if(
          name.begin(), name.end(),
          [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
      return name;
    });

TEST(LoadScene, TheLodsOfAFileAddUpToItsPolygons) {
  const auto sum = [&](const char* file, const std::vector<std::string>& lods) {
    std::size_t polygons = 0;
    LoadOptions options = without_ground();
    for (const std::string& lod : lods) {
      options.lod = lod;
      const LoadedScene loaded =
          load({std::filesystem::path(GNOMON_DATA) / "city" / file}, options);
      EXPECT_EQ(loaded.files[0].lods, lods);
      EXPECT_EQ(loaded.files[0].lod_used, lod);
      polygons += loaded.files[0].surfaces;
    }
    return polygons;
  };
  if (!std::filesystem::exists(GNOMON_DATA))
    GTEST_SKIP() << "skipped: " << GNOMON_DATA << " is not there";
  EXPECT_EQ(sum("multi_lod.json", {"1.2", "1.3", "2.2"}), 752u);
  EXPECT_EQ(sum("tile_901_trimmed.jsonl", {"0", "1.2", "1.3", "2.2"}), 3552u);
}

TEST(LoadScene, TheShippedViennaIsRead) {
  LoadOptions options = without_ground();
  options.crs = "EPSG:31256";
  const LoadedScene loaded =
      load({std::filesystem::path(GNOMON_SCENES) / "vienna" / "vienna.city.jsonl"}, options);
  EXPECT_EQ(loaded.files[0].objects, 490u);
  EXPECT_EQ(loaded.scene.mesh.triangles.size(), 39739u);
  std::set<std::string> buildings;
  for (const Surface& s : loaded.scene.surfaces) {
    buildings.insert(s.object.substr(0, s.object.find('/')));
  }
  EXPECT_EQ(buildings.size(), 149u);
}

TEST(LoadScene, EveryObjOfTheCollectionLoadsOrSaysWhyNot) {
  if (!std::filesystem::exists(GNOMON_DATA))
    GTEST_SKIP() << "skipped: " << GNOMON_DATA << " is not there";
  std::size_t loaded = 0, refused = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(GNOMON_DATA)) {
    if (entry.path().extension() != ".obj") continue;
    const auto result = load_scene({entry.path()}, without_ground());
    if (result) {
      ++loaded;
      EXPECT_GT(result.value().scene.mesh.triangles.size(), 0u);
    } else {
      ++refused;
      EXPECT_NE(result.error().message.find(entry.path().filename().string() + ":"),
                std::string::npos)
          << result.error().message;
    }
  }
  EXPECT_EQ(loaded, 24u);
  EXPECT_EQ(refused, 13u);  // empty, points or lines only, broken indices or numbers, UTF-16
}

}  // namespace
}  // namespace gnomon
