#include <gnomon/volume/parts.h>

#include <algorithm>

#include <gnomon/core/exact.h>
#include <gnomon/mesh/triangle_sets.h>

// Notation: t a triangle (A,B,C) of the part, o a point inside the tetrahedron of the part's first
// triangle and one more of its vertices, g the centre of the first triangle. o and g are sums of
// vertices, kept homogeneous (w = 4 and 3), so that nothing is rounded.

namespace gnomon {
namespace {

template <class T, std::size_t n>
H4<T> sum_of(const std::array<Vec3, n>& points) {
  H4<T> sum = lift<T>(points[0]);
  for (std::size_t k = 1; k < n; ++k) {
    const H4<T> p = lift<T>(points[k]);
    sum = {sum.x + p.x, sum.y + p.y, sum.z + p.z, sum.w + p.w};
  }
  return sum;
}

// Exact sign of |a; b; c; d|, 0 if the points are coplanar. Each row is any callable that returns
// H4<T>.
template <class A, class B, class C, class D>
int sign4(const A& a, const B& b, const C& c, const D& d) {
  ExactStats ignored;
  return tie_sign({}, ignored, [&]<class T>(int, int, int) {
    return det4<T>(a.template operator()<T>(), b.template operator()<T>(),
                   c.template operator()<T>(), d.template operator()<T>());
  });
}

auto row(const Vec3& p) {
  return [&p]<class T>() { return lift<T>(p); };
}
template <std::size_t n>
auto row(const std::array<Vec3, n>& points) {
  return [&points]<class T>() { return sum_of<T>(points); };
}

struct Corners3 {
  const Vec3 &a, &b, &c;
};
Corners3 corners(const TriMesh& mesh, std::uint32_t t) {
  const Triangle& v = mesh.triangles[t];
  return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
}

// A vertex off the plane of the first triangle: the furthest one in floating point, or, if that is
// exactly in the plane, the first that exactly is not. One in the plane if all are.
Vec3 vertex_off_plane(const TriMesh& mesh, const Part& part) {
  const auto [a, b, c] = corners(mesh, part.triangles[0]);
  const Vec3 u = b - a, v = c - a;
  const Vec3 n(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
  Vec3 furthest = a;
  double largest = 0;
  for (const std::uint32_t t : part.triangles) {
    for (const std::uint32_t k : mesh.triangles[t]) {
      const Vec3 d = mesh.positions[k] - a;
      const double h = std::fabs(n.x * d.x + n.y * d.y + n.z * d.z);
      if (h > largest) largest = h, furthest = mesh.positions[k];
    }
  }
  if (sign4(row(a), row(b), row(c), row(furthest)) != 0) return furthest;
  for (const std::uint32_t t : part.triangles) {
    for (const std::uint32_t k : mesh.triangles[t]) {
      const Vec3& p = mesh.positions[k];
      if (sign4(row(a), row(b), row(c), row(p)) != 0) return p;
    }
  }
  return furthest;
}

// Precondition: two triangles at each edge of the part, running opposite ways, none concave.
// Returns the winding if every triangle sees o on the same side and the ray from o through g
// meets the first triangle alone; else 0.
int winding_of_convex(const TriMesh& mesh, const Part& part) {
  const auto [a, b, c] = corners(mesh, part.triangles[0]);
  const std::array<Vec3, 4> o = {a, b, c, vertex_off_plane(mesh, part)};
  const std::array<Vec3, 3> g = {a, b, c};
  const int inner = sign4(row(a), row(b), row(c), row(o));
  if (inner == 0) return 0;  // flat
  for (const std::uint32_t t : part.triangles) {
    const auto [p, q, r] = corners(mesh, t);
    if (sign4(row(p), row(q), row(r), row(o)) != inner) return 0;
    if (t == part.triangles[0]) continue;
    // The closed cone of t over o holds the ray exactly if no edge function has the wrong sign:
    // |p;q;g;o| and its cyclic followers have the sign of |p;q;r;o|, or are 0.
    if (sign4(row(p), row(q), row(g), row(o)) * inner >= 0 &&
        sign4(row(q), row(r), row(g), row(o)) * inner >= 0 &&
        sign4(row(r), row(p), row(g), row(o)) * inner >= 0) {
      return 0;
    }
  }
  return inner;  // |A;B;C;x| > 0 behind an outward triangle, as for lights
}

}  // namespace

Parts split_into_parts(const TriMesh& mesh, const EdgeTable& edges,
                       const std::vector<std::uint8_t>& selected) {
  const auto chosen = [&](std::uint32_t t) { return selected.empty() || selected[t] != 0; };
  const auto n = static_cast<std::uint32_t>(mesh.triangles.size());
  const std::size_t edge_count = edges.vertices.size();
  constexpr std::uint32_t kNone = 0xffffffffu;

  TriangleSets sets(n);
  for (std::size_t k = 0; k < edge_count; ++k) {
    std::uint32_t last = kNone;
    for (std::uint32_t i = edges.first[k]; i < edges.first[k + 1]; ++i) {
      const std::uint32_t t = edges.incidence[i] >> 1;
      if (!chosen(t)) continue;
      if (last != kNone) sets.join(last, t);
      last = t;
    }
  }

  Parts result;
  result.part_of.assign(n, kNoPart);
  std::vector<std::uint32_t> sizes;
  for (std::uint32_t t = 0; t < n; ++t) {
    if (!chosen(t)) continue;
    const std::uint32_t root = sets.root(t);
    if (root == t) {
      result.part_of[t] = static_cast<std::uint32_t>(sizes.size());
      sizes.push_back(0);
    } else {
      result.part_of[t] = result.part_of[root];
    }
    ++sizes[result.part_of[t]];
  }
  result.parts.resize(sizes.size());
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    Part& part = result.parts[k];
    part.triangles.reserve(sizes[k]);
    part.closed = part.convex = true;
    part.lo = Vec3(HUGE_VAL), part.hi = Vec3(-HUGE_VAL);
  }
  for (std::uint32_t t = 0; t < n; ++t) {
    if (result.part_of[t] == kNoPart) continue;
    Part& part = result.parts[result.part_of[t]];
    part.triangles.push_back(t);
    for (const std::uint32_t v : mesh.triangles[t]) {
      const Vec3& p = mesh.positions[v];
      for (int k = 0; k < 3; ++k) {
        part.lo[k] = std::min(part.lo[k], p[k]);
        part.hi[k] = std::max(part.hi[k], p[k]);
      }
    }
  }

  // What the edges say. Of a pair of neighbours, the second's vertex off the edge is on one side of
  // the first; all pairs of a convex part agree on that side (`bent`), apart from coplanar ones.
  std::vector<std::int8_t> bent(sizes.size(), 0);
  for (std::size_t k = 0; k < edge_count; ++k) {
    std::uint32_t count = 0, backward = 0, neighbours[2] = {kNone, kNone};
    for (std::uint32_t i = edges.first[k]; i < edges.first[k + 1]; ++i) {
      const std::uint32_t t = edges.incidence[i] >> 1;
      if (!chosen(t)) continue;
      if (count < 2) neighbours[count] = t;
      ++count, backward += edges.incidence[i] & 1u;
    }
    if (count == 0) continue;
    const std::uint32_t index = result.part_of[neighbours[0]];
    Part& part = result.parts[index];
    if (2 * backward != count) part.closed = part.convex = false;
    if (count != 2) part.convex = false;
    if (!part.convex) continue;
    const auto [a, b] = edges.vertices[k];
    const Triangle& other = mesh.triangles[neighbours[1]];
    const std::uint32_t off = other[0] != a && other[0] != b   ? other[0]
                              : other[1] != a && other[1] != b ? other[1]
                                                               : other[2];
    const auto [p, q, r] = corners(mesh, neighbours[0]);
    const int side = sign4(row(p), row(q), row(r), row(mesh.positions[off]));
    if (side == 0) continue;
    if (bent[index] == 0) bent[index] = static_cast<std::int8_t>(side);
    if (bent[index] != side) part.convex = false;
  }
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    Part& part = result.parts[k];
    if (!part.convex) continue;
    part.winding = winding_of_convex(mesh, part);
    // Inside is where the neighbours bend to.
    part.convex = part.winding != 0 && part.winding == bent[k];
    if (!part.convex) part.winding = 0;
  }
  return result;
}

}  // namespace gnomon
