// One interface over all methods: the same edges, whatever was asked before.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "soup.h"

#include <gnomon/silhouette/light_sides.h>
#include <gnomon/silhouette/silhouette_finder.h>
#include <scenes/generated_sphere.h>

namespace gnomon {
namespace {

constexpr SilhouetteBy kAll[] = {SilhouetteBy::automatic, SilhouetteBy::brute_force,
                                 SilhouetteBy::dual_space, SilhouetteBy::edge_tree};

bool same(const Silhouette& expected, Silhouette found) {
  Silhouette scratch;
  sort_as_table(found, scratch);
  return std::equal(expected.begin(), expected.end(), found.begin(), found.end(),
                    [](const SilhouetteEdge& a, const SilhouetteEdge& b) {
                      return a.a == b.a && a.b == b.b && a.multiplicity == b.multiplicity;
                    });
}

Light a_light(std::mt19937& random) {
  std::normal_distribution<double> g;
  const Vec3 v(g(random), g(random), g(random));
  return snapped(random() % 2 == 0 ? direction(v) : point(v * 7.0));
}

TEST(SilhouetteFinder, EveryMethodFindsTheSameEdgesThoughVerticesMove) {
  TriMesh m;
  test::add_soup(m, 200, 3, 1, 3);
  test::add_box(m, {0, 0, 0}, {1, 2, 3});
  m = test::scene_of(m).mesh;
  const EdgeTable edges = build_edge_table(m);
  SilhouetteFinder finders[4];
  std::mt19937 random(9);
  std::uniform_real_distribution<double> u(-0.3, 0.3);
  for (int pose = 0; pose < 3; ++pose) {
    for (int k = 0; k < 12; ++k) {
      const Light light = a_light(random);
      const std::vector<std::int8_t> expected_sides = light_sides(m, light);
      const Silhouette expected = find_silhouette(edges, expected_sides);
      for (int f = 0; f < 4; ++f) {
        Silhouette found;
        std::vector<std::int8_t> sides{5};
        find_silhouette(found, sides, finders[f], kAll[f], m, edges, light);
        EXPECT_TRUE(same(expected, found)) << f;
        EXPECT_EQ(sides, f < 2 ? expected_sides : std::vector<std::int8_t>{});
      }
    }
    for (Vec3& p : m.positions) p += Vec3(u(random), u(random), u(random));
    for (SilhouetteFinder& finder : finders) vertices_moved(finder);
  }
}

TEST(SilhouetteFinder, EveryMethodFindsTheSameEdgesWhereATriangleHasLostItsArea) {
  TriMesh m;
  test::add_box(m, {0, 0, 0}, {1, 1, 1});
  m = test::scene_of(m).mesh;
  const EdgeTable edges = build_edge_table(m);
  SilhouetteFinder finders[4];
  Silhouette found;
  std::vector<std::int8_t> sides;
  for (int f = 0; f < 4; ++f)
    find_silhouette(found, sides, finders[f], kAll[f], m, edges, Light(0.1, 0.2, 0.9, 0));
  m.positions[m.triangles[0][1]] = m.positions[m.triangles[0][0]];
  for (SilhouetteFinder& finder : finders) vertices_moved(finder);
  std::mt19937 random(4);
  for (int k = 0; k < 100; ++k) {
    const Light light = a_light(random);
    const std::vector<std::int8_t> of_triangles = light_sides(m, light);
    EXPECT_EQ(std::count(of_triangles.begin(), of_triangles.end(), 0), 0);
    const Silhouette expected = find_silhouette(edges, of_triangles);
    for (const SilhouetteEdge& e : expected) EXPECT_EQ(std::abs(e.multiplicity), 2);
    for (int f = 0; f < 4; ++f) {
      find_silhouette(found, sides, finders[f], kAll[f], m, edges, light);
      EXPECT_TRUE(same(expected, found)) << f;
    }
  }
}

TEST(SilhouetteFinder, EveryMethodFindsTheSameEdgesOfTrianglesThatHaveLostTheirArea) {
  TriMesh m;
  test::add_soup(m, 80, 3, 0, 5);
  test::add_box(m, {0, 0, 0}, {1, 2, 3});
  test::add_box(m, {2, 2, 0}, {2.4, 2.4, 0.3});
  m = test::scene_of(m).mesh;
  const EdgeTable edges = build_edge_table(m);
  SilhouetteFinder finders[4];
  for (Vec3& p : m.positions) p = {std::round(p.x / 2), std::round(p.y / 2), std::round(p.z / 2)};
  std::mt19937 random(2);
  for (int k = 0; k < 30; ++k) {
    const Light light = a_light(random);
    const Silhouette expected = find_silhouette(edges, light_sides(m, light));
    for (int f = 0; f < 4; ++f) {
      Silhouette found;
      std::vector<std::int8_t> sides;
      find_silhouette(found, sides, finders[f], kAll[f], m, edges, light);
      EXPECT_TRUE(same(expected, found)) << f;
    }
  }
}

TEST(SilhouetteFinder, TakesTheTreeOnceManyLightsWereAskedForAndNotForOneFrameOfAnAnimation) {
  TriMesh m;
  test::add_box(m, {0, 0, 0}, {1, 2, 3});
  m = test::scene_of(m).mesh;
  const EdgeTable edges = build_edge_table(m);
  SilhouetteFinder finder;
  std::mt19937 random(1);
  Silhouette found;
  std::vector<std::int8_t> sides;
  const auto ask = [&] {
    find_silhouette(found, sides, finder, SilhouetteBy::automatic, m, edges, a_light(random));
  };
  for (std::uint32_t k = 1; k < kLightsBeforeTree; ++k) {
    ask();
    EXPECT_FALSE(finder.edge_tree);
    EXPECT_FALSE(sides.empty());
  }
  ask();
  EXPECT_TRUE(finder.edge_tree);
  EXPECT_TRUE(finder.current);
  EXPECT_TRUE(sides.empty());
  vertices_moved(finder);
  EXPECT_FALSE(finder.current);
  for (std::uint32_t k = 1; k < kLightsBeforeRefresh; ++k) {
    ask();
    EXPECT_FALSE(finder.current);  // brute force again
    EXPECT_EQ(finder.last, SilhouetteBy::brute_force);
  }
  ask();
  EXPECT_TRUE(finder.current);
  EXPECT_EQ(finder.last, SilhouetteBy::edge_tree);
}

double distance_to_plane(const TriMesh& m, std::uint32_t t, const Light& light) {
  const Triangle& v = m.triangles[t];
  const Vec3 &a = m.positions[v[0]], &b = m.positions[v[1]], &c = m.positions[v[2]];
  const Vec3 u = b - a, w = c - a;
  const Vec3 n(u.y * w.z - u.z * w.y, u.z * w.x - u.x * w.z, u.x * w.y - u.y * w.x);
  const Vec3 d = Vec3(light) - a * light.w;
  return std::fabs(n.x * d.x + n.y * d.y + n.z * d.z) /
         std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
}

TEST(NearPlanes, HoldEveryTriangleThatTheLightIsNearAndFewOthers) {
  const TriMesh sphere = scenes::generated_sphere(4, 5).mesh;
  TriMesh soup;
  test::add_soup(soup, 300, 3, 1, 6);
  soup = test::scene_of(soup).mesh;
  std::mt19937 random(4);
  for (const TriMesh& m : {sphere, soup}) {
    const EdgeTree tree = build_edge_tree(m, build_edge_table(m));
    ExtractionScratch scratch;
    std::vector<std::uint32_t> near;
    for (int k = 0; k < 60; ++k) {
      const Light light = a_light(random);
      for (const double distance : {0.0, 1e-6, 0.01, 0.4}) {
        find_near_planes(near, tree, light, distance, scratch);
        EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
        EXPECT_EQ(std::adjacent_find(near.begin(), near.end()), near.end());
        for (std::uint32_t t = 0; t < m.triangles.size(); ++t) {
          const double d = distance_to_plane(m, t, light);
          const bool listed = std::binary_search(near.begin(), near.end(), t);
          EXPECT_TRUE(listed || d > distance * (1 - 1e-9)) << t << " at " << d;
          // Sixteen bits a coordinate within a leaf, whose planes may be spread over two.
          EXPECT_FALSE(listed && d > distance * 1.01 + 0.01) << t << " at " << d;
        }
      }
    }
  }
}

}  // namespace
}  // namespace gnomon
