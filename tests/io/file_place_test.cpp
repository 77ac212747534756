// Files of many kinds in one scene: which comes first, who stands on whom, what contradicts.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored \
    "-Wrestrict"  // GCC 12 warns of "text" + std::string (its bug 105651)
#endif

#include <fmt/format.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/load_scene.h>
#include <gtest/gtest.h>

#include <limits>

#include <io/load_files.h>

namespace gnomon {
namespace {

using namespace testing_files;

// 10 x 10 cells of 10 m from (1200, 340700) in Vienna's CRS: the height is 100 + column; a hole of
// 2 x 2 cells in the middle.
std::string terrain() {
  std::string text =
      "ncols 10\nnrows 10\nxllcorner 1200\nyllcorner 340700\ncellsize 10\nNODATA_value -9999\n";
  for (int row = 0; row < 10; ++row) {
    for (int column = 0; column < 10; ++column) {
      const bool hole = (row == 4 || row == 5) && (column == 4 || column == 5);
      text += hole ? "-9999 " : fmt::format("{} ", 100 + column);
    }
    text += '\n';
  }
  return text;
}
FileOptions in_vienna(const std::string& file) { return {.file = file, .crs = "EPSG:31256"}; }

Site at(double x, double y) { return Site(locate("EPSG:31256", {x, y, 0}).value().place, true); }

// A box of 4 x 4 x `height` m from z = `low`, z up.
std::string cube(double low = 0, double height = 6, const std::string& before = "") {
  std::string text = before;
  for (const double z : {low, low + height}) {
    text += fmt::format("v 0 0 {0}\nv 4 0 {0}\nv 4 4 {0}\nv 0 4 {0}\n", z);
  }
  return text + "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
}

std::string footprint(double x, double y, const std::string& more = "") {
  return fmt::format(
      R"({{"type":"FeatureCollection","crs":{{"type":"name","properties":{{"name":"EPSG:31256"}}}},)"
      R"("features":[{{"type":"Feature","properties":{{"height":5{2}}},"geometry":)"
      R"({{"type":"Polygon","coordinates":[[[{0},{1}],[{3},{1}],[{3},{4}],[{0},{4}],[{0},{1}]]]}}}}]}})",
      x, y, more, x + 4, y + 4);
}

// Of the triangles of the file with this number, in the coordinates of the CRS.
double lowest(const Scene& scene, std::uint32_t file) {
  double z = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    const Surface& s = scene.surfaces[scene.surface_of[t]];
    if (s.file != file || s.object == "Ground") continue;
    for (const std::uint32_t v : scene.mesh.triangles[t])
      z = std::min(z, scene.mesh.positions[v].z);
  }
  return z + scene.frame.origin.z;
}
double highest_ground(const Scene& scene) {
  double z = -std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (scene.surfaces[scene.surface_of[t]].object != "Ground") continue;
    for (const std::uint32_t v : scene.mesh.triangles[t])
      z = std::max(z, scene.mesh.positions[v].z);
  }
  return z + scene.frame.origin.z;
}

LoadOptions z_up() {
  LoadOptions options = without_ground();
  options.up = 'z';
  return options;
}

// ---- who stands on whom ----------------------------------------------------------------------

TEST(FilePlace, OverAHoleInTheTerrainTheNearestHeightIsTaken) {
  const Files file;
  const auto dem = file("dem.asc", terrain()), house = file("house.obj", cube());
  LoadOptions options = z_up();
  options.for_files = {in_vienna("dem.asc"), {.file = "house.obj", .site = at(1246, 340751)}};
  const LoadedScene in_hole = load({dem, house}, options);
  // The centres around the hole are at 1235 (103 m) and 1265 (106 m).
  EXPECT_NEAR(lowest(in_hole.scene, 1), 103, 1.01);
  EXPECT_GT(lowest(in_hole.scene, 1), 102.5);
  EXPECT_TRUE(warns(in_hole.scene, "the height of the nearest was taken", 1));
  options.for_files[1].site = at(1400, 340751);  // east of it: at its border, 109 m
  EXPECT_NEAR(lowest(load({dem, house}, options).scene, 1), 109, 1e-3);
  options.for_files[1].site = at(1225, 340725);
  const LoadedScene on_it = load({dem, house}, options);
  EXPECT_NEAR(lowest(on_it.scene, 1), 102, 1e-3);  // the datum shift's millimetres
  EXPECT_FALSE(warns(on_it.scene, "the nearest was taken", 1));
}

TEST(FilePlace, HeightsAboveGroundInAHoleStandOnTheGroundBesideThem) {
  const Files file;
  std::string blocks = terrain();
  blocks = blocks.substr(0, blocks.find("-9999\n") + 6);
  for (int row = 0; row < 10; ++row) {
    for (int column = 0; column < 10; ++column) blocks += row == 4 && column == 4 ? "7 " : "0 ";
    blocks += '\n';
  }
  LoadOptions options = without_ground();
  options.crs = "EPSG:31256";
  options.above_ground = {"ndsm.asc"};
  const LoadedScene loaded = load({file("dem.asc", terrain()), file("ndsm.asc", blocks)}, options);
  EXPECT_NEAR(lowest(loaded.scene, 1), 103, 1e-6) << "not at the terrain's lowest point";
  EXPECT_TRUE(warns(loaded.scene, "the height of the nearest was taken", 1));
}

TEST(FilePlace, HeightsAboveGroundInTheLastHalfCellOfATerrainStandOnItWithoutAWarning) {
  const Files file;
  const std::string dem =
      "ncols 3\nnrows 3\nxllcorner 1200\nyllcorner 340700\ncellsize 25\n"
      "400 400 400\n400 400 400\n400 400 400\n";
  std::string ndsm = "ncols 75\nnrows 75\nxllcorner 1200\nyllcorner 340700\ncellsize 1\n";
  for (int k = 0; k < 75 * 75; ++k) ndsm += k == 75 * 37 + 2 || k == 0 ? "9 " : "0 ";
  LoadOptions options = without_ground();
  options.crs = "EPSG:31256";
  options.above_ground = {"ndsm.asc"};
  const Scene scene = load({file("dem.asc", dem), file("ndsm.asc", ndsm)}, options).scene;
  EXPECT_EQ(lowest(scene, 1), 400);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(FilePlace, ADesignStandsOnTheFootOfAnotherNotOnItsBalcony) {
  const Files file;
  const auto first =
      file("first.obj", cube(0, 6, "o walls\n") +
                            "o balcony\nv 4 0 3\nv 6 0 3\nv 6 4 3\nv 4 4 3\nf 9 10 11 12\n");
  const auto second = file("second.obj", cube());
  LoadOptions options = z_up();
  Site known = at(1200, 340700);
  known.on_ground = false;
  known.place.height = 100;
  options.for_files = {{.file = "first.obj", .site = known},
                       {.file = "second.obj", .site = at(1206, 340700)}};
  for (const auto& order : {std::vector{first, second}, std::vector{second, first}}) {
    const LoadedScene loaded = load(order, options);
    EXPECT_NEAR(lowest(loaded.scene, 0), 100, 1e-6);
    EXPECT_NEAR(lowest(loaded.scene, 1), 100, 1e-6);
    EXPECT_TRUE(loaded.scene.warnings.empty());
  }
}

TEST(FilePlace, DesignsAtSitesOfDifferentHeightsStandOnGroundOfTheirOwn) {
  const Files file;
  LoadOptions options = z_up();
  options.ground = "auto";
  Site low = at(1200, 340700), high = at(1260, 340700);
  low.on_ground = high.on_ground = false;
  low.place.height = 100, high.place.height = 103;
  options.for_files = {{.file = "low.obj", .site = low}, {.file = "high.obj", .site = high}};
  const Scene scene = load({file("low.obj", cube()), file("high.obj", cube())}, options).scene;
  EXPECT_NEAR(highest_ground(scene), 103, 1e-6);
}

TEST(FilePlace, TheGroundOfACityDoesNotRiseToTheRoofOfADesign) {
  const Files file;
  LoadOptions options = z_up();
  options.ground = "auto";
  options.for_files = {{.file = "house.obj", .site = at(1240, 340705)}};
  const auto house = file("house.obj", cube(0, 6, "o walls\n") +
                                           "o roof\nv -1 -1 6\nv 5 -1 6\nv 5 5 6\nv -1 5 6\n"
                                           "v 2 2 9\nf 9 12 11 10\nf 9 10 13\nf 10 11 13\n"
                                           "f 11 12 13\nf 12 9 13\n");
  const Scene scene = load({file("at.json", box()), house}, options).scene;
  EXPECT_NEAR(highest_ground(scene), 40, 1e-6);
}

TEST(FilePlace, GroupsOfADesignerAreNotWordsOfCityJson) {
  const Files file;
  LoadOptions options = z_up();
  options.ground = "auto";
  const std::string slab = "g Room 1\nv 9 0 3\nv 12 0 3\nv 12 4 3\nf 9 10 11\n";
  const auto level = [&](const std::string& text) {
    const LoadedScene loaded = load({file("house.obj", text)}, options);
    EXPECT_EQ(loaded.ground.kind, "level") << text;
    return highest_ground(loaded.scene);
  };
  EXPECT_EQ(level(cube() + slab), 0);
  EXPECT_EQ(level(cube(0, 6, "g LandUse\n")), 0);
}

// ---- CRS and sites ---------------------------------------------------------------------------

TEST(FilePlace, LocalTerrainAndAHouseShareASite) {
  const Files file;
  std::string local = terrain();
  local.replace(local.find("1200"), 4, "0").replace(local.find("340700"), 6, "0");
  LoadOptions options = z_up();
  options.site = Site(Place{48.2 * kDegree, 16.3 * kDegree, 0}, true);
  const LoadedScene shared = load({file("dem.asc", local), file("house.obj", cube(105))}, options);
  EXPECT_EQ(shared.scene.frame.crs, "");
  EXPECT_EQ(shared.scene.frame.place->latitude, 48.2 * kDegree);
  EXPECT_EQ(lowest(shared.scene, 1), 105);
  // At sites of their own they meet in the UTM zone; the terrain keeps its heights.
  options.for_files = {{.file = "dem.asc", .north = 90 * kDegree, .site = options.site},
                       {.file = "house.obj", .site = options.site}};
  const LoadedScene apart = load({file("dem.asc", local), file("house.obj", cube())}, options);
  EXPECT_EQ(apart.scene.frame.crs, "EPSG:32633");
  EXPECT_EQ(lowest(apart.scene, 0), 100);
  EXPECT_NEAR(lowest(apart.scene, 1), 100, 1e-6) << "at the terrain's corner";
}

TEST(FilePlace, LocalFootprintsStandOnTheTerrainOfTheirSite) {
  const Files file;
  const std::string local =  // names no CRS
      R"(<ogr:FeatureCollection xmlns:ogr="http://ogr.maptools.org/" )"
      R"(xmlns:gml="http://www.opengis.net/gml"><gml:featureMember><ogr:a fid="a.0">)"
      R"(<ogr:geometryProperty><gml:Polygon><gml:outerBoundaryIs><gml:LinearRing>)"
      R"(<gml:coordinates>0,0 4,0 4,4 0,4 0,0</gml:coordinates></gml:LinearRing>)"
      R"(</gml:outerBoundaryIs></gml:Polygon></ogr:geometryProperty><ogr:height>5</ogr:height>)"
      R"(</ogr:a></gml:featureMember></ogr:FeatureCollection>)";
  LoadOptions options = without_ground();
  options.for_files = {in_vienna("dem.asc"), {.file = "plots.gml", .site = at(1285, 340725)}};
  const LoadedScene loaded = load({file("dem.asc", terrain()), file("plots.gml", local)}, options);
  EXPECT_NEAR(lowest(loaded.scene, 1), 108, 0.5);
  EXPECT_TRUE(loaded.files[1].placed.starts_with("local origin")) << loaded.files[1].placed;
}

TEST(FilePlace, FootprintsGiveTheSceneItsCrsWhateverIsKnownOfTheDesignsHeight) {
  const Files file;
  const auto plots = file("plots.geojson", footprint(1200, 340700)), house = file("h.obj", cube());
  LoadOptions options = z_up();
  for (const bool on_ground : {true, false}) {
    options.site = at(1210, 340700);
    options.site->on_ground = on_ground;
    for (const auto& order : {std::vector{plots, house}, std::vector{house, plots}}) {
      const LoadedScene loaded = load(order, options);
      EXPECT_EQ(loaded.scene.frame.crs, "EPSG:31256");
      EXPECT_EQ(lowest(loaded.scene, 0), 0);
      EXPECT_EQ(lowest(loaded.scene, 1), 0);
    }
  }
}

TEST(FilePlace, ADesignStandsBesideFootprintsThatKnowTheirBase) {
  const Files file;
  LoadOptions options = z_up();
  options.site = at(1210, 340700);
  const Scene scene =
      load({file("h.obj", cube()),
            file("plots.geojson", footprint(1200, 340700, R"(,"base_elevation":150)"))},
           options)
          .scene;
  EXPECT_EQ(lowest(scene, 0), 150);
}

TEST(FilePlace, NamesMayHoldEqualsSignsAndBrackets) {
  const Files file;
  LoadOptions options = z_up();
  options.for_files = {{.file = "a [1]=b.obj", .site = at(1210, 340700)}};
  const auto house = file("a [1]=b.obj", cube());
  EXPECT_TRUE(load({house}, options).scene.frame.place);
  options.for_files[0].file = (file.folder / "." / "a [1]=b.obj").string();
  EXPECT_TRUE(load({house}, options).scene.frame.place);
}

// ---- contradictions --------------------------------------------------------------------------

TEST(FilePlace, OptionsThatContradictAFileAreErrors) {
  const Files file;
  const auto city = file("at.json", box()), house = file("house.obj", cube());
  LoadOptions options = z_up();
  options.for_files = {{.file = "at.json", .crs = "EPSG:28992"}};
  expect_failure({city}, options, {"at.json", "EPSG:31256", "EPSG:28992", "--crs"});
  options.for_files = {{.file = "at.json", .north = 0.5}};
  expect_failure({city}, options, {"at.json", "EPSG:31256", "--north"});
  options.for_files = {{.file = "house.obj", .north = 0.5}};
  expect_failure({city, house}, options, {"house.obj", "--north", "--site"});
  options.for_files = {{.file = "house.obj", .site = at(1210, 340700)}};
  options.crs = "EPSG:28992";
  expect_failure({city, house}, options, {"at.json", "EPSG:28992", "leave out --crs"});
  options.crs = "nonsense";
  expect_failure({city, house}, options, {"nonsense", "leave out --crs"});
}

TEST(FilePlace, OptionsThatNoFileUsesAreWarnings) {
  const Files file;
  const auto city = file("at.json", box()), house = file("house.obj", cube());
  LoadOptions options = without_ground();
  options.lod = "2";
  options.footprints.height = "hoehe";
  options.surface = RasterMesh::cells;
  options.for_files = {{.file = "at.json", .unit = "ft"}};
  const Warnings with_city = load({city}, options).scene.warnings;
  ASSERT_EQ(with_city.size(), 3u);
  EXPECT_EQ(with_city[0].first, "at.json");
  options.for_files.clear();
  const Scene alone = load({house}, options).scene;
  EXPECT_TRUE(warns(alone, "--lod was not used", 1));
  EXPECT_TRUE(warns(alone, "Options for footprints were not used", 1));
  EXPECT_TRUE(warns(alone, "--surface was not used", 1));
}

// ---- what is suspicious ----------------------------------------------------------------------

TEST(FilePlace, WhatStandsBeyondTheTerrainOrFarFromItIsCounted) {
  const Files file;
  const auto dem = file("dem.asc", terrain());
  const auto with = [&](const std::string& corner) {
    LoadOptions options = without_ground();
    options.crs = "EPSG:31256";
    return load({dem, file("at.json", box("EPSG:31256", corner))}, options).scene;
  };
  EXPECT_TRUE(with("[1220,340710,102]").warnings.size() == 1);  // the hole's cells
  EXPECT_TRUE(warns(with("[1400,340700,102]"), "stand where the terrain has no surface", 1));
  EXPECT_TRUE(warns(with("[1220,340710,152]"), "float above the ground", 1));
  EXPECT_TRUE(warns(with("[1220,340710,52]"), "lie below the ground", 1));
}

TEST(FilePlace, ABuildingWithOneCornerInAHoleStandsOnTheTerrain) {
  const Files file;
  LoadOptions options = without_ground();
  options.crs = "EPSG:31256";
  // Its first corner is in the hole, between the centres around (1245, 340745).
  const Scene scene =
      load({file("dem.asc", terrain()), file("at.json", box("EPSG:31256", "[1250,340750,103]"))},
           options)
          .scene;
  EXPECT_FALSE(warns(scene, "where the terrain has no surface", 1));
}

TEST(FilePlace, TreesAndLampsMayBeginInTheAir) {
  const Files file;
  std::string tree = box("EPSG:31256", "[1260,340702,70]");
  tree.replace(tree.find("\"Building\""), 10, "\"SolitaryVegetationObject\"");
  tree.replace(tree.find("\"Box\""), 5, "\"Tree\"");
  LoadOptions options = without_ground();
  options.crs = "EPSG:31256";
  const Scene scene = load({file("dem.asc", terrain()), file("tree.json", tree)}, options).scene;
  EXPECT_FALSE(warns(scene, "float above the ground", 1));
}

TEST(FilePlace, ADesignInTheAirOrInTheGroundIsAWarningButNotAStoreyOnTopOfAnother) {
  const Files file;
  const auto city = file("at.json", box());  // from (1200, 340700, 40), 10 x 10 x 20 m
  const auto with = [&](double x, double height) {
    LoadOptions options = z_up();
    Site site = at(x, 340702);
    site.on_ground = false;
    site.place.height = height;
    options.for_files = {{.file = "house.obj", .site = site}};
    return load({city, file("house.obj", cube())}, options).scene;
  };
  EXPECT_TRUE(with(1215, 40).warnings.empty());
  EXPECT_TRUE(with(1203, 60).warnings.empty()) << "on the roof";
  const Scene high = with(1215, 171);
  ASSERT_TRUE(warns(high, "float above the ground", 1));
  EXPECT_EQ(high.warnings[0].first, "house.obj: 131.0 m above the ground there");
  EXPECT_TRUE(warns(with(1215, 34.5), "reach below the ground", 1));
  EXPECT_TRUE(warns(with(1215, 20), "lie below the ground", 1));
}

TEST(FilePlace, SizesThatHintAtAnotherUnitAreNamedForEachFile) {
  const Files file;
  LoadOptions options = z_up();
  const auto with = [&](const std::string& unit, const std::string& text) {
    options.for_files = {{.file = "house.obj", .unit = unit, .site = at(1215, 340702)}};
    return load({file("at.json", box()), file("house.obj", text)}, options).scene;
  };
  EXPECT_TRUE(warns(with("mm", cube()), "very small", 1));
  EXPECT_TRUE(warns(with("m", cube(0, 6000)), "very high", 1));
  EXPECT_EQ(with("m", cube(0, 6000)).warnings[0].first,
            "house.obj: 6000 m high; --unit house.obj=mm?");
  EXPECT_TRUE(with("m", cube()).warnings.empty());
}

}  // namespace
}  // namespace gnomon
