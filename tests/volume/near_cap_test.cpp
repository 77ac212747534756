#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include "soup.h"

#include <gnomon/core/exact.h>
#include <gnomon/silhouette/light_sides.h>
#include <gnomon/silhouette/silhouette.h>
#include <gnomon/volume/near_cap.h>
#include <gnomon/volume/near_clip.h>
#include <scenes/generated_sphere.h>

namespace gnomon {
namespace {

struct Frame {
  Vec3 origin, u, v;
};

NearCap cap_of(const Scene& s, std::size_t t, int side, const Light& light, const CapPlane& plane) {
  const Triangle& v = s.mesh.triangles[t];
  return near_cap(s.mesh.positions[v[0]], s.mesh.positions[v[1]], s.mesh.positions[v[2]], side,
                  light, plane);
}

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double area(const NearCap& cap) {
  double sum = 0;
  for (int k = 1; k + 1 < cap.size; ++k) sum += turn(cap.at[0], cap.at[k], cap.at[k + 1]);
  return sum / 2;
}

// +1 inside a counterclockwise polygon, -1 inside a clockwise one. `margin` becomes the distance
// from its edges' lines, if that is smaller.
int covered(const NearCap& cap, const Vec2& p, double& margin) {
  int left = 0, right = 0;
  for (int k = 0; k < cap.size; ++k) {
    const Vec2 &a = cap.at[k], &b = cap.at[(k + 1) % cap.size];
    const double t = turn(a, b, p), length = std::hypot(b.x - a.x, b.y - a.y);
    if (length == 0) continue;
    left += t > 0, right += t <= 0;
    margin = std::min(margin, std::fabs(t) / length);
  }
  return right == 0 && left > 0 ? 1 : left == 0 && right > 0 ? -1 : 0;
}

int sign4(const Vec4& a, const Vec4& b, const Vec4& c, const Vec4& d) {
  ExactStats ignored;
  return tie_sign({}, ignored, [&]<class T>(int, int, int) {
    return det4<T>(lift<T>(a), lift<T>(b), lift<T>(c), lift<T>(d));
  });
}

int casters_between(const Scene& s, const Vec4& x, const Light& light) {
  int count = 0;
  for (const Triangle& t : s.mesh.triangles) {
    const Vec4 a = point(s.mesh.positions[t[0]]), b = point(s.mesh.positions[t[1]]),
               c = point(s.mesh.positions[t[2]]);
    const int f = sign4(a, b, c, x);
    if (sign4(a, b, c, light) != -f) continue;
    count += sign4(light, x, a, b) == f && sign4(light, x, b, c) == f && sign4(light, x, c, a) == f;
  }
  return count;
}

Frame random_frame(std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1, 1);
  const auto vec = [&] { return Vec3(u(random), u(random), u(random)); };
  return {2.0 * vec(), 3.0 * vec(), 3.0 * vec()};
}

TEST(NearCap, CutsCoverEachPointOfThePlaneAsOftenAsCastersLieBetweenItAndTheLight) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> u(-1, 1);
  int points = 0, shaded = 0, largest = 0;
  for (int k = 0; k < 300; ++k) {
    TriMesh m;
    test::add_soup(m, 12, 4, 0, static_cast<unsigned>(k));
    Scene s = test::scene_of(m);
    const Light light = k % 3 == 0   ? Light(u(random), u(random), u(random), 0)
                        : k % 3 == 1 ? Light(5 * u(random), 5 * u(random), 5 * u(random), 1)
                                     : Light(6 * u(random), 6 * u(random), 6 * u(random), 2);
    const Frame f = random_frame(random);
    const CapPlane plane = cap_plane(f.origin, f.u, f.v);
    const auto sides = light_sides(s.mesh, light);
    std::vector<NearCap> caps;
    for (std::size_t t = 0; t < sides.size(); ++t) {
      caps.push_back(cap_of(s, t, sides[t], light, plane));
      EXPECT_GE(area(caps.back()), -1e-12);
      largest = std::max(largest, caps.back().size);
    }
    for (int j = 0; j < 40; ++j) {
      const Vec2 p(u(random), u(random));
      int count = 0;
      double margin = 1;
      for (const NearCap& cap : caps) count += covered(cap, p, margin);
      if (margin < 1e-9) continue;
      const int expected = casters_between(s, point(f.origin + p.x * f.u + p.y * f.v), light);
      EXPECT_EQ(count, expected) << k;
      ++points, shaded += expected > 0;
    }
  }
  EXPECT_GT(points, 10000);
  EXPECT_GT(shaded, 2000);
  EXPECT_GE(largest, 5);
}

TEST(NearCap, WindingChangesNothing) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-4, 4);
  for (int k = 0; k < 500; ++k) {
    const Vec3 a(u(random), u(random), u(random)), b(u(random), u(random), u(random)),
        c(u(random), u(random), u(random));
    const Light light(u(random), u(random), u(random), k % 2);
    const Frame f = random_frame(random);
    const CapPlane plane = cap_plane(f.origin, f.u, f.v);
    ExactStats stats;
    const NearCap p = near_cap(a, b, c, light_side(a, b, c, light, stats), light, plane);
    const NearCap q = near_cap(c, b, a, light_side(c, b, a, light, stats), light, plane);
    EXPECT_NEAR(area(p), area(q), 1e-12);
    ASSERT_EQ(p.size, q.size);
    for (int i = 0; i < p.size; ++i) {  // the same corners, perhaps from another one on
      bool found = false;
      for (int j = 0; j < q.size; ++j) found = found || p.at[i] == q.at[j];
      EXPECT_TRUE(found);
    }
  }
}

using Bits = std::array<std::uint64_t, 2>;
Bits bits(const Vec2& p) {
  return {std::bit_cast<std::uint64_t>(p.x + 0.0), std::bit_cast<std::uint64_t>(p.y + 0.0)};
}

// The border of all cuts together: directed edges that are not taken back by a neighbour, bit for
// bit; without those along the square.
std::map<std::pair<Bits, Bits>, int> border(const Scene& s, const std::vector<std::int8_t>& sides,
                                            int lit, const Light& light, const CapPlane& plane) {
  std::map<std::pair<Bits, Bits>, int> chain;
  for (std::size_t t = 0; t < sides.size(); ++t) {
    if (lit != 0 && sides[t] != lit) continue;
    const NearCap cap = cap_of(s, t, sides[t], light, plane);
    for (int k = 0; k < cap.size; ++k) {
      const Vec2 &a = cap.at[k], &b = cap.at[(k + 1) % cap.size];
      const auto along = [&](int axis) { return std::fabs(a[axis]) == 1 && a[axis] == b[axis]; };
      if (a == b || along(0) || along(1)) continue;
      const Bits p = bits(a), q = bits(b);
      p < q ? ++chain[{p, q}] : --chain[{q, p}];
    }
  }
  std::erase_if(chain, [](const auto& e) { return e.second == 0; });
  return chain;
}

TEST(NearCap, NeighboursShareTheirCornersBitForBit) {
  // A sphere's triangles all cast. Prisms meet in sides that cancel, but for the contour's (and its
  // own cut with the plane, where the prisms begin and the two triangles at an edge meet).
  const Scene s = scenes::generated_sphere(3, 1.5);
  const EdgeTable edges = build_edge_table(s.mesh);
  std::mt19937 random(12);
  std::uniform_real_distribution<double> u(-4, 4);
  int seen = 0;
  for (int k = 0; k < 60; ++k) {
    const Light light(u(random), u(random), u(random), k % 2);
    const Frame f = random_frame(random);
    const CapPlane plane = cap_plane(f.origin, f.u, f.v);
    const auto sides = light_sides(s.mesh, light);
    // Cuts of the contour's sides and of the casters themselves, as prisms' edges by hand: a prism
    // has one edge on each of its four faces, so what is left is at most one edge for each side of
    // the contour (twice counted) and one for each caster that the plane cuts.
    std::size_t most = 0;
    for (const SilhouetteEdge& e : find_silhouette(edges, sides)) {
      most += e.multiplicity != 0;
    }
    const auto cut = [&](std::size_t t) {
      int above = 0;
      for (const std::uint32_t v : s.mesh.triangles[t]) {
        const Vec4 p = point(s.mesh.positions[v]);
        above += glm::dot(plane.h, p) >= 0;
      }
      return above == 1 || above == 2;
    };
    for (std::size_t t = 0; t < sides.size(); ++t) most += cut(t);
    const auto left = border(s, sides, 0, light, plane);
    EXPECT_LE(left.size(), most);
    seen += !left.empty();
  }
  EXPECT_GT(seen, 10);
}

TEST(NearCap, AFanOfTrianglesLeavesOnlyItsRim) {
  // A disc of 200 triangles around one vertex, wholly before the plane: of its cut nothing is left
  // but the rim.
  TriMesh m;
  constexpr std::uint32_t n = 200;
  m.positions.push_back({0.03, 0.01, 2.1});
  for (std::uint32_t k = 0; k < n; ++k) {
    const double angle = 2 * M_PI * k / n;
    m.positions.push_back({std::cos(angle), std::sin(angle), 2 + 0.1 * std::sin(3 * angle)});
    m.triangles.push_back({0, k + 1, (k + 1) % n + 1});
  }
  const Scene s = test::scene_of(m);
  const CapPlane plane = cap_plane({0.1, 0, 0}, {3, 0.2, 0.1}, {0.3, 3, -0.2});
  const Light sun(0.2, 0.1, 1, 0), lamp(0.3, 0.2, 7, 1);
  for (const Light& light : {sun, lamp}) {
    EXPECT_EQ(border(s, light_sides(s.mesh, light), 0, light, plane).size(), n);
  }
  // The same through a window that cuts the disc's shadow: the rim's edges within it alone.
  const CapPlane window = cap_plane({0.1, 0, 0}, {0.5, 0.2, 0.1}, {0.3, 0.5, -0.2});
  for (const Light& light : {sun, lamp}) {
    EXPECT_LT(border(s, light_sides(s.mesh, light), 0, light, window).size(), n / 2);
  }
}

TEST(NearCap, APrismThatEndsNowhereInThePlaneIsClippedToTheSquare) {
  // A wall across the plane; the light stands low: its shadow in the plane has no end.
  const CapPlane plane = cap_plane({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const Vec3 a(-0.5, -2, -1), b(-0.5, 2, -1), c(-0.5, 0, 3);
  ExactStats stats;
  for (const Light& light : {Light(-1, 0, 0, 0), Light(-1, 0, -0.25, 0), Light(-5, 0, 0, 1)}) {
    const NearCap cap = near_cap(a, b, c, light_side(a, b, c, light, stats), light, plane);
    EXPECT_NEAR(area(cap), 1.5 * 2, 1e-12);  // from x = -0.5 on, all of the square
  }
  const NearCap none =
      near_cap(a, b, c, light_side(a, b, c, Light(1, 0, 0, 0), stats), Light(1, 0, 0, 0), plane);
  EXPECT_NEAR(area(none), 0.5 * 2, 1e-12);
}

TEST(NearCap, PrismsOnTheLightsSideOfThePlaneOnlyReachItBehindTheirTriangle) {
  const CapPlane plane = cap_plane({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  ExactStats stats;
  const Vec3 a(-0.25, -0.25, -1), b(0.25, -0.25, -1), c(0, 0.25, -1);
  const Light below(0, 0, -3, 1), above(0, 0, 3, 1);
  const NearCap cap = near_cap(a, b, c, light_side(a, b, c, below, stats), below, plane);
  EXPECT_EQ(cap.size, 3);
  EXPECT_NEAR(area(cap), 0.125 * 2.25, 1e-12);  // 1.5 times as large
  EXPECT_EQ(near_cap(a, b, c, light_side(a, b, c, above, stats), above, plane).size, 0);
}

TEST(NearCap, IsThereExactlyForTrianglesThatMayShadeTheNearRectangle) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> u(-4, 4);
  int there = 0;
  ExactStats stats;
  for (int k = 0; k < 20000; ++k) {
    TriMesh m;
    for (int j = 0; j < 3; ++j) m.positions.push_back({u(random), u(random), u(random)});
    m.triangles = {{0, 1, 2}};
    const Vec3 &a = m.positions[0], &b = m.positions[1], &c = m.positions[2];
    const Light light(u(random), u(random), u(random), k % 2);
    const Frame f = random_frame(random);
    const NearCap cap =
        near_cap(a, b, c, light_side(a, b, c, light, stats), light, cap_plane(f.origin, f.u, f.v));
    const NearClip near = near_clip_volume(
        {f.origin - f.u - f.v, f.origin + f.u - f.v, f.origin + f.u + f.v, f.origin - f.u + f.v},
        light);
    const std::uint32_t only[] = {0};
    EXPECT_EQ(cap.size > 0, may_any_shade_near(near, m, only)) << k;
    there += cap.size > 0;
  }
  EXPECT_GT(there, 2000);
}

TEST(NearCap, RowsOfAProjectionGiveDeviceCoordinates) {
  // An eye at the origin looking along -z, near plane at 0.5, rectangle 1 x 0.5.
  const double n = 0.5, r = 0.5, t = 0.25;
  const Vec4 x(n / r, 0, 0, 0), y(0, n / t, 0, 0), z(0, 0, -1, -2 * n), w(0, 0, -1, 0);
  const CapPlane rows = cap_plane(x, y, w, w + z),
                 axes = cap_plane({0, 0, -n}, {r, 0, 0}, {0, t, 0});
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-2, 2);
  int seen = 0;
  ExactStats stats;
  for (int k = 0; k < 400; ++k) {
    const Vec3 a(u(random), u(random), u(random)), b(u(random), u(random), u(random)),
        c(u(random), u(random), u(random));
    const Light light(u(random), u(random), u(random), k % 2);
    const int side = light_side(a, b, c, light, stats);
    const NearCap p = near_cap(a, b, c, side, light, rows),
                  q = near_cap(a, b, c, side, light, axes);
    EXPECT_NEAR(area(p), area(q), 1e-9);
    EXPECT_GE(area(p), -1e-12);
    seen += area(p) > 0.01;
  }
  EXPECT_GT(seen, 30);
}

TEST(NearCap, ALightAtAVertexOrInThePlaneGivesCornersInTheSquare) {
  const CapPlane plane = cap_plane({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  ExactStats stats;
  const Vec3 a(0.25, 0.5, 0), b(1, 2, 3), c(-2, 1, -1);
  for (const Light& light : {Light(a, 1), Light(b, 1), Light(0.5, 0.5, 0, 1), Light(1, 1, 0, 0)}) {
    const NearCap cap = near_cap(a, b, c, light_side(a, b, c, light, stats), light, plane);
    for (int k = 0; k < cap.size; ++k) {
      EXPECT_LE(std::fabs(cap.at[k].x), 1);
      EXPECT_LE(std::fabs(cap.at[k].y), 1);
    }
  }
}

}  // namespace
}  // namespace gnomon
