// The counter against the exact count, which shares no code with it.
#include <gtest/gtest.h>

#include "soup.h"

#include <gnomon/io/load_scene.h>
#include <gnomon/raster/count_shadows.h>
#include <gnomon/raster/visible_surfaces.h>
#include <gnomon/trace/verification_cases.h>

namespace gnomon {
namespace {

std::vector<std::int32_t> counted(const Casters& casters, const Receivers& r, const Light& light) {
  std::vector<std::int32_t> counts(r.triangle.size(), 0);
  count_shadows(casters, r, std::span(&light, 1), [&](const CountBand& b) {
    for (int row = 0; row < b.rows; ++row) {
      for (int x = 0; x < b.width; ++x) {
        counts[static_cast<std::size_t>((b.first_row + row) * b.width + x)] =
            b.counts[row * b.stride + x];
      }
    }
  });
  return counts;
}

// Number of samples whose counts differ, over the lights and views that `gnomon verify` chooses.
std::size_t differences(const Scene& scene, int size, int suns, int points) {
  const Casters casters = prepare_casters(scene);
  const Oracle oracle = build_oracle(scene);
  std::vector<NamedLight> lights = choose_suns(scene, suns);
  for (const NamedLight& p : choose_points(oracle, points)) lights.push_back(p);
  std::vector<NamedView> views = {whole_plan(scene, size), aerial_camera(scene, size)};
  for (const NamedLight& l : lights) {
    if (const auto inside = shaded_camera(oracle, l.light, size)) {
      views.push_back(*inside);
      break;
    }
  }
  std::size_t different = 0;
  for (const NamedView& v : views) {
    const Receivers r = visible_surfaces(scene, v.view);
    for (const NamedLight& l : lights) {
      const auto ours = counted(casters, r, l.light);
      const auto exact = exact_counts(oracle, r, l.light);
      for (std::size_t k = 0; k < ours.size(); ++k) different += ours[k] != exact[k] ? 1 : 0;
    }
  }
  return different;
}

TEST(CounterEqualsOracle, OnViennaUnderSunsAndPointLights) {
  LoadOptions options;
  options.crs = "EPSG:31256";
  const LoadedScene loaded =
      load_scene({GNOMON_SCENES "/vienna/vienna.city.jsonl"}, options).value();
  EXPECT_EQ(differences(loaded.scene, 64, 8, 4), 0u);
}

TEST(CounterEqualsOracle, OnSoupsOnAGridFullOfTies) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    TriMesh m;
    test::add_soup(m, 60, 9, seed % 2 == 0 ? 0 : 3, seed);
    test::add_box(m, {-3, -3, -3}, {3, 6, 3});
    test::add_ground(m, 12, -9);
    EXPECT_EQ(differences(test::scene_of(std::move(m)), 48, 8, 6), 0u) << seed;
  }
}

TEST(CounterEqualsOracle, WhereOnlySomeCastAndOthersReceive) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    TriMesh m;
    test::add_soup(m, 80, 9, seed == 2 ? 3 : 0, seed);
    test::add_ground(m, 12, -9);
    Scene s = test::scene_of(std::move(m));
    s.surfaces.resize(3);
    s.surfaces[1].receives = false;
    s.surfaces[2].casts = false;
    for (std::size_t t = 0; t < s.surface_of.size(); ++t)
      s.surface_of[t] = static_cast<std::uint32_t>(t % 3);
    EXPECT_EQ(differences(s, 48, 8, 6), 0u) << seed;
  }
}

TEST(CounterEqualsOracle, WithDuplicatedAndTouchingFaces) {
  TriMesh m;
  test::add_ground(m, 12, 0);
  test::add_box(m, {-3, -3, 0}, {3, 3, 5});
  test::add_box(m, {3, -3, 0}, {7, 3, 5});   // shares a wall and the level of its roof
  test::add_box(m, {-3, -3, 0}, {3, 3, 5});  // the first once more
  test::add_ground(m, 6, 0);                 // coplanar with the larger ground
  EXPECT_EQ(differences(test::scene_of(std::move(m)), 48, 8, 6), 0u);
}

}  // namespace
}  // namespace gnomon
