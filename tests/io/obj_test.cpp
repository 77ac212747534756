#include <gnomon/io/obj.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace gnomon {
namespace {

Model read(const std::string& text, char up = 'z', double unit = 1.0) {
  auto model = read_obj(text, "t.obj", up, unit);
  if (!model) {
    ADD_FAILURE() << model.error().message;
    return {};
  }
  return std::move(model).value();
}

void expect_failure(const std::string& text, const std::string& line, const std::string& part) {
  const auto model = read_obj(text, "t.obj", 'y', 1.0);
  ASSERT_FALSE(model) << text;
  const std::string& message = model.error().message;
  EXPECT_TRUE(message.starts_with("t.obj: line " + line + ": ")) << message;
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

std::vector<Vec3> corners_of(const Model& m, const ModelPolygon& p) {
  std::vector<Vec3> corners;
  for (std::uint32_t c = m.ring_begin[p.first_ring]; c < m.ring_begin[p.last_ring]; ++c) {
    corners.push_back(m.vertices[m.corners[c]] * m.scale + m.translate);
  }
  return corners;
}

const std::string kFour = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 5\n";

TEST(Obj, YUpBecomesZUp) {
  const std::string text = "v 1 2 3\nv 4 5 6\nv 7 8 10\nf 1 2 3\n";
  EXPECT_EQ(corners_of(read(text, 'y'), read(text, 'y').polygons[0])[0], Vec3(1, -3, 2));
  EXPECT_EQ(corners_of(read(text, 'z'), read(text, 'z').polygons[0])[0], Vec3(1, 2, 3));
}

TEST(Obj, UnitsBecomeMetres) {
  const Model m = read("v 1000 2000 3000\nv 0 0 0\nv 1 0 0\nf 1 2 3\n", 'z', 0.001);
  EXPECT_EQ(corners_of(m, m.polygons[0])[0], Vec3(1, 2, 3));
}

TEST(Obj, GeoreferencedCoordinatesKeepTheirDigits) {
  const Model m =
      read("v 2684572.4301234567 1246323.0590000001 448.126\nv 0 0 0\nv 1 0 0\nf 1 2 3\n");
  const Vec3 p = corners_of(m, m.polygons[0])[0];
  EXPECT_NEAR(p.x, 2684572.4301234567, 1e-9 * 2684572);  // a float would be 0.1 m off
  EXPECT_NEAR(p.y, 1246323.0590000001, 1e-9 * 1246323);
  EXPECT_NEAR(p.x, 2684572.4301234567, 1e-8);
}

TEST(Obj, PolygonsStayWholeAndKnowTheirLine) {
  const Model m = read("# a comment\n" + kFour + "\nf 1 2 3 4\nf 1/1 2/2/2 3//3\n");
  ASSERT_EQ(m.polygons.size(), 2u);
  EXPECT_EQ(corners_of(m, m.polygons[0]).size(), 4u);
  EXPECT_EQ(corners_of(m, m.polygons[1]).size(), 3u);
  EXPECT_EQ(m.polygons[0].number, 7u);
  EXPECT_EQ(name_of(m, m.polygons[1]), "t.obj: line 8");
  EXPECT_EQ(m.report.format, "OBJ");
}

TEST(Obj, ObjectsGroupsAndMaterialsAreKeptApart) {
  const Model m = read(kFour +
                       "f 1 2 3\no House 7 \ng walls north\nusemtl red brick\nf 1 2 4\ng\nf 2 3 4\n"
                       "o Shed\nusemtl wood\nf 1 3 4\nf 1 3 4\n");
  std::vector<std::string> names;
  for (const ModelPolygon& p : m.polygons) {
    const Surface& s = m.surfaces[p.surface];
    names.push_back(s.object + "|" + s.group + "|" + s.material + "|" + s.semantic);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"|||", "House 7|walls north|red brick|",
                                             "House 7||red brick|", "Shed||wood|", "Shed||wood|"}));
  EXPECT_EQ(m.surfaces.size(), 4u);
  EXPECT_EQ(m.report.objects, 3u);
  EXPECT_EQ(m.report.surfaces, 5u);
}

TEST(Obj, NegativeIndicesCountBackFromTheFace) {
  const Model m = read("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf -1 -2 1\n");
  EXPECT_EQ(corners_of(m, m.polygons[0])[0], Vec3(0, 0, 0));
  EXPECT_EQ(corners_of(m, m.polygons[1]), (std::vector<Vec3>{{5, 5, 5}, {0, 1, 0}, {9, 9, 9}}));
}

TEST(Obj, FacesMayStandAboveTheirVertices) {
  EXPECT_EQ(read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0").polygons.size(), 1u);
}

TEST(Obj, AnyLineEndAndContinuedLinesAreRead) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const Model m =
        read("v 0 0 0" + end + "v 1 \\" + end + " 0 0" + end + "v 0 1 0" + end + "\tv\t0 1  1 \t" +
             end + "f 1 2 \\" + end + "3 4 # the wall" + end + "f 1 2 3");
    ASSERT_EQ(m.polygons.size(), 2u);
    EXPECT_EQ(corners_of(m, m.polygons[0]).size(), 4u);
    EXPECT_EQ(m.polygons[0].number, 6u);
    EXPECT_EQ(m.polygons[1].number, 8u);
  }
}

// tinyobjloader multiplies by powers of ten and misses the last digit of the second coordinate.
TEST(Obj, CoordinatesAreTheNearestDoubles) {
  const Model m =
      read("v 340841.32 340837.151 1336.6799999999998\nv 1e-5 0.1 -7.5e3\nv 0 9 +2\nf 1 2 3\n");
  ASSERT_EQ(m.vertices.size(), 3u);
  EXPECT_EQ(m.vertices[0], Vec3(340841.32, 340837.151, 1336.6799999999998));
  EXPECT_EQ(m.vertices[1], Vec3(1e-5, 0.1, -7500));
  EXPECT_EQ(m.vertices[2], Vec3(0, 9, 2));
}

TEST(Obj, ColoursAndWeightsAfterAVertexAreIgnored) {
  const Model m = read("v 0 0 0 nan nan nan\nv +1 0. .5e1 0.5\nv -0 1 0 1 1 1\nf 1 2 3\n");
  EXPECT_EQ(corners_of(m, m.polygons[0])[1], Vec3(1, 0, 5));
}

TEST(Obj, PointsLinesAndFreeFormAreLeftOutWithWarnings) {
  const Model m = read(kFour + "p 1\nl 1 2\nl 2 3\nf 1 2 3\ncstype bspline\nsurf 0 1 0 1 1 2 3\n");
  EXPECT_EQ(m.polygons.size(), 1u);
  ASSERT_EQ(m.warnings.size(), 2u);
  EXPECT_EQ(m.warnings[0].count, 3u);
  EXPECT_EQ(m.warnings[0].first, "t.obj: line 5");
  EXPECT_EQ(m.warnings[1].count, 1u);
}

TEST(Obj, UnknownStatementsAreCountedAndKnownOnesAreNot) {
  const Model m = read(kFour + "f 1 2 3\ncall wing.obj\nvertex 1 2 3\n");
  ASSERT_EQ(m.warnings.size(), 1u);
  EXPECT_EQ(m.warnings[0].count, 2u);
  EXPECT_EQ(m.warnings[0].first, "t.obj: line 6: \"call\"");
  const Model known = read("# comment\n#comment\nmtllib a.mtl\n" + kFour +
                           "vt 0 0\nvn 0 0 1\nvp 0\no a\ng b\ns off\nusemtl c\nusemap d\nmg 1\n"
                           "lod 3\nbevel on\nmaplib e\nshadow_obj f.obj\n   \n\t\nf 1 2 3\nend\n");
  EXPECT_TRUE(known.warnings.empty()) << known.warnings[0].first;
}

TEST(Obj, WhatTinyobjloaderWouldReadAsZeroIsAnError) {
  expect_failure("v 0 0 0\nv 1 nan 0\n", "2", "y coordinate \"nan\"");
  expect_failure("v 0 0 inf\n", "1", "z coordinate \"inf\"");
  expect_failure("v 0 0\n", "1", "no z coordinate");
  expect_failure("v\n", "1", "no x coordinate");
  expect_failure("v 0 0 1,5\n", "1", "\"1,5\"");
  expect_failure("v 0 0 1e999\n", "1", "\"1e999\"");
  expect_failure("v 0x10 0 0\n", "1", "\"0x10\"");
  expect_failure(kFour + "f 1 2 x\n", "5", "\"x\"");
  expect_failure(kFour + "f 1 2 1/2/3/4\n", "5", "\"1/2/3/4\"");
}

TEST(Obj, IndicesOutOfRangeAreErrorsWithTheirLine) {
  expect_failure(kFour + "f 1 2 3\nf 1 2 5\n", "6", "index 5 is out of range; the file has 4");
  expect_failure(kFour + "f 0 1 2\n", "5", "index 0");
  expect_failure(kFour + "f -5 1 2\n", "5", "index -5");
  expect_failure(kFour + "f 1 2 99999999999\n", "5", "out of range");
  expect_failure(kFour + "f 1 2 99999999999999999999\n", "5", "not a vertex index");
  expect_failure(kFour + "f\n", "5", "no corners");
}

TEST(Obj, BinaryIsNotAnObj) {
  expect_failure(std::string("v 0 0 0\nab\0cd\n", 14), "2", "not text");
}

}  // namespace
}  // namespace gnomon
