// What Assimp itself reads: Collada, FBX, IFC, ...; and every mesh file of the data folders.
#include <gnomon/io/digits.h>
#include <gnomon/io/tried_apart.h>
#include <gnomon/scene/select.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <stdexcept>

#include "mesh_files.h"

namespace gnomon {
namespace {

using Assimp = MeshFiles;

std::string collada(const std::string& up, const std::string& positions, const std::string& indices,
                    const std::string& nodes) {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="cm" meter="0.01"/><up_axis>)" +
         up + R"(</up_axis></asset><library_geometries><geometry id="g" name="Wall"><mesh>
<source id="p"><float_array id="pa" count="12">)" +
         positions + R"(</float_array><technique_common><accessor source="#pa" count="4" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount><p>)" +
         indices + R"(</p></polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s" name="Town">)" +
         nodes +
         R"(</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

const std::string kPositions = "0 0 0 100 0 0 100 200 300 0 200 300", kIndices = "0 1 2 3";
const std::string kHouse =
    R"(<node id="n" name="House"><translate>1000 2000 3000</translate><instance_geometry url="#g"/></node>)";

TEST_F(Assimp, ColladaSaysItsUpAxisAndUnitAndIsTurnedOnce) {
  const Model z = read("t.dae", collada("Z_UP", kPositions, kIndices, kHouse));
  const Model y = read("t.dae", collada("Y_UP", kPositions, kIndices, kHouse));
  ASSERT_EQ(z.polygons.size(), 1u);
  ASSERT_EQ(corners_of(z, 0).size(), 4u);  // a polygon stays one
  const Vec3 in_z = corners_of(z, 0)[2], in_y = corners_of(y, 0)[2];
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(in_z[k], Vec3(11, 22, 33)[k], 1e-5);
    EXPECT_NEAR(in_y[k], Vec3(11, -33, 22)[k], 1e-5);
  }
  EXPECT_EQ(z.report.format, "Collada");
  EXPECT_EQ(z.surfaces[0].object, "Town/House");
}

TEST_F(Assimp, OneMeshUnderManyNodesStandsInAllPlaces) {
  const std::string row =
      R"(<node id="a" name="Row"><translate>0 0 1000</translate>
<node id="b" name="A"><instance_geometry url="#g"/></node>
<node id="c" name="B"><translate>500 0 0</translate><instance_geometry url="#g"/></node></node>)";
  const Model m = read("t.dae", collada("Z_UP", kPositions, kIndices, row));
  ASSERT_EQ(m.polygons.size(), 2u);
  std::set<std::string> names;
  for (const Surface& s : m.surfaces) names.insert(s.object);
  EXPECT_EQ(names, (std::set<std::string>{"Town/Row/A", "Town/Row/B"}));
  EXPECT_EQ(m.surfaces[0].whole, 4u);  // Town
  EXPECT_NEAR(corners_of(m, 0)[0].z, 10, 1e-6);
  EXPECT_NEAR(std::fabs(corners_of(m, 1)[0].x - corners_of(m, 0)[0].x), 5, 1e-6);
}

TEST_F(Assimp, ColladaInstancesOfWhatIsNotThereAreCounted) {
  const std::string more =
      R"(<node id="m" name="More"><instance_geometry url="#wing"/><instance_controller url="#rig"/>)"
      R"(<instance_node url='#tower'/><instance_node url="#n"/>)"
      R"(<!-- <instance_geometry url="#commented"/> --></node>)";
  const Model m = read("t.dae", collada("Z_UP", kPositions, kIndices, kHouse + more));
  EXPECT_GE(m.polygons.size(), 1u);
  ASSERT_EQ(warned(m, "Instances of what is not in the file"), 3u);
  EXPECT_TRUE(m.warnings[0].first.ends_with("t.dae: <instance_geometry url=\"#wing\">"))
      << m.warnings[0].first;
  const Model whole = read("t.dae", collada("Z_UP", kPositions, kIndices, kHouse));
  EXPECT_EQ(warned(whole, "Instances of what"), 0u);
}

TEST_F(Assimp, DigitsBeyondSinglePrecisionAreWarnedOf) {
  // 2684572.43 in single precision is 2684572.5: 0.07 of the file's centimetres are lost.
  const Model lost = read(
      "t.dae", collada("Z_UP", "2684572.43 0 0 100 0 0 100 200 300 0 200 300", kIndices, kHouse));
  ASSERT_EQ(warned(lost, "more digits than the single precision"), 1u);
  for (const Warning& w : lost.warnings) {
    if (w.what.find("more digits") != std::string::npos) {
      EXPECT_NE(w.what.find("0.0007 m"), std::string::npos) << w.what;
    }
  }
  const Model kept = read(
      "t.dae", collada("Z_UP", "2684572.5 0 0 100 0 0 100 200 300 0 200 300", kIndices, kHouse));
  EXPECT_EQ(warned(kept, "more digits"), 0u);
  // 0.0006 cm lost: 6 micrometres, not worth a word.
  const Model little = read(
      "t.dae", collada("Z_UP", "26845.724 0 0 100 0 0 100 200 300 0 200 300", kIndices, kHouse));
  EXPECT_EQ(warned(little, "more digits"), 0u);
  EXPECT_GT(lost_digits("26845.724").largest, 0.0);
}

// A chunk of 3DS: its number, its length with these 6 bytes, what is in it.
std::string chunk(std::uint16_t number, const std::string& content) {
  const auto length = static_cast<std::uint32_t>(content.size() + 6);
  return bytes_of<std::uint16_t>({number}) + bytes_of<std::uint32_t>({length}) + content;
}

TEST_F(Assimp, ThreeDsStandsUprightWithKeyFramesAndWithout) {
  const std::string name("House", 6);  // with its zero
  const std::string mesh =
      chunk(0x4110, bytes_of<std::uint16_t>({3}) + bytes_of<float>({0, 0, 0, 10, 8, 0, 0, 8, 6})) +
      chunk(0x4120, bytes_of<std::uint16_t>({1, 0, 1, 2, 7}));
  const std::string scene = chunk(0x3D3D, chunk(0x4000, name + chunk(0x4100, mesh)));
  const std::string frames =
      chunk(0xB000, chunk(0xB002, chunk(0xB010, name + bytes_of<std::uint16_t>({0, 0, 0xFFFF}))));
  for (const std::string& keys : {std::string(), frames}) {
    const Model m = read("t.3ds", chunk(0x4D4D, scene + keys));
    ASSERT_EQ(m.polygons.size(), 1u) << keys.size();
    const std::vector<Vec3> at = corners_of(m, 0);
    EXPECT_TRUE(std::count(at.begin(), at.end(), Vec3(10, 8, 0)) == 1 &&
                std::count(at.begin(), at.end(), Vec3(0, 8, 6)) == 1)
        << keys.size() << ": " << at[1].x << ' ' << at[1].y << ' ' << at[1].z;
  }
}

TEST(TriedApart, CrashesHangsAndHungerAreAnswersNotEnds) {
  const TrialLimits limits{1, std::uint64_t{1} << 30};
  EXPECT_EQ(tried_apart([] { return std::string(); }, limits), "");
  EXPECT_EQ(tried_apart([] { return std::string("no"); }, limits), "no");
  EXPECT_EQ(tried_apart([]() -> std::string { throw std::runtime_error("thrown"); }, limits),
            "thrown");
  EXPECT_EQ(tried_apart([]() -> std::string { std::abort(); }, limits), "its reader crashes on it");
  EXPECT_EQ(tried_apart(
                [] {
                  volatile bool always = true;
                  while (always) {
                  }
                  return std::string();
                },
                limits),
            "its reader does not come to an end with it");
#ifndef __SANITIZE_ADDRESS__
  EXPECT_EQ(tried_apart([] { return std::string(std::size_t{8} << 30, 'x'); }, limits),
            "std::bad_alloc");
#endif
}

TEST_F(Assimp, AFileThatItsReaderAbortsOnIsAnError) {
  // An empty zip archive: the reader of 3MF asserts that there is a model in it.
  expect_failure("t.3mf", std::string("PK\5\6") + std::string(18, '\0'), {"cannot be read as 3MF"});
}

TEST(Digits, AreLostWhereMoreThanHalfAUnitOfTheLastOneIs) {
  EXPECT_EQ(lost_digits("0.1 0.100000001 1e3 -0 16777216 12345.6").numbers, 0u);
  EXPECT_EQ(lost_digits("16777217").numbers, 1u);
  EXPECT_EQ(lost_digits("16777217").largest, 1.0);
  EXPECT_EQ(lost_digits("1.6777217e7").numbers, 1u);
  EXPECT_EQ(lost_digits("1.67772171e6").numbers, 1u);  // kept as 1677721.75
  EXPECT_EQ(lost_digits("1677721.8").numbers, 0u);     // kept as 1677721.75: half a unit, not more
  EXPECT_EQ(lost_digits("IFC(2684572.43,0.)").numbers, 1u);
  EXPECT_EQ(
      lost_digits_of_ifc("#1=IFCCARTESIANPOINT((2684572.43,0.));#2=IFCREAL(16777217.);").numbers,
      1u);
}

TEST(Digits, NineSignificantDigitsOfAFloatAreNeverLost) {
  std::uint32_t state = 1;
  for (int k = 0; k < 20000; ++k) {
    state = state * 1664525u + 1013904223u;
    float f;
    std::memcpy(&f, &state, sizeof f);
    if (!std::isfinite(f)) continue;
    char text[64];
    std::snprintf(text, sizeof text, "%.9g", double(f));
    EXPECT_EQ(lost_digits(text).numbers, 0u) << text;
  }
}

std::string fbx(int up, int front, int front_sign, double unit) {
  const auto setting = [](const std::string& name, const std::string& value) {
    return "P: \"" + name + "\", \"int\", \"Integer\", \"\"," + value + "\n";
  };
  return "; FBX 7.3.0 project file\nFBXHeaderExtension: {\nFBXHeaderVersion: 1003\nFBXVersion: "
         "7300\n}\n"
         "GlobalSettings: {\nVersion: 1000\nProperties70: {\n" +
         setting("UpAxis", std::to_string(up)) + setting("UpAxisSign", "1") +
         setting("FrontAxis", std::to_string(front)) +
         setting("FrontAxisSign", std::to_string(front_sign)) + setting("CoordAxis", "0") +
         setting("CoordAxisSign", "1") + "P: \"UnitScaleFactor\", \"double\", \"Number\", \"\"," +
         std::to_string(unit) +
         "\n}\n}\nDefinitions: {\nVersion: 100\nCount: 2\nObjectType: \"Geometry\" {\nCount: 1\n}\n"
         "ObjectType: \"Model\" {\nCount: 1\n}\n}\nObjects: {\n"
         "Geometry: 1000, \"Geometry::Plane\", \"Mesh\" {\nVertices: *12 {\na: "
         "0,0,0,1,0,0,1,2,3,0,2,3\n}\n"
         "PolygonVertexIndex: *4 {\na: 0,1,2,-4\n}\nGeometryVersion: 124\n}\n"
         "Model: 2000, \"Model::House\", \"Mesh\" {\nVersion: 232\nProperties70: {\n"
         "P: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",10,20,30\n}\nCulling: "
         "\"CullingOff\"\n}\n}\n"
         "Connections: {\nC: \"OO\",2000,0\nC: \"OO\",1000,2000\n}\n";
}

TEST_F(Assimp, FbxAxesAndUnitAreApplied) {
  const Model z = read("t.fbx", fbx(2, 1, -1, 100));  // metres, z up
  const Model y = read("t.fbx", fbx(1, 2, 1, 1));     // centimetres, y up
  ASSERT_EQ(z.polygons.size(), 1u);
  EXPECT_EQ(corners_of(z, 0)[2], Vec3(11, 22, 33));
  EXPECT_EQ(corners_of(y, 0)[2], Vec3(11, -33, 22) * 0.01);
  EXPECT_EQ(z.surfaces[0].object, "House");
}

TEST_F(Assimp, NonsenseIsRefusedInWordsOfOurs) {
  for (const char* name : {"t.dae", "t.fbx", "t.3ds", "t.md2", "t.ifc", "t.lwo", "t.x", "t.smd",
                           "t.3mf", "t.b3d", "t.ms3d", "t.md5mesh", "t.zae", "t.amf", "t.md3"}) {
    SCOPED_TRACE(name);
    expect_failure(name, "this is not a model at all, but long enough to be one, who knows", {});
  }
  expect_failure("t.dae", "<COLLADA>", {"cannot be read as Collada", "export it again"});
  expect_failure("t.dae", "", {"empty"});
}

TEST_F(Assimp, IndicesAndNumbersThatCannotBeAreErrors) {
  expect_failure("t.dae", collada("Z_UP", kPositions, "0 1 2 4", kHouse), {});
  expect_failure("t.dae",
                 collada("Z_UP", "0 0 0 100 nan 0 100 200 300 0 200 300", kIndices, kHouse), {});
}

TEST(AssimpFiles, AreKnownByTheirExtension) {
  for (const char* name : {"a.glb", "a.GLTF", "a.ply", "a.STL", "a.off", "a.dae", "a.3ds", "a.fbx",
                           "a.ifc", "a.md2"}) {
    EXPECT_TRUE(is_assimp_file(name)) << name;
  }
  for (const char* name : {"a.obj", "a.json", "a.jsonl", "a.png", "a.tif", "a.txt", "a.xml",
                           "a.raw", "a.ase", "a.x3d", "a", "glb"}) {
    EXPECT_FALSE(is_assimp_file(name)) << name;
  }
}

std::filesystem::path data(const std::string& name) {
  return std::filesystem::path(GNOMON_DATA) / name;
}

TEST(AssimpData, IfcStandsUprightInMetresWithoutItsSpacesAndOpenings) {
  const auto file = data("ifc/AC14-FZK-Haus.ifc");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: no " << file;
  const auto read = read_assimp(file, 0, 0);
  ASSERT_TRUE(read) << read.error().message;
  const Model& m = read.value();
  Vec3 low(1e9), high(-1e9);
  for (const Vec3& v : m.vertices) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], v[k]);
      high[k] = std::max(high[k], v[k]);
    }
  }
  EXPECT_NEAR(low.x, -3, 1e-4);  // the terrain, 18 m by 16 m, with 12 m by 10 m of house on it
  EXPECT_NEAR(high.x, 15, 1e-4);
  EXPECT_NEAR(low.y, -3, 1e-4);
  EXPECT_NEAR(high.y, 13, 1e-4);
  EXPECT_NEAR(high.z, 6.3177, 1e-3);  // the ridge
  std::size_t walls = 0;
  for (const Surface& s : m.surfaces) {
    EXPECT_FALSE(glob_matches("IfcSpace*", s) || glob_matches("IfcOpening*", s)) << s.object;
    EXPECT_TRUE(s.object.starts_with(s.group + "_")) << s.object;
    if (glob_matches("IfcWall*", s)) ++walls;
  }
  EXPECT_GT(walls, 0u);
  EXPECT_EQ(m.warnings.size(), 1u);
  EXPECT_EQ(warned(m, "IFC spaces"), 24u);  // 17 openings and 7 spaces
}

TEST(AssimpData, EveryFileLoadsOrSaysWhyNot) {
  const std::set<std::string> refused = {"invalid.off",
                                         "empty.off",
                                         "empty.ply",
                                         "empty.3ds",

                                         "empty.lwo",
                                         "empty.x",
                                         "empty.smd",
                                         "empty.md5mesh",
                                         "OutOfMemory.off",
                                         "issue623.ply",
                                         "sceneWrongType.gltf",
                                         "badArray.gltf",
                                         "IndexOutOfRange.gltf",
                                         "AllIndicesOutOfRange.gltf",
                                         "RecursiveNodes.gltf",
                                         "BoxWithInfinites.glb",
                                         "BoxTextured.gltf"};
  std::size_t seen = 0;
  for (const char* folder : {"architecture", "animated", "hard", "malformed"}) {
    if (!std::filesystem::exists(data(folder))) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(data(folder))) {
      // empty.ply and empty.stl of "hard" have a header and no more: models without polygons.
      if (!entry.is_regular_file() || !is_assimp_file(entry.path())) continue;
      ++seen;
      const auto m = read_assimp(entry.path(), 0, 0);
      const bool expected = !(refused.contains(entry.path().filename().string()) &&
                              std::string(folder) == "malformed");
      EXPECT_EQ(static_cast<bool>(m), expected) << entry.path();
      if (!m) {
        EXPECT_TRUE(m.error().message.starts_with(entry.path().string() + ": "))
            << m.error().message;
        EXPECT_TRUE(m.error().message.ends_with('.')) << m.error().message;
        continue;
      }
      for (const Vec3& v : m.value().vertices) {
        ASSERT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) << entry.path();
      }
      for (const std::uint32_t c : m.value().corners) ASSERT_LT(c, m.value().vertices.size());
    }
  }
  if (seen == 0) GTEST_SKIP() << "skipped: no models in " << GNOMON_DATA;
}

}  // namespace
}  // namespace gnomon
