#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <hwy/targets.h>
#include <glm/geometric.hpp>

#include "soup.h"

#include <gnomon/silhouette/light_planes.h>
#include <gnomon/silhouette/light_sides.h>
#include <gnomon/silhouette/vector_silhouette.h>

namespace gnomon {
namespace {

void expect_light_sides_on_every_instruction_set(const std::vector<Scene>& scenes,
                                                 const std::vector<Light>& lights) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (const Scene& s : scenes) {
      const LightPlanes planes = light_planes(s.mesh, 2);
      for (const Light& given : lights) {
        const Light light = snapped(given);
        std::vector<std::int8_t> sides(3, 7);
        sides_from_planes(sides, s.mesh, planes, light, 2);
        EXPECT_EQ(sides, light_sides(s.mesh, light));
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

// Suns, and lamps inside, outside, on vertices of grids, and far away.
std::vector<Light> lights() {
  return {{0, 0, 1, 0},    {1, 0, 0, 0},         {1, 1, 0, 0},         {-1, 2, 3, 0},
          {3, -1, -2, 0},  {1e-9, 1, 1e-9, 0},   {0.3, 0.5, 0.2, 0},   {1e-12, 1e-30, 1e-12, 0},
          {2, 2, 2, 1},    {0, 0, 0, 1},         {0.1, -3.7, 12.2, 1}, {1, 1e-12, 5, 1},
          {3e6, -2, 7, 1}, {1e12, 1e12, 1e12, 1}};
}

TEST(LightPlanes, GiveLightSidesOfSoupsWithTiesAndFarFromTheOrigin) {
  std::vector<Scene> scenes;
  for (const double grid : {0.0, 1.0}) {
    TriMesh m;
    test::add_soup(m, 1003, 20, grid, 7);  // no whole number of vectors
    scenes.push_back(test::scene_of(m));
    TriMesh flat = m, far = m;
    for (Vec3& p : flat.positions) p = {p.x * 1e-3, p.y * 1e6, p.z + 1e5};
    scenes.push_back(test::scene_of(flat));
    for (Vec3& p : far.positions) p += Vec3(1e6, -5e6, 0);
    scenes.push_back(test::scene_of(far));
  }
  std::vector<Light> all = lights();
  all.push_back({1e6 + 2, -5e6 + 2, 2, 1});
  all.push_back({1e6 + 2.5, -5e6 + 1e-9, 2, 1});
  expect_light_sides_on_every_instruction_set(scenes, all);
}

TEST(LightPlanes, GiveLightSidesOfNeedlesOfAnyThicknessUnderLightsNearTheirPlanes) {
  TriMesh m;
  std::vector<Light> all = lights();
  all.push_back({0.1, 0.2, 0.3, 1});
  for (int k = 0; k < 60; ++k) {
    const auto i = static_cast<std::uint32_t>(m.positions.size());
    const double thin = std::ldexp(1.0, -k);
    const Vec3 a(0.1, 0.2, 0.3), b(10.7, 3.1 + k, 0.9), across(0, 1, -1);
    m.positions.insert(m.positions.end(), {a, b, b + thin * across});
    m.triangles.push_back({i, i + 1, i + 2});
    const Vec3 off = cross(b - a, across);
    for (const double share : {-0.1, -0.01, 1e-5, 0.03})
      all.push_back(point(a + 0.37 * (b - a) + 5.0 * across + share * off));
  }
  expect_light_sides_on_every_instruction_set({test::scene_of(m)}, all);
}

TEST(LightPlanes, GiveLightSidesAtTheEndsOfCoordinates) {
  std::vector<Scene> scenes;
  for (const double size : {1e-25, 1e-12, 1e10}) {
    TriMesh m;
    test::add_soup(m, 50, 20, 1, 3);
    for (Vec3& p : m.positions) p *= size;
    scenes.push_back(test::scene_of(m));
  }
  std::vector<Light> all = lights();
  all.push_back({2e10, 2e10, 2e10, 1});
  all.push_back({2e-12, 2e-12, -3e-12, 1});
  expect_light_sides_on_every_instruction_set(scenes, all);
}

TEST(LightPlanes, OfTrianglesWithoutAreaGiveWhatLightSidesGives) {
  TriMesh m;  // vertices that moved onto each other
  m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
  m.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 0, 1}, {2, 1, 0}};
  const LightPlanes planes = light_planes(m, 1);
  for (const Light& light : {Light(0, 0, 1, 0), Light(1, 2, 3, 1), Light(0, 0, -1, 0)}) {
    std::vector<std::int8_t> sides;
    sides_from_planes(sides, m, planes, light, 1);
    EXPECT_EQ(sides, light_sides(m, light));
  }
}

void expect_same(const Silhouette& found, const Silhouette& specified) {
  ASSERT_EQ(found.size(), specified.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_EQ(found[k].a, specified[k].a);
    EXPECT_EQ(found[k].b, specified[k].b);
    EXPECT_EQ(found[k].multiplicity, specified[k].multiplicity);
  }
}

TEST(VectorSilhouette, IsTheSilhouetteOnEveryInstructionSet) {
  TriMesh m;
  test::add_soup(m, 301, 20, 4, 3);  // open, and edges of many triangles
  for (int i = 0; i < 1500; ++i) {   // more than one chunk and block, and no whole number of them
    const double at = 30 + 3 * i;
    test::add_box(m, {at, 0, 0}, {at + 1 + i % 3, 2, 5});  // some touch
  }
  const Scene s = test::scene_of(std::move(m));
  const EdgeTable edges = build_edge_table(s.mesh);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (const Light& light : {Light(1, 2, 3, 0), Light(0, 0, 1, 0), Light(2, 2, 2, 1)}) {
      const std::vector<std::int8_t> sides = light_sides(s.mesh, light);
      const Silhouette specified = find_silhouette(edges, sides);
      for (const int threads : {1, 2, 3}) {
        Silhouette found(3);
        find_silhouette_in_vectors(found, edges, sides, threads);
        expect_same(found, specified);
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

// Where reading ahead would leave the table: few edges, the last of one triangle or of many.
TEST(VectorSilhouette, OfTinyMeshesIsTheSilhouetteOnEveryInstructionSet) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (std::uint32_t n = 0; n < 40; ++n) {
      TriMesh fan;  // triangles over one edge, which comes first or last
      fan.positions = {{0, 0, 0}, {0, 0, 1}};
      for (std::uint32_t t = 0; t < n; ++t) {
        fan.positions.push_back({std::cos(t), std::sin(t), 0.5});
        fan.triangles.push_back(t % 3 == 0 ? Triangle{0, 1, t + 2} : Triangle{1, 0, t + 2});
      }
      TriMesh turned = fan;
      const auto most = static_cast<std::uint32_t>(fan.positions.size() - 1);
      std::reverse(turned.positions.begin(), turned.positions.end());
      for (Triangle& t : turned.triangles) t = {most - t[0], most - t[1], most - t[2]};
      for (const TriMesh& m : {fan, turned}) {
        const EdgeTable edges = build_edge_table(m);
        const std::vector<std::int8_t> sides = light_sides(m, Light(1, 2, 0.5, 0));
        Silhouette found;
        find_silhouette_in_vectors(found, edges, sides, 2);
        expect_same(found, find_silhouette(edges, sides));
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace
}  // namespace gnomon
