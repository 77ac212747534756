#include <gtest/gtest.h>

#include "soup.h"

#include <gnomon/core/exact.h>
#include <gnomon/silhouette/light_sides.h>
#include <gnomon/volume/shadow_volume.h>
#include <gnomon/volume/volume_lists.h>

namespace gnomon {
namespace {

int sign4(const Vec4& a, const Vec4& b, const Vec4& c, const Vec4& d) {
  return det4(lift<Dyadic>(a), lift<Dyadic>(b), lift<Dyadic>(c), lift<Dyadic>(d)).sign();
}

// Change of the count along the segment x -> y, over all polygons; points in general position.
int crossings(const std::vector<VolumePolygon>& polygons, const Vec4& x, const Vec4& y) {
  int count = 0;
  for (const VolumePolygon& p : polygons) {
    for (int k = 1; k + 1 < p.size; ++k) {  // fan of triangles
      const auto i = static_cast<std::size_t>(k);
      const Vec4 &a = p.vertices[0], &b = p.vertices[i], &c = p.vertices[i + 1];
      const int f = sign4(a, b, c, x);
      if (f == 0 || sign4(a, b, c, y) != -f) continue;
      if (sign4(y, x, a, b) == f && sign4(y, x, b, c) == f && sign4(y, x, c, a) == f)
        count += p.weight * f;
    }
  }
  return count;
}

Scene scene() {
  TriMesh m;
  test::add_soup(m, 30, 4, 0, 11);
  test::add_box(m, {-1.5, -1.25, -1}, {1.125, 0.75, 2});
  return test::scene_of(m);
}

int casters_between(const Scene& s, const Vec4& x, const Light& light) {
  int count = 0;
  for (const Triangle& t : s.mesh.triangles) {
    const Vec4 a = point(s.mesh.positions[t[0]]), b = point(s.mesh.positions[t[1]]),
               c = point(s.mesh.positions[t[2]]);
    const int f = sign4(a, b, c, x);
    if (sign4(a, b, c, light) != -f) continue;
    if (sign4(light, x, a, b) == f && sign4(light, x, b, c) == f && sign4(light, x, c, a) == f)
      ++count;
  }
  return count;
}

TEST(ShadowVolume, CrossingsAreTheDifferenceOfCastersTowardsTheLight) {
  const Scene s = scene();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-7, 7);
  for (const Light& light :
       {Light(0.31, 0.23, 0.87, 0), Light(0.17, 0.29, 5.3, 1), Light(0.11, 0.07, 0.05, 1)}) {
    const auto sides = light_sides(s.mesh, light);
    const VolumePolygons v =
        build_volume(s.mesh, {}, sides, find_silhouette(build_edge_table(s.mesh), sides), light);
    for (int k = 0; k < 300; ++k) {
      const Vec4 x(u(random), u(random), u(random), 1), y(u(random), u(random), u(random), 1);
      EXPECT_EQ(crossings(v.sides, x, y) + crossings(v.light_cap, x, y),
                casters_between(s, y, light) - casters_between(s, x, light));
    }
  }
}

TEST(ShadowVolume, ClosedByItsDarkCapAPointLightsVolumeIsLeftOnTheWayToInfinity) {
  const Scene s = scene();
  const Light light(0.17, 0.29, 5.3, 1);
  const auto sides = light_sides(s.mesh, light);
  const VolumePolygons v =
      build_volume(s.mesh, {}, sides, find_silhouette(build_edge_table(s.mesh), sides), light);
  EXPECT_EQ(v.dark_cap.size(), s.mesh.triangles.size());
  std::mt19937 random(6);
  std::uniform_real_distribution<double> u(-7, 7);
  for (int k = 0; k < 300; ++k) {
    // Just past infinity (w < 0) in a random direction nothing is in shadow: all that was entered
    // is left.
    const Vec4 x(u(random), u(random), u(random), 1),
        beyond(u(random), u(random), u(random), -0x1p-40);
    EXPECT_EQ(crossings(v.sides, x, beyond) + crossings(v.light_cap, x, beyond) +
                  crossings(v.dark_cap, x, beyond),
              -casters_between(s, x, light));
  }
}

TEST(ShadowVolume, DirectionalLightNeedsNoDarkCap) {
  const Scene s = scene();
  const Light light(0.31, 0.23, 0.87, 0);
  const auto sides = light_sides(s.mesh, light);
  const VolumePolygons v =
      build_volume(s.mesh, {}, sides, find_silhouette(build_edge_table(s.mesh), sides), light);
  EXPECT_TRUE(v.dark_cap.empty());
  for (const VolumePolygon& p : v.sides) EXPECT_EQ(p.size, 3);
}

// Chunks of a soup full of ties: each one's silhouette, and their sum, is that of brute force.
TEST(SilhouetteOfFew, IsThatOfAPartOfTheseTriangles) {
  TriMesh m;
  test::add_soup(m, 150, 2, 1, 5);
  test::add_box(m, {0, 0, 0}, {1, 1, 1});
  const Scene s = test::scene_of(m);
  for (const Light& light : {Light(1, 2, 3, 0), Light(0, 0, 1, 0), Light(0.5, 0.5, 4, 1)}) {
    const auto sides = light_sides(s.mesh, light);
    for (const Casting casting : {Casting::all_triangles, Casting::negative_sides}) {
      for (std::uint32_t first = 0; first + 20 < s.mesh.triangles.size(); first += 20) {
        std::vector<std::uint32_t> few;
        std::vector<std::uint8_t> casting_few(s.mesh.triangles.size(), 0);
        for (std::uint32_t t = first; t < first + 20; ++t) {
          few.push_back(t);
          casting_few[t] = casts(casting, sides[t]) ? 1 : 0;
        }
        const Silhouette expected = find_silhouette(build_edge_table(s.mesh, casting_few), sides);
        Silhouette ours;
        find_silhouette_of_few(ours, s.mesh, few, sides, casting);
        ASSERT_EQ(ours.size(), expected.size());
        for (std::size_t k = 0; k < ours.size(); ++k) {
          EXPECT_EQ(ours[k].a, expected[k].a);
          EXPECT_EQ(ours[k].b, expected[k].b);
          EXPECT_EQ(ours[k].multiplicity, expected[k].multiplicity);
        }
      }
    }
  }
}

}  // namespace
}  // namespace gnomon
