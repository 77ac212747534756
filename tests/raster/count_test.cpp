#include <gtest/gtest.h>

#include "soup.h"

#include <gnomon/raster/count_shadows.h>
#include <gnomon/raster/visible_surfaces.h>

namespace gnomon {
namespace {

using test::scene_of;

std::vector<std::int32_t> fast_counts(const Scene& scene, const Receivers& r, const Light& light,
                                      int threads = 1) {
  const Casters casters = prepare_casters(scene);
  std::vector<std::int32_t> counts(r.triangle.size(), 0);
  std::int32_t* const to = counts.data();
  count_shadows(casters, r, std::span(&light, 1), std::span(&to, 1), threads);
  return counts;
}

int count_at(const Scene& scene, const View& view, const Light& light, int column, int row) {
  const Receivers r = visible_surfaces(scene, view);
  return fast_counts(scene, r, light)[static_cast<std::size_t>(row * view.width + column)];
}

Scene box_on_ground() {
  TriMesh m;
  test::add_ground(m, 50);
  test::add_box(m, {-5, -5, 0}, {5, 5, 10});
  return scene_of(std::move(m));
}

TEST(CountShadows, BoxShadesGroundBehindItTwiceOnceEnteringOnceLeaving) {
  const Scene scene = box_on_ground();
  const View view = plan_view({-50, -50, 50, 50}, 1, 0);
  const Light sun(-1, 0, 1, 0);  // from the west, 45 degrees: the shadow reaches x = 15
  EXPECT_EQ(count_at(scene, view, sun, 60, 50), 2);  // x = 10.5
  EXPECT_EQ(count_at(scene, view, sun, 64, 50), 2);  // x = 14.5
  EXPECT_EQ(count_at(scene, view, sun, 65, 50), 0);  // x = 15.5
  EXPECT_EQ(count_at(scene, view, sun, 40, 50), 0);  // sunny side
  EXPECT_EQ(count_at(scene, view, sun, 50, 50), 0);  // roof
}

TEST(CountShadows, SunBelowAFlatRoofLeavesItInItsOwnShadow) {
  const Scene scene = box_on_ground();
  const View view = plan_view({-50, -50, 50, 50}, 1, 0);
  EXPECT_GT(count_at(scene, view, Light(-1, 0, -0.1, 0), 50, 50), 0);
}

TEST(CountShadows, ReceiverThatDoesNotCastIsDarkWhereItTurnsAway) {
  Scene scene = box_on_ground();
  scene.surfaces[0].casts = false;
  const View view = plan_view({-50, -50, 50, 50}, 1, 0);
  EXPECT_EQ(count_at(scene, view, Light(-1, 0, -0.1, 0), 50, 50), 1);
  EXPECT_EQ(count_at(scene, view, Light(-1, 0, 0.1, 0), 50, 50), 0);
}

struct Case {
  const char* name;
  Scene scene;
  View view;
  Light light;
};

std::vector<Case> hard_cases() {
  std::vector<Case> cases;
  const View plan = plan_view({-12, -12, 12, 12}, 1, 0);
  const View fine = plan_view({-11.3, -12.1, 12, 12}, 0.7, 0);
  const View camera = perspective_view({14.2, -17.3, 9.1}, {0, 0, 0}, {0, 0, 1}, 0.9, 32, 24);
  const View inside = perspective_view({0.5, 0.25, 0.125}, {5, 3, -2}, {0, 0, 1}, 1.5, 32, 24);
  const View parallel = orthographic_view({14.2, -17.3, 9.1}, {0, 0, 0}, {0, 0, 1}, 22, 32, 24);
  const View on_grid =
      perspective_view({2, 2, 2}, {2, 12, 2}, {0, 0, 1}, 1.5707963267948966, 24, 24);
  const Light lights[] = {{-1, 0, 1, 0}, {0.3, 0.5, 0.2, 0},    {0, 0, 1, 0},
                          {1, 1, 0, 0},  {0.7, -0.7, -0.3, 0},  {2.5, 3.5, 7.25, 1},
                          {2, 2, 2, 1},  {0.5, 0.25, 0.125, 1}, {100, 50, 80, 1},
                          {-3, 4, -6, 1}};
  for (unsigned seed = 1; seed <= 2; ++seed) {
    for (const double grid : {0.0, 2.0}) {
      for (const Light& light : lights) {
        for (const View& view : {plan, fine, camera, inside, parallel, on_grid}) {
          TriMesh m;
          test::add_soup(m, 12, 8, grid, seed);
          if (seed == 2) {
            test::add_ground(m, 10, -8);
            test::add_box(m, {-4, -2, -8}, {2, 4, 2});
          }
          cases.push_back({grid > 0 ? "grid" : "random", scene_of(std::move(m)), view, light});
        }
      }
    }
  }
  return cases;
}

TEST(CountShadows, FastFormEqualsTheSpecificationOnSoupsWithTies) {
  std::size_t k = 0;
  for (const Case& c : hard_cases()) {
    const Receivers r = visible_surfaces(c.scene, c.view);
    ASSERT_EQ(fast_counts(c.scene, r, c.light),
              count_shadows_reference(prepare_casters(c.scene), r, c.light))
        << c.name << " case " << k;
    ++k;
  }
}

TEST(CountShadows, FastFormEqualsTheSpecificationWhereCastersHideReceivers) {
  std::size_t k = 0;
  for (Case& c : hard_cases()) {
    // Every other triangle receives and does not cast, so rays pass through casters before they
    // reach their sample.
    c.scene.surfaces.push_back({});
    c.scene.surfaces[0].receives = false;
    c.scene.surfaces[1].casts = false;
    for (std::size_t t = 0; t < c.scene.surface_of.size(); t += 2) c.scene.surface_of[t] = 1;
    const Receivers r = visible_surfaces(c.scene, c.view);
    ASSERT_EQ(fast_counts(c.scene, r, c.light),
              count_shadows_reference(prepare_casters(c.scene), r, c.light))
        << c.name << " case " << k;
    ++k;
  }
}

TEST(CountShadows, FilmThinnerThanFloatAboveTheDeepestReceiverStillShadesIt) {
  // The receivers' nearness is stored as float, here rounded up past the film's: its sides must not
  // be cut off for it.
  TriMesh m;
  test::add_ground(m, 20, 0.3);
  test::add_ground(m, 5, 0.30000001);
  test::add_quad(m, {15, 15, 17.123}, {16, 15, 17.123}, {16, 16, 17.123}, {15, 16, 17.123});
  Scene s = scene_of(std::move(m));
  s.surfaces.push_back({});
  s.surfaces[0].receives = false;
  s.surfaces[1].casts = false;
  s.surface_of[0] = s.surface_of[1] = 1;
  const Receivers r = visible_surfaces(s, plan_view({-20, -20, 20, 20}, 1, 0));
  const Light light(0.1, 0.2, 1, 0);
  const auto counts = fast_counts(s, r, light);
  EXPECT_EQ(counts, count_shadows_reference(prepare_casters(s), r, light));
  EXPECT_EQ(counts[static_cast<std::size_t>(20 * 40 + 20)], 1);
}

TEST(CountShadows, LightExactlyOppositeTheEyeIsCountedBeyondThePicture) {
  // Strips have no direction on the screen; by the tie rule they are endless, so casters outside
  // the picture count.
  TriMesh m;
  test::add_soup(m, 40, 12, 0, 31);
  test::add_ground(m, 30, -12);
  const Scene s = scene_of(std::move(m));
  const View parallel = orthographic_view({3, -4, 5}, {0, 0, 0}, {0, 0, 1}, 6, 24, 24);
  for (const auto& [view, light] :
       {std::pair{plan_view({-3, -3, 3, 3}, 0.25, 0), Light(0, 0, -2, 0)},
        std::pair{parallel, -parallel.eye}, std::pair{parallel, parallel.eye}}) {
    const Receivers r = visible_surfaces(s, view);
    const auto counts = fast_counts(s, r, light);
    EXPECT_EQ(counts, count_shadows_reference(prepare_casters(s), r, light));
    for (const std::int32_t n : counts) EXPECT_GE(n, 0);
  }
}

TEST(CountShadows, CameraStraightDownOnFlatGroundWithTheLightInItsPlane) {
  TriMesh m;
  test::add_ground(m, 20, 0.123456789);
  test::add_soup(m, 20, 6, 0, 32);
  const Scene s = scene_of(std::move(m));
  for (const double height : {7.7, 9.123, 21.0}) {
    const View view = perspective_view({0.3, 0.2, height}, {0.3, 0.2, 0}, {0, 1, 0}, 1, 26, 26);
    const Receivers r = visible_surfaces(s, view);
    for (const Light& light :
         {Light(1, 0.5, 0, 0), Light(9, 4, 0.123456789, 1), Light(0, 0, 1, 0)}) {
      EXPECT_EQ(fast_counts(s, r, light), count_shadows_reference(prepare_casters(s), r, light))
          << height;
    }
  }
}

TEST(CountShadows, CountsAreNeverNegative) {
  for (const Case& c : hard_cases()) {
    const Receivers r = visible_surfaces(c.scene, c.view);
    for (const std::int32_t n : fast_counts(c.scene, r, c.light)) ASSERT_GE(n, 0);
  }
}

TEST(CountShadows, MasksDoNotDependOnThreadsOrderOrWinding) {
  std::mt19937 random(7);
  for (const Case& c : hard_cases()) {
    const Receivers r = visible_surfaces(c.scene, c.view);
    const auto expected = fast_counts(c.scene, r, c.light);
    EXPECT_EQ(fast_counts(c.scene, r, c.light, 2), expected);
    EXPECT_EQ(fast_counts(c.scene, r, c.light, 7), expected);
    Scene shuffled = c.scene;
    std::shuffle(shuffled.mesh.triangles.begin(), shuffled.mesh.triangles.end(), random);
    for (Triangle& t : shuffled.mesh.triangles) {
      if (random() & 1) std::swap(t[1], t[2]);
    }
    const Receivers again = visible_surfaces(shuffled, c.view, 3);
    EXPECT_EQ(fast_counts(shuffled, again, c.light), expected);
  }
}

}  // namespace
}  // namespace gnomon
