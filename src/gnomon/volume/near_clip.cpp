#include <gnomon/volume/near_clip.h>

#include <algorithm>
#include <cmath>
#include <limits>

// A half space is judged by its stored normal alone: whatever rounding made of the normal, its
// `most` is an upper bound of normal . x over the corners of the volume, so that nothing depends on
// the normal being the intended one.

namespace gnomon {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double dot(const Vec3& n, const Vec3& p) { return (n.x * p.x + n.y * p.y) + n.z * p.z; }
double dot_error(const Vec3& n, const Vec3& p) {
  return kDotSlack * (std::fabs(n.x * p.x) + std::fabs(n.y * p.y) + std::fabs(n.z * p.z));
}
Vec3 cross(const Vec3& u, const Vec3& v) {
  return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

double above(double x) { return std::nextafter(x, kInfinity); }
double below(double x) { return std::nextafter(x, -kInfinity); }

// x + y with y >= 0, not below the exact sum; x - y not above it. An error bound of 0 means that
// all products are 0, exactly: a plane that holds the direction of a sun must not lose it here.
double raised(double x, double y) { return y == 0 ? x : above(x + y); }
double lowered(double x, double y) { return y == 0 ? x : below(x - y); }

double upper_dot(const Vec3& n, const Vec3& p) { return raised(dot(n, p), dot_error(n, p)); }
double lower_dot(const Vec3& n, const Vec3& p) { return lowered(dot(n, p), dot_error(n, p)); }

// For a normal that should be at right angles to a directional light's direction d, but is not, by
// rounding: it is tilted by some roundings so that the prism goes inwards for certain. With e an
// error bound of n.d, n - tilt d has (n - tilt d).d <= -7 (|n.d| + e) before its own rounding
// (which moves it by less than e; who uses it tests it again).
Vec3 along_light(const Light& light, const Vec3& n) {
  if (light.w != 0) return n;
  const Vec3 d(light);
  const double tilt = 8 * (std::fabs(dot(n, d)) + dot_error(n, d)) / dot(d, d);
  return tilt > 0 ? n - tilt * d : n;
}

struct Builder {
  const std::array<Vec3, 4>& corners;
  const Light& light;
  NearClip near;

  Vec3 light_vector() const { return {light.x, light.y, light.z}; }

  // Keeps the half space along n if it holds for certain.
  void add(const Vec3& n) {
    double most = -kInfinity;
    for (const Vec3& c : corners) most = std::max(most, upper_dot(n, c));
    const double to_light = upper_dot(n, light_vector());
    if (light.w == 0) {
      if (to_light > 0) return;  // the prism may leave it on its way to the light
    } else {
      most = std::max(most, above(to_light / light.w));
    }
    if (!std::isfinite(most)) return;
    near.half_spaces[static_cast<std::size_t>(near.size++)] = {n, most};
  }

  void add_along_light(const Vec3& n) { add(along_light(light, n)); }
};

// The directions of the volume's edges: two of the rectangle, and those towards the light.
struct Edges {
  Vec3 side_u, side_v;
  std::array<Vec3, 4> towards;
};
Edges edges_of(const std::array<Vec3, 4>& corners, const Light& light) {
  Edges e{corners[1] - corners[0], corners[3] - corners[0], {}};
  const Vec3 l(light);
  for (std::size_t k = 0; k < 4; ++k) e.towards[k] = light.w == 0 ? l : l - light.w * corners[k];
  return e;
}

}  // namespace

NearClip near_clip_volume(const std::array<Vec3, 4>& near_rectangle, const Light& light) {
  Builder b{near_rectangle, light, {}};
  const Vec3 l = b.light_vector();

  NearClip& near = b.near;
  near.near_rectangle = near_rectangle;
  near.light = light;
  for (int k = 0; k < 3; ++k) {
    near.lo[k] = near.hi[k] = near_rectangle[0][k];
    for (const Vec3& c : near_rectangle) {
      near.lo[k] = std::min(near.lo[k], c[k]);
      near.hi[k] = std::max(near.hi[k], c[k]);
    }
    if (light.w == 0) {
      if (l[k] > 0) near.hi[k] = kInfinity;
      if (l[k] < 0) near.lo[k] = -kInfinity;
    } else {
      near.lo[k] = std::min(near.lo[k], below(l[k] / light.w));
      near.hi[k] = std::max(near.hi[k], above(l[k] / light.w));
    }
  }

  const auto [side_u, side_v, towards] = edges_of(near_rectangle, light);
  // The centre, to know which way is out (times 4).
  const Vec3 middle = near_rectangle[0] + near_rectangle[1] + near_rectangle[2] + near_rectangle[3];
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3& a = near_rectangle[k];
    const Vec3 n = cross(near_rectangle[(k + 1) % 4] - a, towards[k]);
    b.add_along_light(dot(n, 4.0 * a - middle) < 0 ? -n : n);
  }
  const Vec3 across = cross(side_u, side_v);
  b.add(across);
  b.add(-across);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 a(0.0);
    a[axis] = 1;
    for (const Vec3& side : {side_u, side_v}) {
      b.add(cross(side, a));
      b.add(-cross(side, a));
    }
    for (std::size_t k = 0; k < (light.w == 0 ? 1u : 4u); ++k) {
      b.add_along_light(cross(towards[k], a));
      b.add_along_light(-cross(towards[k], a));
    }
  }
  return near;
}

bool may_shade_near(const NearClip& near, const Vec3& lo, const Vec3& hi) {
  for (int k = 0; k < 3; ++k) {
    if (lo[k] > near.hi[k] || hi[k] < near.lo[k]) return false;
  }
  for (int k = 0; k < near.size; ++k) {
    const auto& [n, most] = near.half_spaces[static_cast<std::size_t>(k)];
    // The corner of the box that goes least along n.
    const Vec3 least(n.x > 0 ? lo.x : hi.x, n.y > 0 ? lo.y : hi.y, n.z > 0 ? lo.z : hi.z);
    if (lower_dot(n, least) > most) return false;
  }
  return true;
}

namespace {

// `point(k)`, k < size.
template <class F>
bool may_shade_near_points(const NearClip& near, std::size_t size, const F& point) {
  if (size == 0) return false;
  Vec3 lo = point(0), hi = lo;
  for (std::size_t k = 1; k < size; ++k) {
    const Vec3& p = point(k);
    for (int i = 0; i < 3; ++i) {
      lo[i] = std::min(lo[i], p[i]);
      hi[i] = std::max(hi[i], p[i]);
    }
  }
  if (!may_shade_near(near, lo, hi)) return false;
  for (int h = 0; h < near.size; ++h) {
    const auto& [n, most] = near.half_spaces[static_cast<std::size_t>(h)];
    bool all_beyond = true;
    for (std::size_t k = 0; k < size && all_beyond; ++k) {
      all_beyond = lower_dot(n, point(k)) > most;
    }
    if (all_beyond) return false;
  }
  return true;
}

}  // namespace

bool may_shade_near(const NearClip& near, std::span<const Vec3> points) {
  return may_shade_near_points(near, points.size(),
                               [&](std::size_t k) -> const Vec3& { return points[k]; });
}

bool may_shade_near(const NearClip& near, const TriMesh& mesh,
                    std::span<const std::uint32_t> triangles) {
  return may_shade_near_points(near, 3 * triangles.size(), [&](std::size_t k) -> const Vec3& {
    return mesh.positions[mesh.triangles[triangles[k / 3]][k % 3]];
  });
}

namespace {

using Corners3 = std::array<Vec3, 3>;

// True only if the triangle lies strictly beyond the volume along n.
bool beyond(const NearClip& near, const Corners3& t, const Vec3& n) {
  const double least = std::min({lower_dot(n, t[0]), lower_dot(n, t[1]), lower_dot(n, t[2])});
  const double to_light = upper_dot(n, Vec3(near.light));
  if (near.light.w == 0 ? to_light > 0 : above(to_light / near.light.w) >= least) {
    return false;
  }
  for (const Vec3& c : near.near_rectangle) {
    if (upper_dot(n, c) >= least) return false;
  }
  return true;
}

bool may_triangle(const NearClip& near, const Edges& edges, const Corners3& t) {
  for (int k = 0; k < 3; ++k) {
    if (std::min({t[0][k], t[1][k], t[2][k]}) > near.hi[k]) return false;
    if (std::max({t[0][k], t[1][k], t[2][k]}) < near.lo[k]) return false;
  }
  for (int h = 0; h < near.size; ++h) {
    const auto& [n, most] = near.half_spaces[static_cast<std::size_t>(h)];
    if (lower_dot(n, t[0]) > most && lower_dot(n, t[1]) > most && lower_dot(n, t[2]) > most) {
      return false;
    }
  }
  const Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
  if (beyond(near, t, normal) || beyond(near, t, -normal)) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 edge = t[(k + 1) % 3] - t[k];
    for (const Vec3& side : {edges.side_u, edges.side_v}) {
      const Vec3 n = cross(side, edge);
      if (beyond(near, t, n) || beyond(near, t, -n)) return false;
    }
    for (std::size_t j = 0; j < (near.light.w == 0 ? 1u : 4u); ++j) {
      const Vec3 n = cross(edges.towards[j], edge), m = -n;
      if (beyond(near, t, along_light(near.light, n)) ||
          beyond(near, t, along_light(near.light, m))) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

bool may_any_shade_near(const NearClip& near, const TriMesh& mesh,
                        std::span<const std::uint32_t> triangles) {
  const Edges edges = edges_of(near.near_rectangle, near.light);
  for (const std::uint32_t t : triangles) {
    const Triangle& v = mesh.triangles[t];
    if (may_triangle(near, edges,
                     {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]})) {
      return true;
    }
  }
  return false;
}

}  // namespace gnomon
