#include <gtest/gtest.h>

#include <cmath>

#include <hwy/targets.h>

#include "soup.h"

#include <gnomon/silhouette/light_sides.h>
#include <gnomon/silhouette/sun_sides.h>
#include <gnomon/silhouette/vector_silhouette.h>

namespace gnomon {
namespace {

// Light sides of soups with ties, of slivers, of meshes far from the origin.
TEST(SunSides, AreLightSidesOnEveryInstructionSet) {
  std::vector<Scene> scenes;
  for (const double grid : {0.0, 1.0}) {
    TriMesh m;
    test::add_soup(m, 1003, 20, grid, 7);  // no whole number of vectors
    scenes.push_back(test::scene_of(m));
    for (Vec3& p : m.positions) p = {p.x * 1e-3, p.y * 1e6, p.z + 1e5};
    scenes.push_back(test::scene_of(m));
  }
  std::vector<Light> suns = {
      {0, 0, 1, 0},   {1, 0, 0, 0},       {1, 1, 0, 0},       {-1, 2, 3, 0},
      {3, -1, -2, 0}, {1e-9, 1, 1e-9, 0}, {0.3, 0.5, 0.2, 0}, {1e-12, 1e-30, 1e-12, 0}};
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (const Scene& s : scenes) {
      const SunPlanes planes = sun_planes(s.mesh, 2);
      for (const Light& given : suns) {
        const Light sun = snapped(given);
        std::vector<std::int8_t> sides;
        ExactStats stats;
        sun_sides(sides, s.mesh, planes, sun, &stats);
        EXPECT_EQ(sides, light_sides(s.mesh, sun));
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(VectorSilhouette, IsTheSilhouetteOnEveryInstructionSet) {
  TriMesh m;
  test::add_soup(m, 301, 20, 4, 3);  // open, and edges of many triangles
  for (int i = 0; i < 100; ++i) {
    const double at = 30 + 3 * i;
    test::add_box(m, {at, 0, 0}, {at + 1 + i % 3, 2, 5});  // some touch
  }
  const Scene s = test::scene_of(std::move(m));
  const EdgeTable edges = build_edge_table(s.mesh);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (const Light& light : {Light(1, 2, 3, 0), Light(0, 0, 1, 0), Light(2, 2, 2, 1)}) {
      const std::vector<std::int8_t> sides = light_sides(s.mesh, light);
      const Silhouette specified = find_silhouette(edges, sides);
      Silhouette found(3);
      find_silhouette_in_vectors(found, edges, sides);
      ASSERT_EQ(found.size(), specified.size());
      for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_EQ(found[k].a, specified[k].a);
        EXPECT_EQ(found[k].b, specified[k].b);
        EXPECT_EQ(found[k].multiplicity, specified[k].multiplicity);
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace
}  // namespace gnomon
