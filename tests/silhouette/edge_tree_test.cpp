// The trees against brute force: the same edges with the same multiplicities, whatever the mesh and
// the light.
#include <gtest/gtest.h>

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "soup.h"

#include <gnomon/silhouette/edge_tree.h>
#include <gnomon/silhouette/hextree.h>
#include <gnomon/silhouette/light_sides.h>

namespace gnomon {
namespace {

// Precondition: `a` is in the table's order.
bool same(const Silhouette& a, Silhouette b) {
  Silhouette scratch;
  sort_as_table(b, scratch);
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const SilhouetteEdge& x, const SilhouetteEdge& y) {
                      return x.a == y.a && x.b == y.b && x.multiplicity == y.multiplicity;
                    });
}

// Random ones, and those at vertices, in planes, along axes.
std::vector<Light> lights_for(const TriMesh& mesh, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> g;
  std::uniform_int_distribution<std::size_t> triangle(0, mesh.triangles.size() - 1);
  double size = 0;
  for (const Vec3& p : mesh.positions) size = std::max(size, std::sqrt(glm::dot(p, p)));
  std::vector<Light> out;
  for (int k = 0; k < count; ++k) {
    const Triangle& t = mesh.triangles[triangle(random)];
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const Vec3 v(g(random), g(random), g(random));
    switch (k % 8) {
      case 0:
        out.push_back(direction(v));
        break;
      case 1:
        out.push_back(point(v * size));
        break;
      case 2:
        out.push_back(point(v * size * 0.1));
        break;  // within
      case 3:
        out.push_back(point(a));
        break;  // at a vertex
      case 4:
        out.push_back(direction(b - a));
        break;  // along an edge
      case 5:
        out.push_back(point((a + b + c) / 3.0));
        break;  // in a plane, or nearly
      case 6:
        out.push_back(Light(0, 0, k % 16 == 6 ? 1 : -1, 0));
        break;
      case 7:
        out.push_back(point(v * size * 1e6));
        break;  // far away
    }
    out.back() = snapped(out.back());
  }
  return out;
}

void expect_same(const TriMesh& mesh, const std::vector<Light>& lights) {
  const EdgeTable table = build_edge_table(mesh);
  const EdgeTree tree = build_edge_tree(mesh, table);
  ExtractionScratch scratch;
  const Hextree hextree = build_hextree(mesh, table, DualForm::facets);
  Silhouette ours, linear, facets;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const Silhouette expected = find_silhouette(table, light_sides(mesh, lights[k]));
    find_silhouette(ours, tree, mesh, lights[k], scratch);
    EXPECT_TRUE(same(expected, ours)) << "light " << k;
    find_silhouette_linear(linear, tree, mesh, lights[k], scratch);
    EXPECT_TRUE(same(expected, linear)) << "light " << k << ", every leaf";
    find_silhouette(facets, hextree, mesh, lights[k]);
    EXPECT_TRUE(same(expected, facets)) << "light " << k << ", the paper's tree";
  }
}

TriMesh sphere(int rows) {
  TriMesh m;
  const int columns = 2 * rows;
  const auto at = [&](int r, int c) {
    const double a = M_PI * r / rows, b = 2 * M_PI * (c % columns) / columns;
    return Vec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
  };
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const auto k = static_cast<std::uint32_t>(m.positions.size());
      m.positions.insert(m.positions.end(),
                         {at(r, c), at(r + 1, c), at(r + 1, c + 1), at(r, c + 1)});
      if (r + 1 < rows) m.triangles.push_back({k, k + 1, k + 2});
      if (r > 0) m.triangles.push_back({k, k + 2, k + 3});
    }
  }
  return test::scene_of(m).mesh;
}

TEST(EdgeTree, EqualsBruteForceOnClosedSmoothMeshes) {
  const TriMesh m = sphere(40);
  expect_same(m, lights_for(m, 400, 1));
}

TEST(EdgeTree, EqualsBruteForceOnBoxesAndGround) {
  TriMesh m;
  test::add_ground(m, 40);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(-40, 40), size(1, 9);
  for (int k = 0; k < 200; ++k) {
    const Vec3 lo(at(random), at(random), 0);
    test::add_box(m, lo, lo + Vec3(size(random), size(random), size(random)));
  }
  m = test::scene_of(m).mesh;
  expect_same(m, lights_for(m, 400, 2));
}

// Edges of one, two, three and many triangles, and wound at random.
TEST(EdgeTree, EqualsBruteForceOnSoupFullOfTies) {
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    TriMesh m;
    test::add_soup(m, 400, 2, 1, seed);
    m = test::scene_of(m).mesh;
    expect_same(m, lights_for(m, 200, seed));
  }
}

TEST(EdgeTree, EqualsBruteForceWhereEdgesAreWoundTheSameWay) {
  TriMesh m = sphere(16);
  for (std::size_t t = 0; t < m.triangles.size(); t += 3)
    std::swap(m.triangles[t][0], m.triangles[t][2]);
  expect_same(m, lights_for(m, 200, 5));
}

TEST(EdgeTree, EqualsBruteForceFarFromTheOriginAndForNeedles) {
  TriMesh m = sphere(12);
  for (Vec3& p : m.positions) p = p * Vec3(1e-7, 1, 1e3) + Vec3(3e6, -5e6, 200);
  expect_same(m, lights_for(m, 200, 6));
}

TEST(EdgeTree, EqualsBruteForceForTheSmallestAndLargestCoordinates) {
  for (const double scale : {0x1p-90, 1e-20, 1e11}) {
    TriMesh m = sphere(8);
    for (Vec3& p : m.positions) p *= scale;
    for (Vec3& p : m.positions) p = Vec3(snapped(p.x), snapped(p.y), snapped(p.z));
    expect_same(test::scene_of(m).mesh, lights_for(m, 64, 7));
  }
}

TEST(EdgeTree, OfNothingOrOneTriangleIsAllowed) {
  TriMesh m;
  const EdgeTree none = build_edge_tree(m, build_edge_table(m));
  ExtractionScratch scratch;
  Silhouette out{{0, 1, 2}};
  find_silhouette(out, none, m, Light(0, 0, 1, 0), scratch);
  EXPECT_TRUE(out.empty());
  m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  m.triangles = {{0, 1, 2}};
  expect_same(m, lights_for(m, 32, 8));
}

TEST(EdgeTree, OfSomeTrianglesIsThatOfTheirEdges) {
  const TriMesh m = sphere(10);
  std::vector<std::uint8_t> selected(m.triangles.size(), 0);
  for (std::size_t t = 0; t < selected.size() / 2; ++t) selected[t] = 1;
  const EdgeTable table = build_edge_table(m, selected);
  const EdgeTree tree = build_edge_tree(m, table);
  ExtractionScratch scratch;
  Silhouette ours;
  for (const Light& light : lights_for(m, 64, 9)) {
    find_silhouette(ours, tree, m, light, scratch);
    EXPECT_TRUE(same(find_silhouette(table, light_sides(m, light)), ours));
  }
}

// A caster that is moved and turned: its light is moved and turned back, the tree stays.
TEST(EdgeTree, OfAMovedCasterIsAskedWithTheLightInItsSpace) {
  const TriMesh m = sphere(24);
  const EdgeTable table = build_edge_table(m);
  const EdgeTree tree = build_edge_tree(m, table);
  const glm::dmat4 to_world(0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 8, -4, 2,
                            1);  // exact; no light is in a plane, where ties would turn
  TriMesh moved = m;
  for (Vec3& p : moved.positions) p = Vec3(to_world * point(Vec3(glm::vec3(p))));
  TriMesh rounded = m;
  for (Vec3& p : rounded.positions) p = Vec3(glm::vec3(p));
  const EdgeTree of_rounded = build_edge_tree(rounded, table);
  ExtractionScratch scratch;
  Silhouette ours;
  for (const Light& light :
       {Light(3, 2, 1, 0), Light(10.25, -3.125, 4.75, 1), Light(8, -4, 2, 1)}) {
    find_silhouette(ours, of_rounded, rounded, snapped(glm::inverse(to_world) * light), scratch);
    EXPECT_TRUE(same(find_silhouette(table, light_sides(moved, light)), ours));
  }
}

TEST(EdgeTree, OfADeformedMeshIsRightAfterItsPlanesAreRefreshed) {
  TriMesh m = sphere(24);
  const EdgeTable table = build_edge_table(m);
  EdgeTree tree = build_edge_tree(m, table);
  for (Vec3& p : m.positions) p = Vec3(p.x + 0.3 * std::sin(3 * p.z), p.y * 2, p.z + p.x * p.y);
  refresh_planes(tree, m);
  ExtractionScratch scratch;
  Silhouette ours;
  for (const Light& light : lights_for(m, 100, 10)) {
    find_silhouette(ours, tree, m, light, scratch);
    EXPECT_TRUE(same(find_silhouette(table, light_sides(m, light)), ours));
  }
}

// On a box the means of three facets' normals point out of the corners: the contour between them is
// not that of the facets. On a fine sphere nearly.
TEST(Hextree, OfVerticesFindsTheContourOfASmoothSurfaceNotOfFacets) {
  const Light light(1, 2, 3, 0);
  TriMesh box;
  test::add_box(box, {0, 0, 0}, {1, 1, 1});
  box = test::scene_of(box).mesh;
  const EdgeTable of_box = build_edge_table(box);
  Silhouette out;
  find_silhouette(out, build_hextree(box, of_box, DualForm::vertices), box, light);
  EXPECT_FALSE(same(find_silhouette(of_box, light_sides(box, light)), out));
  std::vector<int> ends(box.positions.size(), 0);
  for (const SilhouetteEdge& e : out) {
    ++ends[e.a];
    ++ends[e.b];
  }
  EXPECT_TRUE(std::any_of(ends.begin(), ends.end(), [](int n) { return n % 2 != 0; }));

  const TriMesh m = sphere(100);
  const EdgeTable table = build_edge_table(m);
  const std::size_t exact = find_silhouette(table, light_sides(m, light)).size();
  find_silhouette(out, build_hextree(m, table, DualForm::vertices), m, light);
  EXPECT_GT(2 * out.size(), exact);  // those that cross the contour, not those along it
  EXPECT_LT(out.size(), 2 * exact);
}

TEST(EdgeTree, LooksAtFewLeavesOfASmoothMesh) {
  const TriMesh m = sphere(200);
  const EdgeTree tree = build_edge_tree(m, build_edge_table(m));
  ExtractionScratch scratch;
  Silhouette out;
  ExtractionStats stats;
  find_silhouette(out, tree, m, Light(1, 2, 3, 0), scratch, &stats);
  EXPECT_LT(stats.leaves * 20, tree.leaves.size());
  EXPECT_GT(stats.nodes, 1u);
  EXPECT_GT(out.size(), 400u);
}

}  // namespace
}  // namespace gnomon
