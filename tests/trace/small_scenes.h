// Scenes of a few triangles for the oracle's tests.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <gnomon/mesh/weld.h>
#include <gnomon/scene/scene.h>
#include <gnomon/trace/exact_count.h>
#include <gnomon/view/view.h>

namespace gnomon::test {

enum SurfaceKind : std::uint32_t { kBoth, kCastsOnly, kReceivesOnly };

inline Scene empty_scene() {
  Scene s;
  s.surfaces.resize(3);
  s.surfaces[kCastsOnly].receives = false;
  s.surfaces[kReceivesOnly].casts = false;
  return s;
}

inline void add_triangle(Scene& s, const Vec3& a, const Vec3& b, const Vec3& c,
                         SurfaceKind kind = kBoth) {
  const auto n = static_cast<std::uint32_t>(s.mesh.positions.size());
  s.mesh.positions.insert(s.mesh.positions.end(), {a, b, c});
  s.mesh.triangles.push_back({n, n + 1, n + 2});
  s.surface_of.push_back(kind);
}

// The parallelogram a, a+u, a+u+v, a+v, cut along its diagonal.
inline void add_quad(Scene& s, const Vec3& a, const Vec3& u, const Vec3& v,
                     SurfaceKind kind = kBoth) {
  add_triangle(s, a, a + u, a + u + v, kind);
  add_triangle(s, a, a + u + v, a + v, kind);
}

inline void add_box(Scene& s, const Vec3& lo, const Vec3& hi) {
  const Vec3 x(hi.x - lo.x, 0, 0), y(0, hi.y - lo.y, 0), z(0, 0, hi.z - lo.z);
  add_quad(s, lo, y, x);
  add_quad(s, lo + z, x, y);
  add_quad(s, lo, x, z);
  add_quad(s, lo + y, z, x);
  add_quad(s, lo, z, y);
  add_quad(s, lo + x, y, z);
}

// Welded, as Scene requires.
inline Scene finished(Scene s) {
  weld(s.mesh, s.surface_of);
  return s;
}

// A level square of the given half size at height z.
inline void add_ground(Scene& s, double half, double z, SurfaceKind kind = kReceivesOnly) {
  add_quad(s, Vec3(-half, -half, z), Vec3(2 * half, 0, 0), Vec3(0, 2 * half, 0), kind);
}

// Triangles with corners on a small grid of integers, so that nearly every predicate has ties
// somewhere.
inline Scene grid_soup(unsigned seed, int triangles, int side) {
  std::mt19937 random(seed);
  const auto coordinate = [&] {
    return static_cast<double>(static_cast<int>(random() % static_cast<unsigned>(side)));
  };
  const auto corner = [&] {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    return Vec3(x, y, z);
  };
  Scene s = empty_scene();
  for (int k = 0; k < triangles; ++k) {
    const Vec3 a = corner(), b = corner(), c = corner();
    add_triangle(s, a, b, c, static_cast<SurfaceKind>(random() % 3));
  }
  return finished(std::move(s));
}

inline Receivers see(const Scene& scene, const View& view) {
  Receivers r;
  r.view = view;
  r.triangle = exact_receivers(build_oracle(scene), view, 1);
  return r;
}

// Every pixel's sample on the triangle `t`, which its rays need not meet first.
inline Receivers on_triangle(const View& view, std::uint32_t t) {
  Receivers r;
  r.view = view;
  r.triangle.assign(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height),
                    t);
  return r;
}

}  // namespace gnomon::test
