#include <gtest/gtest.h>

#include <map>
#include <set>

#include "soup.h"

#include <gnomon/silhouette/light_sides.h>
#include <gnomon/volume/lit_regions.h>
#include <gnomon/volume/loops.h>
#include <scenes/generated_city.h>
#include <scenes/generated_sphere.h>

namespace gnomon {
namespace {

using Chain = std::map<std::pair<std::uint32_t, std::uint32_t>, int>;

// Edges a < b with their signed sums, without zeros; and how many directed edges there are.
Chain chain_of(std::span<const SilhouetteEdge> silhouette, std::size_t& edges) {
  Chain chain;
  edges = 0;
  for (const SilhouetteEdge& e : silhouette) {
    chain[{e.a, e.b}] += e.multiplicity;
    edges += static_cast<std::size_t>(std::abs(e.multiplicity));
  }
  return chain;
}
Chain chain_of(const Loops& loops, std::size_t& edges) {
  Chain chain;
  edges = 0;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const auto loop = loops.loop(k);
    for (std::size_t j = 0; j < loop.size(); ++j) {
      const std::uint32_t p = loop[j], q = loop[(j + 1) % loop.size()];
      chain[{std::min(p, q), std::max(p, q)}] += p < q ? 1 : -1;
      ++edges;
    }
  }
  return chain;
}

void expect_whole(std::span<const SilhouetteEdge> silhouette, const Loops& loops) {
  std::size_t expected_edges = 0, edges = 0;
  const Chain expected = chain_of(silhouette, expected_edges);
  EXPECT_EQ(chain_of(loops, edges), expected);
  EXPECT_EQ(edges, expected_edges);  // nothing walked both ways
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const auto loop = loops.loop(k);
    EXPECT_GE(loop.size(), 3u);
    EXPECT_EQ(std::set<std::uint32_t>(loop.begin(), loop.end()).size(), loop.size());
  }
}

std::vector<Scene> scenes_to_try() {
  std::vector<Scene> all;
  TriMesh soup;
  test::add_soup(soup, 300, 4, 0, 3);
  all.push_back(test::scene_of(soup));
  TriMesh tied;
  test::add_soup(tied, 400, 2, 1, 4);  // few vertices, triangles by the dozen at an edge
  all.push_back(test::scene_of(tied));
  TriMesh boxes;
  test::add_box(boxes, {0, 0, 0}, {1, 1, 1});
  test::add_box(boxes, {1, 1, 0}, {2, 2, 1});  // share an edge
  test::add_box(boxes, {1, 1, 1}, {2, 2, 2});  // and a face
  all.push_back(test::scene_of(boxes));
  TriMesh open;
  test::add_ground(open, 5);
  all.push_back(test::scene_of(open));
  all.push_back(scenes::generated_sphere(4, 5, Vec3(0.0), 0.3));
  all.push_back(scenes::generated_sphere(3, 5));
  all.push_back(scenes::generated_city({.buildings = 30, .seed = 7}));
  return all;
}

TEST(Loops, EdgesAddUpToTheSilhouetteExactlyAndNoLoopMeetsItself) {
  LoopScratch scratch;
  for (const Scene& s : scenes_to_try()) {
    const EdgeTable edges = build_edge_table(s.mesh);
    for (const Light& light : {Light(0.31, 0.23, 0.87, 0), Light(0.17, 0.29, 5.3, 1),
                               Light(0, 0, 1, 0), Light(1, 1, 1, 1)}) {
      const auto sides = light_sides(s.mesh, light);
      const Silhouette silhouette = find_silhouette(edges, sides);
      expect_whole(silhouette, find_loops(silhouette));
      const LitRegions regions = find_lit_regions(edges, sides, -1);
      for (std::size_t k = 0; k < regions.size(); ++k) {
        expect_whole(regions.silhouette_of(k), find_loops(regions.silhouette_of(k), &scratch));
      }
    }
  }
}

TEST(Loops, ABoxHasItsContourTwiceAndItsLitRegionOnce) {
  TriMesh m;
  test::add_box(m, {0, 0, 0}, {1, 1, 1});
  const Scene s = test::scene_of(m);
  const EdgeTable edges = build_edge_table(s.mesh);
  const auto sides = light_sides(s.mesh, Light(1, 2, 3, 0));
  const Loops twice = find_loops(find_silhouette(edges, sides));
  ASSERT_EQ(twice.size(), 2u);
  EXPECT_EQ(twice.loop(0).size(), 6u);
  EXPECT_TRUE(std::ranges::equal(twice.loop(0), twice.loop(1)));
  const Loops once = find_loops(find_lit_regions(edges, sides, -1).silhouette_of(0));
  ASSERT_EQ(once.size(), 1u);
  EXPECT_EQ(once.loop(0).size(), 6u);
}

TEST(Loops, AreTheSameWithAndWithoutSharedMemory) {
  const Scene s = scenes::generated_city({.buildings = 10, .seed = 3});
  const Silhouette silhouette =
      find_silhouette(build_edge_table(s.mesh), light_sides(s.mesh, Light(1, 2, 3, 0)));
  LoopScratch scratch;
  const Loops a = find_loops(silhouette);
  for (int k = 0; k < 2; ++k) {
    const Loops b = find_loops(silhouette, &scratch);
    EXPECT_EQ(a.vertices, b.vertices);
    EXPECT_EQ(a.first, b.first);
  }
}

TEST(Loops, AFigureOfEightIsCutAtItsCrossing) {
  // 0 -> 1 -> 2 -> 0 -> 3 -> 4 -> 0
  const Silhouette eight = {{0, 1, 1}, {0, 2, -1}, {0, 3, 1}, {0, 4, -1}, {1, 2, 1}, {3, 4, 1}};
  const Loops loops = find_loops(eight);
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_EQ(loops.vertices, (std::vector<std::uint32_t>{0, 1, 2, 0, 3, 4}));
}

TEST(Loops, OfNothingAreNone) {
  EXPECT_EQ(find_loops({}).size(), 0u);
  EXPECT_TRUE(find_loops({}).vertices.empty());
}

#ifndef NDEBUG
TEST(LoopsDeathTest, UnbalancedMultiplicitiesAreACallersMistake) {
  const Silhouette unbalanced = {{0, 1, 1}, {0, 2, -1}, {1, 2, 2}};
  EXPECT_DEATH(find_loops(unbalanced), "do not balance");
}
#endif

}  // namespace
}  // namespace gnomon
