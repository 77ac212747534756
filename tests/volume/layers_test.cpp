#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "soup.h"

#include <gnomon/core/exact.h>
#include <gnomon/silhouette/light_sides.h>
#include <gnomon/volume/layers.h>
#include <scenes/generated_city.h>
#include <scenes/generated_sphere.h>

namespace gnomon {
namespace {

int sign4(const Vec4& a, const Vec4& b, const Vec4& c, const Vec4& d) {
  ExactStats ignored;
  return tie_sign({}, ignored, [&]<class T>(int, int, int) {
    return det4<T>(lift<T>(a), lift<T>(b), lift<T>(c), lift<T>(d));
  });
}

// Exactly: the closed triangle and the closed segment from x to the light meet.
bool crosses(const TriMesh& mesh, std::uint32_t t, const Vec4& x, const Light& light) {
  const Vec4 p = point(mesh.positions[mesh.triangles[t][0]]),
             q = point(mesh.positions[mesh.triangles[t][1]]),
             r = point(mesh.positions[mesh.triangles[t][2]]);
  const int f = sign4(p, q, r, x);
  if (f == 0 || f * sign4(p, q, r, light) > 0) return false;
  return f * sign4(light, x, p, q) >= 0 && f * sign4(light, x, q, r) >= 0 &&
         f * sign4(light, x, r, p) >= 0;
}

int items_crossed(const TriMesh& mesh, const LayerItems& items, const Vec4& x, const Light& light) {
  int count = 0;
  for (std::size_t k = 0; k + 1 < items.first.size(); ++k) {
    const auto *begin = &items.triangles[items.first[k]],
               *end = begin + items.first[k + 1] - items.first[k];
    count += std::any_of(begin, end, [&](std::uint32_t t) { return crosses(mesh, t, x, light); });
  }
  return count;
}

LayerItems every_triangle(const TriMesh& mesh) {
  LayerItems items;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    items.triangles.push_back(t);
    items.first.push_back(t + 1);
  }
  return items;
}

// The largest number of items on rays to points around the scene, many of them aimed at vertices
// and edges.
int most_found(const TriMesh& mesh, const LayerItems& items, const Light& light, double half,
               int rays, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-half, half), unit(0, 1);
  std::uniform_int_distribution<std::size_t> vertex(0, mesh.positions.size() - 1);
  int most = 0;
  for (int k = 0; k < rays; ++k) {
    Vec3 x(u(random), u(random), u(random));
    if (k % 3 == 1) x = mesh.positions[vertex(random)];
    if (k % 3 == 2) {
      const double t = unit(random);
      x = t * mesh.positions[vertex(random)] + (1 - t) * mesh.positions[vertex(random)];
    }
    // Far behind x as seen from the light, or beyond the scene for a sun.
    const Vec3 l(light);
    const Vec4 end = light.w == 0
                         ? point(x - l * (4 * half / std::sqrt(l.x * l.x + l.y * l.y + l.z * l.z)))
                         : point(l / light.w + (x - l / light.w) * 64.0);
    most = std::max(most, items_crossed(mesh, items, end, light));
  }
  return most;
}

TEST(LayerBound, IsNeverBelowTheItemsThatAnyRayOfASoupCrosses) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    TriMesh m;
    test::add_soup(m, 50, 4, seed % 2 == 0 ? 1 : 0, seed);
    const Scene s = test::scene_of(m);
    const LayerItems items = every_triangle(s.mesh);
    for (const Light& light :
         {Light(0.31, 0.23, 0.87, 0), Light(0, 0, 1, 0), Light(-1, 0, 0, 0), Light(1, 1, 0, 0),
          Light(0.17, 0.29, 9.3, 1), Light(0.11, 0.07, 0.05, 1), Light(0, 0, 0, 1),
          Light(2, 2, 2, 2), Light(s.mesh.positions[7], 1)}) {
      const int found = most_found(s.mesh, items, light, 8, 90, seed);
      for (const int cells : {1, 7, 64, seed == 1 ? 1024 : 256}) {
        const int bound = layer_bound(s.mesh, items, light, cells);
        EXPECT_LE(bound, 2 * 50);
        EXPECT_GE(bound, found);
      }
    }
  }
}

TEST(LayerBound, HoldsForTrianglesThatPassCloseToTheLight) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  const Light lamp(0.3, -0.2, 0.7, 1);
  for (int k = 0; k < 120; ++k) {
    // Large triangles, each through a point at a distance of 10^-1 ... 10^-12 from the lamp.
    TriMesh m;
    const double near = std::pow(10.0, -1 - k % 12);
    for (int t = 0; t < 6; ++t) {
      const Vec3 p = Vec3(lamp) + near * Vec3(u(random), u(random), u(random));
      const Vec3 e(u(random), u(random), u(random)), f(u(random), u(random), u(random));
      const auto v = static_cast<std::uint32_t>(m.positions.size());
      m.positions.insert(m.positions.end(), {p + 50.0 * e, p + 50.0 * f, p - 40.0 * (e + f)});
      m.triangles.push_back({v, v + 1, v + 2});
    }
    const Scene s = test::scene_of(m);
    const LayerItems items = every_triangle(s.mesh);
    EXPECT_GE(layer_bound(s.mesh, items, lamp), most_found(s.mesh, items, lamp, 40, 60, 7)) << near;
  }
}

TEST(LayerBound, CountsWhatTouchesTheLightEverywhere) {
  TriMesh m;
  test::add_quad(m, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});  // holds the lamp
  test::add_quad(m, {-1, -1, 5}, {1, -1, 5}, {1, 1, 5}, {-1, 1, 5});
  const Scene s = test::scene_of(m);
  const Light lamp(0.25, 0.5, 0, 1);
  LayerItems low;
  low.triangles = {0, 1};
  low.first = {0, 2};
  EXPECT_EQ(layer_bound(s.mesh, low, lamp), 2);  // everywhere, and in its first triangle's cells
  EXPECT_GE(layer_bound(s.mesh, every_triangle(s.mesh), lamp), 3);
}

TEST(LayerBound, ConvexPartsAreOneLayerWhenTheirLitTrianglesCast) {
  const Scene s = scenes::generated_sphere(4, 5);
  const Parts parts = split_into_parts(s.mesh, build_edge_table(s.mesh));
  for (const Light& light : {Light(0.31, 0.23, 0.87, 0), Light(0.17, 0.29, 30.3, 1)}) {
    const auto sides = light_sides(s.mesh, light);
    std::vector<std::uint8_t> lit(sides.size());
    for (std::size_t t = 0; t < lit.size(); ++t) lit[t] = sides[t] == -1;
    EXPECT_EQ(layer_bound(s.mesh, layer_items(parts, sides, lit), light), 1);
    EXPECT_EQ(layer_bound(s.mesh, layer_items(parts, sides), light), 2);
  }
  const Light inside(0.1, 0.2, 0.3, 1);
  EXPECT_EQ(layer_bound(s.mesh, layer_items(parts, light_sides(s.mesh, inside)), inside), 1);
}

TEST(LayerBound, ItemsOfAConvexPartAreItsTwoSidesAndOthersAreTriangles) {
  TriMesh m;
  test::add_box(m, {0, 0, 0}, {1, 1, 1});
  test::add_ground(m, 5, -1);
  const Scene s = test::scene_of(m);
  const auto sides = light_sides(s.mesh, Light(1, 2, 3, 0));
  const LayerItems items = layer_items(split_into_parts(s.mesh, build_edge_table(s.mesh)), sides);
  EXPECT_EQ(items.first, (std::vector<std::uint32_t>{0, 6, 12, 13, 14}));
}

// 20 x 20 boxes on a plane, of different heights.
Scene four_hundred_boxes() {
  TriMesh m;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> height(4, 20), offset(0, 4);
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      const double x = 15 * (i - 10) + offset(random), y = 15 * (j - 10) + offset(random);
      test::add_box(m, {x, y, 0}, {x + 8, y + 8, height(random)});
    }
  }
  test::add_ground(m, 200);
  return test::scene_of(m);
}

TEST(LayerBound, OfFourHundredBoxesIsWithinTwiceTheTruthAndFarBelow255) {
  const Scene s = four_hundred_boxes();
  const Parts parts = split_into_parts(s.mesh, build_edge_table(s.mesh));
  for (const Light& light : {Light(1, 2, 60, 1), Light(1, 2, 25, 1), Light(-170, 3, 21, 1),
                             Light(1, 2, 3, 0), Light(1, 0.4, 0.1, 0)}) {
    const auto sides = light_sides(s.mesh, light);
    std::vector<std::uint8_t> lit(sides.size());
    for (std::size_t t = 0; t < lit.size(); ++t) lit[t] = sides[t] == -1;
    const LayerItems items = layer_items(parts, sides, lit);
    const int bound = layer_bound(s.mesh, items, light);
    const int found = most_found(s.mesh, items, light, 160, 400, 1);
    EXPECT_GE(bound, found);
    EXPECT_LE(bound, 2 * found + 3);
    EXPECT_LT(bound, 60);
  }
}

TEST(LayerBound, OfATownAndItsMovedCopyIsTheSame) {
  // Far from the origin the slack grows, but stays far below a cell.
  const Scene s = scenes::generated_city({.buildings = 40, .seed = 2});
  Scene moved = s;
  for (Vec3& p : moved.mesh.positions) p += Vec3(0x1p20, 0x1p19, 0);
  const LayerItems items = every_triangle(s.mesh);
  const int here = layer_bound(s.mesh, items, Light(1, 2, 3, 0)),
            there = layer_bound(moved.mesh, items, Light(1, 2, 3, 0));
  EXPECT_NEAR(here, there, 2);
  EXPECT_NEAR(layer_bound(s.mesh, items, Light(3, 4, 90, 1)),
              layer_bound(moved.mesh, items, Light(0x1p20 + 3, 0x1p19 + 4, 90, 1)), 2);
}

TEST(LayerBound, OfNothingIsZero) {
  EXPECT_EQ(layer_bound({}, {}, Light(0, 0, 1, 0)), 0);
  EXPECT_EQ(layer_bound({}, {}, Light(0, 0, 1, 1)), 0);
}

}  // namespace
}  // namespace gnomon
