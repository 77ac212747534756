#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored \
    "-Wrestrict"  // GCC 12 warns of "text" + std::string (its bug 105651)
#endif

#include <gnomon/io/footprint_layer.h>

#include <gdal.h>
#include <gtest/gtest.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include <glm/geometric.hpp>

#include <gnomon/io/crs.h>
#include <gnomon/io/footprint_file.h>
#include <gnomon/io/footprints.h>
#include <gnomon/io/osm_tags.h>
#include <gnomon/io/triangulate.h>

#include "io/write_test_files.h"

namespace gnomon {
namespace {

using gnomon::testing::TestFolder;

const std::string kMetres =
    R"("crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::31256"}},)";

// A ring as GeoJSON, closed, of points in EPSG:31256 relative to (1000, 340000), in Vienna.
std::string ring(const std::vector<Vec2>& points) {
  std::string out = "[";
  for (std::size_t k = 0; k <= points.size(); ++k) {
    const Vec2& p = points[k % points.size()];
    out += (k ? ",[" : "[") + std::to_string(1000 + p.x) + "," + std::to_string(340000 + p.y) + "]";
  }
  return out + "]";
}

std::string square(double x, double y, double side) {
  return ring({{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}});
}

std::string feature(const std::string& properties, const std::string& geometry,
                    const std::string& id = "") {
  return R"({"type":"Feature",)" + (id.empty() ? "" : R"("id":")" + id + R"(",)") +
         R"("properties":{)" + properties + R"(},"geometry":)" + geometry + "}";
}

std::string polygon(const std::string& rings) {
  return R"({"type":"Polygon","coordinates":[)" + rings + "]}";
}

// A square building of 10 m; `x` where it stands.
std::string house(const std::string& properties, double x = 0, const std::string& id = "") {
  return feature(properties, polygon(square(x, 0, 10)), id);
}

std::string collection(const std::vector<std::string>& features) {
  std::string out = R"({"type":"FeatureCollection",)" + kMetres + R"("features":[)";
  for (std::size_t k = 0; k < features.size(); ++k) out += (k ? "," : "") + features[k];
  return out + "]}";
}

class FootprintLayer : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  Result<Model> read(const std::string& text, const FootprintOptions& options = {},
                     const GroundAt& ground = {}) const {
    return read_footprints(write("town.geojson", text), options, "", "", ground);
  }
  Model model(const std::string& text, const FootprintOptions& options = {},
              const GroundAt& ground = {}) const {
    auto m = read(text, options, ground);
    EXPECT_TRUE(m) << (m ? "" : m.error().message);
    return m ? std::move(m).value() : Model{};
  }
  std::string refusal(const std::string& text, const FootprintOptions& options = {}) const {
    const auto m = read(text, options);
    EXPECT_FALSE(m);
    return m ? "" : m.error().message;
  }
  TestFolder folder_;
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// The warning whose sentence has `part`; count 0 if there is none.
Warning warning(const Model& m, const std::string& part) {
  for (const Warning& w : m.warnings) {
    if (has(w.what, part)) return w;
  }
  return {};
}

struct Span {
  double low = INFINITY, high = -INFINITY;
};
std::map<std::string, Span> heights(const Model& m) {
  std::map<std::string, Span> out;
  for (const ModelPolygon& p : m.polygons) {
    Span& s = out[m.surfaces[p.surface].object];
    for (auto c = m.ring_begin[p.first_ring]; c < m.ring_begin[p.last_ring]; ++c) {
      const double z = m.vertices[m.corners[c]].z;
      s = {std::min(s.low, z), std::max(s.high, z)};
    }
  }
  return out;
}

// Top of the only building.
double top(const Model& m) {
  const auto h = heights(m);
  return h.size() == 1 ? h.begin()->second.high : NAN;
}

// Each edge of the polygons runs as often one way as the other: closed, and wound alike.
bool watertight(const Model& m) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (std::size_t r = 0; r + 1 < m.ring_begin.size(); ++r) {
    const auto begin = m.ring_begin[r], n = m.ring_begin[r + 1] - begin;
    for (std::uint32_t k = 0; k < n; ++k) {
      const auto a = m.corners[begin + k], b = m.corners[begin + (k + 1) % n];
      if (a < b) ++balance[{a, b}];
      if (b < a) --balance[{b, a}];
    }
  }
  return !m.polygons.empty() &&
         std::all_of(balance.begin(), balance.end(), [](const auto& e) { return e.second == 0; });
}

// By the divergence theorem over the rings' fans, positive if they are wound outwards.
double volume(const Model& m) {
  double six = 0;
  const Vec3 o = m.vertices[0];
  for (std::size_t r = 0; r + 1 < m.ring_begin.size(); ++r) {
    for (auto c = m.ring_begin[r] + 1; c + 1 < m.ring_begin[r + 1]; ++c) {
      const Vec3 a = m.vertices[m.corners[m.ring_begin[r]]] - o;
      const Vec3 b = m.vertices[m.corners[c]] - o, d = m.vertices[m.corners[c + 1]] - o;
      six += glm::dot(a, glm::cross(b, d));
    }
  }
  return six / 6;
}

std::size_t count(const Model& m, const std::string& semantic) {
  return static_cast<std::size_t>(std::count_if(
      m.polygons.begin(), m.polygons.end(),
      [&](const ModelPolygon& p) { return m.surfaces[p.surface].semantic == semantic; }));
}

// ---- solids --------------------------------------------------------------------------------

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

// ---- heights -------------------------------------------------------------------------------

TEST(OsmTags, LengthsAreReadWithTheirUnits) {
  EXPECT_EQ(parse_metres("12"), 12);
  EXPECT_EQ(parse_metres(" 12 m "), 12);
  EXPECT_EQ(parse_metres("12.5m"), 12.5);
  EXPECT_EQ(parse_metres("12,5"), 12.5);
  EXPECT_EQ(parse_metres("+3 metres"), 3);
  EXPECT_DOUBLE_EQ(*parse_metres("40 ft"), 40 * 0.3048);
  EXPECT_DOUBLE_EQ(*parse_metres("40'"), 40 * 0.3048);
  EXPECT_DOUBLE_EQ(*parse_metres("12'6\""), 12.5 * 0.3048);
  EXPECT_DOUBLE_EQ(*parse_metres("12 ft 6 in"), 12.5 * 0.3048);
  EXPECT_EQ(parse_number("1e-3"), 1e-3);
  for (const char* bad : {"", "tall", "~12", "10-12", "12;15", "1,200", "12 km", "nan", "inf", "m",
                          "12 m x", "1e999", "--3", "12'6"}) {
    EXPECT_FALSE(parse_metres(bad)) << bad;
  }
}

TEST(OsmTags, PackedTagsAreTakenApart) {
  const auto hstore = parse_tags(R"("height"=>"12 m", "name"=>"The \"Inn\"","x"=>NULL)");
  ASSERT_TRUE(hstore);
  EXPECT_EQ(*hstore, (Tags{{"height", "12 m"}, {"name", "The \"Inn\""}}));
  const auto json = parse_tags(R"({"height":12.5,"levels":"3","x":null})");
  ASSERT_TRUE(json);
  EXPECT_EQ(*json, (Tags{{"height", "12.5"}, {"levels", "3"}}));
  EXPECT_FALSE(parse_tags("a,b"));
  EXPECT_FALSE(parse_tags(R"("height"=>"12)"));
  EXPECT_FALSE(parse_tags(R"({"height":)"));
}

TEST_F(FootprintLayer, HeightsComeFromTheUsualAttributesInAnyCase) {
  const std::pair<const char*, double> cases[] = {
      {R"("height":"12 m")", 12},
      {R"("HEIGHT":12.25)", 12.25},
      {R"("building:height":"40'")", 40 * 0.3048},
      {R"("measuredHeight":7)", 7},
      {R"("bouwhoogte":8)", 8},
      {R"("building:levels":"4")", 12},
      {R"("num_floors":4)", 12},
      {R"("height":null,"building:levels":2)", 6},
      {R"("height":20,"building:levels":2)", 20},
      {R"("building:levels":2,"roof:levels":1)", 9},
      {R"("building:levels":2,"roof:levels":1,"roof:height":"2.5")", 8.5},
      {R"("tags":{"height":"9"})", 9},
      {R"("other_tags":"\"building\"=>\"yes\",\"height\"=>\"9.5\"")", 9.5}};
  for (const auto& [properties, expected] : cases) {
    EXPECT_DOUBLE_EQ(top(model(collection({house(properties)}))), expected) << properties;
  }
}

TEST_F(FootprintLayer, NamedAttributesAreTakenInsteadOfTheUsualOnes) {
  FootprintOptions options;
  options.height = "Eaves";
  options.floors = "n";
  options.floor_height = 4;
  EXPECT_EQ(top(model(collection({house(R"("height":99,"eaves":5,"n":1)")}), options)), 5);
  EXPECT_EQ(top(model(collection({house(R"("height":99,"eaves":null,"n":2)")}), options)), 8);
  const std::string why = refusal(collection({house(R"("height":99,"n":1)")}), options);
  EXPECT_TRUE(has(why, "no attribute \"Eaves\"; it has height, n")) << why;
  options = {};
  options.floor_height = 0;
  EXPECT_TRUE(has(refusal(collection({house(R"("height":9)")}), options), "storey"));
}

TEST_F(FootprintLayer, MinHeightRaisesTheFloor) {
  const Model m =
      model(collection({house(R"("height":10,"min_height":4)", 0, "a"),
                        house(R"("building:levels":5,"building:min_level":2)", 20, "b")}));
  auto h = heights(m);
  EXPECT_EQ(h["a"].low, 4);
  EXPECT_EQ(h["a"].high, 10);
  EXPECT_EQ(h["b"].low, 6);
  EXPECT_EQ(h["b"].high, 15);
  EXPECT_TRUE(watertight(m));
  // The made ground must not rise to them.
  EXPECT_EQ(count(m, "GroundSurface"), 0u);
  EXPECT_EQ(count(m, "OuterCeilingSurface"), 2u);
  EXPECT_EQ(m.surfaces[0].group, "BuildingInstallation");
}

TEST_F(FootprintLayer, UnusableHeightsAreLeftOutAndTheFirstIsNamed) {
  const Model m = model(
      collection({house(R"("height":"3")"), house(R"("height":"0")", 20, "way/7"),
                  house(R"("height":"-4")", 40), house(R"("height":"tall")", 60),
                  house(R"("height":"NaN")", 80), house(R"("height":"4","min_height":"4")", 100),
                  house(R"("height":"4","min_height":"?")", 120)}));
  EXPECT_EQ(m.report.objects, 1u);
  const Warning w = warning(m, "cannot be used");
  EXPECT_EQ(w.count, 6u);
  EXPECT_TRUE(has(w.first, "town.geojson: feature 2 (id way/7): height is \"0\"")) << w.first;
  const std::string why = refusal(collection({house(R"("height":"tall")")}));
  EXPECT_TRUE(has(why, "height is \"tall\"")) << why;
}

TEST_F(FootprintLayer, FeaturesWithoutHeightAreCountedAndAFileOfThemIsRefused) {
  const Model m =
      model(collection({house(R"("height":3)"), house(R"("use":"x")", 20, "q"), house("", 40)}));
  const Warning w = warning(m, "without a height");
  EXPECT_EQ(w.count, 2u);
  EXPECT_TRUE(has(w.first, "feature 2 (id q)")) << w.first;
  EXPECT_TRUE(has(w.what, "height, building:height") && has(w.what, "building:levels") &&
              w.what.size() < 250)
      << w.what;
  const std::string why = refusal(collection({house(R"("use":"x","stock":2)")}));
  EXPECT_TRUE(has(why, "none of its 1 footprints has a height")) << why;
  EXPECT_TRUE(has(why, "its attributes: use, stock")) << why;
}

// ---- bases ---------------------------------------------------------------------------------

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

// ---- what is a building --------------------------------------------------------------------

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

// ---- coordinates ---------------------------------------------------------------------------

const std::string kDegrees =
    R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"height":9},)"
    R"("geometry":{"type":"Polygon","coordinates":[[[16.37,48.2],[16.371,48.2],[16.371,48.201],)"
    R"([16.37,48.201],[16.37,48.2]]]}}]})";

TEST_F(FootprintLayer, GeoJsonWithoutCrsIsLongitudeAndLatitudeAndGoesToItsUtmZone) {
  const Model m = model(kDegrees);
  EXPECT_EQ(m.report.crs, "EPSG:32633");
  const Vec2 corner = reproject("EPSG:4326", "EPSG:32633", {{16.37, 48.2}}).value()[0];
  EXPECT_EQ(m.vertices[0].x, corner.x);
  EXPECT_EQ(m.vertices[0].y, corner.y);
  EXPECT_NEAR(volume(m), 74.3 * 111.2 * 9, 0.01 * 74.3 * 111.2 * 9);
}

TEST_F(FootprintLayer, CoordinatesGoToTheScenesCrsAndTheGroundIsAskedThere) {
  const Vec2 corner = reproject("EPSG:4326", "EPSG:31256", {{16.37, 48.2}}).value()[0];
  double asked = INFINITY;
  const GroundAt ground = [&](double x, double) {
    asked = std::min(asked, std::fabs(x - corner.x));
    return std::optional(1.0);
  };
  const auto m = read_footprints(write("a.geojson", kDegrees), {}, "EPSG:31256", "", ground);
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_EQ(m.value().report.crs, "EPSG:31256");
  EXPECT_EQ(m.value().vertices[0].x, corner.x);
  EXPECT_EQ(asked, 0);
}

TEST_F(FootprintLayer, MetresWithoutTheirCrsMemberTakeTheCrsGivenOrAreRefused) {
  std::string text = collection({house(R"("height":3)")});
  text.erase(text.find(kMetres), kMetres.size());
  EXPECT_TRUE(has(refusal(text), "no longitude and latitude")) << refusal(text);
  const auto m = read_footprints(write("a.geojson", text), {}, "", "EPSG:31256", {});
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_EQ(m.value().report.crs, "EPSG:31256");
  EXPECT_EQ(m.value().vertices[0].x, 1000);
  EXPECT_EQ(warning(m.value(), "no degrees").count, 1u);
}

TEST_F(FootprintLayer, WebMercatorIsNotTrueToScaleSoUtmIsTaken) {
  std::string text = kDegrees;
  const auto p = reproject("EPSG:4326", "EPSG:3857",
                           {{16.37, 48.2}, {16.371, 48.2}, {16.371, 48.201}, {16.37, 48.201}})
                     .value();
  std::string r;
  for (const Vec2& q : p) {
    r += (r.empty() ? "[" : ",[") + std::to_string(q.x) + "," + std::to_string(q.y) + "]";
  }
  const Model m = model(R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":)"
                        R"("urn:ogc:def:crs:EPSG::3857"}},"features":[)" +
                        feature(R"("height":9)", polygon("[" + r + "]")) + "]}");
  EXPECT_EQ(m.report.crs, "EPSG:32633");
  EXPECT_NEAR(volume(m), volume(model(text)), 0.1);
  EXPECT_EQ(warning(m, "true to scale").count, 1u);
}

// ---- files ---------------------------------------------------------------------------------

struct Made {
  std::string layer;
  int epsg;  // 0: none
  std::string wkt;
};

// A file of OGR's making with one feature of height 6 in each layer.
void make(const std::filesystem::path& path, const std::string& driver,
          const std::vector<Made>& layers) {
  RegisterOGRShape();
  RegisterOGRGeoPackage();
  RegisterOGRFlatGeobuf();
  RegisterOGRGML();
  RegisterOGRLIBKML();
  const GDALDatasetH dataset =
      GDALCreate(GDALGetDriverByName(driver.c_str()), path.c_str(), 0, 0, 0, GDT_Unknown, nullptr);
  ASSERT_NE(dataset, nullptr);
  for (const Made& made : layers) {
    OGRSpatialReferenceH srs = nullptr;
    if (made.epsg) {
      srs = OSRNewSpatialReference(nullptr);
      OSRImportFromEPSG(srs, made.epsg);
      OSRSetAxisMappingStrategy(srs, OAMS_TRADITIONAL_GIS_ORDER);
    }
    OGRGeometryH geometry = nullptr;
    std::string wkt = made.wkt;
    char* text = wkt.data();
    ASSERT_EQ(OGR_G_CreateFromWkt(&text, srs, &geometry), OGRERR_NONE);
    const OGRLayerH layer = GDALDatasetCreateLayer(dataset, made.layer.c_str(), srs,
                                                   OGR_G_GetGeometryType(geometry), nullptr);
    ASSERT_NE(layer, nullptr);
    const OGRFieldDefnH field = OGR_Fld_Create("height", OFTReal);
    OGR_L_CreateField(layer, field, 1);
    OGR_Fld_Destroy(field);
    const OGRFeatureH f = OGR_F_Create(OGR_L_GetLayerDefn(layer));
    OGR_F_SetFieldDouble(f, OGR_F_GetFieldIndex(f, "height"), 6);
    OGR_F_SetGeometryDirectly(f, geometry);
    ASSERT_EQ(OGR_L_CreateFeature(layer, f), OGRERR_NONE);
    OGR_F_Destroy(f);
    if (srs) OSRRelease(srs);
  }
  GDALClose(dataset);
}

const std::string kHouse =
    "POLYGON ((1000 340000,1010 340000,1010 340010,1000 340010,1000 340000))";

std::string first_bytes(const std::filesystem::path& path) {
  return gnomon::testing::content(path).substr(0, 4096);
}

TEST_F(FootprintLayer, EveryFormatGivesTheSameSolid) {
  const struct {
    const char *name, *driver, *format;
  } cases[] = {{"a.gpkg", "GPKG", "GeoPackage footprints"},
               {"a.shp", "ESRI Shapefile", "Shapefile footprints"},
               {"a.fgb", "FlatGeobuf", "FlatGeobuf footprints"},
               {"a.gml", "GML", "GML footprints"}};
  for (const auto& c : cases) {
    make(folder_ / c.name, c.driver, {{"a", 31256, kHouse}});
    EXPECT_TRUE(is_footprint_file(folder_ / c.name, first_bytes(folder_ / c.name))) << c.name;
    const auto m = read_footprints(folder_ / c.name, {}, "", "", {});
    ASSERT_TRUE(m) << m.error().message;
    EXPECT_EQ(m.value().report.format, c.format);
    EXPECT_EQ(m.value().report.crs, "EPSG:31256") << c.name;
    EXPECT_NEAR(volume(m.value()), 600, 1e-6) << c.name;
    EXPECT_EQ(m.value().vertices[0].x, 1000) << c.name << ": the axes are east, north";
  }
}

TEST_F(FootprintLayer, KmlIsReadToo) {
  make(folder_ / "a.kml", "LIBKML",
       {{"a", 4326, "POLYGON ((16.37 48.2,16.371 48.2,16.371 48.201,16.37 48.201,16.37 48.2))"}});
  EXPECT_TRUE(is_footprint_file(folder_ / "a.kml", first_bytes(folder_ / "a.kml")));
  const auto m = read_footprints(folder_ / "a.kml", {}, "", "", {});
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_EQ(m.value().report.crs, "EPSG:32633");
  EXPECT_EQ(m.value().report.format, "KML footprints");
}

TEST_F(FootprintLayer, ReadingLeavesTheFolderAsItWas) {
  for (const auto& [name, driver] :
       {std::pair("a.gml", "GML"), {"a.gpkg", "GPKG"}, {"a.shp", "ESRI Shapefile"}}) {
    make(folder_ / name, driver, {{"a", 31256, kHouse}});
  }
  std::filesystem::remove(folder_ / "a.xsd");  // without it GDAL would like to write a .gfs
  auto before = folder_.names();
  for (const char* name : {"a.gml", "a.gpkg", "a.shp"}) {
    EXPECT_TRUE(read_footprints(folder_ / name, {}, "", "", {})) << name;
  }
  auto after = folder_.names();
  std::sort(before.begin(), before.end());
  std::sort(after.begin(), after.end());
  EXPECT_EQ(before, after);
}

TEST_F(FootprintLayer, CurvedPolygonsBecomeStraightOnes) {
  make(folder_ / "a.gpkg", "GPKG",
       {{"a", 31256,
         "CURVEPOLYGON (CIRCULARSTRING (1000 340000,1010 340010,1020 340000,1010 339990,1000 "
         "340000))"}});
  const auto m = read_footprints(folder_ / "a.gpkg", {}, "", "", {});
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_TRUE(watertight(m.value()));
  // A regular polygon of 90 sides (4 degrees each) in a circle of 10 m.
  EXPECT_NEAR(volume(m.value()), 6 * 0.5 * 90 * 100 * std::sin(4 * kDegree), 0.01);
}

TEST_F(FootprintLayer, TheCrsThatAFileNamesIsToldWithoutReadingIt) {
  EXPECT_EQ(crs_of_footprint_file(write("m.geojson", collection({house("")})), "").value(),
            "EPSG:31256");
  EXPECT_EQ(crs_of_footprint_file(write("d.geojson", kDegrees), "").value(), "EPSG:4326");
  make(folder_ / "n.shp", "ESRI Shapefile", {{"n", 0, kHouse}});
  EXPECT_EQ(crs_of_footprint_file(folder_ / "n.shp", "").value(), "");
  make(folder_ / "a.gpkg", "GPKG", {{"houses", 31256, kHouse}, {"lots", 25832, kHouse}});
  EXPECT_EQ(crs_of_footprint_file(folder_ / "a.gpkg", "lots").value(), "EPSG:25832");
  EXPECT_FALSE(crs_of_footprint_file(folder_ / "a.gpkg", ""));
  EXPECT_FALSE(crs_of_footprint_file(folder_ / "none.gpkg", ""));
}

TEST_F(FootprintLayer, SeveralPolygonLayersAreListedAndOneIsChosenByName) {
  make(folder_ / "a.gpkg", "GPKG",
       {{"houses", 31256, kHouse},
        {"lots", 31256, kHouse},
        {"roads", 31256, "LINESTRING (0 0,1 1)"}});
  const auto m = read_footprints(folder_ / "a.gpkg", {}, "", "", {});
  ASSERT_FALSE(m);
  EXPECT_TRUE(has(m.error().message, "houses, lots; name")) << m.error().message;
  FootprintOptions options;
  options.layer = "houses";
  EXPECT_TRUE(read_footprints(folder_ / "a.gpkg", options, "", "", {}));
  options.layer = "barns";
  const auto wrong = read_footprints(folder_ / "a.gpkg", options, "", "", {});
  ASSERT_FALSE(wrong);
  EXPECT_TRUE(has(wrong.error().message, "no layer \"barns\"; it has houses, lots, roads"))
      << wrong.error().message;
  make(folder_ / "b.gpkg", "GPKG", {{"roads", 31256, "LINESTRING (0 0,1 1)"}});
  const auto lines = read_footprints(folder_ / "b.gpkg", {}, "", "", {});
  ASSERT_FALSE(lines);
  EXPECT_TRUE(has(lines.error().message, "no layer with polygons (its layers: roads)"))
      << lines.error().message;
}

TEST_F(FootprintLayer, ShapefilesWithoutPrjAreLocalMetresUnlessTheyLookLikeDegrees) {
  make(folder_ / "m.shp", "ESRI Shapefile", {{"m", 0, "POLYGON ((0 0,0 9,9 9,9 0,0 0))"}});
  const auto local = read_footprints(folder_ / "m.shp", {}, "", "", {});
  ASSERT_TRUE(local) << local.error().message;
  EXPECT_EQ(local.value().report.crs, "");
  EXPECT_NEAR(volume(local.value()), 9 * 9 * 6, 1e-9);
  make(folder_ / "d.shp", "ESRI Shapefile",
       {{"d", 0, "POLYGON ((16.37 48.2,16.37 48.201,16.371 48.2,16.37 48.2))"}});
  const auto degrees = read_footprints(folder_ / "d.shp", {}, "", "", {});
  ASSERT_FALSE(degrees);
  EXPECT_TRUE(has(degrees.error().message, "look like degrees")) << degrees.error().message;
  const auto told = read_footprints(folder_ / "d.shp", {}, "", "EPSG:4326", {});
  ASSERT_TRUE(told) << told.error().message;
  EXPECT_EQ(told.value().report.crs, "EPSG:32633");
}

TEST_F(FootprintLayer, DamagedFilesAreRefusedByNameAndNothingIsPrinted) {
  ::testing::internal::CaptureStderr();
  const auto expect = [&](const std::string& name, const std::string& part) {
    const auto m = read_footprints(folder_ / name, {}, "", "", {});
    ASSERT_FALSE(m) << name;
    EXPECT_TRUE(has(m.error().message, name) && has(m.error().message, part)) << m.error().message;
  };
  expect("missing.geojson", "no such file");
  write("bad.geojson", R"({"type":"FeatureCollection","features":[{"type":"Feature")");
  expect("bad.geojson", "check that the file is whole");
  write("noise.gpkg", "this is no database");
  expect("noise.gpkg", "check that the file is whole");
  write("empty.geojson", R"({"type":"FeatureCollection","features":[]})");
  expect("empty.geojson", "no features");

  make(folder_ / "a.shp", "ESRI Shapefile", {{"a", 31256, kHouse}});
  std::filesystem::remove(folder_ / "a.shx");
  expect("a.shp", ".shx");

  make(folder_ / "b.gpkg", "GPKG", {{"b", 31256, kHouse}});
  std::filesystem::resize_file(folder_ / "b.gpkg", 60000);
  expect("b.gpkg", "check that the file is whole");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(FootprintLayer, NamesThatMeanAddressesToGdalAreNotOpened) {
  for (const char* name : {"/vsicurl/http://127.0.0.1:9/a.geojson", "http://127.0.0.1:9/a.geojson",
                           "WFS:http://127.0.0.1:9/"}) {
    const auto m = read_footprints(name, {}, "", "", {});
    ASSERT_FALSE(m);
    EXPECT_TRUE(has(m.error().message, "no such file")) << m.error().message;
  }
  write("a.vrt", R"(<OGRVRTDataSource><OGRVRTLayer name="a"><SrcDataSource>/vsicurl/http://)"
                 R"(127.0.0.1:9/a.geojson</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>)");
  const auto m = read_footprints(folder_ / "a.vrt", {}, "", "", {});
  ASSERT_FALSE(m);
  EXPECT_TRUE(has(m.error().message, "cannot be read as GeoJSON")) << m.error().message;
}

TEST(FootprintFormat, FilesAreKnownByTheirContent) {
  EXPECT_TRUE(is_footprint_file("a.json", R"({ "type" : "FeatureCollection", "features": [)"));
  EXPECT_TRUE(is_footprint_file("a.json", R"({"features":[{"type":"Feature","geometry":)"));
  EXPECT_TRUE(is_footprint_file("a.json", R"({"type":"Polygon","coordinates":[)"));
  EXPECT_TRUE(is_footprint_file("a.geojson", ""));
  EXPECT_TRUE(is_footprint_file("A.GPKG", ""));
  EXPECT_TRUE(is_footprint_file("a.kmz", "PK\x03\x04"));
  EXPECT_FALSE(is_footprint_file("a.json", R"({"type":"CityJSON","version":"2.0"})"));
  EXPECT_FALSE(is_footprint_file("a.geojson", R"({"type":"CityJSON","version":"2.0"})"));
  EXPECT_FALSE(is_footprint_file("a.jsonl", "{\"type\":\"CityJSONFeature\",\"id\":\"a\"}\n"));
  EXPECT_FALSE(is_footprint_file("a.obj", "v 0 0 0\n"));
  EXPECT_FALSE(is_footprint_file("a.gml",
                                 "<core:CityModel xmlns:core=\"http://www.opengis.net/citygml/2.0\""
                                 " xmlns:gml=\"http://www.opengis.net/gml\">"));
  EXPECT_FALSE(is_footprint_file("a.dae", "<?xml version=\"1.0\"?><COLLADA>"));
}

}  // namespace
}  // namespace gnomon
