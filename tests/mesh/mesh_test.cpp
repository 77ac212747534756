#include <gtest/gtest.h>

#include "soup.h"

#include <gnomon/mesh/edge_table.h>
#include <gnomon/mesh/weld.h>

namespace gnomon {
namespace {

TEST(Weld, BoxOfSixQuadsHasEightVertices) {
  TriMesh m;
  test::add_box(m, {0, 0, 0}, {1, 2, 3});
  std::vector<std::uint32_t> per(m.triangles.size());
  for (std::uint32_t k = 0; k < per.size(); ++k) per[k] = k;
  const WeldReport r = weld(m, per);
  EXPECT_EQ(m.positions.size(), 8u);
  EXPECT_EQ(m.triangles.size(), 12u);
  EXPECT_EQ(r.merged_vertices, 16u);
  EXPECT_EQ(r.zero_area_triangles, 0u);
}

TEST(Weld, DropsTrianglesOfZeroAreaWithTheirEntriesAndKeepsOrder) {
  TriMesh m;
  m.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  m.triangles = {{0, 1, 3}, {0, 1, 2}, {1, 2, 3}, {0, 0, 3}};
  std::vector<std::uint32_t> per = {10, 11, 12, 13};
  const WeldReport r = weld(m, per);
  EXPECT_EQ(r.zero_area_triangles, 2u);
  EXPECT_EQ(r.first_zero_area, 1u);
  EXPECT_EQ(per, (std::vector<std::uint32_t>{10, 12}));
}

TEST(Weld, MinusZeroIsZeroAndSpecksBelowTheSmallestCoordinateAreCounted) {
  TriMesh m;
  m.positions = {{0.0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, 0, 1e-40}, {1, 0, 0}, {0, 0, 1}};
  m.triangles = {{0, 1, 2}, {3, 4, 5}};
  std::vector<std::uint32_t> per = {0, 0};
  EXPECT_EQ(weld(m, per).snapped_coordinates, 1u);
  EXPECT_EQ(m.positions.size(), 4u);
  EXPECT_EQ(m.triangles[0][0], m.triangles[1][0]);
}

TEST(Weld, TrianglesWithTheSameCornersInAnyOrderAreCounted) {
  TriMesh m;
  m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  m.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 2, 0}, {3, 1, 0}, {0, 1, 2}, {1, 2, 3}};
  const Coincident found = find_coincident(m);
  EXPECT_EQ(found.triangles, 3u);
  EXPECT_EQ(found.first, 2u);
  m.triangles.resize(2);
  EXPECT_EQ(find_coincident(m).triangles, 0u);
}

TEST(EdgeTable, ClosedBoxHasEighteenEdgesWithTwoOppositeTriangles) {
  TriMesh m;
  test::add_box(m, {0, 0, 0}, {1, 1, 1});
  const Scene s = test::scene_of(m);
  const EdgeTable t = build_edge_table(s.mesh);
  ASSERT_EQ(t.vertices.size(), 18u);
  for (std::size_t k = 0; k < t.vertices.size(); ++k) {
    EXPECT_LT(t.vertices[k][0], t.vertices[k][1]);
    ASSERT_EQ(t.first[k + 1] - t.first[k], 2u);
    EXPECT_NE(t.incidence[t.first[k]] & 1, t.incidence[t.first[k] + 1] & 1);
  }
}

TEST(EdgeTable, KeepsAllTrianglesOfANonManifoldEdge) {
  TriMesh m;
  m.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}};
  m.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  const EdgeTable t = build_edge_table(m);
  EXPECT_EQ(t.vertices.size(), 7u);
  EXPECT_EQ(t.first[1] - t.first[0], 3u);  // edge (0,1) comes first
  const EdgeTable two = build_edge_table(m, {1, 0, 1});
  EXPECT_EQ(two.first[1] - two.first[0], 2u);
}

}  // namespace
}  // namespace gnomon
