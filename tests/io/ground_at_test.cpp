#include <gnomon/io/ground_at.h>

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

using Triangles = std::vector<std::array<Vec3, 3>>;

// A surface of n x n squares of `step` metres, two triangles each, from `corner` on.
template <class Z>
Triangles squares(int n, double step, const Vec2& corner, Z z) {
  Triangles t;
  t.reserve(static_cast<std::size_t>(n) * static_cast<std::size_t>(n) * 2);
  const auto at = [&](int i, int j) {
    const double x = corner.x + i * step, y = corner.y + j * step;
    return Vec3(x, y, z(x, y));
  };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      t.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      t.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return t;
}

TEST(GroundAt, InterpolatesWithinATriangleWhateverItsWinding) {
  for (const bool flipped : {false, true}) {
    Triangles t = {{Vec3(0, 0, 1), Vec3(4, 0, 5), Vec3(0, 4, 9)}};
    if (flipped) std::swap(t[0][1], t[0][2]);
    const GroundAt ground = ground_at(t);
    EXPECT_EQ(ground(1, 1), 1 + 1 + 2.0);
    EXPECT_EQ(ground(2, 1), 1 + 2 + 2.0);
  }
}

TEST(GroundAt, EdgesAndVerticesBelongToBothNeighbours) {
  // Coordinates whose products round: only exact signs leave no gap along the diagonal.
  const Vec3 a(0.1, 0.2, 3), b(1000.7, 0.3, 3), c(900.3, 700.9, 3), d(-0.7, 600.1, 3);
  const GroundAt both = ground_at({{a, b, c}, {a, c, d}});
  const GroundAt first = ground_at({{a, b, c}}), second = ground_at({{a, c, d}});
  for (int k = 0; k <= 1000; ++k) {
    const Vec3 p = a + k / 1000.0 * (c - a);
    EXPECT_EQ(both(p.x, p.y), 3.0) << k;
  }
  for (const Vec3& v : {a, c}) {
    EXPECT_EQ(first(v.x, v.y), 3.0);
    EXPECT_EQ(second(v.x, v.y), 3.0);
  }
}

TEST(GroundAt, AVertexGivesItsOwnHeightToTheBit) {
  const Vec3 a(0.1, 0.2, 0.1), b(3.3, 0.7, 1e-17), c(1.9, 5.3, 123456.789);
  const GroundAt ground = ground_at({{a, b, c}});
  for (const Vec3& v : {a, b, c}) EXPECT_EQ(ground(v.x, v.y), v.z);
}

TEST(GroundAt, NothingOutsideAndInHoles) {
  Triangles t = squares(4, 1, {0, 0}, [](double, double) { return 7.0; });
  t.erase(t.begin() + 10, t.begin() + 12);  // the square 1..2, 1..2
  const GroundAt ground = ground_at(t);
  EXPECT_EQ(ground(0.5, 0.25), 7.0);
  EXPECT_EQ(ground(1.5, 1.25), std::nullopt);
  EXPECT_EQ(ground(1.0, 1.5), 7.0);  // the hole's edge belongs to the square beside it
  EXPECT_EQ(ground(-1e-9, 1), std::nullopt);
  EXPECT_EQ(ground(4.0000001, 1), std::nullopt);
  EXPECT_EQ(ground(1, 1e300), std::nullopt);
  EXPECT_EQ(ground_at({})(0, 0), std::nullopt);
}

TEST(GroundAt, VerticalTrianglesCountForNothing) {
  const GroundAt ground = ground_at({{Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 2, 0)},
                                     {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(1, 0, 9)},
                                     {Vec3(1, 1, 5), Vec3(1, 1, 6), Vec3(1, 1, 7)}});
  EXPECT_EQ(ground(1, 0), 0.0);
  EXPECT_EQ(ground(1, 1), 0.0);
  EXPECT_EQ(ground_at({{Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(1, 0, 9)}})(1, 0), std::nullopt);
}

TEST(GroundAt, TheHighestOfSeveralSurfacesWinsInAnyOrder) {
  Triangles t = squares(3, 2, {0, 0}, [](double x, double) { return x; });
  const Triangles level = squares(1, 6, {0, 0}, [](double, double) { return 3.0; });
  t.insert(t.end(), level.begin(), level.end());
  const GroundAt ground = ground_at(t);
  std::reverse(t.begin(), t.end());
  const GroundAt reversed = ground_at(t);
  for (const double x : {0.0, 1.25, 3.0, 4.5, 6.0}) {
    EXPECT_EQ(ground(x, 2.5), std::max(x, 3.0));
    EXPECT_EQ(reversed(x, 2.5), std::max(x, 3.0));
  }
}

TEST(GroundAt, FewLargeTrianglesAmongManySmallOnesAreFound) {
  Triangles t = squares(200, 0.01, {0, 0}, [](double, double) { return 1.0; });
  for (int k = 0; k < 200; ++k) {
    t.push_back({Vec3(-1e6, -1e6, -k), Vec3(1e6, -1e6, -k), Vec3(0, 1e6, -k)});
  }
  const GroundAt ground = ground_at(t);
  EXPECT_EQ(ground(1.234, 0.567), 1.0);
  EXPECT_EQ(ground(-5000, 77), 0.0);
}

TEST(GroundAt, FiveMillionTrianglesAtRealCoordinatesAnswerEverywhere) {
  const auto z = [](double x, double y) { return 0.25 * (x - 500000) + 0.5 * (y - 4800000); };
  const GroundAt ground = ground_at(squares(1600, 0.5, {500000, 4800000}, z));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> at(0, 800);
  for (int k = 0; k < 100000; ++k) {
    const double x = 500000 + at(random), y = 4800000 + at(random);
    const auto found = ground(x, y);
    ASSERT_TRUE(found) << x << ' ' << y;
    // Differences of coordinates are exact here; what remains are a few roundings at 1e3.
    ASSERT_NEAR(*found, z(x, y), 1e-9);
  }
}

}  // namespace
}  // namespace gnomon
