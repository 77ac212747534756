// A model that is posed again and again stands as load_scene puts it at each time.
#include <gnomon/io/animated_model.h>

#include <algorithm>
#include <cmath>

#include "looks_files.h"

namespace gnomon {
namespace {

using namespace testing_files;

const std::filesystem::path kAnimated = std::filesystem::path(GNOMON_DATA) / "animated";

AnimatedModel open(const std::filesystem::path& path, const AnimatedOptions& options = {}) {
  auto model = open_animated(path, options);
  if (!model) {
    ADD_FAILURE() << model.error().message;
    return {};
  }
  return std::move(model).value();
}

bool before(const Vec3& a, const Vec3& b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

// Corners of all triangles in their order; the origin, in whole metres, is put back.
std::vector<Vec3> corners_of(const TriMesh& mesh, const std::vector<Vec3>& positions,
                             const Vec3& origin = Vec3(0)) {
  std::vector<Vec3> out;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) out.push_back(positions[v] + origin);
  }
  return out;
}

void expect_same_as_scene(const std::filesystem::path& path, const std::string& animation,
                          const std::vector<double>& times) {
  const AnimatedModel model = open(path, {.animation = animation});
  const std::size_t triangles = model.mesh.triangles.size();
  std::vector<Vec3> positions;
  for (const double time : times) {
    LoadOptions options = without_ground();
    options.time = time;
    options.animation = animation;
    const Scene scene = load({path}, options).scene;
    model.pose(time, positions);
    ASSERT_EQ(positions.size(), model.mesh.positions.size());
    ASSERT_EQ(scene.mesh.triangles.size(), triangles) << "all have an area at these times";
    const std::vector<Vec3> wanted =
        corners_of(scene.mesh, scene.mesh.positions, scene.frame.origin);
    const std::vector<Vec3> found = corners_of(model.mesh, positions);
    for (std::size_t k = 0; k < found.size(); ++k) {
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(found[k][c], wanted[k][c], 1e-12) << time;
    }
  }
}

TEST(AnimatedModel, PosesAreThoseOfLoadScene) {
  if (!std::filesystem::exists(kAnimated)) GTEST_SKIP() << kAnimated << " is not there";
  expect_same_as_scene(kAnimated / "SimpleSkin.gltf", "", {0, 0.25, 1, 5.4, 7});
  expect_same_as_scene(kAnimated / "AnimatedMorphCube.gltf", "", {0, 0.7, 2.05, 4.1, 9});
  expect_same_as_scene(kAnimated / "Fox.glb", "Run", {0, 0.3, 0.61, 5});
  expect_same_as_scene(kAnimated / "MD2" / "faerie.md2", "run", {0, 0.17, 0.58, 3});
}

TEST(AnimatedModel, HandsOutRestDurationAndNames) {
  if (!std::filesystem::exists(kAnimated)) GTEST_SKIP() << kAnimated << " is not there";
  const AnimatedModel fox = open(kAnimated / "Fox.glb", {.animation = "Walk", .appearance = true});
  EXPECT_EQ(fox.animations, (std::vector<std::string>{"Survey", "Walk", "Run"}));
  EXPECT_EQ(fox.animation, 1u);
  EXPECT_NEAR(fox.duration, 0.7083, 1e-3);
  EXPECT_EQ(fox.appearance.material_of.size(), fox.mesh.triangles.size());
  EXPECT_EQ(fox.appearance.uv.size(), fox.mesh.triangles.size());
  const Scene rest = load({kAnimated / "Fox.glb"}, without_ground()).scene;
  EXPECT_EQ(fox.mesh.positions.size(), rest.mesh.positions.size());  // one vertex at each place
  std::vector<Vec3> a = fox.mesh.positions, b;
  for (const Vec3& p : rest.mesh.positions) b.push_back(p + rest.frame.origin);
  std::sort(a.begin(), a.end(), before);
  std::sort(b.begin(), b.end(), before);
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k].z, b[k].z, 1e-12);
  const AnimatedModel faerie = open(kAnimated / "MD2" / "faerie.md2", {.animation = "run"});
  EXPECT_NEAR(faerie.duration, 0.6, 1e-12);
  EXPECT_EQ(faerie.animations.front(), "stand");
}

TEST(AnimatedModel, NormalsTurnWithTheShape) {
  const auto file = kAnimated / "AnimatedMorphCube.gltf";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const AnimatedModel cube = open(file, {.appearance = true});
  std::vector<Vec3> positions;
  std::vector<std::array<glm::vec3, 3>> normals;
  cube.pose(0, positions, normals);
  ASSERT_EQ(normals.size(), cube.mesh.triangles.size());
  for (std::size_t t = 0; t < normals.size(); ++t) {  // at 0 it is a box: facets' own normals
    const Triangle& v = cube.mesh.triangles[t];
    const Vec3 a = positions[v[1]] - positions[v[0]], b = positions[v[2]] - positions[v[0]];
    const Vec3 n(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    const double length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    for (const glm::vec3& m : normals[t]) {
      const double cosine = (n.x * double(m.x) + n.y * double(m.y) + n.z * double(m.z)) / length;
      EXPECT_NEAR(cosine, 1, 1e-5);
    }
    EXPECT_EQ(normals[t], cube.appearance.normals[t]);
  }
}

// Two triangles that share an edge, each a mesh under a node of its own; the second node moves.
const char* kHinge =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2]}],
"nodes":[{"mesh":0},{"mesh":1},{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]},{"primitives":[{"attributes":{"POSITION":1}}]}],
"animations":[{"channels":[{"sampler":0,"target":{"node":1,"path":"translation"}}],
"samplers":[{"input":2,"output":3}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":0,"byteOffset":12,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":0,"byteOffset":48,"componentType":5126,"count":2,"type":"SCALAR"},
{"bufferView":0,"byteOffset":56,"componentType":5126,"count":2,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteLength":80}],"buffers":[{"byteLength":80,"uri":"hinge.bin"}]})";

TEST(AnimatedModel, VerticesAreOneOnlyWhereTheyMoveTogether) {
  const Files files;
  const std::vector<float> numbers = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 1, 0, 0, 0, 0, 5, 0};
  files("hinge.bin", std::string(reinterpret_cast<const char*>(numbers.data()), 80));
  const AnimatedModel m = open(files("hinge.gltf", kHinge));
  EXPECT_EQ(m.mesh.triangles.size(), 3u);
  EXPECT_EQ(m.mesh.positions.size(), 9u);  // at rest there are 4 places
  EXPECT_EQ(m.animations, (std::vector<std::string>{"0"}));
  std::vector<Vec3> positions;
  m.pose(0.5, positions);
  const auto at = [&](std::size_t t, std::size_t c) { return positions[m.mesh.triangles[t][c]]; };
  EXPECT_EQ(at(0, 1), Vec3(1, 0, 0));
  EXPECT_EQ(at(1, 0), Vec3(1, 0, 2.5));
}

TEST(AnimatedModel, WhatCannotBePlayedSaysSo) {
  const Files files;
  const auto obj = open_animated(files("tower.obj", kObj));
  ASSERT_FALSE(obj);
  EXPECT_NE(obj.error().message.find("never animated"), std::string::npos);
  EXPECT_FALSE(open_animated(files.folder / "gone.glb"));
  std::string still = kHinge;
  still.erase(still.find("\"animations\""),
              still.find("\"accessors\"") - still.find("\"animations\""));
  files("hinge.bin", std::string(80, '\0'));
  const auto empty = open_animated(files("still.gltf", still));
  ASSERT_FALSE(empty);  // all vertices at one place, and move together
  const std::vector<float> numbers = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 1, 0, 0, 0, 0, 5, 0};
  files("hinge.bin", std::string(reinterpret_cast<const char*>(numbers.data()), 80));
  const AnimatedModel stands = open(files("still.gltf", still));
  EXPECT_EQ(stands.duration, 0);
  ASSERT_FALSE(stands.warnings.empty());
  EXPECT_NE(stands.warnings.back().what.find("no animations"), std::string::npos);
  std::vector<Vec3> positions;
  stands.pose(7, positions);
  EXPECT_EQ(positions, stands.mesh.positions);
}

}  // namespace
}  // namespace gnomon
