#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <glm/common.hpp>

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

void add_box_of(LayerItems& items, const TriMesh& mesh) {
  for (const Vec3& p : mesh.positions) {
    items.lo = glm::min(items.lo, p);
    items.hi = glm::max(items.hi, p);
  }
}

LayerItems every_triangle(const TriMesh& mesh) {
  LayerItems items;
  add_box_of(items, mesh);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    items.triangles.push_back(t);
    items.first.push_back(t + 1);
    items.halves.push_back(2);
    items.convex_part.push_back(kNoPart);
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
  low.halves = {2};
  low.convex_part = {kNoPart};
  add_box_of(low, s.mesh);
  EXPECT_EQ(layer_bound(s.mesh, low, lamp), 1);
  EXPECT_GE(layer_bound(s.mesh, every_triangle(s.mesh), lamp), 3);
}

constexpr auto kOne = CastingSides::one;

// Of a random light near this one, and never beyond.
Light moved_by(const Light& light, double spread, std::mt19937& random) {
  std::uniform_real_distribution<double> u(-spread, spread);
  const double largest =
      std::max({std::fabs(light.x), std::fabs(light.y), std::fabs(light.z)}) * 0.999;
  Light out = light;
  for (int k = 0; k < 3; ++k) {
    if (std::fabs(light[k]) < largest) out[k] += largest * u(random);
  }
  return snapped(out);
}

TEST(LayerBound, HoldsForEveryLightThatIsNear) {
  std::mt19937 random(11);
  for (unsigned seed = 1; seed <= 6; ++seed) {
    TriMesh m;
    test::add_soup(m, 50, 4, seed % 2 == 0 ? 1 : 0, seed);
    const Scene s = test::scene_of(m);
    const LayerItems items = every_triangle(s.mesh);
    for (const Light& light :
         {Light(0.31, 0.23, 0.87, 0), Light(0, 0, 1, 0), Light(-1, 0.1, 0, 0)}) {
      for (const double spread : {0.001, 0.05, 0.4}) {
        const int bound = layer_bound(s.mesh, items, light, 64, spread);
        for (int k = 0; k < 8; ++k) {
          const Light other = moved_by(light, spread, random);
          ASSERT_TRUE(near(light, other, spread));
          EXPECT_GE(bound, most_found(s.mesh, items, other, 8, 60, seed));
        }
      }
    }
  }
}

TEST(LayerBound, LightsAreNearByTheirDirectionsAlone) {
  const Light sun(0.3, -0.2, 0.9, 0);
  EXPECT_TRUE(near(sun, sun * 2.0, 1e-9));
  EXPECT_FALSE(near(sun, -sun, 1e9));
  EXPECT_FALSE(near(sun, Light(0.3, -0.2, 0.8, 0), 0.01));
  EXPECT_FALSE(near(sun, Light(30, -20, 90, 1), 0.1));
  EXPECT_TRUE(near(Light(1, 2, 3, 1), Light(1, 2, 3, 1), 0));
  EXPECT_FALSE(near(Light(1, 2, 3, 1), Light(1, 2, 3.001, 1), 1));
}

TEST(LayerBound, ConvexPartsAreOneLayerWhenOneSideOfThemCasts) {
  const Scene s = scenes::generated_sphere(4, 5);
  const Parts parts = split_into_parts(s.mesh, build_edge_table(s.mesh));
  for (const Light& light : {Light(0.31, 0.23, 0.87, 0), Light(0.17, 0.29, 30.3, 1)}) {
    EXPECT_EQ(layer_bound(s.mesh, layer_items(parts, {&kOne, 1}), light), 1);
    EXPECT_EQ(layer_bound(s.mesh, layer_items(parts), light), 2);
    // By its outline alone.
    const EdgeTable edges = build_edge_table(s.mesh);
    const PartSilhouettes outlines =
        split_by_part(find_silhouette(edges, light_sides(s.mesh, light)),
                      parts_of_edges(edges, parts, s.mesh.positions.size()), {&kOne, 1});
    EXPECT_EQ(layer_bound(s.mesh, layer_items(parts, {&kOne, 1}), light, 64, 0, &outlines), 1);
  }
}

// Outlines of boxes at one light, and rays of others near it.
TEST(LayerBound, ByOutlinesHoldsForEveryLightThatIsNear) {
  TriMesh m;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> at(-8, 8), size(0.5, 4);
  for (int k = 0; k < 60; ++k) {
    const Vec3 lo(at(random), at(random), at(random));
    test::add_box(m, lo, lo + Vec3(size(random), size(random), size(random)));
  }
  const Scene s = test::scene_of(m);
  const EdgeTable edges = build_edge_table(s.mesh);
  const Parts parts = split_into_parts(s.mesh, edges);
  const std::vector<CastingSides> one(parts.parts.size(), CastingSides::one);
  const LayerItems items = layer_items(parts, one);
  for (const Light& light : {Light(0.3, 0.2, 0.9, 0), Light(0, 0, 1, 0), Light(1, 1, 0, 0)}) {
    const PartSilhouettes outlines =
        split_by_part(find_silhouette(edges, light_sides(s.mesh, light)),
                      parts_of_edges(edges, parts, s.mesh.positions.size()), one);
    for (const double spread : {0.0, 0.01, 0.3}) {
      const int bound = layer_bound(s.mesh, items, light, 64, spread, &outlines);
      EXPECT_LE(bound, 60);
      for (int k = 0; k < 8; ++k) {
        const Light other = spread == 0 ? light : moved_by(light, spread, random);
        EXPECT_GE(bound, most_found(s.mesh, items, other, 12, 80, 5));
      }
    }
  }
}

TEST(LayerBound, ItemsOfAConvexPartAreOneAndOthersAreTriangles) {
  TriMesh m;
  test::add_box(m, {0, 0, 0}, {1, 1, 1});
  test::add_ground(m, 5, -1);
  const Scene s = test::scene_of(m);
  const Parts parts = split_into_parts(s.mesh, build_edge_table(s.mesh));
  const LayerItems items = layer_items(parts);
  EXPECT_EQ(items.first, (std::vector<std::uint32_t>{0, 12, 13, 14}));
  EXPECT_EQ(items.halves, (std::vector<std::uint8_t>{4, 2, 2}));
  const std::vector<CastingSides> sides = {CastingSides::one, CastingSides::none};
  const LayerItems box = layer_items(parts, sides);
  EXPECT_EQ(box.first, (std::vector<std::uint32_t>{0, 12}));
  EXPECT_EQ(box.halves, (std::vector<std::uint8_t>{2}));
}

// A comb of teeth side by side: closed, not convex, and crossed as often as it has teeth.
Scene comb(int teeth) {
  TriMesh m;
  std::vector<Vec2> outline;
  for (int k = 0; k < teeth; ++k) {
    outline.insert(outline.end(),
                   {Vec2(2 * k, 1), Vec2(2 * k, 9), Vec2(2 * k + 1, 9), Vec2(2 * k + 1, 1)});
  }
  const auto at = [](const Vec2& p, double y) { return Vec3(p.x, y, p.y); };
  const std::size_t n = outline.size();
  const auto side = [&](const Vec2& p, const Vec2& q) {
    test::add_quad(m, at(p, 0), at(q, 0), at(q, 5), at(p, 5));
  };
  for (std::size_t k = 0; k + 1 < n; ++k) side(outline[k], outline[k + 1]);
  side(outline[n - 1], Vec2(2 * teeth - 1, 0));
  side(Vec2(2 * teeth - 1, 0), Vec2(0, 0));
  side(Vec2(0, 0), outline[0]);
  // Front and back: the teeth, and the spine below them in pieces that share their edges.
  for (const bool back : {false, true}) {
    const auto quad = [&](double x0, double z0, double x1, double z1) {
      const double y = back ? 5 : 0;
      if (back) {
        test::add_quad(m, {x0, y, z0}, {x0, y, z1}, {x1, y, z1}, {x1, y, z0});
      } else {
        test::add_quad(m, {x0, y, z0}, {x1, y, z0}, {x1, y, z1}, {x0, y, z1});
      }
    };
    for (int k = 0; k < teeth; ++k) quad(2 * k, 1, 2 * k + 1, 9);
    // The spine as a fan from its lower left corner.
    const Vec3 corner(0, back ? 5.0 : 0.0, 0);
    std::vector<Vec3> rim = {Vec3(2 * teeth - 1, corner.y, 0)};
    for (int k = teeth - 1; k >= 0; --k) {
      rim.push_back(Vec3(2 * k + 1, corner.y, 1));
      rim.push_back(Vec3(2 * k, corner.y, 1));
    }
    for (std::size_t k = 0; k + 1 < rim.size(); ++k) {
      const auto v = static_cast<std::uint32_t>(m.positions.size());
      m.positions.insert(m.positions.end(), {corner, rim[k], rim[k + 1]});
      m.triangles.push_back(back ? Triangle{v, v + 2, v + 1} : Triangle{v, v + 1, v + 2});
    }
  }
  return test::scene_of(m);
}

TEST(LayerBound, OfAClosedPartHalfOfAllTrianglesIsAtLeastThoseOfEitherSide) {
  const Scene s = comb(9);
  const Parts parts = split_into_parts(s.mesh, build_edge_table(s.mesh));
  ASSERT_EQ(parts.parts.size(), 1u);
  ASSERT_TRUE(parts.parts[0].closed);
  ASSERT_FALSE(parts.parts[0].convex);
  const LayerItems halves = layer_items(parts, {&kOne, 1});
  for (const Light& light : {Light(0.97, 0.013, 0.02, 0), Light(0.31, 0.23, 0.87, 0),
                             Light(-0.9, 0.1, 0.2, 0), Light(30.1, 2.3, 5.7, 1)}) {
    const auto sides = light_sides(s.mesh, light);
    const int bound = layer_bound(s.mesh, halves, light);
    EXPECT_LE(bound, layer_bound(s.mesh, layer_items(parts), light) / 2);
    for (const int side : {-1, 1}) {
      LayerItems one;
      for (std::uint32_t t = 0; t < sides.size(); ++t) {
        if (sides[t] != side) continue;
        one.triangles.push_back(t);
        one.first.push_back(static_cast<std::uint32_t>(one.triangles.size()));
      }
      // Generic rays: a closed ray through an edge crosses both of its triangles.
      std::mt19937 random(7);
      std::uniform_real_distribution<double> x(0, 17), y(0, 5), z(0, 9);
      for (int k = 0; k < 300; ++k) {
        const Vec3 p(x(random), y(random), z(random));
        const Vec3 away = light.w == 0 ? Vec3(light) : Vec3(light) - p;
        EXPECT_GE(bound, items_crossed(s.mesh, one, point(p - away * 64.0), light));
      }
    }
  }
  EXPECT_GE(layer_bound(s.mesh, halves, Light(1, 0, 0.001, 0)), 9);
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
    std::vector<CastingSides> casting;  // the ground is not closed
    LayerItems lit;
    for (const Part& part : parts.parts) {
      casting.push_back(part.closed ? CastingSides::one : CastingSides::both);
      for (const std::uint32_t t : part.triangles) {
        if (part.closed && sides[t] != -1) continue;
        lit.triangles.push_back(t);
        if (!part.convex) lit.first.push_back(static_cast<std::uint32_t>(lit.triangles.size()));
      }
      if (part.convex) lit.first.push_back(static_cast<std::uint32_t>(lit.triangles.size()));
    }
    const int bound = layer_bound(s.mesh, layer_items(parts, casting), light);
    const int found = most_found(s.mesh, lit, light, 160, 400, 1);
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
