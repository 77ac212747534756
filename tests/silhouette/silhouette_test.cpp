#include <gtest/gtest.h>

#include <map>

#include "soup.h"

#include <gnomon/silhouette/light_sides.h>
#include <gnomon/silhouette/silhouette.h>

namespace gnomon {
namespace {

Silhouette silhouette_of(const Scene& s, const Light& light) {
  return find_silhouette(build_edge_table(s.mesh), light_sides(s.mesh, light));
}

TEST(Silhouette, BoxUnderAnObliqueSunHasSixEdgesOfMultiplicityTwo) {
  TriMesh m;
  test::add_box(m, {0, 0, 0}, {1, 1, 1});
  const Silhouette s = silhouette_of(test::scene_of(m), Light(1, 2, 3, 0));
  EXPECT_EQ(s.size(), 6u);
  for (const SilhouetteEdge& e : s) EXPECT_EQ(std::abs(e.multiplicity), 2);
}

TEST(Silhouette, BorderOfAnOpenSheetHasMultiplicityOne) {
  TriMesh m;
  test::add_ground(m, 5);
  const Silhouette s = silhouette_of(test::scene_of(m), Light(1, 2, 3, 0));
  EXPECT_EQ(s.size(), 4u);  // the diagonal cancels
  for (const SilhouetteEdge& e : s) EXPECT_EQ(std::abs(e.multiplicity), 1);
}

TEST(Silhouette, FlippingTrianglesChangesNothing) {
  TriMesh m;
  test::add_soup(m, 40, 5, 2, 3);
  test::add_box(m, {0, 0, 0}, {1, 1, 1});
  Scene s = test::scene_of(m);
  for (const Light& light : {Light(1, 2, 3, 0), Light(0, 0, 1, 0), Light(2, 2, 2, 1)}) {
    Scene flipped = s;
    for (std::size_t t = 0; t < flipped.mesh.triangles.size(); t += 3) {
      std::swap(flipped.mesh.triangles[t][0], flipped.mesh.triangles[t][2]);
    }
    const Silhouette a = silhouette_of(s, light), b = silhouette_of(flipped, light);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
      EXPECT_EQ(a[k].a, b[k].a);
      EXPECT_EQ(a[k].b, b[k].b);
      EXPECT_EQ(a[k].multiplicity, b[k].multiplicity);
    }
  }
}

TEST(Silhouette, MultiplicitiesBalanceAtEveryVertex) {
  TriMesh m;
  test::add_soup(m, 200, 5, 1, 9);
  const Scene s = test::scene_of(m);
  for (const Light& light : {Light(1, 2, 3, 0), Light(0, 1, 0, 0), Light(1, 1, 1, 1)}) {
    std::map<std::uint32_t, int> sum;
    for (const SilhouetteEdge& e : silhouette_of(s, light)) {
      sum[e.a] += e.multiplicity;
      sum[e.b] -= e.multiplicity;
    }
    for (const auto& [vertex, balance] : sum) EXPECT_EQ(balance, 0) << vertex;
  }
}

TEST(LightSides, FilterAgreesWithTheExactPredicate) {
  TriMesh m;
  test::add_soup(m, 300, 500, 0, 4);
  test::add_soup(m, 300, 5, 1, 5);
  const Scene s = test::scene_of(m);
  for (const Light& light :
       {Light(0.3, -0.2, 0.9, 0), Light(1, 0, 0, 0), Light(2, 1, 3, 1), Light(900, -40, 70, 1)}) {
    const auto sides = light_sides(s.mesh, light);
    ExactStats stats;
    for (std::size_t t = 0; t < sides.size(); ++t) {
      const Triangle& v = s.mesh.triangles[t];
      EXPECT_EQ(sides[t], light_side(s.mesh.positions[v[0]], s.mesh.positions[v[1]],
                                     s.mesh.positions[v[2]], light, stats));
    }
  }
}

}  // namespace
}  // namespace gnomon
