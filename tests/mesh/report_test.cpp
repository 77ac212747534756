#include <gnomon/mesh/report.h>

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "../soup.h"

namespace gnomon {
namespace {

MeshReport report_of(TriMesh mesh) {
  const Scene s = test::scene_of(std::move(mesh));
  return report_mesh(s.mesh, build_edge_table(s.mesh));
}

TEST(MeshReport, CallsABoxWoundOutwardsSolid) {
  TriMesh m;
  test::add_box(m, {1000, 1000, 0}, {1002, 1003, 4});
  const MeshReport r = report_of(m);
  ASSERT_EQ(r.components.size(), 1u);
  const Component& c = r.components[0];
  EXPECT_EQ(c.kind, SurfaceKind::solid);
  EXPECT_DOUBLE_EQ(c.volume, 24);
  EXPECT_EQ(c.counts.triangles, 12u);
  EXPECT_EQ(c.counts.edges, 18u);
  EXPECT_EQ(c.counts.boundary + c.counts.non_manifold + c.counts.mis_wound + c.counts.unbalanced,
            0u);
  EXPECT_EQ(r.weight_one_triangles, 12u);
  EXPECT_EQ(classification(r),
            "1 component: 1 solid; 0 boundary edges, 0 non-manifold, 0 mis-wound");
}

TEST(MeshReport, CallsABoxWoundInwardsInsideOut) {
  TriMesh m;
  test::add_box(m, {0, 0, 0}, {2, 3, 4});
  for (Triangle& t : m.triangles) std::swap(t[0], t[1]);
  const MeshReport r = report_of(m);
  EXPECT_EQ(r.components[0].kind, SurfaceKind::inside_out);
  EXPECT_DOUBLE_EQ(r.components[0].volume, -24);
  EXPECT_EQ(r.weight_one_triangles, 0u);
}

TEST(MeshReport, CountsTheBoundaryOfAnOpenBox) {
  TriMesh m;
  test::add_box(m, {0, 0, 0}, {1, 1, 1});
  m.triangles.erase(m.triangles.begin(), m.triangles.begin() + 2);
  const MeshReport r = report_of(m);
  EXPECT_EQ(r.components[0].kind, SurfaceKind::open);
  EXPECT_EQ(r.total.boundary, 4u);
  EXPECT_EQ(r.total.unbalanced, 4u);
}

TEST(MeshReport, FindsTheOneTriangleThatIsWoundAgainstItsNeighbours) {
  TriMesh m;
  test::add_box(m, {0, 0, 0}, {1, 1, 1});
  std::swap(m.triangles[5][0], m.triangles[5][1]);
  const MeshReport r = report_of(m);
  EXPECT_EQ(r.components[0].kind, SurfaceKind::mis_wound);
  EXPECT_EQ(r.total.mis_wound, 3u);
  EXPECT_EQ(r.total.boundary, 0u);
}

TEST(MeshReport, KeepsTwoBoxesThatShareAnEdgeInOneNonManifoldComponent) {
  TriMesh m;
  test::add_box(m, {0, 0, 0}, {1, 1, 1});
  test::add_box(m, {1, 1, 0}, {2, 2, 1});
  const MeshReport r = report_of(m);
  ASSERT_EQ(r.components.size(), 1u);
  EXPECT_EQ(r.components[0].kind, SurfaceKind::non_manifold);
  EXPECT_EQ(r.total.non_manifold, 1u);
  EXPECT_EQ(r.total.unbalanced, 0u);  // closed all the same
  EXPECT_DOUBLE_EQ(r.components[0].volume, 2);
}

TEST(MeshReport, SeparatesBoxesThatTouchInAVertexOnly) {
  TriMesh m;
  test::add_box(m, {0, 0, 0}, {1, 1, 1});
  test::add_box(m, {1, 1, 1}, {2, 2, 2});
  const MeshReport r = report_of(m);
  EXPECT_EQ(r.components.size(), 2u);
  EXPECT_EQ(r.of_kind[static_cast<std::size_t>(SurfaceKind::solid)], 2u);
}

TEST(MeshReport, OrdersComponentsByTheirFirstTriangle) {
  TriMesh m;
  test::add_box(m, {0, 0, 0}, {1, 1, 1});
  test::add_ground(m, 10, -5);
  test::add_box(m, {4, 4, 4}, {5, 5, 5});
  const MeshReport r = report_of(m);
  ASSERT_EQ(r.components.size(), 3u);
  EXPECT_EQ(r.components[1].kind, SurfaceKind::open);
  EXPECT_EQ(r.components[1].first_triangle, 12u);
  EXPECT_EQ(r.components[2].first_triangle, 14u);
  EXPECT_EQ(r.component_of[25], 2u);
  EXPECT_EQ(classification(r),
            "3 components: 2 solid, 1 open; 4 boundary edges, 0 non-manifold, 0 mis-wound");
}

TEST(MeshReport, TotalsAreTheSumsOfTheComponentsOfASoup) {
  TriMesh m;
  test::add_soup(m, 3000, 10, 4, 7);
  const MeshReport r = report_of(m);
  EdgeCounts sum;
  for (const Component& c : r.components) {
    sum.triangles += c.counts.triangles;
    sum.edges += c.counts.edges;
    sum.boundary += c.counts.boundary;
    sum.non_manifold += c.counts.non_manifold;
    sum.mis_wound += c.counts.mis_wound;
    sum.unbalanced += c.counts.unbalanced;
  }
  EXPECT_EQ(sum.triangles, r.total.triangles);
  EXPECT_EQ(sum.edges, r.total.edges);
  EXPECT_EQ(sum.boundary, r.total.boundary);
  EXPECT_EQ(sum.non_manifold, r.total.non_manifold);
  EXPECT_EQ(sum.mis_wound, r.total.mis_wound);
  EXPECT_EQ(sum.unbalanced, r.total.unbalanced);
  EXPECT_GT(r.total.non_manifold, 0u);
}

TEST(MeshReport, OfAnEmptyMeshIsEmpty) {
  const MeshReport r = report_of({});
  EXPECT_TRUE(r.components.empty());
  EXPECT_EQ(classification(r), "0 components; 0 boundary edges, 0 non-manifold, 0 mis-wound");
}

}  // namespace
}  // namespace gnomon
