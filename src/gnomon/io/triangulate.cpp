#include <geos_c.h>
#include <gnomon/core/exact.h>
#include <gnomon/io/triangulate.h>
#include <gnomon/mesh/tri_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>

namespace gnomon {
namespace {

using Ring = std::vector<std::uint32_t>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

// GEOS' handles may not be shared between threads, so each thread has its own.
class Geos {
 public:
  Geos() : handle_(GEOS_init_r()) {}
  ~Geos() { GEOS_finish_r(handle_); }
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;
  operator GEOSContextHandle_t() const { return handle_; }  // NOLINT: a handle by another name

 private:
  GEOSContextHandle_t handle_;
};

Geos& geos() {
  thread_local Geos handle;
  return handle;
}

struct DestroyGeometry {
  void operator()(GEOSGeometry* g) const { GEOSGeom_destroy_r(geos(), g); }
};
using Geometry = std::unique_ptr<GEOSGeometry, DestroyGeometry>;

// Where a polygon lies in its plane of projection; counter-clockwise there means its own winding.
struct Plane {
  int u = 0, v = 1;
  Vec2 operator()(const Vec3& p) const { return {p[u], p[v]}; }
};

Plane projection(const std::vector<Vec3>& positions, const Ring& outer) {
  Vec3 normal(0, 0, 0);
  const Vec3 base = positions[outer[0]];  // subtracted so that far coordinates do not cancel
  for (std::size_t k = 0; k < outer.size(); ++k) {
    const Vec3 a = positions[outer[k]] - base, b = positions[outer[(k + 1) % outer.size()]] - base;
    normal += Vec3((a.y - b.y) * (a.z + b.z), (a.z - b.z) * (a.x + b.x), (a.x - b.x) * (a.y + b.y));
  }
  int axis = 2;  // ties go to z, then x: most surfaces that are level in two directions are floors
  if (std::fabs(normal.x) > std::fabs(normal[axis])) axis = 0;
  if (std::fabs(normal.y) > std::fabs(normal[axis])) axis = 1;
  Plane plane{(axis + 1) % 3, (axis + 2) % 3};
  if (normal[axis] < 0) std::swap(plane.u, plane.v);
  return plane;
}

template <class T>
T turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  const T ax(a.x), ay(a.y);
  return (T(b.x) - ax) * (T(c.y) - ay) - (T(b.y) - ay) * (T(c.x) - ax);
}

// +1 if a, b, c turn to the left, -1 to the right, 0 if they lie on a line: exact.
int orientation(Vec2 a, Vec2 b, Vec2 c) {
  for (Vec2* p : {&a, &b, &c}) *p = {snapped(p->x), snapped(p->y)};
  const Approx approx = turn<Approx>(a, b, c);
  return approx.certain() ? approx.sign() : turn<Dyadic>(a, b, c).sign();
}

// Twice the signed area; only its sign is used, and a wrong one is found out by the check below.
double doubled_area(const std::vector<Vec2>& flat) {
  double sum = 0;
  for (std::size_t k = 1; k + 1 < flat.size(); ++k) {
    const Vec2 a = flat[k] - flat[0], b = flat[k + 1] - flat[0];
    sum += a.x * b.y - a.y * b.x;
  }
  return sum;
}

// The ring without repeated corners and without its closing corner.
Ring cleaned(const std::vector<Vec3>& positions, const Ring& ring) {
  Ring out;
  for (const std::uint32_t v : ring) {
    if (out.empty() || positions[out.back()] != positions[v]) out.push_back(v);
  }
  while (out.size() > 1 && positions[out.back()] == positions[out.front()]) out.pop_back();
  return out;
}

bool has_three_distinct(const std::vector<Vec3>& positions, const Ring& ring) {
  for (std::size_t k = 2; k < ring.size(); ++k) {  // 0 and 1 differ once a ring is cleaned
    if (positions[ring[k]] != positions[ring[0]] && positions[ring[k]] != positions[ring[1]]) {
      return true;
    }
  }
  return false;
}

Triangulation fan(const Ring& outer, std::string problem) {
  Triangulation result;
  for (std::size_t k = 1; k + 1 < outer.size(); ++k) {
    result.triangles.push_back({outer[0], outer[k], outer[k + 1]});
  }
  result.problem = std::move(problem);
  return result;
}

// A corner in the plane of projection, so that GEOS' triangles can be named by our indices.
struct Corner {
  Vec2 at;
  std::uint32_t vertex;
};
bool before(const Vec2& a, const Vec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

// One vertex per projected point, sorted. Nothing if two corners above each other differ in height:
// then a point of the plane would not name a vertex.
std::optional<std::vector<Corner>> name_corners(const std::vector<Vec3>& positions,
                                                const std::vector<Ring>& rings,
                                                const Plane& plane) {
  std::vector<Corner> corners;
  for (const Ring& ring : rings) {
    for (const std::uint32_t v : ring) corners.push_back({plane(positions[v]), v});
  }
  std::stable_sort(corners.begin(), corners.end(),
                   [](const Corner& a, const Corner& b) { return before(a.at, b.at); });
  std::vector<Corner> unique;
  for (const Corner& c : corners) {
    if (unique.empty() || unique.back().at != c.at) {
      unique.push_back(c);
    } else if (positions[unique.back().vertex] != positions[c.vertex]) {
      return std::nullopt;
    }
  }
  return unique;
}

std::optional<std::uint32_t> vertex_at(const std::vector<Corner>& corners, const Vec2& p) {
  const auto at = std::lower_bound(corners.begin(), corners.end(), p,
                                   [](const Corner& c, const Vec2& q) { return before(c.at, q); });
  if (at == corners.end() || at->at != p) return std::nullopt;
  return at->vertex;
}

Geometry linear_ring(const Ring& ring, const std::vector<Vec3>& positions, const Plane& plane) {
  std::vector<double> xy;
  xy.reserve(2 * ring.size() + 2);
  for (std::size_t k = 0; k <= ring.size(); ++k) {
    const Vec2 p = plane(positions[ring[k % ring.size()]]);
    xy.push_back(p.x);
    xy.push_back(p.y);
  }
  GEOSCoordSequence* sequence = GEOSCoordSeq_copyFromBuffer_r(
      geos(), xy.data(), static_cast<unsigned>(ring.size() + 1), 0, 0);
  return Geometry(sequence ? GEOSGeom_createLinearRing_r(geos(), sequence) : nullptr);
}

Geometry polygon_of(const std::vector<Ring>& rings, const std::vector<Vec3>& positions,
                    const Plane& plane) {
  std::vector<Geometry> owned;
  std::vector<GEOSGeometry*> holes;
  for (const Ring& ring : rings) {
    owned.push_back(linear_ring(ring, positions, plane));
    if (!owned.back()) return nullptr;
  }
  for (std::size_t k = 1; k < owned.size(); ++k) holes.push_back(owned[k].release());
  return Geometry(GEOSGeom_createPolygon_r(geos(), owned[0].release(), holes.data(),
                                           static_cast<unsigned>(holes.size())));
}

// Triangles of GEOS by our indices, counter-clockwise; nothing if one has an unknown vertex.
std::optional<std::vector<Triangle>> named_triangles(const GEOSGeometry* collection,
                                                     const std::vector<Corner>& corners) {
  std::vector<Triangle> triangles;
  const int n = GEOSGetNumGeometries_r(geos(), collection);
  for (int k = 0; k < n; ++k) {
    const GEOSGeometry* face = GEOSGetGeometryN_r(geos(), collection, k);
    const GEOSGeometry* shell = face ? GEOSGetExteriorRing_r(geos(), face) : nullptr;
    const GEOSCoordSequence* sequence = shell ? GEOSGeom_getCoordSeq_r(geos(), shell) : nullptr;
    unsigned size = 0;
    if (!sequence || !GEOSCoordSeq_getSize_r(geos(), sequence, &size) || size != 4) return {};
    std::array<double, 8> xy;
    if (!GEOSCoordSeq_copyToBuffer_r(geos(), sequence, xy.data(), 0, 0)) return {};
    Triangle t;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto vertex = vertex_at(corners, {xy[2 * c], xy[2 * c + 1]});
      if (!vertex) return {};
      t[c] = *vertex;
    }
    if (orientation({xy[0], xy[1]}, {xy[2], xy[3]}, {xy[4], xy[5]}) < 0) std::swap(t[1], t[2]);
    triangles.push_back(t);
  }
  return triangles;
}

Edge upward(const Edge& e) { return {std::min(e.first, e.second), std::max(e.first, e.second)}; }

// Edges that are left when opposite ones cancel, sorted.
std::vector<Edge> without_opposites(std::vector<Edge> edges) {
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    const Edge up_a = upward(a), up_b = upward(b);
    return up_a != up_b ? up_a < up_b : a < b;
  });
  std::vector<Edge> left;
  for (std::size_t k = 0; k < edges.size();) {
    const Edge up = upward(edges[k]);
    std::ptrdiff_t balance = 0;
    for (; k < edges.size() && upward(edges[k]) == up; ++k) balance += edges[k] == up ? 1 : -1;
    const Edge edge = balance > 0 ? up : Edge{up.second, up.first};
    left.insert(left.end(), static_cast<std::size_t>(std::abs(balance)), edge);
  }
  return left;
}

// Counter-clockwise triangles cover a polygon exactly once if and only if their edges, opposite
// ones cancelled, are the polygon's rings (outer counter-clockwise, holes clockwise): both sides
// then have the same winding number at every point. Equal areas follow; no tolerance is needed.
bool covers(const std::vector<Triangle>& triangles, const std::vector<Ring>& rings,
            const std::vector<Vec3>& positions, const Plane& plane,
            const std::vector<Corner>& corners) {
  std::vector<Edge> inner, outline;
  for (const Triangle& t : triangles) {
    for (std::size_t c = 0; c < 3; ++c) inner.emplace_back(t[c], t[(c + 1) % 3]);
  }
  for (std::size_t r = 0; r < rings.size(); ++r) {
    std::vector<Vec2> flat;
    for (const std::uint32_t v : rings[r]) flat.push_back(plane(positions[v]));
    const bool reverse = (doubled_area(flat) > 0) != (r == 0);
    for (std::size_t k = 0; k < flat.size(); ++k) {
      const std::uint32_t a = *vertex_at(corners, flat[k]);
      const std::uint32_t b = *vertex_at(corners, flat[(k + 1) % flat.size()]);
      outline.push_back(reverse ? Edge{b, a} : Edge{a, b});
    }
  }
  return without_opposites(std::move(inner)) == without_opposites(std::move(outline));
}

// Why GEOS calls the polygon invalid; empty if it is valid.
std::string invalid_because(const GEOSGeometry* polygon) {
  if (GEOSisValid_r(geos(), polygon) == 1) return {};
  char* reason = GEOSisValidReason_r(geos(), polygon);
  std::string text = reason ? reason : "invalid";
  GEOSFree_r(geos(), reason);
  return text.substr(0, text.find('['));  // the place in the projection would not help anyone
}

// How a corner of a ring may be clipped, the best first.
enum class Ear { kTurnsBack, kTrue, kStraight };

// Triangles of a ring that GEOS calls invalid because it touches itself, as rings do that reach a
// hole over a slit. Clips spikes, then corners whose triangle holds no other corner; whether the
// result is right, covers() decides. May return too few triangles.
std::vector<Triangle> clip_ears(const Ring& outer, const std::vector<Vec3>& positions,
                                const Plane& plane, const std::vector<Corner>& corners) {
  constexpr std::size_t kMostCorners = 2000;  // the worst case is cubic
  std::vector<Triangle> triangles;
  if (outer.size() > kMostCorners) return triangles;
  Ring ring;
  for (const std::uint32_t v : outer) ring.push_back(*vertex_at(corners, plane(positions[v])));

  const auto corner = [&](std::size_t k) {
    const std::size_t n = ring.size();
    return Triangle{ring[(k + n - 1) % n], ring[k], ring[(k + 1) % n]};
  };
  const auto is_ear = [&](const Triangle& t, Ear kind) {
    const auto at = [&](std::uint32_t v) { return plane(positions[v]); };
    const Vec2 a = at(t[0]), b = at(t[1]), c = at(t[2]);
    const int turn = orientation(a, b, c);
    if (kind == Ear::kStraight) return turn == 0;
    if (kind == Ear::kTurnsBack) return turn == 0 && before(a, b) != before(b, c);
    return turn > 0 && std::none_of(ring.begin(), ring.end(), [&](std::uint32_t v) {
             return v != t[0] && v != t[1] && v != t[2] && orientation(a, b, at(v)) >= 0 &&
                    orientation(b, c, at(v)) >= 0 && orientation(c, a, at(v)) >= 0;
           });
  };
  while (ring.size() >= 3) {
    const std::size_t n = ring.size();
    std::size_t found = n;
    for (const Ear kind : {Ear::kTurnsBack, Ear::kTrue, Ear::kStraight}) {
      for (std::size_t k = 0; k < n && found == n; ++k) {
        if (is_ear(corner(k), kind)) found = k;
      }
    }
    if (found == n) break;
    const Triangle t = corner(found);
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(found));
    if (t[0] == t[2]) {  // there and back again: no triangle, and one end of it less
      ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(found % (n - 1)));
    } else {
      triangles.push_back(t);
    }
  }
  return triangles;
}

// What is left where GEOS cannot help: the outer ring by ears, or a fan of it if it crosses itself.
Triangulation without_geos(const std::vector<Ring>& rings, const std::vector<Vec3>& positions,
                           const Plane& plane, const std::vector<Corner>& corners,
                           const std::string& reason) {
  Triangulation result;
  result.triangles = clip_ears(rings[0], positions, plane, corners);
  if (!covers(result.triangles, {rings[0]}, positions, plane, corners)) {
    return fan(rings[0], reason);
  }
  if (result.triangles.empty()) {  // an exact cover of nothing, which must not go unsaid
    result.problem = "the outer ring goes back on its own edges and has no area";
    return result;
  }
  if (rings.size() > 1) result.problem = reason + "; its holes were left out";
  return result;
}

// Two triangles over a diagonal, if both wind the polygon's way: then they cover it exactly once.
bool split_quad(const Ring& ring, const std::vector<Vec3>& positions, const Plane& plane,
                std::vector<Triangle>& triangles) {
  std::array<Vec2, 4> p;
  for (std::size_t k = 0; k < 4; ++k) p[k] = plane(positions[ring[k]]);
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t a = k, b = k + 1, c = k + 2, d = (k + 3) % 4;
    if (orientation(p[a], p[b], p[c]) > 0 && orientation(p[a], p[c], p[d]) > 0) {
      triangles = {{ring[a], ring[b], ring[c]}, {ring[a], ring[c], ring[d]}};
      return true;
    }
  }
  return false;
}

}  // namespace

Triangulation triangulate(const std::vector<Vec3>& positions,
                          const std::vector<std::vector<std::uint32_t>>& rings) {
  Triangulation result;
  std::vector<Ring> clean;
  for (const Ring& ring : rings) {
    Ring c = cleaned(positions, ring);
    if (has_three_distinct(positions, c)) {
      clean.push_back(std::move(c));
    } else if (clean.empty()) {
      result.problem = "the outer ring has fewer than 3 distinct corners";
      return result;
    } else {
      result.problem = "a hole has fewer than 3 distinct corners and was left out";
    }
  }
  if (clean.empty()) {
    result.problem = "the polygon has no ring";
    return result;
  }
  const Ring& outer = clean[0];
  if (clean.size() == 1 && outer.size() == 3) {
    result.triangles = {{outer[0], outer[1], outer[2]}};
    return result;
  }

  const Plane plane = projection(positions, outer);
  if (clean.size() == 1 && outer.size() == 4 &&
      split_quad(outer, positions, plane, result.triangles)) {
    return result;
  }
  const auto corners = name_corners(positions, clean, plane);
  if (!corners) return fan(outer, "two corners lie above each other in the polygon's plane");

  const Geometry polygon = polygon_of(clean, positions, plane);
  if (!polygon) return fan(outer, "GEOS cannot make a polygon of its rings");
  // GEOS 3.11 never returns from a ring that crosses itself, and joins holes without looking where
  // they are.
  const std::string reason = invalid_because(polygon.get());
  if (!reason.empty()) return without_geos(clean, positions, plane, *corners, reason);
  const Geometry collection(GEOSConstrainedDelaunayTriangulation_r(geos(), polygon.get()));
  if (collection) {
    auto triangles = named_triangles(collection.get(), *corners);
    if (triangles && covers(*triangles, clean, positions, plane, *corners)) {
      result.triangles = std::move(*triangles);
      return result;
    }
  }
  return without_geos(clean, positions, plane, *corners, "GEOS cannot triangulate it");
}

}  // namespace gnomon
