#include <scenes/generated_sphere.h>

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

#include <gnomon/mesh/weld.h>

namespace gnomon::scenes {

Scene generated_sphere(int levels, double radius, const Vec3& centre, double bumps) {
  const double g =
      (1 + std::sqrt(5.0)) / 2;  // the icosahedron's corners are those of three golden rectangles
  std::vector<Vec3> points = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                              {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                              {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  std::vector<Triangle> faces = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (Vec3& p : points) p = glm::normalize(p);
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [place, added] = middles.try_emplace({std::min(a, b), std::max(a, b)},
                                                      static_cast<std::uint32_t>(points.size()));
      if (added) points.push_back(glm::normalize(points[a] + points[b]));
      return place->second;
    };
    std::vector<Triangle> finer;
    finer.reserve(faces.size() * 4);
    for (const Triangle& f : faces) {
      const std::uint32_t ab = middle(f[0], f[1]), bc = middle(f[1], f[2]), ca = middle(f[2], f[0]);
      finer.insert(finer.end(), {{f[0], ab, ca}, {f[1], bc, ab}, {f[2], ca, bc}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  Scene scene;
  scene.surfaces.push_back({.object = "sphere", .group = {}, .material = {}, .semantic = {}});
  scene.surface_of.assign(faces.size(), 0);
  for (const Vec3& p : points) {
    const double wave = std::sin(5 * p.x + 1) * std::sin(6 * p.y + 2) * std::sin(4 * p.z + 3);
    scene.mesh.positions.push_back(centre + p * (radius * (1 + bumps * wave)));
  }
  scene.mesh.triangles = std::move(faces);
  weld(scene.mesh, scene.surface_of);
  return scene;
}

}  // namespace gnomon::scenes
