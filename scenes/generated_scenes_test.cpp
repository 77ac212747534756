#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include <gnomon/mesh/edge_table.h>
#include <scenes/box_city.h>
#include <scenes/generated_city.h>
#include <scenes/generated_sphere.h>
#include <scenes/paper_scenes.h>

namespace gnomon::scenes {
namespace {

// Edges of the selected triangles that are not used once in each direction by exactly two of them.
std::size_t open_edges(const Scene& scene, const std::vector<std::uint8_t>& selected) {
  const EdgeTable edges = build_edge_table(scene.mesh, selected);
  std::size_t open = 0;
  for (std::size_t k = 0; k < edges.vertices.size(); ++k) {
    const std::uint32_t first = edges.first[k];
    const bool closed = edges.first[k + 1] - first == 2 &&
                        ((edges.incidence[first] ^ edges.incidence[first + 1]) & 1) == 1;
    open += closed ? 0 : 1;
  }
  return open;
}

double volume(const Scene& scene, const std::vector<std::uint8_t>& selected) {
  double sum = 0;
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (selected[t] == 0) continue;
    const Triangle& v = scene.mesh.triangles[t];
    sum += glm::dot(scene.mesh.positions[v[0]],
                    glm::cross(scene.mesh.positions[v[1]], scene.mesh.positions[v[2]])) /
           6;
  }
  return sum;
}

TEST(GeneratedCity, HasTheBuildingsAskedForAllClosedAndWoundOutwards) {
  const Scene s = generated_city({.buildings = 500});
  EXPECT_EQ(s.surfaces.size(), 501u);
  std::vector<std::uint8_t> buildings(s.mesh.triangles.size());
  std::vector<double> volumes(s.surfaces.size());
  for (std::size_t t = 0; t < buildings.size(); ++t) buildings[t] = s.surface_of[t] == 0 ? 0 : 1;
  EXPECT_EQ(open_edges(s, buildings), 0u);
  for (std::uint32_t b = 1; b < s.surfaces.size(); ++b) {
    std::vector<std::uint8_t> one(s.mesh.triangles.size());
    for (std::size_t t = 0; t < one.size(); ++t) one[t] = s.surface_of[t] == b ? 1 : 0;
    EXPECT_GT(volume(s, one), 200.0) << s.surfaces[b].object;
  }
}

TEST(GeneratedCity, HasAboutTheTrianglesAskedFor) {
  for (const std::size_t triangles : {20000u, 300000u}) {
    const double n =
        static_cast<double>(generated_city({.triangles = triangles}).mesh.triangles.size());
    EXPECT_NEAR(n / static_cast<double>(triangles), 1.0, 0.1);
  }
}

TEST(GeneratedCity, IsTheSameForTheSameOptionsOnly) {
  const Scene a = generated_city({.buildings = 50, .seed = 3}),
              b = generated_city({.buildings = 50, .seed = 3});
  EXPECT_EQ(a.mesh.positions, b.mesh.positions);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_NE(a.mesh.positions, generated_city({.buildings = 50, .seed = 4}).mesh.positions);
}

// Compilers differ in the order in which they evaluate a call's arguments, and with it in which of
// them gets which random number.
TEST(GeneratedCity, HasItsHousesInTheSamePlaceFromEveryCompiler) {
  EXPECT_EQ(generated_city({.buildings = 1}).mesh.positions.back(), Vec3(-62.018, -10.138, 9.914));
}

TEST(GeneratedCity, LiesWithinItsBounds) {
  const CityOptions options{.buildings = 300};
  const Scene s = generated_city(options);
  const Bounds2 bounds = city_bounds(options);
  for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) {
    if (s.surface_of[t] == 0) continue;
    for (const std::uint32_t v : s.mesh.triangles[t]) {
      const Vec3& p = s.mesh.positions[v];
      ASSERT_TRUE(p.x > bounds.x0 && p.x < bounds.x1 && p.y > bounds.y0 && p.y < bounds.y1);
    }
  }
}

TEST(BoxCity, HasClosedBoxesWoundOutwardsAndAGroundBelow) {
  const Scene s = box_city();
  ASSERT_EQ(s.surfaces.size(), 401u);
  EXPECT_EQ(s.mesh.triangles.size(), 2u + 400 * 12);
  std::vector<std::uint8_t> boxes(s.mesh.triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t) boxes[t] = s.surface_of[t] == 0 ? 0 : 1;
  EXPECT_EQ(open_edges(s, boxes), 0u);
  for (std::uint32_t b = 1; b < s.surfaces.size(); ++b) {
    std::vector<std::uint8_t> one(s.mesh.triangles.size());
    for (std::size_t t = 0; t < one.size(); ++t) one[t] = s.surface_of[t] == b ? 1 : 0;
    EXPECT_GE(volume(s, one), 8.0 * 8.0 * 4.0) << s.surfaces[b].object;
  }
}

TEST(BoxCity, LeavesStreetsFreeAndIsNoHigherThanItSays) {
  const Scene s = box_city();
  double tallest = 0;
  for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : s.mesh.triangles[t]) {
      const Vec3& p = s.mesh.positions[v];
      if (s.surface_of[t] == 0) {
        EXPECT_EQ(Vec3(std::fabs(p.x), std::fabs(p.y), p.z),
                  Vec3(kBoxCityHalf + kBoxCityMargin, kBoxCityHalf + kBoxCityMargin, 0));
        continue;
      }
      tallest = std::max(tallest, p.z);
      for (int k = 0; k < 2; ++k) {  // streets run along whole multiples of the pitch
        const double from_street = std::fabs(std::remainder(p[k], kBoxPitch));
        ASSERT_GE(from_street, kBoxStreet / 2 - 1e-9);
        ASSERT_LT(std::fabs(p[k]), kBoxCityHalf);
      }
    }
  }
  EXPECT_LE(tallest, kBoxTallest);
  EXPECT_GT(tallest, 0.9 * kBoxTallest);
}

TEST(BoxCity, IsTheSameForTheSameSeedOnly) {
  EXPECT_EQ(box_city(3).mesh.positions, box_city(3).mesh.positions);
  EXPECT_NE(box_city(3).mesh.positions, box_city(4).mesh.positions);
}

TEST(GeneratedSphere, IsClosedAndHasTheSpheresVolume) {
  const Scene s = generated_sphere(5, 2.0, Vec3(10, 20, 30));
  EXPECT_EQ(s.mesh.triangles.size(), 20u << 10);
  const std::vector<std::uint8_t> all(s.mesh.triangles.size(), 1);
  EXPECT_EQ(open_edges(s, all), 0u);
  EXPECT_NEAR(volume(s, all), 4.0 / 3.0 * 3.14159265 * 8, 0.1);
  EXPECT_EQ(
      open_edges(generated_sphere(4, 1.0, Vec3(0.0), 0.3), std::vector<std::uint8_t>(20u << 8, 1)),
      0u);
}

TEST(PaperScenes, AreClosedBodiesWoundOutwardsOverFloorsThatOnlyReceive) {
  for (const PaperScene& s : {convex_bodies(), concave_bodies(), figures_in_a_room()}) {
    std::vector<std::uint8_t> bodies(s.scene.mesh.triangles.size());
    for (std::uint32_t t = 0; t < bodies.size(); ++t) bodies[t] = casts(s.scene, t) ? 1 : 0;
    EXPECT_EQ(open_edges(s.scene, bodies), 0u) << s.name;
    for (std::uint32_t b = 0; b < s.scene.surfaces.size(); ++b) {
      if (!s.scene.surfaces[b].casts) continue;
      std::vector<std::uint8_t> one(bodies.size());
      for (std::size_t t = 0; t < one.size(); ++t) one[t] = s.scene.surface_of[t] == b ? 1 : 0;
      EXPECT_GT(volume(s.scene, one), 0.01) << s.name << " " << s.scene.surfaces[b].object;
    }
  }
}

TEST(PaperScenes, AreTheSameEachTime) {
  EXPECT_EQ(convex_bodies().scene.mesh.positions, convex_bodies().scene.mesh.positions);
  EXPECT_EQ(lamps_of_the_room(12, 0.5).size(), 12u);
}

TEST(PaperScenes, HaveTheirFiguresInTheSamePlaceFromEveryCompiler) {
  const Scene room = figures_in_a_room().scene;
  const auto figure = std::find_if(room.surfaces.begin(), room.surfaces.end(),
                                   [](const Surface& s) { return s.object == "figure_0"; });
  const auto first = std::find(room.surface_of.begin(), room.surface_of.end(),
                               static_cast<std::uint32_t>(figure - room.surfaces.begin()));
  const Triangle& t =
      room.mesh.triangles[static_cast<std::size_t>(first - room.surface_of.begin())];
  EXPECT_EQ(room.mesh.positions[t[0]] * 1024.0, Vec3(-2626, -623, 0));  // below the figure's axis
}

}  // namespace
}  // namespace gnomon::scenes
