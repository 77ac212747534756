#include <gnomon/io/footprint_layer.h>

#include <algorithm>
#include <set>

#include <gnomon/io/footprints.h>
#include <gnomon/io/triangulate.h>
#include <gnomon/scene/objects.h>

#include "io/footprint_test_files.h"

namespace gnomon {
namespace {

TEST_F(FootprintLayer, SquareBecomesAClosedBoxWoundOutwards) {
  const Model m = model(collection({house(R"("height":12)", 0, "A1")}));
  EXPECT_TRUE(watertight(m));
  EXPECT_NEAR(volume(m), 1200, 1e-6);
  EXPECT_EQ(m.vertices.size(), 8u);
  EXPECT_EQ(count(m, "RoofSurface"), 1u);
  EXPECT_EQ(count(m, "GroundSurface"), 1u);
  EXPECT_EQ(count(m, "WallSurface"), 4u);
  EXPECT_EQ(m.surfaces[0].object, "A1");
  EXPECT_EQ(m.surfaces[0].group, "Building");
  EXPECT_EQ(m.report.format, "GeoJSON footprints");
  EXPECT_EQ(m.report.crs, "EPSG:31256");
  EXPECT_EQ(m.report.objects, 1u);
  EXPECT_EQ(m.report.surfaces, 6u);
  EXPECT_EQ(m.vertices[0].x, 1000) << "the file's own CRS needs no moving";
}

TEST_F(FootprintLayer, EitherWindingGivesTheSameSolid) {
  const auto one = [&](const std::vector<Vec2>& points) {
    return volume(model(collection({feature(R"("height":3)", polygon(ring(points)))})));
  };
  EXPECT_NEAR(one({{0, 0}, {4, 0}, {4, 5}, {0, 5}}), 60, 1e-6);
  EXPECT_NEAR(one({{0, 5}, {4, 5}, {4, 0}, {0, 0}}), 60, 1e-6);
}

TEST_F(FootprintLayer, CourtyardHasWallsWhateverItsWinding) {
  for (const bool reverse : {false, true}) {
    std::vector<Vec2> hole = {{3, 3}, {7, 3}, {7, 7}, {3, 7}};
    if (reverse) std::reverse(hole.begin(), hole.end());
    const Model m =
        model(collection({feature(R"("height":5)", polygon(square(0, 0, 10) + "," + ring(hole)))}));
    EXPECT_TRUE(watertight(m));
    EXPECT_NEAR(volume(m), (100 - 16) * 5, 1e-6);
    EXPECT_EQ(count(m, "WallSurface"), 8u);
  }
}

TEST_F(FootprintLayer, MultiPolygonIsOneObject) {
  const Model m = model(collection(
      {feature(R"("height":5)", R"({"type":"MultiPolygon","coordinates":[[)" + square(0, 0, 10) +
                                    "],[" + square(20, 0, 10) + "]]}")}));
  EXPECT_TRUE(watertight(m));
  EXPECT_EQ(heights(m).size(), 1u);
  EXPECT_NEAR(volume(m), 1000, 1e-6);
}

TEST_F(FootprintLayer, RepeatedPointsAndOpenRingsChangeNothing) {
  const std::string rings[] = {ring({{0, 0}, {0, 0}, {10, 0}, {10, 10}, {10, 10}, {0, 10}, {0, 0}}),
                               "[[1000,340000],[1010,340000],[1010,340010],[1000,340010]]"};
  for (const std::string& r : rings) {
    const Model m = model(collection({feature(R"("height":2)", polygon(r))}));
    EXPECT_EQ(m.vertices.size(), 8u) << r;
    EXPECT_NEAR(volume(m), 200, 1e-6) << r;
  }
}

TEST_F(FootprintLayer, SelfCrossingRingsAreRepairedAndCounted) {
  const Model m = model(
      collection({feature(R"("height":3)", polygon(ring({{0, 0}, {10, 10}, {10, 0}, {0, 10}})))}));
  EXPECT_TRUE(watertight(m));
  EXPECT_NEAR(volume(m), 150, 1e-6);  // both wings of the bow tie
  const Warning w = warning(m, "repaired");
  EXPECT_EQ(w.count, 1u);
  EXPECT_TRUE(has(w.first, "feature 1: Self-intersection")) << w.first;
}

TEST_F(FootprintLayer, RingsWithoutAreaAreLeftOutAndCounted) {
  const Model m = model(collection(
      {house(R"("height":3)"), feature(R"("height":3)", polygon(ring({{20, 0}, {30, 0}})), "flat"),
       feature(R"("height":3)", polygon(ring({{20, 0}, {30, 0}, {40, 0}})), "line")}));
  EXPECT_EQ(m.report.objects, 1u);
  EXPECT_EQ(warning(m, "without an area").count, 2u);
}

TEST_F(FootprintLayer, NeighboursShareTheCornersOfTheirCommonWall) {
  const Model m = model(collection({house(R"("height":3)", 0), house(R"("height":3)", 10)}));
  EXPECT_EQ(m.vertices.size(), 12u);
  EXPECT_TRUE(watertight(m));
}

TEST_F(FootprintLayer, BuildingsStandOnTheLowestGroundUnderTheirCorners) {
  const GroundAt slope = [](double x, double) { return std::optional((x - 1000) / 10 + 100); };
  const Model m = model(collection({house(R"("height":5)", 20)}), {}, slope);
  EXPECT_DOUBLE_EQ(heights(m).begin()->second.low, 102);
  EXPECT_DOUBLE_EQ(top(m), 107);
  EXPECT_TRUE(m.warnings.empty());
}

TEST_F(FootprintLayer, WithoutGroundTheyStandAtZeroAndAreCounted) {
  const std::string two = collection({house(R"("height":5)"), house(R"("height":5)", 20)});
  const Model alone = model(two);  // nothing else in the scene: nothing to warn of
  EXPECT_EQ(heights(alone).begin()->second.low, 0);
  EXPECT_TRUE(alone.warnings.empty());
  const GroundAt nowhere = [](double, double) { return std::optional<double>(); };
  const Model m = model(two, {}, nowhere);
  EXPECT_EQ(heights(m).begin()->second.low, 0);
  EXPECT_EQ(warning(m, "stand at height 0").count, 2u);
  const GroundAt west = [](double x, double) {
    return x < 1005 ? std::optional(30.0) : std::optional<double>();
  };
  const Model half =
      model(collection({house(R"("height":5)"), house(R"("height":5)", 20)}), {}, west);
  EXPECT_EQ(warning(half, "stand at height 0").count, 1u);
  EXPECT_EQ(heights(half)["feature 1"].low, 30);
}

TEST_F(FootprintLayer, BaseAttributesAreAbsoluteAndGoBeforeTheGround) {
  const GroundAt level = [](double, double) { return std::optional(7.0); };
  const std::string text =
      collection({house(R"("height":5,"ground_z":"200","base_height":"50","low":9)")});
  EXPECT_EQ(top(model(text, {}, level)), 205);
  FootprintOptions options;
  options.base = "low";
  EXPECT_EQ(top(model(text, options, level)), 14);
}

TEST_F(FootprintLayer, HeightsInCoordinatesAreNotUsedAndCounted) {
  const std::string r = "[[1000,340000,50],[1010,340000,50],[1010,340010,50],[1000,340000,50]]";
  const Model m = model(collection({feature(R"("height":5)", polygon(r))}));
  EXPECT_EQ(heights(m).begin()->second.low, 0);
  EXPECT_EQ(warning(m, "Heights in the coordinates").count, 1u);
}

TEST_F(FootprintLayer, OtherGeometriesAndMissingOnesAreCounted) {
  const Model m =
      model(collection({house(R"("height":3)"),
                        feature(R"("height":3)", R"({"type":"Point","coordinates":[1000,340000]})"),
                        feature(R"("height":3)", "null")}));
  EXPECT_EQ(m.report.objects, 1u);
  EXPECT_EQ(warning(m, "other than polygons").count, 1u);
  EXPECT_EQ(warning(m, "without a geometry").count, 1u);
}

TEST_F(FootprintLayer, WhatIsUndergroundOrNoBuildingIsCounted) {
  const Model m =
      model(collection({house(R"("height":3,"building":"yes","layer":"1")"),
                        house(R"("height":3,"building":"yes","layer":"-1")", 20),
                        house(R"("height":3,"building":"yes","location":"underground")", 40),
                        house(R"("height":3,"building":"no")", 60)}));
  EXPECT_EQ(m.report.objects, 1u);
  EXPECT_EQ(warning(m, "below the ground").count, 2u);
  EXPECT_EQ(warning(m, "building=no").count, 1u);
}

TEST_F(FootprintLayer, PartsReplaceTheOutlineAroundThem) {
  const auto rectangle = [](double x0, double x1) {
    return polygon(ring({{x0, 0}, {x1, 0}, {x1, 10}, {x0, 10}}));
  };
  const Model m = model(
      collection({feature(R"("building":"yes")", rectangle(0, 20), "way/1"),
                  feature(R"("building:part":"yes","height":5)", rectangle(0, 10), "way/2"),
                  feature(R"("building:part":"yes","height":30,"min_height":4)", rectangle(10, 20),
                          "relation/3"),
                  feature(R"("building":"yes","height":8)", rectangle(20, 30), "way/4"),
                  feature(R"("building:part":"yes","height":8)", rectangle(40, 50), "way/5")}));
  auto h = heights(m);
  EXPECT_EQ(h.size(), 4u);
  EXPECT_EQ(h["way/1/way:2"].high, 5);
  EXPECT_EQ(h["way/1/relation:3"].low, 4);
  EXPECT_EQ(h["way/4"].high, 8);
  EXPECT_EQ(h["way/5"].high, 8) << "a part without an outline stays";
  EXPECT_EQ(m.surfaces[0].group, "BuildingPart");
  Scene scene;
  scene.surfaces = m.surfaces;
  EXPECT_EQ(whole_objects(scene).names, (std::vector<std::string>{"way/1", "way/4", "way/5"}));
  EXPECT_EQ(warning(m, "replaced by the parts").count, 1u);
  EXPECT_EQ(warning(m, "leave open").count, 0u);
  EXPECT_EQ(warning(m, "without a height").count, 0u) << "a replaced outline needs none";
}

TEST_F(FootprintLayer, PartsThatLeaveTheirOutlineOpenAreCounted) {
  const Model m = model(
      collection({feature(R"("building":"yes","height":9)", polygon(square(0, 0, 10)), "o"),
                  feature(R"("building:part":"yes","height":5)", polygon(square(0, 0, 5)), "p")}));
  EXPECT_EQ(heights(m).size(), 1u);
  const Warning w = warning(m, "leave open");
  EXPECT_EQ(w.count, 1u);
  EXPECT_TRUE(has(w.first, "25 %")) << w.first;
}

TEST_F(FootprintLayer, UnusablePartsLeaveTheOutline) {
  const Model m =
      model(collection({feature(R"("building":"yes","height":9)", polygon(square(0, 0, 10)), "o"),
                        feature(R"("building:part":"yes")", polygon(square(0, 0, 10)), "p")}));
  EXPECT_EQ(top(m), 9);
  EXPECT_EQ(warning(m, "without a height").count, 1u);
}

TEST_F(FootprintLayer, PartsStandWhereTheirBuildingStands) {
  const GroundAt slope = [](double x, double) { return std::optional((x - 1000) / 10); };
  const Model m =
      model(collection({feature(R"("building":"yes")", polygon(square(0, 0, 10)), "o"),
                        feature(R"("building:part":"yes","height":5)",
                                polygon(ring({{5, 0}, {10, 0}, {10, 10}, {5, 10}})), "p"),
                        feature(R"("building:part":"yes","height":5)",
                                polygon(ring({{0, 0}, {5, 0}, {5, 10}, {0, 10}})), "q")}),
            {}, slope);
  EXPECT_EQ(heights(m)["o/p"].low, 0);
  EXPECT_EQ(heights(m)["o/q"].low, 0);
}

TEST_F(FootprintLayer, WhatStartsAboveTheGroundIsNoFootprintOfTheMadeGround) {
  const auto half = [](double x) {
    return polygon(ring({{x, 0}, {x + 5, 0}, {x + 5, 10}, {x, 10}}));
  };
  const Model m = model(collection(
      {feature(R"("building":"yes")", polygon(square(0, 0, 10)), "way/1"),
       feature(R"("building:part":"yes","height":5)", half(0), "way/2"),
       feature(R"("building:part":"yes","height":30,"min_height":4)", half(5), "relation/3"),
       house(R"("height":8,"min_height":5)", 40, "bridge"), house(R"("height":8)", 60)}));
  Scene scene;
  scene.surfaces = m.surfaces;
  scene.mesh.positions = m.vertices;
  for (const ModelPolygon& p : m.polygons) {
    std::vector<std::vector<std::uint32_t>> rings;
    for (auto r = p.first_ring; r < p.last_ring; ++r) {
      rings.emplace_back(m.corners.begin() + m.ring_begin[r],
                         m.corners.begin() + m.ring_begin[r + 1]);
    }
    for (const Triangle& t : triangulate(m.vertices, rings).triangles) {
      scene.mesh.triangles.push_back(t);
      scene.surface_of.push_back(p.surface);
    }
  }
  const Footprints found = find_footprints(scene);
  EXPECT_TRUE(found.open.empty());
  ASSERT_EQ(found.closed.size(), 4u);  // of way/2 and the last house
  for (const auto& t : found.closed) EXPECT_EQ(t[0].z, 0);
}

TEST_F(FootprintLayer, ObjectsHaveNamesOfTheirOwn) {
  const Model m = model(collection(
      {house(R"("height":3,"name":"Shed")"), house(R"("height":3,"name":"Shed")", 20),
       house(R"("height":3,"osm_id":"77","name":"x")", 40), house(R"("height":3)", 60)}));
  const auto h = heights(m);
  std::set<std::string> names;
  for (const auto& [name, span] : h) names.insert(name);
  EXPECT_EQ(names, (std::set<std::string>{"Shed", "Shed (feature 2)", "77", "feature 4"}));
  EXPECT_EQ(warning(m, "name of another").count, 1u);
}

TEST_F(FootprintLayer, RoofShapesThatAreNotBuiltAreCounted) {
  const Model m = model(collection({house(R"("height":3,"roof:shape":"gabled")"),
                                    house(R"("height":3,"roof:shape":"flat")", 20)}));
  EXPECT_EQ(warning(m, "roof:shape").count, 1u);
}

}  // namespace
}  // namespace gnomon
