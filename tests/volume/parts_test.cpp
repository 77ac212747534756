#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "soup.h"

#include <gnomon/silhouette/light_sides.h>
#include <gnomon/volume/parts.h>
#include <scenes/generated_city.h>
#include <scenes/generated_sphere.h>

namespace gnomon {
namespace {

Parts parts_of(const Scene& s, const std::vector<std::uint8_t>& selected = {}) {
  return split_into_parts(s.mesh, build_edge_table(s.mesh), selected);
}

TriMesh box(const Vec3& lo, const Vec3& hi) {
  TriMesh m;
  test::add_box(m, lo, hi);
  return m;
}

TriMesh flipped(TriMesh m) {
  for (Triangle& t : m.triangles) std::swap(t[0], t[2]);
  return m;
}

// Two apexes over a closed walk of corners, wound outwards if the walk is counterclockwise.
TriMesh bipyramid(const std::vector<Vec3>& walk, const Vec3& top, const Vec3& bottom) {
  TriMesh m;
  m.positions = walk;
  const auto n = static_cast<std::uint32_t>(walk.size());
  m.positions.push_back(top);
  m.positions.push_back(bottom);
  for (std::uint32_t k = 0; k < n; ++k) {
    m.triangles.push_back({k, (k + 1) % n, n});
    m.triangles.push_back({(k + 1) % n, k, n + 1});
  }
  return m;
}

std::vector<Vec3> star(int corners, int step) {
  std::vector<Vec3> walk;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * M_PI * k * step / corners;
    walk.push_back({std::cos(angle), std::sin(angle), 0});
  }
  return walk;
}

TEST(Parts, ABoxIsOneClosedConvexPartWithItsBounds) {
  const Parts p = parts_of(test::scene_of(box({1, 2, 3}, {4, 6, 8})));
  ASSERT_EQ(p.parts.size(), 1u);
  EXPECT_TRUE(p.parts[0].closed);
  EXPECT_TRUE(p.parts[0].convex);
  EXPECT_EQ(p.parts[0].winding, 1);
  EXPECT_EQ(p.parts[0].triangles.size(), 12u);
  EXPECT_EQ(p.parts[0].lo, Vec3(1, 2, 3));
  EXPECT_EQ(p.parts[0].hi, Vec3(4, 6, 8));
}

TEST(Parts, ABoxWoundInwardsIsConvexWithTheOtherWinding) {
  const Parts p = parts_of(test::scene_of(flipped(box({0, 0, 0}, {1, 1, 1}))));
  ASSERT_EQ(p.parts.size(), 1u);
  EXPECT_TRUE(p.parts[0].convex);
  EXPECT_EQ(p.parts[0].winding, -1);
}

TEST(Parts, WindingTellsWhichLightSideIsLit) {
  for (const bool inwards : {false, true}) {
    const TriMesh m = box({-1, -1, -1}, {1, 1, 1});
    const Scene s = test::scene_of(inwards ? flipped(m) : m);
    const Parts p = parts_of(s);
    const auto sides = light_sides(s.mesh, Light(0.1, 0.2, 9, 1));  // sees the top alone
    for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) {
      bool top = true;
      for (const std::uint32_t v : s.mesh.triangles[t]) top = top && s.mesh.positions[v].z == 1;
      EXPECT_EQ(sides[t] == -p.parts[0].winding, top);
    }
  }
}

TEST(Parts, PartsThatShareOnlyAVertexStayApart) {
  TriMesh m = box({0, 0, 0}, {1, 1, 1});
  test::add_box(m, {1, 1, 1}, {2, 2, 2});
  const Parts p = parts_of(test::scene_of(m));
  ASSERT_EQ(p.parts.size(), 2u);
  EXPECT_TRUE(p.parts[0].convex && p.parts[1].convex);
}

TEST(Parts, BoxesThatShareAnEdgeAreOneClosedPartThatIsNotConvex) {
  TriMesh m = box({0, 0, 0}, {1, 1, 1});
  test::add_box(m, {1, 1, 0}, {2, 2, 1});
  const Parts p = parts_of(test::scene_of(m));
  ASSERT_EQ(p.parts.size(), 1u);
  EXPECT_TRUE(p.parts[0].closed);
  EXPECT_FALSE(p.parts[0].convex);
}

TEST(Parts, ASheetIsOpenAndABoxWithOneFlippedTriangleIsNotClosed) {
  TriMesh m;
  test::add_ground(m, 5);
  const Parts sheet = parts_of(test::scene_of(m));
  ASSERT_EQ(sheet.parts.size(), 1u);
  EXPECT_FALSE(sheet.parts[0].closed || sheet.parts[0].convex);
  TriMesh b = box({0, 0, 0}, {1, 1, 1});
  std::swap(b.triangles[3][0], b.triangles[3][1]);
  const Parts p = parts_of(test::scene_of(b));
  EXPECT_FALSE(p.parts[0].closed || p.parts[0].convex);
}

TEST(Parts, OnlySelectedTrianglesBelong) {
  TriMesh m = box({0, 0, 0}, {1, 1, 1});
  test::add_box(m, {1, 1, 0}, {2, 2, 1});  // shares an edge, not selected
  std::vector<std::uint8_t> selected(24, 0);
  std::fill(selected.begin(), selected.begin() + 12, 1);
  const Parts p = parts_of(test::scene_of(m), selected);
  ASSERT_EQ(p.parts.size(), 1u);
  EXPECT_TRUE(p.parts[0].convex);
  EXPECT_EQ(std::count(p.part_of.begin(), p.part_of.end(), kNoPart), 12);
  EXPECT_TRUE(parts_of(test::scene_of(m), std::vector<std::uint8_t>(24, 0)).parts.empty());
}

TEST(Parts, ADentOfOneUnitInTheLastPlaceIsNotConvexAndABulgeIs) {
  for (const bool dent : {true, false}) {
    TriMesh m = box({0, 0, 0}, {1, 1, 1});
    // The top gets its middle as a vertex.
    m.triangles.erase(m.triangles.begin() + 2, m.triangles.begin() + 4);
    const auto k = static_cast<std::uint32_t>(m.positions.size());
    m.positions.insert(m.positions.end(), {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}});
    m.positions.push_back({0.5, 0.5, dent ? std::nextafter(1.0, 0) : std::nextafter(1.0, 2)});
    for (std::uint32_t j = 0; j < 4; ++j) m.triangles.push_back({k + j, k + (j + 1) % 4, k + 4});
    const Parts p = parts_of(test::scene_of(m));
    ASSERT_EQ(p.parts.size(), 1u);
    EXPECT_TRUE(p.parts[0].closed);
    EXPECT_EQ(p.parts[0].convex, !dent);
  }
}

TEST(Parts, AThinSliverOfOneUnitInTheLastPlaceIsConvexAndAFlatOneIsNot) {
  const double thin = std::nextafter(1.0, 2);
  EXPECT_TRUE(parts_of(test::scene_of(box({0, 0, 1}, {1, 1, thin}))).parts[0].convex);
  TriMesh flat;
  flat.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  flat.triangles = {{0, 1, 2}, {0, 2, 1}};
  const Parts p = parts_of(test::scene_of(flat));
  ASSERT_EQ(p.parts.size(), 1u);
  EXPECT_TRUE(p.parts[0].closed);
  EXPECT_FALSE(p.parts[0].convex);
}

TEST(Parts, TetrahedraWhoseHeightIsOneRoundingAreConvex) {
  // The fourth corner would be in the plane of the others, but for rounding; seen from the first
  // triangle floating point often finds no height at all.
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(0.5, 1), unit(0.2, 0.4);
  int solid = 0;
  for (int k = 0; k < 2000; ++k) {
    const auto corner = [&] { return Vec3(u(random), u(random), u(random)); };
    const Vec3 a = corner(), b = corner(), c = corner();
    const Vec3 d = a + unit(random) * (b - a) + unit(random) * (c - a);
    const int side =
        det4(lift<Dyadic>(a), lift<Dyadic>(b), lift<Dyadic>(c), lift<Dyadic>(d)).sign();
    TriMesh m;
    m.positions = {a, b, c, d};
    m.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    const Parts p = parts_of(test::scene_of(m));
    ASSERT_EQ(p.parts.size(), 1u);
    EXPECT_EQ(p.parts[0].convex, side != 0);
    EXPECT_EQ(p.parts[0].winding, side);
    solid += side != 0;
  }
  EXPECT_GT(solid, 1500);
}

TEST(Parts, ABipyramidOverAPentagramIsConvexAtEveryEdgeButNotConvex) {
  const Scene once = test::scene_of(bipyramid(star(5, 1), {0, 0, 1}, {0, 0, -1}));
  EXPECT_TRUE(parts_of(once).parts[0].convex);
  const Scene twice = test::scene_of(bipyramid(star(5, 2), {0, 0, 1}, {0, 0, -1}));
  const Parts p = parts_of(twice);
  ASSERT_EQ(p.parts.size(), 1u);
  EXPECT_TRUE(p.parts[0].closed);
  EXPECT_FALSE(p.parts[0].convex);
}

TEST(Parts, ATorusAndAnLAreClosedButNotConvex) {
  TriMesh torus;
  constexpr std::uint32_t n = 12;
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const double u = 2 * M_PI * i / n, v = 2 * M_PI * j / n;
      torus.positions.push_back(
          {(3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v)});
      const std::uint32_t a = i * n + j, b = (i + 1) % n * n + j, c = (i + 1) % n * n + (j + 1) % n,
                          d = i * n + (j + 1) % n;
      torus.triangles.push_back({a, b, c});
      torus.triangles.push_back({a, c, d});
    }
  }
  const Parts p = parts_of(test::scene_of(torus));
  ASSERT_EQ(p.parts.size(), 1u);
  EXPECT_TRUE(p.parts[0].closed);
  EXPECT_FALSE(p.parts[0].convex);
  const Parts l = parts_of(test::scene_of(
      bipyramid({{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2.5, 0.5, 0}}, {2.6, 0.4, 1}, {2.6, 0.4, -1})));
  EXPECT_TRUE(l.parts[0].closed);
  EXPECT_FALSE(l.parts[0].convex);
}

TEST(Parts, SpheresAreConvexAndBumpySpheresAreNot) {
  for (const int levels : {0, 2, 4}) {
    const Parts p = parts_of(scenes::generated_sphere(levels, 5, {100, 20, 3}));
    ASSERT_EQ(p.parts.size(), 1u);
    EXPECT_TRUE(p.parts[0].convex) << levels;
    EXPECT_EQ(p.parts[0].winding, 1);
  }
  const Parts bumpy = parts_of(scenes::generated_sphere(4, 5, Vec3(0.0), 0.2));
  EXPECT_TRUE(bumpy.parts[0].closed);
  EXPECT_FALSE(bumpy.parts[0].convex);
}

// By definition: every vertex behind or on the plane of every triangle, the same way round.
bool all_vertices_behind(const TriMesh& mesh, const Part& part) {
  int seen = 0;
  for (const std::uint32_t t : part.triangles) {
    const auto at = [&](std::size_t k) {
      return lift<Dyadic>(mesh.positions[mesh.triangles[t][k]]);
    };
    for (const std::uint32_t u : part.triangles) {
      for (const std::uint32_t v : mesh.triangles[u]) {
        const int side = det4(at(0), at(1), at(2), lift<Dyadic>(mesh.positions[v])).sign();
        if (side == 0) continue;
        if (seen == 0) seen = side;
        if (side != seen) return false;
      }
    }
  }
  return seen != 0;
}

TEST(Parts, ConvexMeansThatAllVerticesLieBehindAllPlanesInRandomBodies) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> grid(-2, 2);
  int convex = 0, concave = 0;
  for (int k = 0; k < 3000; ++k) {
    // Octahedra with corners on a small grid: many coplanar neighbours, many concave.
    const auto at = [&](double x, double y, double z) {
      return Vec3(x + grid(random) * 0.5, y + grid(random) * 0.5, z + grid(random) * 0.5);
    };
    const Scene s = test::scene_of(bipyramid({at(2, 0, 0), at(0, 2, 0), at(-2, 0, 0), at(0, -2, 0)},
                                             at(0, 0, 2), at(0, 0, -2)));
    const Parts p = parts_of(s);
    for (const Part& part : p.parts) {
      if (!part.closed) continue;
      EXPECT_EQ(part.convex, all_vertices_behind(s.mesh, part)) << k;
      ++(part.convex ? convex : concave);
    }
  }
  EXPECT_GT(convex, 200);
  EXPECT_GT(concave, 200);
}

TEST(Parts, EveryTriangleOfATownIsInExactlyOnePart) {
  const Scene s = scenes::generated_city({.buildings = 40, .seed = 2});
  const Parts p = parts_of(s);
  std::size_t triangles = 0, closed = 0, convex = 0;
  std::uint32_t before = 0;
  for (std::size_t k = 0; k < p.parts.size(); ++k) {
    const Part& part = p.parts[k];
    EXPECT_TRUE(std::is_sorted(part.triangles.begin(), part.triangles.end()));
    EXPECT_TRUE(k == 0 || part.triangles[0] > before);
    before = part.triangles[0];
    for (const std::uint32_t t : part.triangles) EXPECT_EQ(p.part_of[t], k);
    triangles += part.triangles.size(), closed += part.closed, convex += part.convex;
  }
  EXPECT_EQ(triangles, s.mesh.triangles.size());
  EXPECT_GE(closed, 40u);
  EXPECT_GT(convex, 10u);
}

}  // namespace
}  // namespace gnomon
