#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "soup.h"

#include <gnomon/silhouette/light_sides.h>
#include <gnomon/volume/lit_regions.h>
#include <scenes/generated_city.h>
#include <scenes/generated_sphere.h>

namespace gnomon {
namespace {

const Light kSun(0.31, 0.23, 0.87, 0), kLamp(0.17, 0.29, 30.3, 1);

bool equal(const SilhouetteEdge& x, const SilhouetteEdge& y) {
  return x.a == y.a && x.b == y.b && x.multiplicity == y.multiplicity;
}

TEST(LitRegions, ABoxHasOneLitRegionAndItsContourOnceRound) {
  TriMesh m;
  test::add_box(m, {0, 0, 0}, {1, 1, 1});
  const Scene s = test::scene_of(m);
  const auto sides = light_sides(s.mesh, kSun);
  const LitRegions lit = find_lit_regions(build_edge_table(s.mesh), sides, -1);
  ASSERT_EQ(lit.size(), 1u);
  EXPECT_EQ(lit.triangles_of(0).size(), 6u);  // three faces
  EXPECT_EQ(lit.silhouette_of(0).size(), 6u);
  for (const SilhouetteEdge& e : lit.silhouette_of(0)) EXPECT_EQ(std::abs(e.multiplicity), 1);
}

TEST(LitRegions, TwoHillsOfOneSurfaceAreTwoRegionsUnderALowSun) {
  // A band with the profile of two ridges; a sun along +x lights one slope of each.
  TriMesh m;
  const double profile[5][2] = {{0, 0}, {1, 1}, {2, 0}, {3, 1}, {4, 0}};
  for (int k = 0; k < 4; ++k) {
    const double x0 = profile[k][0], z0 = profile[k][1], x1 = profile[k + 1][0],
                 z1 = profile[k + 1][1];
    test::add_quad(m, {x0, 0, z0}, {x1, 0, z1}, {x1, 5, z1}, {x0, 5, z0});
  }
  const Scene s = test::scene_of(m);
  const auto sides = light_sides(s.mesh, Light(1, 0, 0.1, 0));
  const LitRegions lit = find_lit_regions(build_edge_table(s.mesh), sides, -1);
  ASSERT_EQ(lit.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(lit.triangles_of(k).size(), 2u);
    EXPECT_EQ(lit.silhouette_of(k).size(), 4u);
  }
  const LitRegions all =
      find_lit_regions(build_edge_table(s.mesh), sides, std::vector<std::uint8_t>(8, 1));
  EXPECT_EQ(all.size(), 1u);
}

TEST(LitRegions, RegionsThatMeetInAVertexAloneAreTwo) {
  TriMesh m;
  test::add_quad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  test::add_quad(m, {1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0});
  const Scene s = test::scene_of(m);
  const LitRegions lit = find_lit_regions(build_edge_table(s.mesh), light_sides(s.mesh, kSun), -1);
  EXPECT_EQ(lit.size(), 2u);
}

TEST(LitRegions, NothingLitIsNoRegion) {
  TriMesh m;
  test::add_ground(m, 1);
  const Scene s = test::scene_of(m);
  const auto sides = light_sides(s.mesh, kSun);
  const LitRegions none = find_lit_regions(build_edge_table(s.mesh), sides, 1);
  EXPECT_EQ(none.size(), 0u);
  EXPECT_TRUE(none.edges.empty() && none.triangles.empty());
  EXPECT_EQ(none.region_of, std::vector<std::uint32_t>(2, kNoRegion));
  EXPECT_EQ(find_lit_regions(build_edge_table(s.mesh), sides, -1, {0, 0}).size(), 0u);
}

std::vector<Scene> scenes_to_try() {
  std::vector<Scene> all;
  TriMesh soup;
  test::add_soup(soup, 60, 4, 2, 3);  // on a grid: shared edges, many triangles at some
  test::add_box(soup, {0, 0, 0}, {2, 2, 2});
  all.push_back(test::scene_of(soup));
  TriMesh boxes;
  test::add_box(boxes, {0, 0, 0}, {1, 1, 1});
  test::add_box(boxes, {1, 1, 0}, {2, 2, 1});
  all.push_back(test::scene_of(boxes));
  all.push_back(scenes::generated_sphere(4, 5, Vec3(0.0), 0.3));
  all.push_back(scenes::generated_city({.buildings = 25, .seed = 5}));
  return all;
}

TEST(LitRegions, EachHasTheSilhouetteOfItsTrianglesAlone) {
  for (const Scene& s : scenes_to_try()) {
    const EdgeTable edges = build_edge_table(s.mesh);
    for (const Light& light : {kSun, kLamp}) {
      const auto sides = light_sides(s.mesh, light);
      for (const int lit : {-1, 0, 1}) {  // 0: all triangles
        std::vector<std::uint8_t> all(sides.size(), 1);
        const LitRegions regions =
            lit == 0 ? find_lit_regions(edges, sides, all) : find_lit_regions(edges, sides, lit);
        EXPECT_EQ(regions.region_of.size(), sides.size());
        std::size_t triangles = 0;
        for (std::size_t k = 0; k < std::min<std::size_t>(regions.size(), 40); ++k) {
          std::vector<std::uint8_t> mine(sides.size(), 0);
          for (const std::uint32_t t : regions.triangles_of(k)) mine[t] = 1;
          const Silhouette expected = find_silhouette(build_edge_table(s.mesh, mine), sides);
          const auto got = regions.silhouette_of(k);
          EXPECT_TRUE(std::equal(got.begin(), got.end(), expected.begin(), expected.end(), equal));
        }
        for (std::size_t k = 0; k < regions.size(); ++k) {
          const auto mine = regions.triangles_of(k);
          EXPECT_TRUE(std::is_sorted(mine.begin(), mine.end()));
          for (const std::uint32_t t : mine) {
            EXPECT_EQ(regions.region_of[t], k);
            EXPECT_TRUE(lit == 0 || sides[t] == lit);
          }
          triangles += mine.size();
        }
        EXPECT_EQ(triangles,
                  lit == 0 ? sides.size()
                           : static_cast<std::size_t>(std::count(sides.begin(), sides.end(), lit)));
      }
    }
  }
}

TEST(LitRegions, NeighboursAreInOneRegionAndRegionsAreConnected) {
  for (const Scene& s : scenes_to_try()) {
    const EdgeTable edges = build_edge_table(s.mesh);
    const auto sides = light_sides(s.mesh, kLamp);
    const LitRegions regions = find_lit_regions(edges, sides, -1);
    // Labels spread over edges until nothing changes, the slow way.
    std::vector<std::uint32_t> label(sides.size());
    for (std::uint32_t t = 0; t < label.size(); ++t) label[t] = t;
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t k = 0; k < edges.vertices.size(); ++k) {
        for (std::uint32_t i = edges.first[k]; i < edges.first[k + 1]; ++i) {
          for (std::uint32_t j = edges.first[k]; j < edges.first[k + 1]; ++j) {
            const std::uint32_t t = edges.incidence[i] >> 1, u = edges.incidence[j] >> 1;
            if (sides[t] != -1 || sides[u] != -1 || label[t] <= label[u]) continue;
            label[t] = label[u];
            changed = true;
          }
        }
      }
    }
    for (std::size_t k = 0; k < regions.size(); ++k) {
      const auto mine = regions.triangles_of(k);
      for (const std::uint32_t t : mine) EXPECT_EQ(label[t], mine[0]);
    }
  }
}

TEST(LitRegions, OfAClosedMeshTogetherAreHalfItsSilhouette) {
  const Scene s = scenes::generated_sphere(4, 5, Vec3(0.0), 0.3);
  const EdgeTable edges = build_edge_table(s.mesh);
  for (const Light& light : {kSun, kLamp}) {
    const auto sides = light_sides(s.mesh, light);
    const LitRegions regions = find_lit_regions(edges, sides, -1);
    EXPECT_GT(regions.size(), 1u);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sum;
    for (const SilhouetteEdge& e : regions.edges) sum[{e.a, e.b}] += 2 * e.multiplicity;
    std::size_t matched = 0;
    for (const SilhouetteEdge& e : find_silhouette(edges, sides)) {
      EXPECT_EQ((sum[{e.a, e.b}]), e.multiplicity);
      ++matched;
    }
    EXPECT_EQ(matched, sum.size());
  }
}

}  // namespace
}  // namespace gnomon
