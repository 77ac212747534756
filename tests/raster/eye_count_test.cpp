#include <gtest/gtest.h>

#include "soup.h"

#include <gnomon/raster/eye_count.h>
#include <gnomon/view/predicates.h>

namespace gnomon {
namespace {

// The specification: the predicate of every caster.
std::int32_t count_one_by_one(const TriMesh& mesh, const std::vector<std::uint8_t>& selected,
                              const View& view, const Light& light) {
  std::int32_t count = 0;
  ExactStats stats;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!selected.empty() && selected[t] == 0) continue;
    const Triangle& c = mesh.triangles[t];
    const Corners corners =
        triangle_corners(mesh.positions[c[0]], mesh.positions[c[1]], mesh.positions[c[2]]);
    if (between_eye_and_light(view, corners, light, stats)) ++count;
  }
  return count;
}

std::int32_t count_fast(const TriMesh& mesh, const std::vector<std::uint8_t>& selected,
                        const View& view, const Light& light, int threads = 2) {
  ExactStats stats;
  return count_between_eye_and_light(mesh, selected, run_boxes(mesh, selected), view, light,
                                     threads, stats);
}

View camera_at(const Vec3& eye) {
  return perspective_view(eye, eye + Vec3(1, 0.5, -0.25), {0, 0, 1}, 1, 8, 8);
}

// Eyes and lamps on and between the points of grids; views and suns along axes and not.
std::vector<View> views() {
  std::vector<View> out;
  for (const Vec3& eye : {Vec3(2, 2, 2), Vec3(0.3, -7.1, 4.4), Vec3(0, 0, 0), Vec3(-40, 3, 25),
                          Vec3(8, -8, 0), Vec3(0.5, 4, 4)})
    out.push_back(camera_at(eye));
  out.push_back(plan_view({-10, -10, 10, 10}, 1, 0));
  out.push_back(orthographic_view({14.2, -17.3, 9.1}, {0, 0, 0}, {0, 0, 1}, 22, 8, 8));
  out.push_back(orthographic_view({1, 1, 0}, {0, 0, 0}, {0, 0, 1}, 22, 8, 8));
  return out;
}

std::vector<Light> lights() {
  return {{0, 0, 1, 0},  {0, 0, -1, 0},     {1, 0, 0, 0},   {-1, 1, 0, 0}, {0.3, 0.5, 0.2, 0},
          {-1, 2, 3, 0}, {1e-9, 1, 0, 0},   {2, 2, 2, 1},   {2, 2, 6, 1},  {0.5, 0.25, 0.125, 1},
          {4, 4, 4, 1},  {-12, 33, 5.5, 1}, {8, 8, 0, 1},   {0, 4, 4, 1},  {0.3, -7.1, 4.4, 1},
          {2, 2, 2, 2},  {3, 1, 2, 0.5},    {1e9, 3, -7, 1}};
}

TEST(EyeCount, OfSoupsWithTiesIsThatOfThePredicateForEveryCaster) {
  int crossed = 0;
  for (const double grid : {0.0, 2.0, 4.0}) {
    TriMesh m;
    test::add_soup(m, 190, 8, grid, 11);
    test::add_box(m, {-4, -4, -4}, {4, 4, 4});
    const TriMesh mesh = test::scene_of(std::move(m)).mesh;
    std::vector<std::uint8_t> some(mesh.triangles.size(), 0);
    for (std::size_t t = 0; t < some.size(); t += t < 100 ? 70 : 3) some[t] = 1;
    for (const View& view : views()) {
      for (const Light& light : lights()) {
        const std::int32_t expected = count_one_by_one(mesh, {}, view, light);
        crossed += expected;
        EXPECT_EQ(count_fast(mesh, {}, view, light), expected);
        EXPECT_EQ(count_fast(mesh, some, view, light), count_one_by_one(mesh, some, view, light));
      }
    }
  }
  EXPECT_GT(crossed, 500);
}

TEST(EyeCount, OfManyRunsIsThatOfThePredicateInAnyOrderOfTriangles) {
  // Small boxes in a row, so that most runs are apart from the segment; then strewn.
  TriMesh row;
  for (int k = 0; k < 900; ++k) {
    const double x = 2 * (k % 30), y = 2 * (k / 30);
    test::add_box(row, {x, y, 0}, {x + 1, y + 1, 1 + k % 5});
  }
  TriMesh strewn = row;
  for (std::size_t t = 0; t < strewn.triangles.size(); ++t)
    strewn.triangles[t] = row.triangles[(t * 7919) % row.triangles.size()];
  for (const View& view : {camera_at({-3, 0.5, 0.5}), camera_at({2, 2, 1}),
                           camera_at({31.3, 30.7, 0.9}), plan_view({0, 0, 60, 60}, 10, 0)}) {
    for (const Light& light : {Light(1, 0, 0, 0), Light(1, 1, 0, 0), Light(0.3, 0.4, 0.05, 0),
                               Light(59, 0.5, 0.5, 1), Light(61, 60.1, 0.7, 1)}) {
      const std::int32_t expected = count_one_by_one(row, {}, view, light);
      for (const int threads : {1, 2, 3}) {
        EXPECT_EQ(count_fast(row, {}, view, light, threads), expected);
        EXPECT_EQ(count_fast(strewn, {}, view, light, threads), expected);
      }
    }
  }
}

TEST(EyeCount, FarFromTheOriginAndOfHairsIsThatOfThePredicate) {
  // Walls in the way whose rims are a hair above or below the line of sight, or on it, where
  // neither float nor double holds the coordinates of boxes well.
  const Vec3 o(4.1e5 + 0.1, -5.5e6 + 0.3, 120.7);
  TriMesh m;
  for (const double hair : {-1e-3, -1e-8, -1e-9, 0.0, 1e-9, 1e-8, 1e-3}) {
    const double x = 10 + 1000 * hair;
    test::add_quad(m, o + Vec3(x, -5, 0), o + Vec3(x, 5, 0), o + Vec3(x, 5, 1 + hair),
                   o + Vec3(x, -5, 1 + hair));
    for (int k = 0; k < 20; ++k)
      test::add_box(m, o + Vec3(x, 20 + k, 0), o + Vec3(x + 1, 20.5 + k, 3));
  }
  const TriMesh mesh = test::scene_of(std::move(m)).mesh;
  const View view = camera_at(o + Vec3(0, 0, 1));
  for (const Light& light :
       {point(o + Vec3(30, 0, 1)), point(o + Vec3(30, 1e-9, 1)), point(o + Vec3(9, 0, 1)),
        Light(1, 0, 0, 0), Light(1, 1e-9, 1e-10, 0), Light(-1, 0, 0, 0)}) {
    EXPECT_EQ(count_fast(mesh, {}, view, light), count_one_by_one(mesh, {}, view, light));
  }
}

TEST(EyeCount, OfNoCastersIsZero) {
  TriMesh m;
  test::add_box(m, {-1, -1, -1}, {1, 1, 1});
  const View view = camera_at({0, 0, 0});
  EXPECT_EQ(count_fast(m, {}, view, Light(1, 2, 3, 0)), 1);
  EXPECT_EQ(count_fast(m, std::vector<std::uint8_t>(12, 0), view, Light(1, 2, 3, 0)), 0);
  EXPECT_EQ(count_fast(TriMesh(), {}, view, Light(1, 2, 3, 0)), 0);
}

}  // namespace
}  // namespace gnomon
