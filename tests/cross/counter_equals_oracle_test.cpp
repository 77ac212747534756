// The counter against the exact count, which shares no code with it.
#include <gtest/gtest.h>

#include "cross/differences.h"
#include "soup.h"

#include <gnomon/io/load_scene.h>

namespace gnomon {
namespace {

using test::differences;

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
