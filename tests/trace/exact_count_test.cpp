#include <gnomon/trace/exact_count.h>

#include <gtest/gtest.h>

#include <cmath>

#include "small_scenes.h"

namespace gnomon {
namespace {

using namespace test;

// One pixel of size 1 whose centre is (x, y).
View pixel_at(double x, double y) {
  return plan_view({x - 0.5, y - 0.5, x + 0.5, y + 0.5}, 1.0, 0.0);
}

std::int32_t count_at(const Scene& scene, const View& view, const Light& light) {
  const Receivers r = see(scene, view);
  EXPECT_NE(r.triangle[0], kNoTriangle);
  const std::int32_t n = exact_counts(scene, r, light, 1)[0];
  EXPECT_EQ(n, exact_count_at(scene, r, light, 0, 0));
  return n;
}

const Light kUp(0, 0, 1, 0), kDown(0, 0, -1, 0);

// A level square of side 2 around the origin at height 1, above a ground that does not cast; the
// square does not receive.
Scene table() {
  Scene s = empty_scene();
  add_ground(s, 10, 0);
  add_ground(s, 1, 1, kCastsOnly);
  return finished(std::move(s));
}

TEST(ExactCount, IsOneUnderATableAndZeroBesideIt) {
  EXPECT_EQ(count_at(table(), pixel_at(0.25, 0.5), kUp), 1);
  EXPECT_EQ(count_at(table(), pixel_at(1.25, 0.5), kUp), 0);
  const Light slanted(1, 0, 1,
                      0);  // from the east at 45 degrees: the shadow moves by 1 to the west
  EXPECT_EQ(count_at(table(), pixel_at(-1.75, 0.5), slanted), 1);
  EXPECT_EQ(count_at(table(), pixel_at(0.25, 0.5), slanted), 0);
}

TEST(ExactCount, IsOneOnTheSharedEdgeOfTwoTriangles) {
  EXPECT_EQ(count_at(table(), pixel_at(0, 0), kUp), 1);
  EXPECT_EQ(count_at(table(), pixel_at(0.5, 0.5), kUp), 1);
}

TEST(ExactCount, GivesEachBorderOfATableToOneSideOnly) {
  // The pixel's centre counts as moved to the right (east) and then down (south).
  EXPECT_EQ(count_at(table(), pixel_at(-1, 0.5), kUp), 1);
  EXPECT_EQ(count_at(table(), pixel_at(1, 0.5), kUp), 0);
  EXPECT_EQ(count_at(table(), pixel_at(0.5, 1), kUp), 1);
  EXPECT_EQ(count_at(table(), pixel_at(0.5, -1), kUp), 0);
}

TEST(ExactCount, EndsAtAPointLight) {
  EXPECT_EQ(count_at(table(), pixel_at(0.25, 0.5), Light(0, 0, 5, 1)), 1);
  EXPECT_EQ(count_at(table(), pixel_at(0.25, 0.5), Light(0, 0, 0.5, 1)), 0);
  EXPECT_EQ(count_at(table(), pixel_at(1.75, 0.5), Light(0, 0, 2, 1)),
            1);  // twice the table's size
  EXPECT_EQ(count_at(table(), pixel_at(2.25, 0.5), Light(0, 0, 2, 1)), 0);
}

TEST(ExactCount, IsOneWhereAReceiverThatDoesNotCastIsTurnedAway) {
  EXPECT_EQ(count_at(table(), pixel_at(5, 5), kDown), 1);
  EXPECT_EQ(count_at(table(), pixel_at(5, 5), Light(0, 0, -1, 1)), 1);
}

TEST(ExactCount, CountsItsOwnReceiverExactlyWhereItsUnlitSideIsSeen) {
  Scene s = empty_scene();
  add_ground(s, 10, 0, kBoth);
  s = finished(std::move(s));
  EXPECT_EQ(count_at(s, pixel_at(5, 4), kUp), 0);
  EXPECT_EQ(count_at(s, pixel_at(5, 4), kDown), 1);
}

TEST(ExactCount, LetsCoincidentTrianglesShadeOnlyWhatTurnsAway) {
  Scene s = empty_scene();
  add_triangle(s, Vec3(-9, -9, 0), Vec3(9, -9, 0), Vec3(0, 9, 0));
  add_triangle(s, Vec3(-9, -9, 0), Vec3(0, 9, 0), Vec3(9, -9, 0));  // wound the other way
  add_triangle(s, Vec3(-8, -8, 0), Vec3(8, -8, 0), Vec3(0, 8, 0));  // in the same plane
  s = finished(std::move(s));
  EXPECT_EQ(count_at(s, pixel_at(0.25, 0.5), kUp), 0);
  EXPECT_EQ(count_at(s, pixel_at(0.25, 0.5), kDown), 3);
}

TEST(ExactCount, IsTwoBehindAClosedBox) {
  Scene s = empty_scene();
  add_ground(s, 100, 0);
  add_box(s, Vec3(0, 0, 0), Vec3(2, 2, 4));
  s = finished(std::move(s));
  const Light east(1, 0, 0.5, 0);
  EXPECT_EQ(count_at(s, pixel_at(-3.5, 1.25), east), 2);
  EXPECT_EQ(count_at(s, pixel_at(-8.5, 1.25), east), 0);  // the shadow is 8 long
  EXPECT_EQ(count_at(s, pixel_at(1.25, 1.5), east), 0);   // the roof
}

TEST(ExactCount, TreatsALightInATrianglesPlaneAsMovedAlongX) {
  // A vertical wall in the plane x = 0 and the sun in that plane: as if the sun stood a little to
  // the east, so the ground just west of the wall is not reached by any shadow at a distance, and
  // the wall's east face is lit.
  Scene s = empty_scene();
  add_ground(s, 100, 0);
  add_quad(s, Vec3(0, -5, 0), Vec3(0, 10, 0), Vec3(0, 0, 5));
  s = finished(std::move(s));
  EXPECT_EQ(count_at(s, pixel_at(-0.25, 0.5), kUp), 0);
  EXPECT_EQ(count_at(s, pixel_at(0.25, 0.5), kUp), 0);
  const View from_east =
      orthographic_view(Vec3(10, 0, 2.25), Vec3(0, 0, 2.25), Vec3(0, 0, 1), 1, 1, 1);
  const View from_west =
      orthographic_view(Vec3(-10, 0, 2.25), Vec3(0, 0, 2.25), Vec3(0, 0, 1), 1, 1, 1);
  EXPECT_EQ(count_at(s, from_east, kUp), 0);
  EXPECT_EQ(count_at(s, from_west, kUp), 1);
}

// All lights of these tests over a soup: directions and points, on the grid and off it.
const Light kLights[] = {Light(0, 0, 1, 0),         Light(1, 0, 0, 0),  Light(1, 1, 0, 0),
                         Light(1, 2, 3, 0),         Light(-1, 0, 1, 0), Light(0.3, -0.2, 0.7, 0),
                         Light(2, 2, 2, 1),         Light(1, 2, 9, 1),  Light(0, 0, -1, 0),
                         Light(2.5, 1.25, 1.75, 1), Light(-3, 2, 2, 1)};

std::vector<View> views() {
  const Vec3 up(0, 0, 1);
  View ortho = orthographic_view(Vec3(9, 7, 8), Vec3(2, 2, 2), up, 6, 9, 9);
  View inside = perspective_view(Vec3(2, 2, 2), Vec3(3, 4, 2), up, 1.5, 9, 9);
  return {plan_view({-0.5, -0.5, 4.5, 4.5}, 0.5, 0.0),      // centres off the grid
          plan_view({-0.25, -0.25, 4.25, 4.25}, 0.5, 0.0),  // centres on the grid
          ortho, perspective_view(Vec3(9, -7, 8), Vec3(2, 2, 2), up, 0.6, 9, 9), inside};
}

TEST(ExactCount, MatchesTheCountWithoutTreeAndFilterOnSoupsFullOfTies) {
  OracleStats stats;
  std::int64_t sum = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Scene s = grid_soup(seed, 40, 5);
    const Oracle oracle = build_oracle(s);
    for (const View& view : views()) {
      const Receivers r = see(s, view);
      for (const Light& light : kLights) {
        const std::vector<std::int32_t> counts = exact_counts(oracle, r, light, 2, &stats);
        for (int row = 0; row < view.height; ++row) {
          for (int column = 0; column < view.width; ++column) {
            const auto k = static_cast<std::size_t>(row * view.width + column);
            ASSERT_EQ(counts[k], exact_count_at(s, r, light, column, row))
                << seed << " " << column << " " << row;
            sum += counts[k];
          }
        }
      }
    }
  }
  EXPECT_GT(sum, 10000);
  EXPECT_GT(stats.signs.ties, 1000u);
}

TEST(ExactReceivers, MatchTheFirstHitWithoutTreeOnSoupsFullOfTies) {
  OracleStats stats;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const Scene s = grid_soup(seed, 40, 5);
    const Oracle oracle = build_oracle(s);
    for (const View& view : views()) {
      const std::vector<std::uint32_t> first = exact_receivers(oracle, view, 2, &stats);
      for (int row = 0; row < view.height; ++row) {
        for (int column = 0; column < view.width; ++column) {
          const auto k = static_cast<std::size_t>(row * view.width + column);
          ASSERT_EQ(first[k], exact_receiver_at(s, view, column, row))
              << seed << " " << column << " " << row;
        }
      }
    }
  }
  EXPECT_GT(stats.samples, 1000u);
  EXPECT_GT(stats.signs.ties, 1000u);
}

TEST(ExactReceivers, AreNoneWhereTheRayMeetsNothing) {
  const Scene s = table();
  EXPECT_EQ(see(s, pixel_at(20, 0)).triangle[0], kNoTriangle);
  const View away = perspective_view(Vec3(0, 0, 5), Vec3(0, 0.01, 9), Vec3(0, 0, 1), 0.5, 1, 1);
  EXPECT_EQ(see(s, away).triangle[0], kNoTriangle);
}

TEST(ExactReceivers, LeaveOutWhatDoesNotReceive) {
  const Scene s = table();
  EXPECT_FALSE(casts(s, see(s, pixel_at(0.25, 0.5)).triangle[0]));
}

std::vector<std::int32_t> counts_of(const Scene& s, const View& view, const Light& light) {
  return exact_counts(s, see(s, view), light, 1);
}

TEST(ExactCount, DoesNotDependOnOrderAndWindingOfTriangles) {
  const Scene s = grid_soup(7, 40, 5);
  // Coplanar receivers are told apart by their index, so the samples' triangles may change; only
  // casters are compared here.
  Scene other = s;
  for (std::size_t t = 0; t < s.mesh.triangles.size(); t += 2)
    std::swap(other.mesh.triangles[t][0], other.mesh.triangles[t][2]);
  std::reverse(other.mesh.triangles.begin(), other.mesh.triangles.end());
  std::reverse(other.surface_of.begin(), other.surface_of.end());
  const auto last = static_cast<std::uint32_t>(s.mesh.triangles.size() - 1);
  for (const View& view : views()) {
    const Receivers r = see(s, view);
    Receivers turned = r;
    for (std::uint32_t& t : turned.triangle) t = t == kNoTriangle ? t : last - t;
    for (const Light& light : kLights)
      EXPECT_EQ(exact_counts(s, r, light, 1), exact_counts(other, turned, light, 1));
  }
}

// Ties fall as if the inputs were really moved by small steps. The inputs are small integers (and
// halves), so the values that are not zero are far larger than these steps, and the moved inputs
// are exact in double.
constexpr double kPixelStep = 0x1p-14, kLightStep = 0x1p-16, kEyeStep = 0x1p-12;

TEST(Ties, FallAsIfThePixelCentreWereMoved) {
  int moved = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Scene s = grid_soup(seed, 30, 4);
    View view = plan_view({-0.5, -0.5, 4.5, 4.5}, 1.0, 0.0);  // centres on the grid
    view.eye = Vec4(0.125, 0.0625, 1, 0);
    View there = view;
    there.origin += kPixelStep * view.right + kPixelStep * kPixelStep * view.down;
    const Light light(0.1875, 0.3125, 0.5, 0);
    ASSERT_EQ(see(s, view).triangle, see(s, there).triangle);
    ASSERT_EQ(counts_of(s, view, light), counts_of(s, there, light));
    View back = view;
    back.origin -= kPixelStep * view.right + kPixelStep * kPixelStep * view.down;
    moved += counts_of(s, view, light) != counts_of(s, back, light) ? 1 : 0;
  }
  EXPECT_GT(moved, 0) << "no tie mattered";
}

TEST(Ties, FallAsIfTheLightWereMoved) {
  int moved = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Scene s = grid_soup(seed, 30, 4);
    // Centres in no special place: a tie of the pixel as well would be broken by the pixel first.
    View view = plan_view({-0.43713, -0.37241, 3.56287, 3.62759}, 0.5, 0.0);
    view.eye = Vec4(0.125, 0.0625, 1, 0);
    const Receivers r = see(s, view);
    for (const Light& light :
         {Light(0, 0, 1, 0), Light(1, 0, 0, 0), Light(2, 1, 3, 1), Light(1, 1, 1, 0)}) {
      const Light step(kLightStep, kLightStep * kLightStep, kLightStep * kLightStep * kLightStep,
                       0);
      ASSERT_EQ(exact_counts(s, r, light, 1), exact_counts(s, r, light + step, 1));
      moved += exact_counts(s, r, light, 1) != exact_counts(s, r, light - step, 1) ? 1 : 0;
    }
  }
  EXPECT_GT(moved, 0) << "no tie mattered";
}

TEST(Ties, FallAsIfTheEyeWereMoved) {
  int moved = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Scene s = grid_soup(seed, 30, 4);
    View view = plan_view({-0.4375, -0.375, 3.5625, 3.625}, 0.5, 0.0);
    for (const Vec4& eye : {Vec4(0, 0, 1, 0), Vec4(1, 0, 1, 0)}) {
      view.eye = eye;
      const Vec4 step(kEyeStep, kEyeStep * kEyeStep, kEyeStep * kEyeStep * kEyeStep, 0);
      View there = view, back = view;
      there.eye += step;
      back.eye -= step;
      const Light light(0.1875, 0.3125, 0.5, 0);
      ASSERT_EQ(see(s, view).triangle, see(s, there).triangle);
      ASSERT_EQ(counts_of(s, view, light), counts_of(s, there, light));
      // With the eye moved the other way, edge-on walls show their other side.
      for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) {
        const Receivers one = on_triangle(view, static_cast<std::uint32_t>(t)),
                        other = on_triangle(back, static_cast<std::uint32_t>(t));
        moved += exact_counts(s, one, light, 1) != exact_counts(s, other, light, 1) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(moved, 0) << "no tie mattered";
}

}  // namespace
}  // namespace gnomon
