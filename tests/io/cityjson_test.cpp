#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 warns of "text" + std::string (its bug 105651).
#pragma GCC diagnostic ignored "-Wrestrict"
#endif

#include <gnomon/io/cityjson.h>
#include <gnomon/scene/objects.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace gnomon {
namespace {

// A unit cube's vertices (0 .. 7: z = 0 counter-clockwise, then z = 1), and a square inside its
// floor (8 .. 11).
constexpr const char* kVertices =
    "[[0,0,0],[10,0,0],[10,10,0],[0,10,0],[0,0,10],[10,0,10],[10,10,10],[0,10,10],"
    "[2,2,0],[4,2,0],[4,4,0],[2,4,0]]";
constexpr const char* kShell =
    "[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]";

std::string document(const std::string& objects, const std::string& more = "",
                     const std::string& version = "2.0", const std::string& vertices = kVertices) {
  return R"({"type":"CityJSON","version":")" + version +
         R"(","transform":{"scale":[0.1,0.1,0.1],"translate":[1000,2000,30]},"CityObjects":{)" +
         objects + R"(},"vertices":)" + vertices + more + "}";
}

std::string building(const std::string& geometries, const std::string& more = "") {
  return R"("B":{"type":"Building","geometry":[)" + geometries + "]" + more + "}";
}

std::string geometry(const std::string& type, const std::string& boundaries,
                     const std::string& more = R"(,"lod":"2")") {
  return R"({"type":")" + type + R"(","boundaries":)" + boundaries + more + "}";
}

Model read(const std::string& text, const std::string& lod = "") {
  auto model = read_cityjson(text, "t.json", lod);
  if (!model) {
    ADD_FAILURE() << model.error().message;
    return {};
  }
  return std::move(model).value();
}

// The message of the failure, or empty.
std::string failure(const std::string& text) {
  const auto model = read_cityjson(text, "t.json", "");
  return model ? "" : model.error().message;
}

void expect_failure(const std::string& text, const std::vector<std::string>& parts) {
  const std::string message = failure(text);
  EXPECT_TRUE(message.starts_with("t.json: ")) << message;
  for (const std::string& part : parts) {
    EXPECT_NE(message.find(part), std::string::npos) << part << " is not in: " << message;
  }
}

std::vector<std::string> semantics(const Model& m) {
  std::vector<std::string> names;
  for (const ModelPolygon& p : m.polygons) names.push_back(m.surfaces[p.surface].semantic);
  return names;
}

std::vector<std::string> objects(const Model& m) {
  std::vector<std::string> names;
  for (const ModelPolygon& p : m.polygons) names.push_back(m.surfaces[p.surface].object);
  return names;
}

bool warns(const Model& m, const std::string& what, std::size_t count) {
  return std::any_of(m.warnings.begin(), m.warnings.end(), [&](const Warning& w) {
    return w.what.find(what) != std::string::npos && w.count == count;
  });
}

std::vector<Vec3> corners_of(const Model& m, const ModelPolygon& p) {
  std::vector<Vec3> corners;
  for (std::uint32_t c = m.ring_begin[p.first_ring]; c < m.ring_begin[p.first_ring + 1]; ++c) {
    corners.push_back(m.vertices[m.corners[c]] * m.scale + m.translate);
  }
  return corners;
}

TEST(CityJson, EveryGeometryTypeOfSurfacesIsRead) {
  const std::string shell = kShell;
  const std::string far = "[[[4,5,6]],[[5,6,7]]]";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"MultiSurface", shell},
      {"CompositeSurface", shell},
      {"Solid", "[" + shell + "]"},
      {"MultiSolid", "[[" + shell + "],[" + far + "]]"},
      {"CompositeSolid", "[[" + shell + "],[" + far + "]]"}};
  for (const auto& [type, boundaries] : cases) {
    const Model m = read(document(building(geometry(type, boundaries))));
    const std::size_t expected = type.ends_with("iSolid") || type == "CompositeSolid" ? 8 : 6;
    EXPECT_EQ(m.polygons.size(), expected) << type;
    EXPECT_EQ(m.report.surfaces, expected);
    EXPECT_EQ(m.report.objects, 1u);
    EXPECT_TRUE(m.warnings.empty()) << type << ": " << m.warnings[0].what;
    EXPECT_EQ(m.vertices.size(), 8u) << "vertices that no polygon uses stay out";
  }
}

TEST(CityJson, TheTransformGivesMetresInTheCrs) {
  const Model m = read(document(building(geometry("MultiSurface", "[[[1,2,6]]]"))));
  const auto corners = corners_of(m, m.polygons[0]);
  EXPECT_EQ(corners[0], Vec3(1001, 2000, 30));
  EXPECT_EQ(corners[2], Vec3(1001, 2001, 31));
}

TEST(CityJson, Version10WithoutTransformTakesVerticesAsTheyAre) {
  const Model m = read(R"({"type":"CityJSON","version":"1.0","CityObjects":{)" +
                       building(geometry("MultiSurface", "[[[0,1,2]]]", R"(,"lod":1)")) +
                       R"(},"vertices":[[0.5,0,0],[1.25,0,0],[0,1,7]]})");
  EXPECT_EQ(m.report.format, "CityJSON 1.0");
  EXPECT_EQ(corners_of(m, m.polygons[0])[1], Vec3(1.25, 0, 0));
  EXPECT_TRUE(m.warnings.empty());
}

TEST(CityJson, AMissingTransformInLaterVersionsIsAWarning) {
  const Model m = read(R"({"type":"CityJSON","version":"1.1","CityObjects":{},"vertices":[]})");
  EXPECT_TRUE(warns(m, "no transform", 1));
}

TEST(CityJson, HolesAreRingsOfTheirPolygon) {
  const Model m = read(document(building(geometry("MultiSurface", "[[[0,1,2,3],[8,11,10,9]]]"))));
  ASSERT_EQ(m.polygons.size(), 1u);
  EXPECT_EQ(m.polygons[0].last_ring - m.polygons[0].first_ring, 2u);
  EXPECT_EQ(m.corners.size(), 8u);
}

TEST(CityJson, TheCrsIsShort) {
  for (const char* crs :
       {"https://www.opengis.net/def/crs/EPSG/0/7415", "urn:ogc:def:crs:EPSG::7415"}) {
    const std::string metadata = std::string(R"(,"metadata":{"referenceSystem":")") + crs + "\"}";
    EXPECT_EQ(read(document("", metadata)).report.crs, "EPSG:7415");
  }
}

TEST(CityJson, SemanticsFollowTheNestingOfEachType) {
  const std::string surfaces =
      R"("surfaces":[{"type":"RoofSurface"},{"type":"WallSurface"},{"type":"+Solar"}])";
  const auto with = [&](const std::string& values) {
    return R"(,"lod":"2","semantics":{)" + surfaces + R"(,"values":)" + values + "}";
  };
  const std::string two = "[[[0,1,2]],[[0,2,3]]]", other = "[[[4,5,6]],[[4,6,7]]]";
  using Names = std::vector<std::string>;
  EXPECT_EQ(semantics(read(document(building(geometry("MultiSurface", two, with("[1,2]")))))),
            (Names{"WallSurface", "+Solar"}));
  EXPECT_EQ(
      semantics(read(document(building(geometry("CompositeSurface", two, with("[null,0]")))))),
      (Names{"", "RoofSurface"}));
  EXPECT_EQ(semantics(read(document(
                building(geometry("Solid", "[" + two + "," + other + "]", with("[[0,1],null]")))))),
            (Names{"RoofSurface", "WallSurface", "", ""}));
  EXPECT_EQ(semantics(read(document(building(geometry(
                "MultiSolid", "[[" + two + "],[" + other + "]]", with("[[[0,1]],[[2,null]]]")))))),
            (Names{"RoofSurface", "WallSurface", "+Solar", ""}));
  EXPECT_EQ(semantics(read(
                document(building(geometry("CompositeSolid", "[[" + two + "]]", with("null")))))),
            (Names{"", ""}));
}

TEST(CityJson, SemanticsThatDoNotFitAreAWarningNotAnError) {
  const Model m = read(document(
      building(geometry("MultiSurface", "[[[0,1,2]],[[0,2,3]]]",
                        R"(,"semantics":{"surfaces":[{"type":"RoofSurface"}],"values":[0,7]})"))));
  EXPECT_EQ(semantics(m), (std::vector<std::string>{"RoofSurface", ""}));
  EXPECT_TRUE(warns(m, "Semantic surfaces that do not fit", 1));
}

TEST(CityJson, MaterialsAreNamedByTheAppearance) {
  const std::string appearance =
      R"(,"appearance":{"materials":[{"name":"brick"},{"name":"glass"}]})";
  const auto names = [&](const std::string& material) {
    const Model m = read(document(
        building(geometry("MultiSurface", "[[[0,1,2]],[[0,2,3]]]", ",\"material\":" + material)),
        appearance));
    std::vector<std::string> list;
    for (const ModelPolygon& p : m.polygons) list.push_back(m.surfaces[p.surface].material);
    return list;
  };
  EXPECT_EQ(names(R"({"t":{"value":1}})"), (std::vector<std::string>{"glass", "glass"}));
  EXPECT_EQ(names(R"({"t":{"values":[0,null]}})"), (std::vector<std::string>{"brick", ""}));
}

TEST(CityJson, PartsAreNamedAfterTheirParents) {
  const std::string g = R"("geometry":[)" + geometry("MultiSurface", "[[[0,1,2]]]") + "]";
  const Model m = read(document(R"("G":{"type":"CityObjectGroup","children":["B"]},)"
                                R"("B":{"type":"Building","parents":["G"],"children":["P"]},)"
                                R"("P":{"type":"BuildingPart","parents":["B"],)" +
                                g +
                                R"(},)"
                                R"("I":{"type":"BuildingInstallation","parents":["P"],)" +
                                g + "}"));
  EXPECT_EQ(objects(m), (std::vector<std::string>{"B/P/I", "B/P"}));
  EXPECT_EQ(m.surfaces[m.polygons[0].surface].group, "BuildingInstallation");
}

TEST(CityJson, PartsBelongToTheirWholeWhateverItsId) {
  const std::string g = R"("geometry":[)" + geometry("MultiSurface", "[[[0,1,2]]]") + "]";
  const Model m = read(document(R"("https://x/b/1":{"type":"Building"},"https://x/b/1-p":)"
                                R"({"type":"BuildingPart","parents":["https://x/b/1"],)" +
                                g + R"(},"https://x/b/2":{"type":"Building",)" + g + "}"));
  Scene scene;
  scene.surfaces = m.surfaces;
  EXPECT_EQ(whole_objects(scene).names,
            (std::vector<std::string>{"https://x/b/1", "https://x/b/2"}));
}

TEST(CityJson, ParentsInACircleEnd) {
  const std::string g = R"("geometry":[)" + geometry("MultiSurface", "[[[0,1,2]]]") + "]";
  const Model m = read(document(R"("A":{"type":"Building","parents":["B"],)" + g +
                                R"(},"B":{"type":"Building","parents":["A"]})"));
  EXPECT_EQ(objects(m), (std::vector<std::string>{"B/A"}));
}

TEST(CityJson, EachObjectGivesItsHighestLod) {
  const std::string text =
      document(R"("A":{"type":"Building","geometry":[)" +
               geometry("MultiSurface", "[[[0,1,2]]]", R"(,"lod":1)") + "," +
               geometry("MultiSurface", "[[[0,1,2]],[[0,2,3]]]", R"(,"lod":2.2)") + "," +
               geometry("MultiSurface", "[[[4,5,6]]]", R"(,"lod":"2.1")") + R"(]},)" +
               building(geometry("MultiSurface", "[[[5,6,7]]]", R"(,"lod":"1")")));
  const Model m = read(text);
  EXPECT_EQ(objects(m), (std::vector<std::string>{"A", "A", "B"}));
  EXPECT_EQ(m.report.lods, (std::vector<std::string>{"1", "2.1", "2.2"}));
  EXPECT_EQ(m.report.lod_used, "highest of each object");
  EXPECT_TRUE(m.warnings.empty());
}

TEST(CityJson, EmptyGeometryOfAHigherLodLeavesTheLowerOne) {
  const std::string good = geometry("MultiSurface", kShell, R"(,"lod":"1")");
  for (const auto& [type, empty] : {std::pair("MultiSurface", "[]"),
                                    {"MultiSurface", "[[]]"},
                                    {"Solid", "[[]]"},
                                    {"MultiSolid", "[[[]]]"}}) {
    const Model m = read(document(building(good + "," + geometry(type, empty, R"(,"lod":"2.2")"))));
    EXPECT_EQ(m.polygons.size(), 6u) << type << empty;
    EXPECT_EQ(m.report.lod_used, "1");
    EXPECT_TRUE(m.warnings.empty());
  }
}

TEST(CityJson, ObjectsWithoutSurfacesAreCountedButNotWholesWhosePartsHaveThem) {
  const std::string surface = geometry("MultiSurface", "[[[0,1,2]]]");
  const Model m = read(document(
      building(surface) +
      R"(,"E":{"type":"Building","geometry":[]},"N":{"type":"Building"},)"
      R"("W":{"type":"Building","geometry":[],"children":["P","Q"]},)"
      R"("P":{"type":"BuildingPart","parents":["W"],"geometry":[)" +
      surface + R"(]},"Q":{"type":"BuildingPart","parents":["W"],"geometry":[)" +
      geometry("Solid", "[]") +
      R"(]},"T":{"type":"SolitaryVegetationObject","geometry":[{"type":"MultiPoint","boundaries":[0],"lod":"1"}]},)"
      R"("G":{"type":"CityObjectGroup","children":["B"]})"));
  EXPECT_EQ(m.polygons.size(), 2u);
  EXPECT_TRUE(warns(m, "Objects without surfaces", 3));  // E, N and Q; T is a point
  for (const Warning& w : m.warnings) {
    if (w.what.find("without surfaces") != std::string::npos) {
      EXPECT_EQ(w.first, "t.json: object \"E\"");
    }
  }
}

TEST(CityJson, AnLodAskedForIsTheOnlyOneTaken) {
  const std::string text =
      document(R"("A":{"type":"Building","geometry":[)" +
               geometry("MultiSurface", "[[[0,1,2]]]", R"(,"lod":2)") + "," +
               geometry("MultiSurface", "[[[4,5,6]],[[4,6,7]]]", R"(,"lod":"2.2")") + R"(]},)" +
               building(geometry("MultiSurface", "[[[5,6,7]]]", R"(,"lod":"1")")));
  for (const char* lod : {"2", "2.0"}) {
    const Model m = read(text, lod);
    EXPECT_EQ(objects(m), (std::vector<std::string>{"A"}));
    EXPECT_EQ(m.report.lod_used, lod);
    EXPECT_TRUE(warns(m, "Objects without geometry of LoD", 1));
  }
  const Model none = read(text, "3");
  EXPECT_TRUE(none.polygons.empty());
  EXPECT_EQ(none.report.lods.size(), 3u);
}

TEST(CityJson, FootprintsCountOnlyWhereThereIsNothingHigher) {
  const std::string flat = geometry("MultiSurface", "[[[0,1,2,3]]]", R"(,"lod":0)");
  const std::string solid = geometry("MultiSurface", "[[[4,5,6,7]]]", R"(,"lod":"1.2")");
  const Model family = read(document(R"("B":{"type":"Building","geometry":[)" + flat +
                                     R"(]},)"
                                     R"("P":{"type":"BuildingPart","parents":["B"],"geometry":[)" +
                                     solid + "]}"));
  EXPECT_EQ(objects(family), (std::vector<std::string>{"B/P"}));
  EXPECT_TRUE(family.warnings.empty());

  const Model alone = read(document(building(flat)));
  EXPECT_EQ(alone.polygons.size(), 1u);
  EXPECT_TRUE(warns(alone, "LoD 0", 1));
}

TEST(CityJson, PointsAndLinesAreLeftOutWithAWarning) {
  const Model m =
      read(document(building(geometry("MultiPoint", "[0,1]") + "," +
                             geometry("MultiLineString", "[[0,1]]", R"(,"lod":"3")") + "," +
                             geometry("MultiSurface", "[[[0,1,2]]]", R"(,"lod":"1")"))));
  EXPECT_EQ(m.polygons.size(), 1u);
  EXPECT_TRUE(warns(m, "Points and lines", 2));
  EXPECT_EQ(m.report.lods, (std::vector<std::string>{"1"}));
}

TEST(CityJson, APolygonStoredTwiceCountsOnceAndKeepsItsSemantics) {
  // The same floor by other vertices with equal coordinates, from another start and the other way
  // round.
  const std::string vertices = "[[0,0,0],[10,0,0],[10,10,0],[0,10,0],[0,0,0],[10,0,0],[10,10,0]]";
  const std::string named =
      R"(,"lod":"2","semantics":{"surfaces":[{"type":"GroundSurface"}],"values":[0]})";
  const Model m = read(document(building(geometry("Solid", "[[[[0,1,2,3]],[[0,1,2]]]]") + "," +
                                         geometry("MultiSurface", "[[[6,5,4,3]]]", named)),
                                "", "2.0", vertices));
  EXPECT_EQ(m.report.stored_twice, 1u);
  ASSERT_EQ(m.polygons.size(), 2u);
  EXPECT_EQ(m.surfaces[m.polygons[0].surface].semantic, "GroundSurface");
  EXPECT_EQ(m.surfaces[m.polygons[1].surface].semantic, "");
}

TEST(CityJson, TheSamePolygonInTwoObjectsOrWithAHoleIsNotStoredTwice) {
  const Model two = read(document(building(geometry("MultiSurface", "[[[0,1,2,3]]]")) +
                                  R"(,"C":{"type":"Building","geometry":[)" +
                                  geometry("MultiSurface", "[[[0,1,2,3]]]") + "]}"));
  EXPECT_EQ(two.report.stored_twice, 0u);
  const Model hole = read(document(
      building(geometry("MultiSurface", "[[[0,1,2,3]],[[0,1,2,3],[8,9,10,11]],[[0,2,1,3]]]"))));
  EXPECT_EQ(hole.report.stored_twice, 0u);
  EXPECT_EQ(hole.polygons.size(), 3u);
}

std::string with_template(const std::string& instance, const std::string& matrix) {
  return document(
      R"("T":{"type":"SolitaryVegetationObject","geometry":[{"type":"GeometryInstance",)" +
          instance + R"(,"transformationMatrix":)" + matrix + "}]}",
      R"(,"geometry-templates":{"templates":[)" +
          geometry("MultiSurface", "[[[0,1,2]],[[0,2,1,3]]]",
                   R"(,"lod":2.1,"semantics":{"surfaces":[{"type":"Leaf"}],"values":[0,null]})") +
          R"(],"vertices-templates":[[0,0,0],[1,0,0],[0,1,0],[0,0,1]]})");
}
constexpr const char* kTurned =
    "[0,-2,0,0.5, 2,0,0,0, 0,0,2,0, 0,0,0,1]";  // quarter turn, twice as large

TEST(CityJson, TemplatesAreTurnedAndPutAtTheirAnchor) {
  const Model m = read(with_template(R"("template":0,"boundaries":[6])", kTurned));
  ASSERT_EQ(m.polygons.size(), 2u);
  EXPECT_EQ(semantics(m), (std::vector<std::string>{"Leaf", ""}));
  EXPECT_EQ(m.report.lods, (std::vector<std::string>{"2.1"}));
  const auto corners = corners_of(m, m.polygons[0]);
  const std::vector<Vec3> expected = {{1001.5, 2001, 31}, {1001.5, 2003, 31}, {999.5, 2001, 31}};
  for (std::size_t k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(corners[k][axis], expected[k][axis], 1e-9);
  }
}

TEST(CityJson, BrokenTemplatesAreErrors) {
  const std::string who = "object \"T\", geometry 0";
  expect_failure(with_template(R"("template":1,"boundaries":[0])", kTurned), {who, "template 1"});
  expect_failure(with_template(R"("template":0,"boundaries":[99])", kTurned), {who, "one vertex"});
  expect_failure(with_template(R"("template":0,"boundaries":[0,1])", kTurned), {who, "one vertex"});
  expect_failure(with_template(R"("template":0,"boundaries":[0])", "[1,0,0]"), {who, "16"});
  expect_failure(
      with_template(R"("template":0,"boundaries":[0])", "[1,0,0,0,0,1,0,0,0,0,1,0,1,0,0,1]"),
      {who, "last row"});
}

std::string sequence(const std::vector<std::string>& lines, const char* end = "\n") {
  std::string text =
      R"({"type":"CityJSON","version":"1.1","transform":{"scale":[0.1,0.1,0.1],"translate":[0,0,0]},)"
      R"("CityObjects":{},"vertices":[]})";
  for (const std::string& line : lines) text += end + line;
  return text;
}
std::string feature(const std::string& id, const std::string& ring) {
  return R"({"type":"CityJSONFeature","id":")" + id + R"(","CityObjects":{")" + id +
         R"(":{"type":"Building","geometry":[)" + geometry("MultiSurface", "[[" + ring + "]]") +
         R"(]}},"vertices":[[0,0,0],[10,0,0],[10,10,5]]})";
}

TEST(CityJsonSeq, FeaturesHaveTheirOwnVertices) {
  for (const char* end : {"\n", "\r\n", "\n\n"}) {
    const Model m = read(sequence({feature("A", "[0,1,2]"), feature("B", "[2,1,0]"), ""}, end));
    EXPECT_EQ(m.report.format, "CityJSONSeq 1.1");
    EXPECT_EQ(objects(m), (std::vector<std::string>{"A", "B"}));
    EXPECT_EQ(m.vertices.size(), 3u) << "equal vertices of features become one";
    EXPECT_EQ(m.report.stored_twice, 0u);
  }
}

TEST(CityJsonSeq, ErrorsNameTheLine) {
  expect_failure(sequence({feature("A", "[0,1,2]"), feature("B", "[0,1,3]")}),
                 {"line 3", "object \"B\", geometry 0", "vertex index 3", "below 3"});
  expect_failure(sequence({feature("A", "[0,1,2]"), "{\"type\":\"CityJSONFeature\",,"}),
                 {"not JSON at line 3, column 27"});
  expect_failure(sequence({R"({"type":"Feature"})"}), {"line 2", "CityJSONFeature"});
  expect_failure(feature("A", "[0,1,2]"), {"header"});
}

TEST(CityJson, ErrorsSayWhatToDo) {
  expect_failure("{\"type\":\"CityJSON\",\n  \"version\": 2.0,\n  oops}", {"line 3, column 3"});
  expect_failure("{\"type\":\"CityJSON\"", {"not JSON at line 1", "cut off"});
  expect_failure("{\"a\":1e999}", {"cannot be read as JSON"});
  expect_failure("[1,2]", {"not CityJSON"});
  expect_failure(R"({"asset":{"version":"2.0"}})", {"not CityJSON"});
  expect_failure(R"({"type":"CityJSON","version":"0.9"})", {"\"0.9\"", "cjio"});
  expect_failure(R"({"type":"CityJSON","version":"1.10"})", {"not supported"});
  expect_failure(R"({"type":"CityJSON"})", {"missing"});
}

TEST(CityJson, BrokenTransformsAreErrors) {
  for (const char* transform :
       {"1", "{}", R"({"scale":[1,1,1]})", R"({"scale":[1,1],"translate":[0,0,0]})",
        R"({"scale":[1,1,"1"],"translate":[0,0,0]})", R"({"scale":[1,0,1],"translate":[0,0,0]})",
        R"({"scale":[1,-1,1],"translate":[0,0,0]})"}) {
    expect_failure(
        std::string(R"({"type":"CityJSON","version":"2.0","transform":)") + transform + "}",
        {"transform is broken"});
  }
}

TEST(CityJson, WrongIndicesNameObjectGeometryAndIndex) {
  for (const char* index : {"12", "-1", "1.5", "\"1\"", "null", "[1]", "18446744073709551616"}) {
    expect_failure(
        document(building(geometry("MultiSurface", "[[[0,1,2]]]") + "," +
                          geometry("MultiSurface", "[[[0,1," + std::string(index) + "]]]"))),
        {"object \"B\", geometry 1", "vertex index", "below 12"});
  }
}

TEST(CityJson, CoordinatesMustBeThreeFiniteNumbers) {
  for (const char* vertex : {"[0,0]", "[0,0,0,0]", "[0,0,\"1\"]", "[0,0,null]", "7", "{}"}) {
    expect_failure(document(building(geometry("MultiSurface", "[[[0,1,2]]]")), "", "2.0",
                            "[[0,0,0],[1,0,0]," + std::string(vertex) + "]"),
                   {"object \"B\", geometry 0", "vertex 2 must be three finite numbers"});
  }
}

TEST(CityJson, WrongNestingIsAnError) {
  expect_failure(document(building(geometry("Solid", kShell))), {"object \"B\"", "ring"});
  expect_failure(document(building(geometry("MultiSurface", "[[0,1,2]]"))), {"list of vertex"});
  expect_failure(document(building(geometry("MultiSurface", "[0,1,2]"))), {"list of rings"});
  expect_failure(document(building(geometry("MultiSurface", "7"))), {"nested"});
  expect_failure(document(building(R"({"type":"Solid"})")), {"no \"boundaries\""});
  expect_failure(document(building(geometry("Polygon", "[[0,1,2]]"))), {"\"Polygon\""});
}

TEST(CityJson, WrongTypesAnywhereNeverThrow) {
  // Every value of a document in turn becomes a value of another type.
  const std::string whole = with_template(R"("template":0,"boundaries":[6])", kTurned);
  const std::string solid = document(
      building(geometry("Solid", "[" + std::string(kShell) + "]",
                        R"(,"lod":"2","material":{"t":{"values":[[0,0,0,0,0,null]]}},)"
                        R"("semantics":{"surfaces":[{"type":"W"}],"values":[[0,0,0,0,0,null]]})"),
               R"(,"parents":["X"])"),
      R"(,"metadata":{"referenceSystem":"EPSG:1"},"appearance":{"materials":[{"name":"m"}]})");
  std::size_t tried = 0, read_well = 0;
  for (const std::string& text : {whole, solid}) {
    for (std::size_t begin = 0; begin < text.size(); ++begin) {
      for (const char* other :
           {"7", "-1", "\"x\"", "null", "[]", "{}", "[[[]]]", "1e300", "true"}) {
        // Replace the value that starts here: up to the next comma or bracket, or the whole
        // bracket.
        if (text[begin] != ':' && text[begin] != '[' && text[begin] != ',') continue;
        std::size_t end = begin + 1;
        int depth = 0;
        for (; end < text.size(); ++end) {
          const char c = text[end];
          if (c == '[' || c == '{') ++depth;
          if (depth == 0 && (c == ',' || c == ']' || c == '}')) break;
          if (c == ']' || c == '}') --depth;
        }
        const auto result =
            read_cityjson(text.substr(0, begin + 1) + other + text.substr(end), "t.json", "");
        ++tried;
        if (result)
          ++read_well;
        else
          EXPECT_TRUE(result.error().message.starts_with("t.json: ")) << result.error().message;
      }
    }
  }
  EXPECT_GT(tried, 1000u);
  EXPECT_GT(read_well, 10u);  // e.g. another name
}

TEST(CityJson, DeepNestingIsAnErrorNotACrash) {
  EXPECT_NE(failure(std::string(1000000, '[')), "");
  EXPECT_NE(failure(document(
                building(geometry("Solid", std::string(100000, '[') + std::string(100000, ']'))))),
            "");
}

}  // namespace
}  // namespace gnomon
