#include <gtest/gtest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include <gnomon/core/place.h>
#include <gnomon/view/predicates.h>
#include <gnomon/view/view.h>

namespace gnomon {
namespace {

TEST(View, PlanPixelCentresLieHalfAPixelInside) {
  const View v = plan_view({10, 20, 30, 50}, 0.5, 7);
  EXPECT_EQ(v.width, 40);
  EXPECT_EQ(v.height, 60);
  EXPECT_EQ(pixel_point(v, 0, 0), Vec4(10.25, 49.75, 7, 1));
  EXPECT_EQ(pixel_point(v, 39, 59), Vec4(29.75, 20.25, 7, 1));
}

TEST(View, PlanBoundsThatRoundingMissesAddNoPixel) {
  EXPECT_EQ(plan_view({0, 0, 0.3, 0.7}, 0.1, 0).width, 3);
  EXPECT_EQ(plan_view({0, 0, 0.3, 0.7}, 0.1, 0).height, 7);
  EXPECT_EQ(plan_view({0, 0, 0.31, 0.7}, 0.1, 0).width, 4);
}

TEST(View, PerspectiveCentreRayMeetsTheTarget) {
  const Vec3 eye(3, -7, 5), target(1, 2, 0.5);
  const View v = perspective_view(eye, target, {0, 0, 1}, 60 * kDegree, 101, 75);
  const Vec3 ray = glm::normalize(Vec3(pixel_point(v, 50, 37)));
  EXPECT_NEAR(glm::distance(ray, glm::normalize(target - eye)), 0, 1e-14);
  // Vertical field of view: from the upper to the lower edge.
  const Vec3 top = Vec3(v.origin + 50.5 * v.right),
             bottom = Vec3(v.origin + 50.5 * v.right + 75.0 * v.down);
  EXPECT_NEAR(std::acos(glm::dot(glm::normalize(top), glm::normalize(bottom))), 60 * kDegree,
              1e-12);
  EXPECT_GT(v.right.x, 0);  // looking north, right is east
  EXPECT_LT(v.down.z, 0);
}

TEST(View, OrthographicRaysAreParallelAndCentredOnTheTarget) {
  const View v = orthographic_view({0, -10, 10}, {0, 0, 0}, {0, 0, 1}, 20, 40, 20);
  EXPECT_TRUE(is_parallel(v));
  const Vec4 centre = v.origin + 20.0 * v.right + 10.0 * v.down;
  EXPECT_NEAR(glm::length(Vec3(centre)), 0, 1e-14);
  EXPECT_NEAR(glm::length(Vec3(v.right)), 1, 1e-14);
}

TEST(Predicates, CoverageOfSharedEdgesIsExclusive) {
  // Two triangles of a square whose edges run through pixel centres: every centre inside belongs to
  // exactly one.
  const View v = plan_view({0, 0, 8, 8}, 1, 0);
  const Vec3 a(0.5, 0.5, 0), b(7.5, 0.5, 0), c(7.5, 7.5, 0), d(0.5, 7.5, 0);
  const Corners one = triangle_corners(a, b, c), two = triangle_corners(a, c, d);
  ExactStats stats;
  const Light none(0.0);
  int covered = 0;
  for (int row = 0; row < 8; ++row) {
    for (int column = 0; column < 8; ++column) {
      const int n =
          static_cast<int>(covers(v, column, row, one, facing(v, one, none, stats), none, stats)) +
          static_cast<int>(covers(v, column, row, two, facing(v, two, none, stats), none, stats));
      EXPECT_LE(n, 1);
      covered += n;
    }
  }
  EXPECT_EQ(covered, 49);  // 7 x 7 of the 8 x 8 centres on or in the square: half of its border
  EXPECT_GT(stats.ties, 0u);
}

TEST(Predicates, CoplanarTrianglesAreNotInFrontOfEachOther) {
  const View v = perspective_view({0, 0, 9}, {0.1, 0.2, 0}, {0, 1, 0}, 1, 16, 16);
  const Corners r = triangle_corners({-9, -9, 1}, {9, -9, 1}, {0, 9, 1});
  const Corners c = triangle_corners({-8, -7, 1}, {3, -9, 1}, {5, 9, 1});
  ExactStats stats;
  const Light none(0.0);
  EXPECT_FALSE(
      in_front(v, 8, 8, c, facing(v, c, none, stats), r, facing(v, r, none, stats), none, stats));
  EXPECT_FALSE(
      in_front(v, 8, 8, r, facing(v, r, none, stats), c, facing(v, c, none, stats), none, stats));
}

TEST(Predicates, VerticalEdgeIsSeenEndOnFromAboveOnly) {
  const View plan = plan_view({0, 0, 8, 8}, 1, 0);
  EXPECT_TRUE(seen_end_on(plan, {1, 2, 0}, {1, 2, 9}));
  EXPECT_FALSE(seen_end_on(plan, {1, 2, 0}, {1, std::nextafter(2.0, 3.0), 9}));
  const View camera = perspective_view({1, 2, 20}, {1, 3, 0}, {0, 0, 1}, 1, 8, 8);
  EXPECT_TRUE(seen_end_on(camera, {1, 2, 0}, {1, 2, 9}));
  EXPECT_FALSE(seen_end_on(camera, {1, 2, 0}, {1, 2, 25}));  // the eye is between them
}

}  // namespace
}  // namespace gnomon
