// What fuzzing and reading for it found (docs/fuzzing.md), each in its smallest form.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored \
    "-Wrestrict"  // GCC 12 warns of "text" + std::string (its bug 105651)
#endif

#include <gnomon/io/cityjson.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/footprint_layer.h>
#include <gnomon/io/ifc_map.h>
#include <gnomon/io/ifc_place.h>
#include <gnomon/io/ply.h>
#include <gnomon/io/read_text.h>
#include <gnomon/io/triangulate.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "ifc_test_file.h"
#include "io/write_test_files.h"

namespace gnomon {
namespace {

using gnomon::testing::TestFolder;

bool warned_of(const Warnings& warnings, const std::string& part) {
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const Warning& w) { return w.what.find(part) != std::string::npos; });
}

TEST(HostileCityJson, ARingOfOneCornerRepeatedCostsNoSquareOfItsLength) {
  std::string ring = "0";
  for (int k = 0; k < 200000; ++k) ring += ",0";
  const auto model = read_cityjson(
      R"({"type":"CityJSON","version":"1.0","CityObjects":{"B":{"type":"Building","geometry":[)"
      R"({"type":"MultiSurface","lod":"2","boundaries":[[[)" +
          ring + R"(]]]}]}},"vertices":[[0,0,0]]})",
      "t.json", "");
  ASSERT_TRUE(model);
  EXPECT_EQ(model.value().polygons.size(), 1u);
}

// Of each pair, which is the same polygon: any start, either direction, nothing else.
TEST(HostileCityJson, PolygonsStoredTwiceAreStillFoundWhereverTheyStart) {
  const auto stored_twice = [](const std::string& a, const std::string& b) {
    const auto model = read_cityjson(
        R"({"type":"CityJSON","version":"1.0","CityObjects":{"B":{"type":"Building","geometry":[)"
        R"({"type":"MultiSurface","lod":"2","boundaries":[[[)" +
            a + "]],[[" + b + R"(]]]}]}},"vertices":[[0,0,0],[1,0,0],[1,1,0],[0,1,0]]})",
        "t.json", "");
    return model ? model.value().report.stored_twice : 99;
  };
  EXPECT_EQ(stored_twice("0,1,2,3", "2,3,0,1"), 1u);
  EXPECT_EQ(stored_twice("0,1,2,3", "1,0,3,2,1"), 1u);
  EXPECT_EQ(stored_twice("0,1,0,2,0,3", "0,3,0,1,0,2"), 1u);
  EXPECT_EQ(stored_twice("0,1,0,2,0,3", "0,2,0,1,0,3"), 1u);
  EXPECT_EQ(stored_twice("0,1,2,3", "0,2,1,3"), 0u);
  EXPECT_EQ(stored_twice("0,1,0,2", "0,1,0,1"), 0u);
}

TEST(HostileCityJson, ATemplateMovedBeyondAllNumbersIsAnError) {
  const auto model = read_cityjson(
      R"({"type":"CityJSON","version":"1.0","CityObjects":{"T":{"type":"Building","geometry":[)"
      R"({"type":"GeometryInstance","template":0,"boundaries":[0],"transformationMatrix":)"
      R"([1e308,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}]}},"vertices":[[0,0,0]],"geometry-templates":{)"
      R"("templates":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2]]]}],)"
      R"("vertices-templates":[[10,0,0],[1,0,0],[0,1,0]]}})",
      "t.json", "");
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().message,
            "t.json: object \"T\", geometry 0: the transformationMatrix moves template vertex 0 "
            "beyond all numbers.");
}

TEST(HostileCityJson, TheParsersReasonsAreShortAndHaveNoControlCharacters) {
  const auto model = read_cityjson("{" + std::string(10000, '\x7f'), "t.json", "");
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().message.find('\x7f'), std::string::npos);
  EXPECT_LT(model.error().message.size(), 500u);
}

TEST(HostileObj, AFaceThatGoesBackOnItsOwnEdgesIsNotLostSilently) {
  const std::vector<Vec3> corners = {{0, 0, 0}, {4, 0, 0}, {2, 2, 0}};
  const Triangulation result = triangulate(corners, {{0, 1, 2, 1, 1}});
  EXPECT_TRUE(result.triangles.empty());
  EXPECT_NE(result.problem.find("has no area"), std::string::npos) << result.problem;
}

TEST(HostilePly, NamesOfElementsInMessagesHaveNoControlCharacters) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement a\x01"
      "z 2\nproperty int i\nend_header\n";
  const auto cut_off = read_ply(header + "1\n\n\n", "t.ply", 'z', 1);
  ASSERT_FALSE(cut_off);
  EXPECT_EQ(cut_off.error().message, "t.ply: the file ends before a?z 1 of 2; it is cut off.");
  const auto no_number = read_ply(header + "1\nx\n", "t.ply", 'z', 1);
  ASSERT_FALSE(no_number);
  EXPECT_NE(no_number.error().message.find("a?z 1 must have"), std::string::npos);
}

TEST(HostileIfc, AMapConversionBeyondAllNumbersIsNotUsed) {
  IfcTestFile file;
  file.unit = kIfcFeet;
  file.more =
      "#89=IFCSIUNIT(*,.LENGTHUNIT.,.EXA.,.METRE.);\n"
      "#90=IFCPROJECTEDCRS('',$,$,$,$,$,#89);\n#91=IFCMAPCONVERSION(#33,#90,1.E308,0.,0.,1.,0.,1.);"
      "\n";
  const auto place = read_ifc_place(file.text(), "t.ifc");
  ASSERT_TRUE(place) << place.error().message;
  EXPECT_FALSE(place.value().conversion);
  EXPECT_TRUE(warned_of(place.value().warnings, "beyond all numbers"));
}

TEST(HostileIfc, AnElevationBeyondAllNumbersIsZero) {
  IfcTestFile file;
  file.unit = "#20=IFCSIUNIT(*,.LENGTHUNIT.,.EXA.,.METRE.);";
  file.latitude = "(48,8,0)";
  file.longitude = "(11,34,30)";
  file.elevation = "1.E308";
  const auto place = read_ifc_place(file.text(), "t.ifc");
  ASSERT_TRUE(place) << place.error().message;
  ASSERT_TRUE(place.value().site);
  EXPECT_EQ(place.value().site->height, 0);
  EXPECT_TRUE(warned_of(place.value().warnings, "elevation"));
}

TEST(HostileIfc, ARelationOfManyWithManyCostsNoProduct) {
  std::string list = "#1";
  for (int k = 0; k < 50000; ++k) list += ",#1";
  std::string others = "#3";
  for (int k = 0; k < 50000; ++k) others += ",#3";
  IfcTestFile file;
  file.more = "#90=IFCRELAGGREGATES('0',#5,$,$,(" + list + "),(" + others + "));\n";
  EXPECT_TRUE(read_ifc_place(file.text(), "t.ifc"));  // of 2.5e9 pairs
}

TEST(HostileIfc, WhatContainsItselfOverARelationIsNamed) {
  IfcTestFile file;
  file.more = "#90=IFCRELAGGREGATES('0',#5,$,$,#61,(#62,#60));\n";  // the building has its site
  const auto place = read_ifc_place(file.text(), "t.ifc");
  ASSERT_FALSE(place);
  EXPECT_NE(place.error().message.find("contains itself"), std::string::npos);
}

TEST(HostileIfc, ASchemaWithControlCharactersDoesNotReachMessages) {
  const auto place = read_ifc_place(
      "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4\x1b[2J'));\nENDSEC;\nDATA;\nENDSEC;\n"
      "END-ISO-10303-21;\n",
      "t.ifc");
  ASSERT_TRUE(place) << place.error().message;
  ASSERT_FALSE(place.value().warnings.empty());
  EXPECT_EQ(place.value().warnings[0].first, "t.ifc: \"IFC4?[2J\"");
}

TEST(HostileCrs, NamesOfAnyLengthAreReadWithoutRecursion) {
  const std::string spaces(1000000, ' ');
  EXPECT_EQ(short_crs(spaces + "x"), spaces + "x");
  EXPECT_EQ(ifc_crs(spaces + "x"), spaces + "x");
}

TEST(HostileFootprints, IdsWithControlCharactersDoNotReachMessages) {
  const TestFolder folder;
  const auto path = folder / "a.geojson";
  std::ofstream(path) << R"({"type":"FeatureCollection","features":[)"
                         R"({"type":"Feature","id":"a\n\u001b[2J\u00f6","properties":{"height":3},)"
                         R"("geometry":{"type":"Polygon","coordinates":[[[11,48],[11.001,48],)"
                         R"([11.001,48.001],[11,48]]]}}]})";
  const auto model =
      read_footprints(path, {}, "", "", [](double, double) { return std::optional<double>(); });
  ASSERT_TRUE(model) << model.error().message;
  bool named = false;
  for (const Warning& w : model.value().warnings) {
    named = named || w.first.find("(id a??[2J\u00f6)") != std::string::npos;
  }
  EXPECT_TRUE(named);
}

TEST(Printable, KeepsLettersAndReplacesTheRest) {
  EXPECT_EQ(printable("h\u00f6he\t1", 60), "h\u00f6he?1");
  EXPECT_EQ(printable("a\xff\xc3", 60), "a??");
  EXPECT_EQ(printable("abc", 3), "abc");
  EXPECT_EQ(printable("abcd", 3), "abc...");
  EXPECT_EQ(printable("ab\u00f6", 3), "ab...");  // never half a letter
}

}  // namespace
}  // namespace gnomon
