// Looks of OBJ files, from the file to the scene: each corner keeps what is its own.
#include <gnomon/mesh/weld.h>

#include <cmath>

#include "looks_files.h"

namespace gnomon {
namespace {

using namespace testing_files;

const std::string kMtl =
    "# a library\nnewmtl wall\nKd 0.5 0.25 0.125\nKs 0.3 0.2 0.1\nNs 32\nKe 0 0.1 0\nd 0.75\n"
    "map_Kd four.png\nnewmtl glass\nTr 0.9\nKd 0.1\n";

// A concave pentagon with a hole's worth of trouble: its vertices' uv is (x / 10, 1 - y / 10), so
// that v counted downwards is y / 10; then a quad on the same vertices with uv of its own.
const std::string kObj2 =
    "mtllib house.mtl\no House\n"
    "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 5 2 0\nv 0 10 0\nv 0 0 5\nv 10 0 5\n"
    "vt 0 1\nvt 1 1\nvt 1 0\nvt 0.5 0.8\nvt 0 0\nvt 0.25 0.5\n"
    "vn 0 0 2\nvn 0 -1 0\n"
    "f 1 2 6\nusemtl wall\nf 1/1/1 2/2/1 3/3/1 4/4/1 5/5/1\n"
    "usemtl glass\nf 1/6/2 6/6/2 7/6/2 2/6/2\nf 1 2 2\n";

TEST(ObjLooks, MaterialsComeFromTheLibrary) {
  const Files files;
  files("house.mtl", kMtl);
  files("four.png", png(four_colours()));
  LoadOptions options = with_looks();
  options.up = 'z';
  const Scene scene = load({files("house.obj", kObj2)}, options).scene;
  ASSERT_EQ(scene.appearance.materials.size(), 2u);
  const Material& wall = scene.appearance.materials[0];
  EXPECT_EQ(wall.name, "wall");
  EXPECT_EQ(wall.base_colour, Vec3(0.5, 0.25, 0.125));
  EXPECT_EQ(wall.specular, Vec3(0.3, 0.2, 0.1));
  EXPECT_EQ(wall.emissive, Vec3(0, 0.1, 0));
  EXPECT_EQ(wall.shininess, 32);
  EXPECT_EQ(wall.opacity, 0.75);
  ASSERT_EQ(wall.base_texture, 0);
  EXPECT_EQ(scene.appearance.textures[0].rgba[0], 255);
  const Material& glass = scene.appearance.materials[1];
  EXPECT_EQ(glass.base_colour, Vec3(0.1));
  EXPECT_NEAR(glass.opacity, 0.1, 1e-15);
  EXPECT_EQ(glass.base_texture, -1);
}

TEST(ObjLooks, CornersKeepTheirUvAndNormalsThroughTriangulationAndWelding) {
  const Files files;
  files("house.mtl", kMtl);
  files("four.png", png(four_colours()));
  LoadOptions options = with_looks();
  options.up = 'z';
  options.ground = "-1";
  const Scene scene = load({files("house.obj", kObj2)}, options).scene;
  const Appearance& looks = scene.appearance;
  const std::size_t n = scene.mesh.triangles.size();
  ASSERT_EQ(looks.material_of.size(), n);
  ASSERT_EQ(looks.uv.size(), n);
  ASSERT_EQ(looks.normals.size(), n);
  ASSERT_EQ(looks.materials.back().name, "made ground");
  const auto ground = static_cast<std::uint32_t>(looks.materials.size() - 1);
  std::size_t walls = 0, glasses = 0, none = 0, made = 0;
  for (std::size_t t = 0; t < n; ++t) {
    if (looks.material_of[t] == kNoMaterial || looks.material_of[t] == ground) {
      ++(looks.material_of[t] == ground ? made : none);
      EXPECT_EQ(looks.normals[t][0], glm::vec3(0));
      continue;
    }
    const bool wall = looks.material_of[t] == 0;
    ++(wall ? walls : glasses);
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 p = corner(scene, t, c) + scene.frame.origin;
      const glm::vec2 uv = looks.uv[t][c];
      EXPECT_FLOAT_EQ(uv.x, wall ? float(p.x) / 10 : 0.25f);
      EXPECT_FLOAT_EQ(uv.y, wall ? float(p.y) / 10 : 0.5f);
      EXPECT_EQ(looks.normals[t][c], wall ? glm::vec3(0, 0, 1) : glm::vec3(0, -1, 0));
    }
  }
  EXPECT_EQ(walls, 3u);
  EXPECT_EQ(glasses, 2u);
  EXPECT_EQ(none, 1u);  // the one without area went
  EXPECT_GE(made, 2u);
}

TEST(ObjLooks, AreNothingWhereNobodyAsks) {
  const Files files;
  LoadOptions options = without_ground();
  options.up = 'z';
  const Scene scene = load({files("house.obj", kObj2)}, options).scene;
  EXPECT_TRUE(scene.appearance.materials.empty() && scene.appearance.textures.empty() &&
              scene.appearance.material_of.empty() && scene.appearance.uv.empty() &&
              scene.appearance.normals.empty());
  EXPECT_FALSE(warns(scene, "Libraries of materials", 1));
}

TEST(ObjLooks, ChangeNoTriangle) {
  const Files files;
  files("house.mtl", kMtl);
  LoadOptions options = with_looks();
  const auto path = files("house.obj", kObj2);
  const Scene looks = load({path}, options).scene;
  options.appearance = false;
  const Scene plain = load({path}, options).scene;
  EXPECT_EQ(looks.mesh.positions, plain.mesh.positions);
  EXPECT_EQ(looks.mesh.triangles, plain.mesh.triangles);
  EXPECT_EQ(looks.surface_of, plain.surface_of);
}

TEST(ObjLooks, FilesOfOneSceneKeepTheirOwn) {
  const Files files;
  files("house.mtl", kMtl);
  files("other.mtl", "newmtl wall\nKd 1 0 0\nmap_Kd one.png\n");
  files("four.png", png(four_colours()));
  files("one.png", png({1, 1, {{9, 8, 7}}}));
  const auto plain = files("plain.stl",
                           "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 9\n"
                           "vertex 1 0 9\nvertex 0 1 9\nendloop\nendfacet\nendsolid\n");
  const auto other = files("other.obj",
                           "mtllib other.mtl\nusemtl wall\nv 20 0 0\nv 21 0 0\nv 20 1 0\nvt 0 0\n"
                           "f 1/1 2/1 3/1\n");
  LoadOptions options = with_looks();
  options.up = 'z';
  const Scene scene = load({plain, files("house.obj", kObj2), other}, options).scene;
  const Appearance& looks = scene.appearance;
  ASSERT_EQ(looks.material_of.size(), scene.mesh.triangles.size());
  ASSERT_EQ(looks.textures.size(), 2u);
  EXPECT_EQ(looks.material_of.front(), kNoMaterial);
  const Material& last = material_of(scene, scene.mesh.triangles.size() - 1);
  EXPECT_EQ(last.base_colour, Vec3(1, 0, 0));
  EXPECT_EQ(looks.textures.at(std::size_t(last.base_texture)).rgba[1], 8);
  EXPECT_EQ(looks.material_of[1], kNoMaterial);
  EXPECT_EQ(material_of(scene, 2).base_colour, Vec3(0.5, 0.25, 0.125));
}

TEST(ObjLooks, NormalsTurnWithAModelAtItsSite) {
  const Files files;
  const std::string tower =
      "v 0 0 0\nv 1 0 0\nv 0 0 1\nvn 0 -1 0\nf 1//1 2//1 3//1\n";  // faces south
  LoadOptions options = with_looks();
  options.for_files.push_back({.file = "tower.obj",
                               .up = 'z',
                               .north = 0.5,
                               .site = Site({48.2 * kDegree, 16.37 * kDegree, 0})});
  const Scene scene =
      load({files("a.city.json", box("EPSG:31256", "[2400,340500,40]")), files("tower.obj", tower)},
           options)
          .scene;
  const std::size_t t = scene.mesh.triangles.size() - 1;
  const Vec3 a = corner(scene, t, 0), b = corner(scene, t, 1);
  const double turn = -std::atan2(b.y - a.y, b.x - a.x);  // clockwise
  EXPECT_NEAR(turn, -0.5, 0.02);
  const glm::vec3 n = scene.appearance.normals[t][0];
  EXPECT_NEAR(n.x, -std::sin(turn), 1e-6);
  EXPECT_NEAR(n.y, -std::cos(turn), 1e-6);
}

TEST(ObjLooks, WhatIsMissingIsCountedAndNoError) {
  const Files files;
  std::filesystem::create_directories(files.folder / "in");
  files("secret.png", png(four_colours()));
  files("in/house.mtl",
        "newmtl wall\nKd x 0 0\nmap_Kd ../secret.png\nmap_Ks gone.png\nnewmtl glass\nmap_Kd "
        "C:\\pictures\\here.png\nmap_Bump grey.png\n");
  files("in/here.png", png(four_colours()));
  files("in/grey.png", png({1, 1, {{5, 5, 5}}}));
  const Scene scene = load({files("in/house.obj", kObj2 + "f 1/99 2/1 6/1\n")}, with_looks()).scene;
  EXPECT_TRUE(warns(scene, "Pictures on surfaces were left out", 1));
  EXPECT_TRUE(warns(scene, "no numbers", 1));
  EXPECT_TRUE(warns(scene, "Maps of materials but of the base colour", 1));
  EXPECT_TRUE(warns(scene, "Bump maps that hold heights", 1));
  EXPECT_TRUE(warns(scene, "texture coordinates (vt) that are not in the file", 1));
  EXPECT_EQ(scene.appearance.materials[0].base_texture, -1);
  EXPECT_EQ(scene.appearance.materials[1].base_texture, 0);
  EXPECT_EQ(scene.appearance.materials[1].base_colour, Vec3(1));  // the picture's alone

  const Scene bare = load({files("bare.obj", kObj2)}, with_looks()).scene;
  EXPECT_TRUE(warns(bare, "Libraries of materials (.mtl) were not found", 1));
}

TEST(ObjLooks, MapsMayHaveOptionsAndBlanksInTheirNames) {
  const Files files;
  files("the house.mtl",
        "newmtl wall\nmap_Kd -clamp on -mm 0 1 my four #1.png\nbump -bm 0.5 normals.png\n");
  files("my four #1.png", png(four_colours()));
  files("normals.png", png({1, 1, {{128, 128, 255}}}));
  const Scene scene = load({files("t.obj",
                                  "mtllib the house.mtl\nusemtl wall\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                  "f 1 2 3\n")},
                           with_looks())
                          .scene;
  const Material& wall = material_of(scene, 0);
  ASSERT_GE(wall.base_texture, 0);
  EXPECT_EQ(scene.appearance.textures[std::size_t(wall.base_texture)].edge_u, TextureEdge::clamp);
  ASSERT_GE(wall.normal_texture, 0);
  EXPECT_EQ(wall.normal_scale, 0.5);
}

}  // namespace
}  // namespace gnomon
