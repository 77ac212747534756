// Models at a time, against values computed from the files' own numbers.
#include <gnomon/mesh/edge_table.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <numbers>

#include "looks_files.h"

namespace gnomon {
namespace {

using namespace testing_files;

const std::filesystem::path kAnimated = std::filesystem::path(GNOMON_DATA) / "animated";

#define SKIP_WITHOUT(file) \
  if (!std::filesystem::exists(file)) GTEST_SKIP() << (file) << " is not there"

LoadOptions at_time(double seconds, const std::string& animation = "") {
  LoadOptions options = without_ground();
  options.time = seconds;
  options.animation = animation;
  return options;
}

// Nothing but the nearest vertex counts: order and welding are not the animation's business.
bool has_vertex(const Scene& scene, const Vec3& p, double within) {
  return std::any_of(scene.mesh.positions.begin(), scene.mesh.positions.end(), [&](const Vec3& v) {
    const Vec3 q = v + scene.frame.origin;
    return std::fabs(q.x - p.x) <= within && std::fabs(q.y - p.y) <= within &&
           std::fabs(q.z - p.z) <= within;
  });
}

void expect_vertices(const Scene& scene, const std::vector<Vec3>& wanted, double within) {
  for (const Vec3& p : wanted) {
    EXPECT_TRUE(has_vertex(scene, p, within)) << p.x << ' ' << p.y << ' ' << p.z;
  }
}

bool is_closed(const Scene& scene) {
  const EdgeTable edges = build_edge_table(scene.mesh);
  for (std::size_t e = 0; e < edges.vertices.size(); ++e) {
    if ((edges.first[e + 1] - edges.first[e]) % 2 != 0) return false;
  }
  return true;
}

std::string bytes_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

template <class T>
T number(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// SimpleSkin.gltf: joint 1 moves by (0, 1, 0), joint 2 stands on it and turns around z; both
// inverse matrices move by (-0.5, -1, 0). A vertex (x, y) of weights 1 - w, w goes to
// (1 - w) (x - 0.5, y) + w ((0, 1) + turned (x - 0.5, y - 1)); glTF's y is our z.
std::vector<Vec3> simple_skin(double angle) {
  std::vector<Vec3> out;
  const double c = std::cos(angle), s = std::sin(angle);
  for (int row = 0; row < 5; ++row) {
    const double y = 0.5 * row, w = 0.25 * row;
    for (const double x : {0.0, 1.0}) {
      const double u = x - 0.5, v = y - 1;
      out.emplace_back((1 - w) * u + w * (c * u - s * v), 0, (1 - w) * y + w * (1 + s * u + c * v));
    }
  }
  return out;
}

TEST(Animation, SimpleSkinStandsWhereItsMatricesPutIt) {
  const auto file = kAnimated / "SimpleSkin.gltf";
  SKIP_WITHOUT(file);
  // At 1 s the joint is turned by 90 degrees: the vertex (0, 2), all joint 2's, is at (-1, 0.5).
  const Scene quarter = load({file}, at_time(1)).scene;
  expect_vertices(quarter, simple_skin(std::numbers::pi / 2), 1e-12);
  expect_vertices(quarter, {{-1, 0, 0.5}, {0.25, 0, 1.25}, {-0.5, 0, 0}}, 1e-12);
  EXPECT_EQ(quarter.mesh.positions.size(), 10u);
  // Half way between the keys at 0 (no turn) and 0.5: half of that turn's angle.
  const double key = 2 * std::atan2(double(0.383f), double(0.924f));
  expect_vertices(load({file}, at_time(0.25)).scene, simple_skin(key / 2), 1e-12);
  // A quarter of the way from there to the key at 1 s, and on the other side at 4.25.
  expect_vertices(load({file}, at_time(0.625)).scene,
                  simple_skin(key + (std::numbers::pi / 2 - key) / 4), 1e-12);
  expect_vertices(load({file}, at_time(4.25)).scene, simple_skin(-std::numbers::pi / 2), 1e-12);
}

TEST(Animation, TimesBeyondTheEndGoRound) {
  const auto file = kAnimated / "SimpleSkin.gltf";
  SKIP_WITHOUT(file);
  const Scene first = load({file}, at_time(1)).scene;
  EXPECT_EQ(load({file}, at_time(5.5 + 1)).scene.mesh.positions, first.mesh.positions);
  EXPECT_EQ(load({file}, at_time(11 * 5.5 + 1)).scene.mesh.positions, first.mesh.positions);
  expect_vertices(load({file}, at_time(5.5)).scene, simple_skin(0), 1e-12);
}

TEST(Animation, MorphTargetsHaveTheWeightsOfTheTime) {
  const auto file = kAnimated / "AnimatedMorphCube.gltf";
  SKIP_WITHOUT(file);
  const std::string bin = bytes_of_file(kAnimated / "AnimatedMorphCube.bin");
  const auto vectors = [&](std::size_t at, std::size_t k) {
    return Vec3(number<float>(bin, at + 12 * k), number<float>(bin, at + 12 * k + 4),
                number<float>(bin, at + 12 * k + 8));
  };
  // Key 61 and half way to 62. The node turns by 180 degrees around (0, 1, -1) and is 100 times as
  // large: (x, y, z) goes to 100 (-x, -z, -y), which is our 100 (-x, y, -z).
  const double before = number<float>(bin, 2760 + 4 * 61),
               after = number<float>(bin, 2760 + 4 * 62);
  for (const double part : {0.0, 0.5}) {
    double w[2];
    for (std::size_t t = 0; t < 2; ++t) {
      const double a = number<float>(bin, 3268 + 4 * (2 * 61 + t)),
                   b = number<float>(bin, 3268 + 4 * (2 * 62 + t));
      w[t] = a + part * (b - a);
    }
    if (part == 0) {
      EXPECT_NEAR(w[0], 0.77859, 1e-5);
      EXPECT_NEAR(w[1], 0.22141, 1e-5);
    }
    const Scene scene = load({file}, at_time(before + part * (after - before))).scene;
    std::vector<Vec3> wanted;
    for (std::size_t k = 0; k < 24; ++k) {
      const Vec3 p = vectors(672, k) + w[0] * vectors(1248, k) + w[1] * vectors(2112, k);
      wanted.emplace_back(-100 * p.x, 100 * p.y, -100 * p.z);
    }
    expect_vertices(scene, wanted, 1e-6);  // the node's numbers are 0.7071067, not sqrt(1/2)
    EXPECT_EQ(scene.mesh.positions.size(), 8u);
    EXPECT_TRUE(is_closed(scene));
  }
}

TEST(Animation, TheFoxStaysWholeAndKeepsItsLooks) {
  const auto file = kAnimated / "Fox.glb";
  SKIP_WITHOUT(file);
  std::vector<std::vector<Vec3>> seen;
  for (const auto& [name, time] :
       std::vector<std::pair<std::string, double>>{{"Survey", 1.0}, {"Walk", 0.35}, {"2", 0.5}}) {
    LoadOptions options = at_time(time, name);
    options.appearance = true;
    const Scene scene = load({file}, options).scene;
    EXPECT_EQ(scene.mesh.triangles.size(), 576u);
    EXPECT_TRUE(is_closed(scene)) << name;
    EXPECT_TRUE(std::find(seen.begin(), seen.end(), scene.mesh.positions) == seen.end());
    seen.push_back(scene.mesh.positions);
    ASSERT_EQ(scene.appearance.textures.size(), 1u);
    EXPECT_GT(scene.appearance.textures[0].width, 0);
    EXPECT_EQ(material_of(scene, 0).name, "fox_material");
    EXPECT_EQ(scene.appearance.uv.size(), 576u);
    EXPECT_TRUE(scene.warnings.empty() || !warns(scene, "Animations", 3));
  }
}

// Vertices of a frame of an MD2: stored bytes * scale + translate.
std::vector<Vec3> md2_frame(const std::string& bytes, std::size_t frame) {
  const auto at = [&](std::size_t k) { return number<std::uint32_t>(bytes, 4 * k); };
  const std::size_t begin = at(14) + frame * at(4), vertices = at(6);
  std::vector<Vec3> out;
  for (std::size_t v = 0; v < vertices; ++v) {
    Vec3 p;
    for (std::size_t c = 0; c < 3; ++c) {
      p[int(c)] = double(number<std::uint8_t>(bytes, begin + 40 + 4 * v + c)) *
                      double(number<float>(bytes, begin + 4 * c)) +
                  double(number<float>(bytes, begin + 12 + 4 * c));
    }
    out.push_back(p);
  }
  return out;
}

TEST(Animation, FramesOfMd2AreAtTenPerSecondAndGoOverIntoEachOther) {
  const auto file = kAnimated / "MD2" / "faerie.md2";
  SKIP_WITHOUT(file);
  const std::string bytes = bytes_of_file(file);
  // "run" has frames 40 to 45 of the file.
  const auto between = [&](std::size_t a, std::size_t b, double part) {
    std::vector<Vec3> p = md2_frame(bytes, a);
    const std::vector<Vec3> q = md2_frame(bytes, b);
    for (std::size_t k = 0; k < p.size(); ++k) p[k] += part * (q[k] - p[k]);
    return p;
  };
  expect_vertices(load({file}, at_time(0, "run")).scene, md2_frame(bytes, 40), 1e-5);
  expect_vertices(load({file}, at_time(0.225, "run")).scene, between(42, 43, 0.25), 1e-5);
  expect_vertices(load({file}, at_time(0.55, "run")).scene, between(45, 40, 0.5), 1e-5);
  expect_vertices(load({file}, at_time(0.3)).scene, md2_frame(bytes, 3), 1e-5);  // "stand"
  const Scene rest = load({file}, without_ground()).scene;
  expect_vertices(rest, md2_frame(bytes, 0), 1e-5);
  EXPECT_TRUE(warns(rest, "Frames after the first were left out", 197));
  EXPECT_FALSE(warns(load({file}, at_time(0)).scene, "Frames after the first", 197));
  expect_failure({file}, at_time(0, "fly"), {"no animation \"fly\"", "\"stand\"", "\"pain1\""});
}

// A triangle under a node that moves, turns or grows; one sampler, LINEAR if nothing else is said.
// Buffer: 3 vertices, then floats from byte 36 on: `times`, then `values`.
std::string gltf(const std::string& node, const std::string& path, const std::string& type,
                 const std::vector<float>& times, const std::vector<float>& values,
                 std::size_t count, const std::string& more = "") {
  std::vector<float> numbers = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  numbers.insert(numbers.end(), times.begin(), times.end());
  numbers.insert(numbers.end(), values.begin(), values.end());
  std::string bytes(numbers.size() * 4, '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  std::string base64;
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t bits = 0;
    for (std::size_t b = 0; b < 3; ++b) {
      bits = bits << 8 | (k + b < bytes.size() ? std::uint8_t(bytes[k + b]) : 0u);
    }
    for (int d = 3; d >= 0; --d) base64 += digits[bits >> (6 * d) & 63];
  }
  const auto n = [](std::size_t v) { return std::to_string(v); };
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" +
         node + R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)" +
         R"("animations":[{"name":"a","channels":[{"sampler":0,"target":{"node":0,"path":")" +
         path + R"("}}],"samplers":[{"input":1,"output":2)" + more + R"(}]}],"accessors":[)" +
         R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)" +
         R"({"bufferView":1,"componentType":5126,"type":"SCALAR","count":)" + n(times.size()) +
         R"(},{"bufferView":2,"componentType":5126,"type":")" + type + R"(","count":)" + n(count) +
         R"(}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,)" +
         R"("byteLength":)" + n(4 * times.size()) + R"(},{"buffer":0,"byteOffset":)" +
         n(36 + 4 * times.size()) + R"(,"byteLength":)" + n(4 * values.size()) +
         R"(}],"buffers":[{"byteLength":)" + n(bytes.size()) +
         R"(,"uri":"data:application/octet-stream;base64,)" + base64 + R"("}]})";
}

TEST(Animation, TranslationsGoStraightStepOrCurve) {
  const Files files;
  const std::vector<float> times = {1, 3}, values = {0, 0, 0, 8, 4, 0};
  const auto where = [&](const std::string& text, double time) {
    const Scene s = load({files("t.gltf", text)}, at_time(time)).scene;
    return corner(s, 0, 0) + s.frame.origin;
  };
  const std::string line = gltf("", "translation", "VEC3", times, values, 2);
  EXPECT_EQ(where(line, 1.5), Vec3(2, 0, 1));  // y up becomes z up
  EXPECT_EQ(where(line, 0), Vec3(0, 0, 0));    // before the first key
  EXPECT_EQ(where(line, 3), Vec3(8, 0, 4));
  EXPECT_EQ(where(line, 4.5), Vec3(2, 0, 1));  // round
  const std::string step =
      gltf("", "translation", "VEC3", times, values, 2, R"(,"interpolation":"STEP")");
  EXPECT_EQ(where(step, 2.9), Vec3(0, 0, 0));
  // Tangents 3 leaving and 5 arriving, 2 s apart, from 0 to 8: at a quarter of the way
  // s = 1/4: 2 (s^3 - 2 s^2 + s) 3 + (3 s^2 - 2 s^3) 8 + 2 (s^3 - s^2) 5
  //        = 6 * 9/64 + 8 * 10/64 - 10 * 3/64 = 104/64.
  const std::string curve =
      gltf("", "translation", "VEC3", times, {9, 9, 9, 0, 0, 0, 3, 0, 0, 5, 0, 0, 8, 4, 0, 9, 9, 9},
           6, R"(,"interpolation":"CUBICSPLINE")");
  EXPECT_NEAR(where(curve, 1.5).x, 104.0 / 64, 1e-12);
  EXPECT_NEAR(where(curve, 1.5).z, 4 * 10.0 / 64, 1e-12);
}

TEST(Animation, RotationsTakeTheShorterWay) {
  const Files files;
  // From no turn to 90 degrees around y, given as the quaternion's opposite.
  const float h = std::sqrt(0.5f);
  const Scene s =
      load({files("t.gltf", gltf("", "rotation", "VEC4", {0, 1}, {0, 0, 0, 1, 0, -h, 0, -h}, 2))},
           at_time(1.0 / 3))
          .scene;
  // (1, 0, 0) turned by 30 degrees around glTF's y is (cos 30, 0, -sin 30): our (cos, sin, 0).
  expect_vertices(s, {{std::cos(std::numbers::pi / 6), 0.5, 0}, {0, 0, 1}}, 1e-7);
}

TEST(Animation, ScalesAndOtherMembersOfTheNodeStay) {
  const Files files;
  const Scene s = load({files("t.gltf", gltf(R"(,"translation":[5,0,0])", "scale", "VEC3", {0, 1},
                                             {1, 1, 1, 3, 1, 1}, 2))},
                       at_time(0.5))
                      .scene;
  expect_vertices(s, {{5, 0, 0}, {7, 0, 0}, {5, 0, 1}}, 1e-12);
}

TEST(Animation, DamagedAnimationsAreErrorsOnlyWhereTheyAreAskedFor) {
  const Files files;
  const std::string back = gltf("", "translation", "VEC3", {2, 1}, {0, 0, 0, 8, 4, 0}, 2);
  const std::string few = gltf("", "translation", "VEC3", {1, 2}, {0, 0, 0}, 1);
  const auto path = files("t.gltf", back);
  expect_failure({path}, at_time(0), {"t.gltf: animation 0, sampler 0", "must ascend from 0"});
  EXPECT_TRUE(warns(load({path}, without_ground()).scene, "Animations are not played", 1));
  expect_failure({files("t.gltf", few)}, at_time(0), {"another number of values than of times"});
  expect_failure({path}, at_time(0, "b"), {"there is no animation \"b\"; the file has \"a\"."});
  expect_failure({path}, at_time(-1), {"--time -1 must be"});
}

TEST(Animation, WhatHasNoAnimationIsCounted) {
  const Files files;
  const auto still = files("tower.obj", kObj);
  const auto moves =
      files("t.gltf", gltf("", "translation", "VEC3", {0, 1}, {0, 0, 0, 1, 0, 0}, 2));
  EXPECT_TRUE(warns(load({still}, at_time(1)).scene, "--time and --animation were not used", 1));
  EXPECT_FALSE(warns(load({still, moves}, at_time(1)).scene, "--time and --animation", 1));
  LoadOptions named = without_ground();
  named.for_files.push_back({.file = "tower.obj", .time = 1.0});
  named.for_files.push_back({.file = "t.gltf", .time = 0.5, .animation = "a"});
  const Scene both = load({still, moves}, named).scene;
  EXPECT_TRUE(warns(both, "--time and --animation were not used", 1));
  EXPECT_TRUE(has_vertex(both, {0.5, 0, 0}, 1e-12));
}

}  // namespace
}  // namespace gnomon
