#include <gnomon/io/triangulate.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <set>

namespace gnomon {
namespace {

using Rings = std::vector<std::vector<std::uint32_t>>;

Vec3 area_vector(const std::vector<Vec3>& p, const Triangulation& t) {
  Vec3 sum(0, 0, 0);
  for (const auto& [a, b, c] : t.triangles) sum += glm::cross(p[b] - p[a], p[c] - p[a]) / 2.0;
  return sum;
}

double area(const std::vector<Vec3>& p, const Triangulation& t) {
  double sum = 0;
  for (const auto& [a, b, c] : t.triangles) {
    sum += glm::length(glm::cross(p[b] - p[a], p[c] - p[a])) / 2.0;
  }
  return sum;
}

TEST(Triangulate, ATriangleIsItself) {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Triangulation t = triangulate(p, {{2, 0, 1}});
  ASSERT_EQ(t.triangles.size(), 1u);
  EXPECT_EQ(t.triangles[0], (std::array<std::uint32_t, 3>{2, 0, 1}));
  EXPECT_EQ(t.problem, "");
}

TEST(Triangulate, KeepsTheWindingInEveryDirection) {
  // An L in each coordinate plane, both ways round: area 3, and the sum of area vectors has the
  // same direction.
  const std::vector<Vec2> shape = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool reverse : {false, true}) {
      std::vector<Vec3> p;
      for (const Vec2& s : shape) {
        Vec3 v(5, 5, 5);
        v[(axis + 1) % 3] = s.x;
        v[(axis + 2) % 3] = s.y;
        p.push_back(v);
      }
      std::vector<std::uint32_t> ring = {0, 1, 2, 3, 4, 5};
      if (reverse) std::reverse(ring.begin(), ring.end());
      const Triangulation t = triangulate(p, {ring});
      EXPECT_EQ(t.problem, "");
      EXPECT_EQ(t.triangles.size(), 4u);
      EXPECT_DOUBLE_EQ(area(p, t), 3.0);
      EXPECT_DOUBLE_EQ(area_vector(p, t)[axis], reverse ? -3.0 : 3.0);
    }
  }
}

TEST(Triangulate, ADartIsSplitAtItsReflexCorner) {
  const std::vector<Vec3> p = {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}};
  for (std::uint32_t start = 0; start < 4; ++start) {
    const Triangulation t =
        triangulate(p, {{start, (start + 1) % 4, (start + 2) % 4, (start + 3) % 4}});
    EXPECT_EQ(t.problem, "");
    EXPECT_DOUBLE_EQ(area(p, t), 4.0);
  }
}

TEST(Triangulate, HolesStayOpenHoweverTheyAreWound) {
  std::vector<Vec3> p;
  for (const Vec2& s : {Vec2(0, 0), Vec2(10, 0), Vec2(10, 10), Vec2(0, 10), Vec2(2, 2), Vec2(4, 2),
                        Vec2(4, 4), Vec2(2, 4), Vec2(6, 6), Vec2(8, 6), Vec2(8, 8)}) {
    p.emplace_back(s.x, s.y, 3.0 + s.x);  // a sloping roof
  }
  for (const Rings& rings : {Rings{{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10}},
                             Rings{{0, 1, 2, 3}, {7, 6, 5, 4}, {10, 9, 8}}}) {
    const Triangulation t = triangulate(p, rings);
    EXPECT_EQ(t.problem, "");
    EXPECT_NEAR(area_vector(p, t).z, 100 - 4 - 2, 1e-12);
    EXPECT_NEAR(area(p, t), (100 - 4 - 2) * std::sqrt(2.0), 1e-12);
    EXPECT_EQ(t.triangles.size(), 11u + 2 * 2 - 2);
  }
}

TEST(Triangulate, CornersOnAStraightEdgeAreKept) {
  // Neighbours share these corners; without them there would be cracks.
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 0, 1}, {1, 0, 1}, {0, 0, 1}};
  const Triangulation t = triangulate(p, {{0, 1, 2, 3, 4, 5}});
  EXPECT_EQ(t.problem, "");
  EXPECT_EQ(t.triangles.size(), 4u);
  EXPECT_DOUBLE_EQ(area(p, t), 2.0);
}

TEST(Triangulate, ClosedRingsAndRepeatedCornersAreTolerated) {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 1, 0}};
  const Triangulation t = triangulate(p, {{0, 1, 1, 2, 4, 3, 0}});
  EXPECT_EQ(t.problem, "");
  EXPECT_EQ(t.triangles.size(), 2u);
  EXPECT_DOUBLE_EQ(area(p, t), 1.0);
}

TEST(Triangulate, ARingThatCrossesItselfIsAFanWithAReason) {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  const Triangulation t = triangulate(p, {{0, 1, 2, 3}});
  EXPECT_EQ(t.triangles.size(), 2u);
  EXPECT_EQ(t.problem, "Self-intersection");
}

TEST(Triangulate, ARingThatReachesItsHoleOverASlitIsCoveredExactly) {
  const std::vector<Vec3> p = {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0},
                               {3, 3, 0}, {3, 6, 0}, {6, 6, 0}, {6, 3, 0}};
  const Triangulation t = triangulate(p, {{0, 1, 2, 3, 0, 4, 5, 6, 7, 4}});
  EXPECT_EQ(t.problem, "");
  EXPECT_EQ(t.triangles.size(), 8u);
  EXPECT_DOUBLE_EQ(area(p, t), 81 - 9);
  EXPECT_DOUBLE_EQ(area_vector(p, t).z, 81 - 9);
}

TEST(Triangulate, ARingThatTouchesItselfInACornerIsCoveredExactly) {
  const std::vector<Vec3> p = {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0}};
  const Triangulation t = triangulate(p, {{0, 1, 2, 3, 4, 5}});
  EXPECT_EQ(t.problem, "");
  EXPECT_DOUBLE_EQ(area(p, t), 2.0);
}

TEST(Triangulate, ASpikeHasNoArea) {
  const std::vector<Vec3> p = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 4, 0}, {2, 9, 0}, {0, 4, 0}};
  const Triangulation t = triangulate(p, {{0, 1, 2, 3, 4, 3, 5}});
  EXPECT_EQ(t.problem, "");
  EXPECT_DOUBLE_EQ(area(p, t), 16.0);
}

TEST(Triangulate, AWildRingEndsAndNeverClaimsAWrongArea) {
  // GEOS 3.11's ear clipper never returns from some of these.
  std::mt19937 random(3);
  std::size_t covered = 0;
  for (int run = 0; run < 3000; ++run) {
    std::vector<Vec3> p;
    std::vector<std::uint32_t> ring;
    for (std::uint32_t k = 0; k < 4 + random() % 6; ++k) {
      p.emplace_back(random() % 5, random() % 5, 0);
      ring.push_back(k);
    }
    const Triangulation t = triangulate(p, {ring});
    if (!t.problem.empty()) continue;
    ++covered;
    double signed_area = 0;  // small whole numbers: exact
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec3 &a = p[k], &b = p[(k + 1) % ring.size()];
      signed_area += (a.x * b.y - a.y * b.x) / 2;
    }
    EXPECT_DOUBLE_EQ(area_vector(p, t).z, signed_area);
    EXPECT_DOUBLE_EQ(area(p, t), std::fabs(signed_area)) << "no triangle lies on its back";
  }
  EXPECT_GT(covered, 300u);
}

TEST(Triangulate, AHoleOutsideItsRingIsAProblem) {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                               {5, 5, 0}, {6, 5, 0}, {5, 6, 0}};
  const Triangulation t = triangulate(p, {{0, 1, 2, 3}, {4, 5, 6}});
  EXPECT_EQ(t.triangles.size(), 2u);
  EXPECT_EQ(t.problem, "Hole lies outside shell; its holes were left out");
}

TEST(Triangulate, CornersAboveEachOtherAreAProblem) {
  const std::vector<Vec3> p = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 4, 1}, {-1, 2, 0}};
  const Triangulation t = triangulate(p, {{0, 1, 2, 3, 4, 5}});
  EXPECT_EQ(t.triangles.size(), 4u);
  EXPECT_NE(t.problem, "");
}

TEST(Triangulate, FewerThanThreeDistinctCornersGiveNothing) {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}};
  for (const Rings& rings :
       {Rings{}, Rings{{}}, Rings{{0}}, Rings{{0, 1}}, Rings{{0, 1, 0, 1}}, Rings{{0, 1, 2}}}) {
    const Triangulation t = triangulate(p, rings);
    EXPECT_TRUE(t.triangles.empty());
    EXPECT_NE(t.problem, "");
  }
}

TEST(Triangulate, AHoleWithoutAreaIsLeftOutWithAProblem) {
  const std::vector<Vec3> p = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, 0}, {2, 2, 0}};
  const Triangulation t = triangulate(p, {{0, 1, 2, 3}, {4, 5}});
  EXPECT_DOUBLE_EQ(area(p, t), 16.0);
  EXPECT_NE(t.problem, "");
}

TEST(Triangulate, CollinearCornersAreAFanWithoutArea) {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  const Triangulation t = triangulate(p, {{0, 1, 2, 3}});
  EXPECT_DOUBLE_EQ(area(p, t), 0.0);
  EXPECT_NE(t.problem, "");
}

TEST(Triangulate, StarsOfManyCornersKeepTheirArea) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(1, 10);
  for (const std::size_t n : {5u, 17u, 200u, 1000u}) {
    std::vector<Vec3> p;
    std::vector<std::uint32_t> ring;
    double expected = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double angle = 2 * 3.14159265358979 * static_cast<double>(k) / static_cast<double>(n);
      const double r = radius(random);
      p.emplace_back(1000 + r * std::cos(angle), r * std::sin(angle), 0.5);
      ring.push_back(static_cast<std::uint32_t>(k));
    }
    for (std::size_t k = 0; k < n; ++k) {
      const Vec3 a = p[k] - p[0], b = p[(k + 1) % n] - p[0];
      expected += (a.x * b.y - a.y * b.x) / 2;
    }
    const Triangulation t = triangulate(p, {ring});
    EXPECT_EQ(t.problem, "");
    EXPECT_EQ(t.triangles.size(), n - 2);
    EXPECT_NEAR(area(p, t), expected, 1e-9 * expected);
  }
}

}  // namespace
}  // namespace gnomon
