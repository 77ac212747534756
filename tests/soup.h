// Small scenes for tests.
#pragma once

#include <cmath>
#include <random>

#include <gnomon/mesh/weld.h>
#include <gnomon/scene/scene.h>

namespace gnomon::test {

// Welded scene of one surface.
inline Scene scene_of(TriMesh mesh) {
  Scene s;
  s.mesh = std::move(mesh);
  s.surface_of.assign(s.mesh.triangles.size(), 0);
  s.surfaces.push_back({});
  weld(s.mesh, s.surface_of);
  return s;
}

inline void add_quad(TriMesh& m, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto k = static_cast<std::uint32_t>(m.positions.size());
  m.positions.insert(m.positions.end(), {a, b, c, d});
  m.triangles.push_back({k, k + 1, k + 2});
  m.triangles.push_back({k, k + 2, k + 3});
}

// Closed box, wound outwards.
inline void add_box(TriMesh& m, const Vec3& lo, const Vec3& hi) {
  const Vec3 p[8] = {{lo.x, lo.y, lo.z}, {hi.x, lo.y, lo.z}, {hi.x, hi.y, lo.z},
                     {lo.x, hi.y, lo.z}, {lo.x, lo.y, hi.z}, {hi.x, lo.y, hi.z},
                     {hi.x, hi.y, hi.z}, {lo.x, hi.y, hi.z}};
  add_quad(m, p[3], p[2], p[1], p[0]);
  add_quad(m, p[4], p[5], p[6], p[7]);
  add_quad(m, p[0], p[1], p[5], p[4]);
  add_quad(m, p[1], p[2], p[6], p[5]);
  add_quad(m, p[2], p[3], p[7], p[6]);
  add_quad(m, p[3], p[0], p[4], p[7]);
}

inline void add_ground(TriMesh& m, double half, double z = 0) {
  add_quad(m, {-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z});
}

// n random triangles in the cube of half-width `half`; coordinates on a grid of `grid` if that is
// positive (many ties).
inline void add_soup(TriMesh& m, int n, double half, double grid, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-half, half);
  const auto coordinate = [&] {
    const double v = u(random);
    return grid > 0 ? std::round(v / grid) * grid : v;
  };
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::uint32_t>(m.positions.size());
    for (int j = 0; j < 3; ++j) {
      const double x = coordinate(), y = coordinate(), z = coordinate();
      m.positions.push_back({x, y, z});
    }
    m.triangles.push_back({k, k + 1, k + 2});
  }
}

}  // namespace gnomon::test
