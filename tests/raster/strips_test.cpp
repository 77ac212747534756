// Plans under suns: sides as strips (raster/strip.h) against the specification, sample by sample,
// on every instruction set that the machine offers.
#include <gtest/gtest.h>

#include <cmath>

#include <hwy/targets.h>

#include "soup.h"

#include <gnomon/raster/add_in_shadow.h>
#include <gnomon/raster/count_shadows.h>
#include <gnomon/raster/least_cells.h>
#include <gnomon/raster/visible_surfaces.h>

namespace gnomon {
namespace {

using test::scene_of;

// Counts of every light, row-major.
std::vector<std::vector<std::int32_t>> counts_of(const Casters& casters, const Receivers& r,
                                                 std::span<const Light> lights, int threads = 2) {
  std::vector<std::vector<std::int32_t>> counts(lights.size(),
                                                std::vector<std::int32_t>(r.triangle.size(), -1));
  std::vector<std::int32_t*> to;
  for (std::vector<std::int32_t>& c : counts) to.push_back(c.data());
  count_shadows(casters, r, lights, to, threads);
  return counts;
}

void expect_masks_of_counts(const Casters& casters, const Receivers& r,
                            std::span<const Light> lights,
                            const std::vector<std::vector<std::int32_t>>& counts) {
  std::vector<std::vector<std::uint8_t>> masks(lights.size(),
                                               std::vector<std::uint8_t>(r.triangle.size(), 7));
  std::vector<std::uint8_t*> to;
  for (auto& m : masks) to.push_back(m.data());
  mask_shadows(casters, r, lights, to, 2);
  for (std::size_t l = 0; l < lights.size(); ++l) {
    for (std::size_t k = 0; k < masks[l].size(); ++k)
      ASSERT_EQ(masks[l][k], counts[l][k] > 0 ? 1 : 0) << l << " " << k;
  }
}

void expect_the_specification(const Scene& scene, const View& view, std::span<const Light> lights) {
  const Casters casters = prepare_casters(scene);
  const Receivers r = visible_surfaces(scene, view);
  std::vector<std::vector<std::int32_t>> reference;
  for (const Light& l : lights) reference.push_back(count_shadows_reference(casters, r, l));
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    EXPECT_EQ(counts_of(casters, r, lights), reference) << instruction_set();
    expect_masks_of_counts(casters, r, lights, reference);
  }
  hwy::SetSupportedTargetsForTest(0);
}

// Suns from all sides, high, low, below the horizon, along rows and columns and nearly so.
std::vector<Light> suns() {
  return {{-0.4, 0.3, 0.5, 0},  {0.5, 0.5, 0.25, 0}, {1, 0, 1, 0},         {0, 1, 1, 0},
          {0, -1, 0.125, 0},    {1, 1e-3, 0.5, 0},   {1, 1e-9, 0.5, 0},    {1e-9, -1, 0.5, 0},
          {0, 0, 1, 0},         {1e-7, 1e-7, 1, 0},  {-0.7, 0.7, -0.3, 0}, {0.6, -0.3, 0.01, 0},
          {-1, -1, 1e-6, 0},    {1, 2, 0, 0},        {0.25, 2, 3, 0},      {-2, 1, 8, 0},
          {0.5, -0.5, 0.25, 0}, {-3, -1, 2, 0}};
}

TEST(Strips, OfSoupsWithAndWithoutTiesCountAsTheSpecification) {
  for (unsigned seed = 1; seed <= 2; ++seed) {
    for (const double grid : {0.0, 1.0}) {
      TriMesh m;
      test::add_soup(m, 10, 9, grid, seed);
      test::add_ground(m, 11, -9);
      test::add_box(m, {-4, -2, -9}, {2, 4, 2});
      const Scene scene = scene_of(std::move(m));
      for (const View& view :
           {plan_view({-12, -12, 12, 12}, 1, 0), plan_view({-11.3, -12.1, 12, 12}, 0.6, 0),
            orthographic_view({14.2, -17.3, 9.1}, {0, 0, 0}, {0, 0, 1}, 22, 33, 27)}) {
        expect_the_specification(scene, view, suns());
      }
    }
  }
}

TEST(Strips, RunOverManyBandsAndFarOutOfThePicture) {
  TriMesh m;
  test::add_ground(m, 100, 0.125);
  test::add_box(m, {-70, -3, 0}, {-60, 4, 30});
  test::add_box(m, {20, 20, 0}, {22, 50, 17});
  test::add_quad(m, {-5, 0, 3}, {40, 1e-3, 3}, {40, 1, 9}, {-5, 1, 9});
  const Scene scene = scene_of(std::move(m));
  const std::vector<Light> low = {
      {-1, 0.1, 0.2, 0}, {-0.1, -1, 0.1, 0}, {1, 1, 0.05, 0}, {0.3, -1, 0.4, 0}};
  expect_the_specification(scene, plan_view({-50, -70, 60, 90}, 0.7, 0), low);
}

TEST(Strips, OverEdgesNearlyAlongRowsAndNearlyAlongTheSun) {
  // Edges that rise by less than a pixel over the picture, and by less than rounding; and edges
  // that turn from the sun's direction by as little.
  TriMesh m;
  test::add_ground(m, 40);
  const double hairs[] = {0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3, 0.1};
  double at = -30;
  for (const double hair : hairs) {
    test::add_quad(m, {-20, at, 4}, {20, at + hair, 5}, {20, at + 3, 6}, {-20, at + 3, 6});
    test::add_quad(m, {at, -20, 9}, {at + 10 + hair, -10, 8}, {at + 11, -10, 8}, {at + 1, -20, 9});
    at += 7.5;
  }
  const Scene scene = scene_of(std::move(m));
  const std::vector<Light> lights = {
      {1, 1, 1, 0}, {-1, -1, 2, 0}, {0.2, 1, 1, 0}, {-0.01, -1, 1, 0}};
  expect_the_specification(scene, plan_view({-40, -40, 40, 40}, 0.9, 0), lights);
}

TEST(Strips, FarFromTheOriginCountAsTheSpecification) {
  TriMesh m;
  const Vec3 o(4.0e5, 5.5e6, 120);
  test::add_quad(m, o + Vec3(-20, -20, 0), o + Vec3(20, -20, 1), o + Vec3(20, 20, 2),
                 o + Vec3(-20, 20, 1));
  test::add_box(m, o + Vec3(-5, -4, 0), o + Vec3(3, 6, 11));
  test::add_box(m, o + Vec3(6.01, -9, 0), o + Vec3(6.02, 9, 5));
  const Scene scene = scene_of(std::move(m));
  expect_the_specification(scene, plan_view({o.x - 20, o.y - 20, o.x + 20, o.y + 20}, 0.75, o.z),
                           suns());
}

TEST(Strips, WhereReceiversTouchStripsAreDecidedExactly) {
  // Terraces whose edges end exactly where shadows of 45 degrees do, on pixels' middles.
  TriMesh m;
  test::add_ground(m, 16);
  test::add_box(m, {-6.5, -6.5, 0}, {-1.5, 5.5, 4});
  test::add_box(m, {2.5, -6.5, 0}, {8.5, 5.5, 2});
  test::add_quad(m, {-1.5, -6.5, 4}, {2.5, -6.5, 0}, {2.5, 5.5, 0},
                 {-1.5, 5.5, 4});  // in its plane
  const Scene scene = scene_of(std::move(m));
  const std::vector<Light> lights = {{-1, 0, 1, 0}, {1, 0, 1, 0}, {0, 1, 1, 0}, {-1, -1, 1, 0}};
  expect_the_specification(scene, plan_view({-16, -16, 16, 16}, 1, 0), lights);
}

TEST(Strips, CountMoreThanSixteenBitsHold) {
  // A stack of one sheet 40 000 times: edges of a multiplicity that a strip cannot hold; and beside
  // it as many sheets next to each other, whose strips add up.
  constexpr int kSheets = 40000;
  TriMesh m;
  test::add_ground(m, 20);
  for (int i = 0; i < kSheets; ++i)
    test::add_quad(m, {-9, -2, 5}, {-5, -2, 5}, {-5, 2, 5}, {-9, 2, 5});
  for (int i = 0; i < kSheets; ++i) {
    const double z = 5 + i * 0x1p-16;
    test::add_quad(m, {5, -2, z}, {9, -2, z}, {9, 2, z}, {5, 2, z});
  }
  const Scene scene = scene_of(std::move(m));
  const Receivers r = visible_surfaces(scene, plan_view({-16, -16, 16, 16}, 1, 0));
  const Light light(0, -1, 1, 0);  // the shadow lies five metres to the north
  const auto counts = counts_of(prepare_casters(scene), r, std::span(&light, 1))[0];
  EXPECT_EQ(counts[static_cast<std::size_t>((16 - 5) * 32 + 16 - 7)], kSheets);
  EXPECT_EQ(counts[static_cast<std::size_t>((16 - 5) * 32 + 16 + 7)], kSheets);
  EXPECT_EQ(counts[static_cast<std::size_t>(16 * 32 + 16)], 0);
}

TEST(Strips, GiveNoShadowWhereThereAreNoSamples) {
  TriMesh m;
  test::add_box(m, {-5, -5, 0}, {5, 5, 10});
  const Scene scene = scene_of(std::move(m));
  const std::vector<Light> lights = suns();
  expect_the_specification(scene, plan_view({20, 20, 40, 40}, 1, 0), lights);  // nothing at all
  expect_the_specification(scene, plan_view({-20, -20, 40, 40}, 1, 0), lights);
}

TEST(Strips, UnknownNearnessIsDecidedExactly) {
  TriMesh m;
  test::add_ground(m, 10);
  test::add_box(m, {-3, -3, 0}, {3, 3, 5});
  const Scene scene = scene_of(std::move(m));
  const Casters casters = prepare_casters(scene);
  Receivers r = visible_surfaces(scene, plan_view({-10, -10, 10, 10}, 0.8, 0));
  const std::vector<Light> lights = suns();
  const auto known = counts_of(casters, r, lights);
  for (std::size_t k = 0; k < r.nearness.size(); k += 3)
    r.nearness[k] = std::numeric_limits<float>::quiet_NaN();
  r.cells = {};
  EXPECT_EQ(counts_of(casters, r, lights), known);
}

TEST(LeastCells, AreNeverAboveASampleUnderThem) {
  TriMesh m;
  test::add_soup(m, 60, 30, 0, 5);
  const Scene scene = scene_of(std::move(m));
  Receivers r = visible_surfaces(scene, plan_view({-33, -30, 40, 31}, 0.5, 0));
  ASSERT_FALSE(r.cells.levels.empty());
  EXPECT_EQ(r.cells.levels.back().least.size(), 1u);
  const int width = r.view.width, height = r.view.height;
  for (int size = 1; size < width + 20; size = size * 2 + 1) {
    for (int y = -3; y < height; y += 13) {
      for (int x = -3; x < width; x += 17) {
        double least = std::numeric_limits<double>::infinity();
        for (int j = std::max(y, 0); j <= std::min(y + size / 2, height - 1); ++j) {
          for (int i = std::max(x, 0); i <= std::min(x + size, width - 1); ++i)
            least = std::min(least, double(r.nearness[static_cast<std::size_t>(j * width + i)]));
        }
        EXPECT_LE(least_under(r.cells, x, x + size, y, y + size / 2), least);
      }
    }
  }
}

}  // namespace
}  // namespace gnomon
