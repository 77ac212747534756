// The steps of docs/ground.md. Unions, differences and constrained Delaunay triangulations are
// those of GEOS (OverlayNG).
#include <gnomon/io/ground.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <gnomon/io/footprints.h>
#include <gnomon/io/geos_geometry.h>
#include <gnomon/io/point_ids.h>
#include <gnomon/io/region.h>

namespace gnomon {
namespace {

// Points around the model at which the ground stops following the buildings: one every 25 to 100 m,
// as near to 200 in all as that allows, and as far away from the model as from each other (metres).
constexpr double kRingMin = 25, kRingMax = 100, kRingPoints = 200;

// A vertex of the union lies on the footprint edge it came from up to the rounding of an
// intersection point, some 1e-10 m at coordinates of 1e6 m, or GEOS' snapping of 1e-12 of them.
// Real vertices are a millimetre apart. In between, in metres:
constexpr double kOnEdge = 1e-6;

// Neighbours on a slope have level bottoms at different heights, and share corners. Makers of
// models put a bottom at the lowest point of the terrain around the building, so that at a shared
// corner the terrain is at the higher bottom: there the ground is, and it covers a little of the
// lower building's wall. A step of more than this is no slope but a part that starts on an upper
// floor (a passage, an oriel); there the ground stays at the lower bottom. The least height of a
// storey in most building codes, in metres.
constexpr double kStorey = 2.5;

// Rings around the footprints, this far from them, with a vertex at least twice this often; a bend
// by less than a fifth of it is left out (metres). Their vertices are free to take heights between
// those of the buildings around, so that a step between two corners ends at the first ring; without
// them it would reach as far as the next building. 3 m is what a stair or an embankment takes
// beside a house; the second ring lets the triangles grow. Both lie within kRingMin of the model.
constexpr double kAround[] = {3, 12};
constexpr double kRingStep = 2, kRingBend = 0.2;
static_assert(kAround[0] * (1 + kRingBend) < kAround[1] * (1 - kRingBend));  // they never meet
static_assert(kAround[1] * (1 + kRingBend) < kRingMin);

// The heights of free vertices are found by repeated averaging; it ends when none moves by more
// than this (metres), the precision of models, or after this often.
constexpr double kSettled = 1e-3;
constexpr int kSweeps = 500;

// GEOS joins the holes of a polygon in a time that grows with the square of their number. On level
// ground the holes can be left out (docs/ground.md); above so many triangles of footprints, some
// thousand houses and some seconds, they are.
constexpr std::size_t kMostHoles = 20000;

// ---- vertices and heights
// ------------------------------------------------------------------------------------

using Edge = std::array<Vec3, 2>;

// The edges of all footprints, found by place: a uniform grid of cells about as large as an edge is
// long.
class EdgeFinder {
 public:
  explicit EdgeFinder(std::vector<Edge> edges) : edges_(std::move(edges)) {
    double length = 0;
    for (const Edge& e : edges_) length += glm::length(e[1] - e[0]);
    cell_ = std::max(1.0, length / static_cast<double>(std::max<std::size_t>(1, edges_.size())));
    for (std::uint32_t k = 0; k < edges_.size(); ++k) {
      const Vec3 low = glm::min(edges_[k][0], edges_[k][1]);
      const Vec3 high = glm::max(edges_[k][0], edges_[k][1]);
      for (std::int64_t x = cell(low.x - kOnEdge); x <= cell(high.x + kOnEdge); ++x) {
        for (std::int64_t y = cell(low.y - kOnEdge); y <= cell(high.y + kOnEdge); ++y) {
          cells_[key(x, y)].push_back(k);
        }
      }
    }
  }

  // The heights at u and v of the lowest footprint edge that runs through both; false if there is
  // none.
  bool heights(const Vec2& u, const Vec2& v, double& zu, double& zv) const {
    const auto at = cells_.find(key(cell(u.x), cell(u.y)));
    if (at == cells_.end()) return false;
    bool found = false;
    for (const std::uint32_t k : at->second) {
      double a, b;
      if (!height_on(edges_[k], u, a) || !height_on(edges_[k], v, b)) continue;
      if (!found || a + b < zu + zv) zu = a, zv = b;
      found = true;
    }
    return found;
  }

 private:
  static bool height_on(const Edge& e, const Vec2& p, double& z) {
    const Vec2 a(e[0].x, e[0].y), b(e[1].x, e[1].y);
    // The ends exactly, so that ground and building share the vertex.
    if (p == a) return z = e[0].z, true;
    if (p == b) return z = e[1].z, true;
    const Vec2 d = b - a;
    const double length = glm::length(d);
    if (length == 0) return false;
    const double along = glm::dot(p - a, d) / length;
    const double beside = ((p.x - a.x) * d.y - (p.y - a.y) * d.x) / length;
    if (std::abs(beside) > kOnEdge || along < -kOnEdge || along > length + kOnEdge) return false;
    const double s = std::clamp(along / length, 0.0, 1.0);
    z = e[0].z == e[1].z ? e[0].z : e[0].z + s * (e[1].z - e[0].z);
    return true;
  }
  std::int64_t cell(double c) const { return static_cast<std::int64_t>(std::floor(c / cell_)); }
  static std::uint64_t key(std::int64_t x, std::int64_t y) {
    return static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(y);
  }

  std::vector<Edge> edges_;
  double cell_ = 1;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

// ---- the surface -----------------------------------------------------------------------------

// Precondition: `points` is not empty.
double nearest_height(const std::vector<Vec3>& points, const Vec2& p) {
  const auto rank = [&](const Vec3& q) {
    return std::pair((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y), q.z);
  };
  return std::min_element(points.begin(), points.end(),
                          [&](const Vec3& a, const Vec3& b) { return rank(a) < rank(b); })
      ->z;
}

struct Surface3 {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;

  std::uint32_t add(const Vec3& p) {
    positions.push_back(p);
    return static_cast<std::uint32_t>(positions.size() - 1);
  }
};

void add_rectangle(Surface3& out, const Bounds2& b, double z) {
  const std::uint32_t k = out.add({b.x0, b.y0, z});
  out.add({b.x1, b.y0, z});
  out.add({b.x1, b.y1, z});
  out.add({b.x0, b.y1, z});
  out.triangles.push_back({k, k + 1, k + 2});
  out.triangles.push_back({k, k + 2, k + 3});
}

// The sides of `b`, counter-clockwise from (x0, y0), `per_side` points each (first corner included,
// last not).
std::array<std::vector<Vec2>, 4> sides_of(const Bounds2& b, int along_x, int along_y) {
  std::array<std::vector<Vec2>, 4> sides;
  for (int k = 0; k < along_x; ++k) {
    const double s = (b.x1 - b.x0) * k / along_x;
    sides[0].push_back({b.x0 + s, b.y0});
    sides[2].push_back({b.x1 - s, b.y1});
  }
  for (int k = 0; k < along_y; ++k) {
    const double s = (b.y1 - b.y0) * k / along_y;
    sides[1].push_back({b.x1, b.y0 + s});
    sides[3].push_back({b.x0, b.y1 - s});
  }
  return sides;
}

// Level beyond: from the ring outwards to `outer` every point has the height of the ring point
// before it.
void add_frame(Surface3& out, const std::array<std::vector<Vec2>, 4>& sides, const Bounds2& outer,
               const std::function<double(const Vec2&)>& height) {
  const Vec2 outwards[4] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
  const auto pushed = [&](Vec2 p, int side) {
    if (outwards[side].x > 0) p.x = outer.x1;
    if (outwards[side].x < 0) p.x = outer.x0;
    if (outwards[side].y > 0) p.y = outer.y1;
    if (outwards[side].y < 0) p.y = outer.y0;
    return p;
  };
  const auto quad = [&](const std::array<Vec3, 4>& c) {  // counter-clockwise
    std::uint32_t id[4];
    for (int k = 0; k < 4; ++k) id[k] = out.add(c[k]);
    for (const std::array<int, 3>& t : {std::array<int, 3>{0, 1, 2}, std::array<int, 3>{0, 2, 3}}) {
      if (turn(c[t[0]], c[t[1]], c[t[2]]) > 0) {
        out.triangles.push_back({id[t[0]], id[t[1]], id[t[2]]});
      }
    }
  };
  for (int side = 0; side < 4; ++side) {
    std::vector<Vec2> points = sides[side];
    points.push_back(sides[(side + 1) % 4].front());
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      const Vec2 a = points[k], b = points[k + 1], oa = pushed(a, side), ob = pushed(b, side);
      const double za = height(a), zb = height(b);
      quad({Vec3(a, za), Vec3(oa, za), Vec3(ob, zb), Vec3(b, zb)});
    }
    const Vec2 corner = points.back();
    const double z = height(corner);
    const int next = (side + 1) % 4;
    quad({Vec3(corner, z), Vec3(pushed(corner, side), z),
          Vec3(pushed(pushed(corner, side), next), z), Vec3(pushed(corner, next), z)});
  }
}

// The ground inside `ring` and outside `closed`, cut along the rings of kAround: the band next to
// the footprints first; all of it in one if `flat`. Empty if GEOS fails.
std::vector<Geom> bands_around(const Geos& geos, const Geom& closed, const std::vector<Edge>& open,
                               const Geom& ring, bool flat) {
  std::vector<Geom> feet;
  feet.push_back(own(geos, GEOSGeom_clone_r(geos.handle, closed.get())));
  for (const Edge& e : open) {
    feet.push_back(line(geos, {{e[0].x, e[0].y}, {e[1].x, e[1].y}}, false));
  }
  Geom wide = collection(geos, GEOS_GEOMETRYCOLLECTION, std::move(feet));
  Geom inner = own(geos, GEOSGeom_clone_r(geos.handle, closed.get()));
  std::vector<Geom> bands;
  double before = 0;
  for (const double distance : kAround) {
    if (flat) break;
    constexpr int kCornersPerQuarter = 2;
    wide = own(geos, GEOSBuffer_r(geos.handle, wide.get(), distance - before, kCornersPerQuarter));
    if (!wide) return {};
    Geom outer =
        own(geos, GEOSTopologyPreserveSimplify_r(geos.handle, wide.get(), kRingBend * distance));
    if (outer) outer = own(geos, GEOSDensify_r(geos.handle, outer.get(), kRingStep * distance));
    if (!outer) return {};
    bands.push_back(own(geos, GEOSDifference_r(geos.handle, outer.get(), inner.get())));
    if (!bands.back()) return {};
    inner = std::move(outer);
    before = distance;
  }
  bands.push_back(own(geos, GEOSDifference_r(geos.handle, ring.get(), inner.get())));
  if (!bands.back()) bands.clear();
  return bands;
}

// Hangs the free vertices between the fixed ones like a soap film, free at its rim: each gets the
// mean of its neighbours' heights, weighted by nearness. No height leaves the range of the fixed
// ones, and a step between two of them fades as fast as it is wide. Where no edge leads to a fixed
// vertex, the nearest of `known` gives the height.
void hang(Surface3& surface, const std::vector<bool>& fixed, const std::vector<Vec3>& known) {
  struct Neighbour {
    std::uint32_t v;
    double weight;
  };
  std::vector<std::vector<Neighbour>> neighbours(surface.positions.size());
  for (const Triangle& t : surface.triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t u = t[k], v = t[(k + 1) % 3];
      const Vec3 d = surface.positions[v] - surface.positions[u];
      const double weight = 1 / std::hypot(d.x, d.y);
      neighbours[u].push_back({v, weight});
      neighbours[v].push_back({u, weight});
    }
  }
  // The start: each free vertex has the height of the one it is first reached from.
  std::vector<std::uint32_t> reached;
  std::vector<bool> has_height = fixed;
  for (std::uint32_t v = 0; v < fixed.size(); ++v) {
    if (fixed[v]) reached.push_back(v);
  }
  for (std::size_t k = 0; k < reached.size(); ++k) {
    for (const Neighbour& n : neighbours[reached[k]]) {
      if (has_height[n.v]) continue;
      has_height[n.v] = true;
      surface.positions[n.v].z = surface.positions[reached[k]].z;
      reached.push_back(n.v);
    }
  }
  for (std::size_t v = 0; v < fixed.size(); ++v) {
    Vec3& p = surface.positions[v];
    if (!has_height[v]) p.z = nearest_height(known, Vec2(p.x, p.y));
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double moved = 0;
    for (std::size_t u = 0; u < neighbours.size(); ++u) {
      if (fixed[u] || !has_height[u]) continue;
      // Differences, so that level stays level to the bit.
      double& z = surface.positions[u].z;
      double sum = 0, weights = 0;
      for (const Neighbour& n : neighbours[u]) {
        sum += n.weight * (surface.positions[n.v].z - z);
        weights += n.weight;
      }
      z += sum / weights;
      moved = std::max(moved, std::abs(sum / weights));
    }
    if (moved < kSettled) break;
  }
}

// All at the same height, to the bit.
bool are_level(const Footprints& feet) {
  const double z = feet.closed.empty() ? feet.open.front()[0].z : feet.closed.front()[0].z;
  const auto at_z = [&](const auto& points) {
    return std::all_of(points.begin(), points.end(), [&](const Vec3& p) { return p.z == z; });
  };
  return std::all_of(feet.closed.begin(), feet.closed.end(), at_z) &&
         std::all_of(feet.open.begin(), feet.open.end(), at_z);
}

Result<Surface3> through(const Footprints& feet, const Bounds2& model, const Bounds2& extent,
                         Warnings& warnings) {
  Geos geos;
  const auto failed = [&](const char* what) {
    return Error{
        fmt::format("the ground could not be made: {} failed ({}); give its height with "
                    "--ground Z, or --ground none",
                    what, geos.message)};
  };

  std::vector<Edge> edges = feet.open;
  std::vector<Geom> triangles;
  for (const std::array<Vec3, 3>& t : feet.closed) {
    for (int k = 0; k < 3; ++k) edges.push_back({t[k], t[(k + 1) % 3]});
    const Vec2 a(t[0].x, t[0].y);
    triangles.push_back(polygon(geos, {a, {t[1].x, t[1].y}, {t[2].x, t[2].y}, a}));
  }
  const double z0 = edges.front()[0].z;
  const bool flat = are_level(feet);
  const EdgeFinder finder(std::move(edges));

  // Ring and outer rectangle. Flat ground needs no ring: the rectangle itself is level.
  const double around = 2 * (model.x1 - model.x0 + model.y1 - model.y0);
  const double spacing = std::clamp(around / kRingPoints, kRingMin, kRingMax);
  Bounds2 ring{model.x0 - spacing, model.y0 - spacing, model.x1 + spacing, model.y1 + spacing};
  const Bounds2 outer{std::min(ring.x0, extent.x0), std::min(ring.y0, extent.y0),
                      std::max(ring.x1, extent.x1), std::max(ring.y1, extent.y1)};
  if (flat) ring = outer;
  const auto count = [&](double side) {
    return flat ? 1 : static_cast<int>(std::ceil(side / spacing));
  };
  const auto sides = sides_of(ring, count(ring.x1 - ring.x0), count(ring.y1 - ring.y0));
  std::vector<Vec2> ring_points;
  for (const auto& side : sides) ring_points.insert(ring_points.end(), side.begin(), side.end());
  ring_points.push_back(ring_points.front());

  // Region: inside the ring, outside the footprints; in bands, but for flat ground.
  Geom closed = own(geos, GEOSGeom_createEmptyPolygon_r(geos.handle));
  if (!triangles.empty()) {
    const Geom soup = collection(geos, GEOS_MULTIPOLYGON, std::move(triangles));
    closed = own(geos, GEOSUnaryUnion_r(geos.handle, soup.get()));
    if (!closed) return failed("the union of the footprints");
  }
  std::vector<Geom> bands = bands_around(geos, closed, feet.open, polygon(geos, ring_points), flat);
  if (bands.empty()) return failed("cutting the footprints out of the ground");
  if (!feet.open.empty()) {
    if (Geom faces = split_by(geos, bands.front().get(), feet.open)) {
      bands.front() = std::move(faces);
    } else {
      warn(warnings,
           "The lower edges of objects without a bottom could not be worked into the ground; they "
           "may stand a little "
           "above or below it.",
           "", feet.open.size());
    }
  }
  const Geom region = collection(geos, GEOS_GEOMETRYCOLLECTION, std::move(bands));
  std::size_t without_edges = 0;
  const Geom mesh = triangulated(geos, region.get(), without_edges);
  if (!mesh) return failed("the triangulation");
  if (without_edges > 0) {
    warn(warnings,
         "The ground between the footprints could not be triangulated along their edges; it was "
         "without them, and may "
         "cut into buildings.",
         geos.message, without_edges);
  }

  // Heights: an edge of the region has those of the lowest footprint edge there, and a vertex the
  // highest of its two edges' heights (kStorey).
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  struct Border {
    std::uint32_t u, v;
    double zu, zv;
  };
  PointIds id;
  std::vector<Border> borders;
  std::unordered_set<std::uint64_t> seen;
  for_each_polygon(geos, region.get(), [&](const GEOSGeometry* face) {
    for_each_ring(geos, face, [&](const std::vector<Vec2>& points) {
      for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        Border b{id(points[k]), id(points[k + 1]), 0, 0};
        if (!finder.heights(points[k], points[k + 1], b.zu, b.zv)) continue;
        const std::uint64_t low = std::min(b.u, b.v), high = std::max(b.u, b.v);
        if (seen.insert(low << 32 | high).second) borders.push_back(b);
      }
    });
  });
  std::vector<double> z(id.points.size(), kUnknown);
  for (const Border& b : borders) {
    z[b.u] = std::min(z[b.u], b.zu);
    z[b.v] = std::min(z[b.v], b.zv);
  }
  const std::vector<double> lowest = z;
  for (const Border& b : borders) {
    if (b.zu <= lowest[b.u] + kStorey) z[b.u] = std::max(z[b.u], b.zu);
    if (b.zv <= lowest[b.v] + kStorey) z[b.v] = std::max(z[b.v], b.zv);
  }

  Surface3 out;
  for_each_polygon(geos, mesh.get(), [&](const GEOSGeometry* t) {
    const std::vector<Vec2> p = points_of(geos, GEOSGetExteriorRing_r(geos.handle, t));
    Triangle v = {id(p[0]), id(p[1]), id(p[2])};
    const int side = turn(Vec3(p[0], 0), Vec3(p[1], 0), Vec3(p[2], 0));
    if (side == 0) return;
    if (side < 0) std::swap(v[1], v[2]);
    out.triangles.push_back(v);
  });
  z.resize(id.points.size(), kUnknown);
  // All others hang between these. Lower edges that enclose nothing have left no vertex in the
  // ground, only their heights.
  std::vector<bool> fixed(id.points.size());
  std::vector<Vec3> known;
  for (std::uint32_t k = 0; k < id.points.size(); ++k) {
    fixed[k] = z[k] != kUnknown;
    if (fixed[k]) known.push_back(Vec3(id.points[k], z[k]));
    out.positions.push_back(Vec3(id.points[k], fixed[k] ? z[k] : z0));
  }
  if (known.empty()) {
    for (const Edge& e : feet.open) known.insert(known.end(), e.begin(), e.end());
  }
  if (!flat) hang(out, fixed, known);
  for (std::size_t k = 0; k < z.size(); ++k) z[k] = out.positions[k].z;
  // What stands more than a storey above its neighbour stands on a skirt: an upright wall from the
  // ground to its lower edge, so that no light passes below it.
  for (const Border& b : borders) {
    const bool at_u = b.zu > z[b.u], at_v = b.zv > z[b.v];
    const Vec3 top_u(id.points[b.u], b.zu), top_v(id.points[b.v], b.zv);
    const std::uint32_t u = at_u ? out.add(top_u) : b.u;
    const std::uint32_t v = at_v ? out.add(top_v) : b.v;
    if (at_u) out.triangles.push_back({b.u, u, b.v});
    if (at_v) out.triangles.push_back({b.v, u, v});
  }
  if (!flat) {
    add_frame(out, sides, outer, [&](const Vec2& p) { return z[id(p)]; });
  }
  return out;
}

// ---- modes ----------------------------------------------------------------------------------

// The rectangle around everything and its lowest point; `extent` alone for an empty scene.
struct Hull {
  Bounds2 bounds;
  double lowest = 0;
};
Hull hull_of(const Scene& scene, const Bounds2& extent) {
  if (scene.mesh.triangles.empty()) return {extent, 0};
  Vec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const Triangle& t : scene.mesh.triangles) {
    for (const std::uint32_t v : t) {
      low = glm::min(low, scene.mesh.positions[v]);
      high = glm::max(high, scene.mesh.positions[v]);
    }
  }
  return {{low.x, low.y, high.x, high.y}, low.z};
}

void add_to_scene(Scene& scene, const Surface3& ground) {
  Surface surface;
  surface.object = surface.group = surface.semantic = "Ground";
  scene.surfaces.push_back(surface);
  const auto index = static_cast<std::uint32_t>(scene.surfaces.size() - 1);
  const auto base = static_cast<std::uint32_t>(scene.mesh.positions.size());
  scene.mesh.positions.insert(scene.mesh.positions.end(), ground.positions.begin(),
                              ground.positions.end());
  for (const Triangle& t : ground.triangles) {
    scene.mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    scene.surface_of.push_back(index);
  }
}

}  // namespace

bool is_made_ground(const Surface& s) { return s.object == "Ground" && s.group == "Ground"; }

Result<GroundReport> add_ground(Scene& scene, const GroundOptions& options) {
  if (options.mode == "none") return GroundReport{"none", 0};

  const Hull hull = hull_of(scene, options.extent);
  const Bounds2 all{
      std::min(hull.bounds.x0, options.extent.x0), std::min(hull.bounds.y0, options.extent.y0),
      std::max(hull.bounds.x1, options.extent.x1), std::max(hull.bounds.y1, options.extent.y1)};
  const auto level = [&](double z) -> Result<GroundReport> {
    if (!(all.x1 > all.x0 && all.y1 > all.y0)) {
      return Error{"the ground has no extent: the model has no width; give --bounds"};
    }
    Surface3 ground;
    add_rectangle(ground, all, z);
    add_to_scene(scene, ground);
    return GroundReport{"level", ground.triangles.size()};
  };

  if (options.mode != "auto") {
    char* end = nullptr;
    const double z = std::strtod(options.mode.c_str(), &end);
    if (options.mode.empty() || *end != '\0' || !std::isfinite(z)) {
      return Error{"the ground '" + options.mode +
                   "' is not understood; give auto, none or a height in metres"};
    }
    return level(z - scene.frame.origin.z);
  }

  for (const std::uint32_t s : scene.surface_of) {
    if (is_terrain(scene.surfaces[s])) return GroundReport{"model terrain", 0};
  }
  const Footprints feet = find_footprints(scene);
  if (feet.closed.empty() && (feet.open.empty() || feet.one_object)) return level(hull.lowest);
  if (feet.closed.size() > kMostHoles && are_level(feet)) return level(feet.closed.front()[0].z);
  Result<Surface3> ground = through(feet, hull.bounds, options.extent, scene.warnings);
  if (!ground) return ground.error();
  add_to_scene(scene, ground.value());
  return GroundReport{feet.one_object ? "level" : "through ground surfaces",
                      ground.value().triangles.size()};
}

}  // namespace gnomon
