// STL, PLY and OFF.
#include <cmath>

#include "mesh_files.h"

namespace gnomon {
namespace {

using Stl = MeshFiles;
using Ply = MeshFiles;
using Off = MeshFiles;

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
  return "facet normal 0 0 1\n outer loop\n  vertex " + a + "\n  vertex " + b + "\n  vertex " + c +
         "\n endloop\nendfacet\n";
}

std::string binary_stl(std::uint32_t count, const std::vector<float>& vertices) {
  std::string bytes = "solid but binary";
  bytes.resize(80, ' ');
  bytes += bytes_of<std::uint32_t>({count});
  for (std::size_t k = 0; k + 9 <= vertices.size(); k += 9) {
    bytes += std::string(12, '\0') +
             bytes_of(std::vector<float>(vertices.begin() + k, vertices.begin() + k + 9)) +
             std::string(2, '\0');
  }
  return bytes;
}

TEST_F(Stl, GeoreferencedTextKeepsItsDigits) {
  const Model m =
      read("t.stl",
           "solid\n" + facet("2684572.4301 1246323.059 448.126", "0 0 0", "1 0 0") + "endsolid\n");
  EXPECT_EQ(corners_of(m, 0)[0], Vec3(2684572.4301, 1246323.059, 448.126));
  EXPECT_TRUE(m.warnings.empty());
}

TEST_F(Stl, SolidsAreObjects) {
  const Model m = read("t.STL", "solid Tower A\n" + facet("0 0 0", "1 0 0", "0 1 0") +
                                    "endsolid Tower A\nsolid\n" + facet("0 0 0", "1 0 0", "0 0 1") +
                                    "ENDSOLID\n");
  ASSERT_EQ(m.surfaces.size(), 2u);
  EXPECT_EQ(m.surfaces[0].object, "Tower A");
  EXPECT_EQ(m.surfaces[1].object, "");
  EXPECT_EQ(m.report.format, "STL");
  EXPECT_EQ(m.report.objects, 2u);
}

TEST_F(Stl, ZIsUpUnlessYIsAskedFor) {
  const std::string text = "solid\n" + facet("1 2 3", "4 5 6", "7 8 10") + "endsolid\n";
  EXPECT_EQ(corners_of(read("t.stl", text), 0)[0], Vec3(1, 2, 3));
  EXPECT_EQ(corners_of(read("t.stl", text, 'y', 0.001), 0)[0], Vec3(1, -3, 2) * 0.001);
}

TEST_F(Stl, BinaryFilesThatStartWithSolidAreBinary) {
  const Model m = read("t.stl", binary_stl(1, {0, 0, 0, 1, 0, 0, 0, 1, 2}));
  ASSERT_EQ(m.polygons.size(), 1u);
  EXPECT_EQ(corners_of(m, 0)[2], Vec3(0, 1, 2));
}

TEST_F(Stl, CutOffFilesAreErrors) {
  expect_failure("t.stl", binary_stl(2, {0, 0, 0, 1, 0, 0, 0, 1, 2}),
                 {"2 triangles", "134 bytes", "room for 1"});
  expect_failure("t.stl", "solid s\n" + facet("0 0 0", "1 0 0", "0 1 0"),
                 {"solid \"s\"", "cut off"});
  expect_failure(
      "t.stl",
      "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\nendfacet\nendsolid\n",
      {"line 2", "1 vertex"});
  expect_failure("t.stl", "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n",
                 {"line 4", "z coordinate is missing"});
  expect_failure("t.stl", "nonsense", {"is no STL"});
}

TEST_F(Stl, WhatIsNotFiniteIsAnError) {
  expect_failure("t.stl", "solid s\n" + facet("0 0 0", "1 nan 0", "0 1 0"),
                 {"line 5", "y coordinate is \"nan\""});
  expect_failure("t.stl", "solid s\n" + facet("0 0 0", "1 0 0", "1e999 1 0"), {"line 6", "1e999"});
  expect_failure("t.stl", binary_stl(1, {0, 0, 0, 1, 0, 0, 0, INFINITY, 2}),
                 {"triangle 0", "vertex 2"});
}

TEST_F(Stl, EmptyFilesAreModelsWithoutPolygons) {
  EXPECT_TRUE(read("t.stl", binary_stl(0, {})).polygons.empty());
  EXPECT_TRUE(read("t.stl", "solid a\nendsolid a\n").polygons.empty());
}

TEST_F(Off, FacesOfAnyNumberOfCornersStayWholeWithCommentsAnywhere) {
  std::string text = "# a\nOFF # b\n12 2 0\n# vertices\n";
  for (int k = 0; k < 12; ++k) text += std::to_string(k) + " " + std::to_string(k * k) + " 0.5\n";
  text += "# faces\n12 0 1 2 3 4 5 6 7 8 9 10 11 0.5 0.5 0.5\n\n3 0 1 2 # red\n";
  const Model m = read("t.off", text);
  ASSERT_EQ(m.polygons.size(), 2u);
  EXPECT_EQ(corners_of(m, 0).size(), 12u);
  EXPECT_EQ(corners_of(m, 0)[11], Vec3(11, 121, 0.5));
}

TEST_F(Off, ColoursNormalsAndWeightsAreUnderstood) {
  EXPECT_EQ(corners_of(read("t.off",
                            "CNOFF 3 1 0\n0 0 0 9 9 9 1 0 0\n1 0 0 9 9 9\n0 1 2 9 9 9\n3 0 1 2\n"),
                       0)[2],
            Vec3(0, 1, 2));
  EXPECT_EQ(corners_of(read("t.off", "4OFF 3 1 0\n0 0 0 1\n1 0 0 1\n0 1 2 2\n3 0 1 2\n"), 0)[2],
            Vec3(0, 0.5, 1));
  expect_failure("t.off", "OFF BINARY\n", {"line 1", "save the model as text"});
  expect_failure("t.off", "4nOFF\n4\n", {"line 1", "4nOFF"});
}

TEST_F(Off, CountsBeyondTheFileAreRefusedBeforeTheyAreBelieved) {
  expect_failure("t.off", "OFF\n353535235358 6 0\n0 0 0\n", {"line 2", "353535235358", "bytes"});
  expect_failure("t.off", "OFF\n3 99999999999 0\n0 0 0\n", {"99999999999 faces"});
  expect_failure("t.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", {"ends after 2 vertices", "cut off"});
  expect_failure("t.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
                 {"ends after 1 face,", "cut off"});
}

TEST_F(Off, WrongFacesAndVerticesNameTheirLine) {
  expect_failure("t.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
                 {"line 6", "face 0", "\"3\"", "there are 3"});
  expect_failure("t.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4 0 1 2\n", {"line 6", "face 0"});
  expect_failure("t.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1\n3 0 1 2\n",
                 {"line 5", "vertex 2", "z is missing"});
  expect_failure("t.off", "OFF\n3 1 0\n0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n",
                 {"line 6", "vertex 1", "not finite"});
}

TEST_F(Off, VerticesThatNoFaceUsesMayBeAnything) {
  EXPECT_EQ(
      read("t.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\nnan nan nan\n3 0 1 2\n").polygons.size(), 1u);
}

TEST_F(Off, PointsLinesAndLeftoversAreWarnedOf) {
  const Model m = read("t.off", "OFF\n3 3 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n2 0 1\n1 0\n3 0 1 2\n");
  EXPECT_EQ(m.polygons.size(), 1u);
  EXPECT_EQ(warned(m, "Points and lines"), 2u);
  EXPECT_EQ(warned(m, "Lines after the last face"), 1u);
}

const std::string kPlyHead =
    "element vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST_F(Ply, TextAndBothBinariesGiveTheSame) {
  const Model text = read("t.ply", "ply\nformat ascii 1.0\n" + kPlyHead +
                                       "2684572.4301 0 0\n1 0 0\n1 1 0\n0 1 0.25\n4 0 1 2 3\n");
  std::string little = "ply\nformat binary_little_endian 1.0\n" + kPlyHead;
  std::string big = "ply\nformat binary_big_endian 1.0\n" + kPlyHead;
  const auto put = [&](const std::string& bytes) {
    little += bytes;
    big += std::string(bytes.rbegin(), bytes.rend());
  };
  for (const double d : {2684572.4301, 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.25})
    put(bytes_of<double>({d}));
  put("\4");
  for (const std::int32_t k : {0, 1, 2, 3}) put(bytes_of<std::int32_t>({k}));
  for (const Model& m : {text, read("t.ply", little), read("t.ply", big)}) {
    ASSERT_EQ(m.polygons.size(), 1u);
    EXPECT_EQ(corners_of(m, 0),
              (std::vector<Vec3>{{2684572.4301, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.25}}));
    EXPECT_TRUE(m.warnings.empty());
  }
  expect_failure("t.ply", little.substr(0, little.size() - 1), {"face 0", "cut off"});
}

TEST_F(Ply, StripsBecomeTrianglesOfOneWinding) {
  const Model m =
      read("t.ply",
           "ply\nformat ascii 1.0\nelement tristrips 1\nproperty list int int vertex_indices\n"
           "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
           "8 0 1 2 3 -1 1 2 3\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n");
  ASSERT_EQ(m.polygons.size(), 3u);
  EXPECT_EQ(corners_of(m, 1), (std::vector<Vec3>{{0, 1, 0}, {1, 0, 0}, {1, 1, 0}}));
}

TEST_F(Ply, CountsAndLinesThatDoNotFitAreErrors) {
  const std::string head = "ply\nformat ascii 1.0\n" + kPlyHead;
  expect_failure("t.ply", head + "0 0 0\n1 0 0\n", {"4 of element \"vertex\"", "no room"});
  expect_failure("t.ply", head + "0 0 0\n1 0 0\n1 1 0\n0 1 0.0000000000000000\n",
                 {"face 0 of 1", "cut off"});
  expect_failure("t.ply", head + "0 0 0\n1 0\n1 1 0\n0 1 0\n3 0 1 2\n",
                 {"line 11", "vertex 1", "\"z\"", "missing"});
  expect_failure("t.ply", head + "0 0 0\n1 0 0 5\n1 1 0\n0 1 0\n3 0 1 2\n",
                 {"line 11", "4 numbers"});
  expect_failure("t.ply", head + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 4\n",
                 {"line 14", "face 0", "vertex 4"});
  expect_failure("t.ply", head + "0 0 0\n1 nan 0\n1 1 0\n0 1 0\n3 0 1 2\n",
                 {"line 14", "vertex 1", "not finite"});
  expect_failure("t.ply", "ply\nformat ascii 1.0\nelement vertex 4\n", {"end_header"});
  expect_failure("t.ply", "plx\n", {"does not start with \"ply\""});
  expect_failure("t.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty quad x\n", {"line 4"});
}

TEST_F(Ply, FilesWithoutFacesAreModelsWithoutPolygons) {
  const Model points =
      read("t.ply",
           "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
           "property float z\nend_header\n0 0 0\n1 1 1\n");
  EXPECT_TRUE(points.polygons.empty());
  EXPECT_EQ(warned(points, "Points and lines"), 2u);
  EXPECT_TRUE(read("t.ply", "ply\nformat ascii 1.0\nend_header\n").polygons.empty());
}

}  // namespace
}  // namespace gnomon
