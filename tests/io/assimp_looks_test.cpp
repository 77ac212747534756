// Looks and animations that come through Assimp.
#include <gnomon/io/animated_model.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>

#include "looks_files.h"

namespace gnomon {
namespace {

using namespace testing_files;

std::string source(const std::string& id, const std::string& numbers, int count, int stride,
                   const std::string& params) {
  const std::string n = std::to_string(count), all = std::to_string(count * stride);
  return "<source id=\"" + id + "\"><float_array id=\"" + id + "a\" count=\"" + all + "\">" +
         numbers + "</float_array><technique_common><accessor source=\"#" + id + "a\" count=\"" +
         n + "\" stride=\"" + std::to_string(stride) + "\">" + params +
         "</accessor></technique_common></source>";
}
const std::string kXyz = R"(<param name="X" type="float"/><param name="Y" type="float"/>)"
                         R"(<param name="Z" type="float"/>)";

// A triangle of 1 m with a material, whose node moves from x = 0 to 10 m in 2 s. z up, metres.
std::string collada() {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="m" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_images><image id="img"><init_from>four.png</init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON>
<newparam sid="surf"><surface type="2D"><init_from>img</init_from></surface></newparam>
<newparam sid="samp"><sampler2D><source>surf</source></sampler2D></newparam>
<technique sid="c"><phong>
<emission><color>0.1 0 0 1</color></emission>
<diffuse><texture texture="samp" texcoord="UV"/></diffuse>
<specular><color>0.3 0.4 0.5 1</color></specular><shininess><float>20</float></shininess>
</phong></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="mat" name="Brick"><instance_effect url="#e"/></material></library_materials>
<library_animations><animation>)" +
         source("in", "0 2", 2, 1, R"(<param name="TIME" type="float"/>)") +
         source("out", "0 0 0 10 0 0", 2, 3, kXyz) +
         R"(<source id="how"><Name_array id="howa" count="2">LINEAR LINEAR</Name_array>
<technique_common><accessor source="#howa" count="2" stride="1"><param name="INTERPOLATION" type="name"/></accessor></technique_common></source>
<sampler id="s"><input semantic="INPUT" source="#in"/><input semantic="OUTPUT" source="#out"/>
<input semantic="INTERPOLATION" source="#how"/></sampler>
<channel source="#s" target="n/move"/></animation></library_animations>
<library_geometries><geometry id="g" name="Wall"><mesh>)" +
         source("p", "0 0 0 1 0 0 0 0 1", 3, 3, kXyz) + source("nn", "0 -1 0", 1, 3, kXyz) +
         source("t", "0 0 1 0 0 0.75", 3, 2,
                R"(<param name="S" type="float"/><param name="T" type="float"/>)") +
         R"(<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="NORMAL" source="#nn" offset="1"/><input semantic="TEXCOORD" source="#t" offset="2" set="0"/>
<vcount>3</vcount><p>0 0 0 1 0 1 2 0 2</p></polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="sc" name="Town"><node id="n" name="House"><translate sid="move">0 0 0</translate>
<instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="m" target="#mat">
<bind_vertex_input semantic="UV" input_semantic="TEXCOORD" input_set="0"/></instance_material></technique_common></bind_material>
</instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#sc"/></scene></COLLADA>)";
}

TEST(AssimpLooks, MaterialsPicturesAndNormalsOfColladaComeAlong) {
  const Files files;
  files("four.png", png(four_colours()));
  const Scene scene = load({files("t.dae", collada())}, with_looks()).scene;
  ASSERT_EQ(scene.mesh.triangles.size(), 1u);
  const Material& brick = material_of(scene, 0);
  EXPECT_EQ(brick.name, "Brick");
  EXPECT_NEAR(brick.specular.y, 0.4, 1e-6);
  EXPECT_NEAR(brick.emissive.x, 0.1, 1e-6);
  EXPECT_EQ(brick.shininess, 20);
  EXPECT_EQ(brick.opacity, 1);
  ASSERT_EQ(brick.base_texture, 0);
  EXPECT_EQ(scene.appearance.textures[0].width, 2);
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec3 p = corner(scene, 0, c) + scene.frame.origin;
    const glm::vec2 uv = scene.appearance.uv[0][c];
    EXPECT_NEAR(double(uv.x), p.x, 1e-6);  // (0, 0), (1, 0) and (0, 0.75), counted from below
    EXPECT_NEAR(double(uv.y), 1 - 0.75 * p.z, 1e-6);
    EXPECT_NEAR(double(scene.appearance.normals[0][c].y), -1, 1e-6);
  }
}

TEST(AssimpLooks, NodesOfColladaMove) {
  const Files files;
  const auto path = files("t.dae", collada());
  LoadOptions options = without_ground();
  options.time = 0.5;
  const Scene scene = load({path}, options).scene;
  const Vec3 p = corner(scene, 0, 0) + scene.frame.origin;
  EXPECT_NEAR(p.x, 2.5, 1e-6);
  EXPECT_FALSE(warns(scene, "Animations are not played", 1));
  const auto model = open_animated(path);
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_NEAR(model.value().duration, 2, 1e-6);
  std::vector<Vec3> positions;
  model.value().pose(0.5, positions);
  EXPECT_NEAR(positions[model.value().mesh.triangles[0][0]].x, 2.5, 1e-6);
  EXPECT_NEAR(positions[model.value().mesh.triangles[0][0]].z, p.z, 1e-9);
  EXPECT_EQ(model.value().mesh.positions[model.value().mesh.triangles[0][0]].x, 0);
}

// The triangle (0, 0, 0), (1, 0, 0), (0, 0, 1) on two joints: Foot at the origin, Top at (0, 0, 1)
// on it, which moves to (0, 2, 1) in 2 s. The third vertex is Top's, the second half of each.
std::string skinned() {
  const std::string one = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 ",
                    down = "1 0 0 0 0 1 0 0 0 0 1 -1 0 0 0 1";
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="m" meter="1"/><up_axis>Z_UP</up_axis></asset><library_animations><animation id="wave">)" +
         source("in", "0 2", 2, 1, R"(<param name="TIME" type="float"/>)") +
         source("out", "0 0 1 0 2 1", 2, 3, kXyz) +
         R"(<source id="how"><Name_array id="howa" count="2">LINEAR LINEAR</Name_array>
<technique_common><accessor source="#howa" count="2" stride="1"><param name="INTERPOLATION" type="name"/></accessor></technique_common></source>
<sampler id="s"><input semantic="INPUT" source="#in"/><input semantic="OUTPUT" source="#out"/>
<input semantic="INTERPOLATION" source="#how"/></sampler>
<channel source="#s" target="Top/move"/></animation></library_animations>
<library_geometries><geometry id="g" name="Flag"><mesh>)" +
         source("p", "0 0 0 1 0 0 0 0 1", 3, 3, kXyz) +
         R"(<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>3</vcount><p>0 1 2</p></polylist>
</mesh></geometry></library_geometries>
<library_controllers><controller id="c"><skin source="#g">
<bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>
<source id="j"><Name_array id="ja" count="2">Foot Top</Name_array><technique_common>
<accessor source="#ja" count="2" stride="1"><param name="JOINT" type="name"/></accessor></technique_common></source>)" +
         source("b", one + down, 2, 16, R"(<param name="TRANSFORM" type="float4x4"/>)") +
         source("w", "1 0.5", 2, 1, R"(<param name="WEIGHT" type="float"/>)") +
         R"(<joints><input semantic="JOINT" source="#j"/><input semantic="INV_BIND_MATRIX" source="#b"/></joints>
<vertex_weights count="3"><input semantic="JOINT" source="#j" offset="0"/><input semantic="WEIGHT" source="#w" offset="1"/>
<vcount>1 2 1</vcount><v>0 0 0 1 1 1 1 0</v></vertex_weights></skin></controller></library_controllers>
<library_visual_scenes><visual_scene id="sc"><node id="Foot" name="Foot" sid="Foot" type="JOINT">
<node id="Top" name="Top" sid="Top" type="JOINT"><translate sid="move">0 0 1</translate></node></node>
<node id="n" name="Flag"><instance_controller url="#c"><skeleton>#Foot</skeleton></instance_controller></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#sc"/></scene></COLLADA>)";
}

TEST(AssimpLooks, BonesOfColladaBend) {
  const Files files;
  const auto path = files("t.dae", skinned());
  LoadOptions options = without_ground();
  options.time = 1.5;  // Top is at (0, 1.5, 1)
  const Scene scene = load({path}, options).scene;
  const std::vector<Vec3> wanted = {{0, 0, 0}, {1, 0.75, 0}, {0, 1.5, 1}};
  ASSERT_EQ(scene.mesh.triangles.size(), 1u);
  for (const Vec3& p : wanted) {
    bool found = false;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 q = corner(scene, 0, c) + scene.frame.origin - p;
      found = found || std::fabs(q.x) + std::fabs(q.y) + std::fabs(q.z) < 1e-6;
    }
    EXPECT_TRUE(found) << p.x << ' ' << p.y << ' ' << p.z;
  }
}

TEST(AssimpLooks, Md2HasNormalsAndCoordinatesOfItsOwn) {
  const auto file = std::filesystem::path(GNOMON_DATA) / "animated/MD2/faerie.md2";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  for (const bool moves : {false, true}) {
    LoadOptions options = with_looks();
    if (moves) options.time = 0.0;
    const Scene scene = load({file}, options).scene;
    ASSERT_EQ(scene.appearance.normals.size(), scene.mesh.triangles.size());
    // Normals look to the side the triangles face, but for a few at sharp folds.
    std::size_t away = 0;
    for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
      const Vec3 a = corner(scene, t, 1) - corner(scene, t, 0),
                 b = corner(scene, t, 2) - corner(scene, t, 0);
      const Vec3 n(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
      const glm::vec3& m = scene.appearance.normals[t][0];
      if (n.x * double(m.x) + n.y * double(m.y) + n.z * double(m.z) < 0) ++away;
    }
    EXPECT_LT(away, scene.mesh.triangles.size() / 20) << moves;
  }
}

TEST(AssimpLooks, SkinsOfMd2LieOnTheirTriangles) {
  const auto folder = std::filesystem::path(GNOMON_DATA) / "animated/MD2";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const auto bytes_of_file = [&](const char* name) {
    std::ifstream file(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const Files files;
  std::string bytes = bytes_of_file("faerie.md2");
  const auto at = [&](std::size_t k) {
    std::uint32_t n;
    std::memcpy(&n, bytes.data() + 4 * k, 4);
    return n;
  };
  const auto put = [&](std::size_t k, std::size_t value) {
    const auto n = static_cast<std::uint32_t>(value);
    std::memcpy(bytes.data() + 4 * k, &n, 4);
  };
  const auto two = [&](std::size_t offset) {
    std::uint16_t n;
    std::memcpy(&n, bytes.data() + offset, 2);
    return std::size_t(n);
  };
  // The file names no skin: one is put in at its end.
  put(5, 1), put(11, bytes.size());
  std::string name = "models/faerie2.bmp";
  name.resize(128, '\0');  // 64 bytes, and more: Assimp takes none that ends with the file
  bytes += name;
  put(16, bytes.size());
  files("faerie2.bmp", bytes_of_file("faerie2.bmp"));
  LoadOptions options = with_looks();
  options.time = 0.0;
  const Scene scene = load({files("f.md2", bytes)}, options).scene;
  const double width = at(2), height = at(3);
  ASSERT_EQ(scene.appearance.uv.size(), std::size_t(at(8)));
  EXPECT_GE(material_of(scene, 0).base_texture, 0);
  for (std::size_t t = 0; t < at(8); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {  // Assimp turns the corners around
      const std::size_t st = two(at(13) + 12 * t + 6 + 2 * (2 - c));
      const glm::vec2 uv = scene.appearance.uv[t][c];
      EXPECT_NEAR(double(uv.x), double(two(at(12) + 4 * st)) / width, 1e-6);
      EXPECT_NEAR(double(uv.y), double(two(at(12) + 4 * st + 2)) / height, 1e-6);
    }
  }
}

}  // namespace
}  // namespace gnomon
