#include <cmath>
#include <nlohmann/json.hpp>

#include "mesh_files.h"

namespace gnomon {
namespace {

using Json = nlohmann::json;
using Gltf = MeshFiles;

// One triangle (1,2,3) (4,5,6) (7,8,10), indexed, in a buffer t.bin beside the file.
struct Triangle {
  std::vector<float> positions = {1, 2, 3, 4, 5, 6, 7, 8, 10};
  std::vector<std::uint16_t> indices = {0, 1, 2};
  Json json = Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"name": "house", "mesh": 0}], "materials": [{"name": "brick"}],
    "meshes": [{"name": "wall", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                  {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
    "buffers": [{"uri": "t.bin", "byteLength": 42}]})");
  std::string bin() const { return bytes_of(positions) + bytes_of(indices); }
};

TEST_F(Gltf, YUpBecomesZUpWithMinusZToTheNorth) {
  const Triangle t;
  write("t.bin", t.bin());
  const Model m = read("t.gltf", t.json.dump());
  ASSERT_EQ(m.polygons.size(), 1u);
  EXPECT_EQ(corners_of(m, 0), (std::vector<Vec3>{{1, -3, 2}, {4, -6, 5}, {7, -10, 8}}));
  EXPECT_EQ(m.report.format, "glTF 2.0");
  EXPECT_EQ(m.surfaces[0].object, "house");
  EXPECT_EQ(m.surfaces[0].group, "wall");
  EXPECT_EQ(m.surfaces[0].material, "brick");
  EXPECT_TRUE(m.warnings.empty());
}

TEST_F(Gltf, NestedNodesComposeInDoubleAndNameTheirPath) {
  Triangle t;
  write("t.bin", t.bin());
  t.json["nodes"] = Json::parse(R"([
    {"name": "site", "children": [1, 2], "translation": [2684572.4301, 448.126, -1246323.059]},
    {"name": "house", "mesh": 0, "scale": [2, 2, 2]},
    {"children": [3], "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476]},
    {"name": "shed", "mesh": 0}])");
  const Model m = read("t.gltf", t.json.dump());
  ASSERT_EQ(m.polygons.size(), 2u);  // one mesh under two nodes
  const Vec3 origin(2684572.4301, 1246323.059, 448.126);
  const Vec3 first = corners_of(m, 0)[0] - origin, turned = corners_of(m, 1)[0] - origin;
  // Half a unit in the last place of 2684572 in double is 2.4e-10 m; in single precision 0.125 m.
  EXPECT_NEAR(first.x, 2, 1e-9);
  EXPECT_NEAR(first.y, -6, 1e-9);
  EXPECT_NEAR(first.z, 4, 1e-9);
  EXPECT_NEAR(turned.x, 3, 1e-9);  // +90 degrees about y: z to x, x to -z
  EXPECT_NEAR(turned.y, 1, 1e-9);
  EXPECT_NEAR(turned.z, 2, 1e-9);
  EXPECT_EQ(m.surfaces[0].object, "site/house");
  EXPECT_EQ(m.surfaces[1].object, "site/shed");
  EXPECT_EQ(m.surfaces[1].whole, 4u);
  t.json["nodes"] = Json::parse(R"([{"name": "way/5", "mesh": 0}])");
  const Model named = read("t.gltf", t.json.dump());
  EXPECT_EQ(named.surfaces[0].whole, 5u);
}

TEST_F(Gltf, NodesOutsideTheDefaultSceneAreCounted) {
  Triangle t;
  write("t.bin", t.bin());
  t.json["scenes"] = Json::parse(R"([{"nodes": [0]}, {"nodes": [2]}])");
  t.json["nodes"] = Json::parse(
      R"([{"name": "house", "mesh": 0}, {"name": "shed", "mesh": 0},
          {"name": "winter", "children": [3]}, {"mesh": 0}])");
  const Model m = read("t.gltf", t.json.dump());
  EXPECT_EQ(m.polygons.size(), 1u);
  ASSERT_EQ(warned(m, "outside the file's default scene"), 2u);
  EXPECT_TRUE(m.warnings[0].first.ends_with("t.gltf: node 1 \"shed\"")) << m.warnings[0].first;
}

TEST_F(Gltf, MatrixAndTrsMeanTheSame) {
  Triangle t;
  write("t.bin", t.bin());
  t.json["nodes"][0]["matrix"] = {0, 0, -2, 0, 0, 2, 0, 0, 2, 0, 0, 0, 10, 20, 30, 1};
  const Vec3 matrix = corners_of(read("t.gltf", t.json.dump()), 0)[0];
  t.json["nodes"][0].erase("matrix");
  t.json["nodes"][0]["translation"] = {10, 20, 30};
  t.json["nodes"][0]["rotation"] = {0, std::sqrt(0.5), 0, std::sqrt(0.5)};
  t.json["nodes"][0]["scale"] = {2, 2, 2};
  const Vec3 trs = corners_of(read("t.gltf", t.json.dump()), 0)[0];
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(matrix[k], trs[k], 1e-13);
  EXPECT_EQ(matrix, Vec3(16, -28, 24));
}

TEST_F(Gltf, DataUrisAndGlbChunksAreBuffersToo) {
  Triangle t;
  Json chunk = t.json;
  chunk["buffers"][0].erase("uri");
  std::string text = chunk.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string bin = t.bin() + std::string(2, '\0');
  std::string glb =
      "glTF" +
      bytes_of<std::uint32_t>({2, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + bin.size()),
                               static_cast<std::uint32_t>(text.size())}) +
      "JSON" + text + bytes_of<std::uint32_t>({static_cast<std::uint32_t>(bin.size())}) +
      std::string("BIN\0", 4) + bin;
  const Model m = read("t.glb", glb);
  EXPECT_EQ(corners_of(m, 0)[2], Vec3(7, -10, 8));
  EXPECT_EQ(m.report.format, "GLB 2.0");
  expect_failure("t.glb", glb.substr(0, glb.size() - 1), {"cut off"});
  t.json["buffers"][0] = {{"uri", "data:application/octet-stream;base64,AACAPwAAAEAAAEBA"},
                          {"byteLength", 12}};
  t.json["bufferViews"][0]["byteLength"] = 12;
  t.json["accessors"][0]["count"] = 1;
  t.json["meshes"][0]["primitives"][0].erase("indices");
  t.json["meshes"][0]["primitives"][0]["mode"] = 0;
  EXPECT_EQ(warned(read("t.gltf", t.json.dump()), "Points and lines"), 1u);
}

TEST_F(Gltf, StripsAndFansBecomeTrianglesOfOneWinding) {
  Triangle t;
  t.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  t.indices = {0, 1, 2, 3};
  t.json["accessors"][0]["count"] = 4;
  t.json["accessors"][1]["count"] = 4;
  t.json["bufferViews"] = Json::parse(
      R"([{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 8}])");
  t.json["buffers"][0]["byteLength"] = 56;
  write("t.bin", t.bin());
  t.json["meshes"][0]["primitives"][0]["mode"] = 5;
  const Model strip = read("t.gltf", t.json.dump());
  ASSERT_EQ(strip.polygons.size(), 2u);
  EXPECT_EQ(corners_of(strip, 1), (std::vector<Vec3>{{0, 0, 1}, {1, 0, 0}, {1, 0, 1}}));
  t.json["meshes"][0]["primitives"][0]["mode"] = 6;
  const Model fan = read("t.gltf", t.json.dump());
  EXPECT_EQ(corners_of(fan, 1), (std::vector<Vec3>{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}}));
  t.json["meshes"][0]["primitives"][0].erase("mode");
  EXPECT_EQ(warned(read("t.gltf", t.json.dump()), "left over"), 1u);
}

TEST_F(Gltf, DamageIsNamed) {
  const Triangle good;
  const auto expect = [&](auto change, const std::vector<std::string>& parts) {
    Triangle t = good;
    change(t);
    write("t.bin", t.bin());
    expect_failure("t.gltf", t.json.dump(), parts);
  };
  expect([](Triangle& t) { t.indices[1] = 3; },
         {"object \"house\", mesh 0, primitive 0", "index 1 names vertex 3", "there are 3"});
  expect([](Triangle& t) { t.positions[4] = NAN; },
         {"object \"house\"", "vertex 1 (4, nan, 6)", "not finite"});
  expect([](Triangle& t) { t.positions[8] = INFINITY; }, {"vertex 2", "not finite"});
  expect([](Triangle& t) { t.json["accessors"][0]["count"] = 4; },
         {"accessor 0", "beyond its bufferView 0"});
  expect([](Triangle& t) { t.json["accessors"][0]["count"] = 4000000000000; }, {"accessor 0"});
  expect([](Triangle& t) { t.json["accessors"][0]["type"] = "VEC2"; },
         {"accessor 0 must be a list of VEC3"});
  expect([](Triangle& t) { t.json["accessors"][1]["bufferView"] = 7; },
         {"accessor 1", "not in the file"});
  expect([](Triangle& t) { t.json["bufferViews"][1]["byteOffset"] = 37; },
         {"bufferView 1", "beyond its buffer"});
  expect([](Triangle& t) { t.json["buffers"][0]["byteLength"] = 43; },
         {"buffer 0", "42 bytes", "43", "cut off"});
  expect([](Triangle& t) { t.json["buffers"][0]["uri"] = "gone.bin"; },
         {"buffer 0", "gone.bin", "missing"});
  expect([](Triangle& t) { t.json["buffers"][0]["uri"] = "/etc/hostname"; },
         {"only files beside the model"});
  expect([](Triangle& t) { t.json["buffers"][0]["uri"] = "http://a/t.bin"; },
         {"only files beside the model"});
  expect([](Triangle& t) { t.json["nodes"][0]["children"] = {0}; }, {"node 0", "within itself"});
  expect([](Triangle& t) { t.json["nodes"][0]["mesh"] = 1; }, {"node 0", "no mesh 1"});
  expect([](Triangle& t) { t.json["nodes"][0]["scale"] = {1, 2}; }, {"node 0", "finite numbers"});
  expect([](Triangle& t) { t.json["scene"] = "hello"; }, {"\"scene\"", "is a text"});
  expect([](Triangle& t) { t.json["asset"]["version"] = "1.0"; }, {"version \"1.0\"", "convert"});
  expect([](Triangle& t) { t.json["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
         {"KHR_draco_mesh_compression", "export it without"});
  expect_failure("t.gltf", good.json.dump().substr(0, 300), {"JSON"});
}

TEST_F(Gltf, TooManyNodesWithinEachOtherAreAnErrorNotACrash) {
  Triangle t;
  write("t.bin", t.bin());
  t.json["nodes"] = Json::array();
  for (int k = 0; k < 100000; ++k) t.json["nodes"].push_back({{"children", {k + 1}}});
  t.json["nodes"].push_back({{"mesh", 0}});
  expect_failure("t.gltf", t.json.dump(), {"more than 1000 nodes"});
}

TEST_F(Gltf, EmptyScenesAreModelsWithoutPolygons) {
  EXPECT_TRUE(read("t.gltf", R"({"asset": {"version": "2.0"}})").polygons.empty());
  EXPECT_TRUE(read("t.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{}]})").polygons.empty());
}

TEST_F(Gltf, UpAndUnitAreTheFormatsOwn) {
  const Triangle t;
  write("t.bin", t.bin());
  const Model m = read("t.gltf", t.json.dump(), 'z', 0.001);
  EXPECT_EQ(corners_of(m, 0)[0], Vec3(1, -3, 2));
  EXPECT_EQ(warned(m, "--up was not used"), 1u);
  EXPECT_EQ(warned(m, "--unit was not used"), 1u);
}

TEST_F(Gltf, SkinsStandWhereTheirJointsAre) {
  const std::filesystem::path file = std::string(GNOMON_DATA) + "/animated/SimpleSkin.gltf";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: no " << file;
  const auto m = read_assimp(file, 0, 0);
  ASSERT_TRUE(m) << m.error().message;
  double low = 1e9, high = -1e9;
  for (const Vec3& v : m.value().vertices) {
    low = std::min(low, v.x);
    high = std::max(high, v.x);
  }
  EXPECT_EQ(low, -0.5);  // the mesh alone reaches from 0 to 1; its bones move it by -0.5
  EXPECT_EQ(high, 0.5);
  EXPECT_EQ(warned(m.value(), "Animations are not played"), 1u);
}

}  // namespace
}  // namespace gnomon
