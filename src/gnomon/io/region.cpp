#include <gnomon/io/region.h>

#include <algorithm>
#include <cmath>

#include <gnomon/io/point_ids.h>

namespace gnomon {
namespace {

// Faces of the linework must cover the region; their areas are sums of rounded products, hence not
// exactly. Relative.
constexpr double kSameArea = 1e-9;

// Many questions to one geometry. Each of its polygons is prepared alone: GEOS 3.11 answers slowly
// for a prepared collection. The geometry must live as long.
class Prepared {
 public:
  Prepared(const Geos& geos, const GEOSGeometry* geometry) : geos_(geos) {
    for_each_polygon(geos, geometry, [&](const GEOSGeometry* polygon) {
      polygons_.push_back(GEOSPrepare_r(geos.handle, polygon));
    });
  }
  ~Prepared() {
    for (const GEOSPreparedGeometry* p : polygons_) GEOSPreparedGeom_destroy_r(geos_.handle, p);
  }
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;
  bool intersects(const GEOSGeometry* other) const {
    return std::any_of(polygons_.begin(), polygons_.end(), [&](const GEOSPreparedGeometry* p) {
      return GEOSPreparedIntersects_r(geos_.handle, p, other) == 1;
    });
  }

 private:
  const Geos& geos_;
  std::vector<const GEOSPreparedGeometry*> polygons_;
};

// Where the constrained triangulation fails: Delaunay of the vertices, without the triangles whose
// middle is not in the region.
Geom unconstrained(const Geos& geos, const GEOSGeometry* region) {
  const Geom all = own(geos, GEOSDelaunayTriangulation_r(geos.handle, region, 0.0, 0));
  if (!all) return own(geos, nullptr);
  const Prepared inside(geos, region);
  std::vector<Geom> kept;
  for_each_polygon(geos, all.get(), [&](const GEOSGeometry* t) {
    const Geom middle = own(geos, GEOSGetCentroid_r(geos.handle, t));
    if (middle && inside.intersects(middle.get())) {
      kept.push_back(own(geos, GEOSGeom_clone_r(geos.handle, t)));
    }
  });
  return collection(geos, GEOS_GEOMETRYCOLLECTION, std::move(kept));
}

// The constrained triangulation of a polygon that is turned by an angle, on its own vertices, which
// are found again by their turned coordinates. Null if GEOS fails, or two vertices become one.
Geom triangulated_at(const Geos& geos, const GEOSGeometry* polygon, double angle) {
  struct Turn {
    double c, s;
    PointIds turned;
    std::vector<Vec2> own;  // by the number of the turned point
    bool is_clear = true;
  } turn{std::cos(angle), std::sin(angle), {}, {}, true};
  const auto there = [](double* x, double* y, void* data) {
    Turn& t = *static_cast<Turn*>(data);
    const Vec2 p(*x, *y);
    *x = t.c * p.x - t.s * p.y;
    *y = t.s * p.x + t.c * p.y;
    const std::uint32_t k = t.turned({*x, *y});
    if (k == t.own.size()) t.own.push_back(p);
    t.is_clear = t.is_clear && t.own[k] == p;
    return 1;
  };
  const auto back = [](double* x, double* y, void* data) {
    Turn& t = *static_cast<Turn*>(data);
    const std::uint32_t k = t.turned({*x, *y});
    if (k >= t.own.size()) return t.is_clear = false, 0;
    *x = t.own[k].x;
    *y = t.own[k].y;
    return 1;
  };
  const Geom turned = own(geos, GEOSGeom_transformXY_r(geos.handle, polygon, there, &turn));
  if (!turned || !turn.is_clear) return own(geos, nullptr);
  const Geom mesh = own(geos, GEOSConstrainedDelaunayTriangulation_r(geos.handle, turned.get()));
  if (!mesh) return own(geos, nullptr);
  Geom result = own(geos, GEOSGeom_transformXY_r(geos.handle, mesh.get(), back, &turn));
  if (!turn.is_clear) result.reset();
  return result;
}

}  // namespace

Geom split_by(const Geos& geos, const GEOSGeometry* region,
              const std::vector<std::array<Vec3, 2>>& edges) {
  std::vector<Geom> lines;
  lines.push_back(own(geos, GEOSBoundary_r(geos.handle, region)));
  for (const std::array<Vec3, 2>& e : edges) {
    lines.push_back(line(geos, {{e[0].x, e[0].y}, {e[1].x, e[1].y}}, false));
  }
  const Geom all = collection(geos, GEOS_GEOMETRYCOLLECTION, std::move(lines));
  const Geom noded = own(geos, GEOSUnaryUnion_r(geos.handle, all.get()));
  if (!noded) return own(geos, nullptr);
  const GEOSGeometry* input = noded.get();
  const Geom faces = own(geos, GEOSPolygonize_r(geos.handle, &input, 1));
  if (!faces) return own(geos, nullptr);
  const Prepared prepared(geos, region);
  std::vector<Geom> kept;
  for_each_polygon(geos, faces.get(), [&](const GEOSGeometry* face) {
    const Geom inside = own(geos, GEOSPointOnSurface_r(geos.handle, face));
    if (inside && prepared.intersects(inside.get())) {
      kept.push_back(own(geos, GEOSGeom_clone_r(geos.handle, face)));
    }
  });
  Geom result = collection(geos, GEOS_GEOMETRYCOLLECTION, std::move(kept));
  const double expected = area(geos, region);
  if (std::abs(area(geos, result.get()) - expected) > kSameArea * expected) result.reset();
  return result;
}

Geom triangulated(const Geos& geos, const GEOSGeometry* region, std::size_t& failed) {
  if (Geom all = own(geos, GEOSConstrainedDelaunayTriangulation_r(geos.handle, region))) return all;
  std::vector<Geom> meshes;
  for_each_polygon(geos, region, [&](const GEOSGeometry* polygon) {
    Geom mesh = own(geos, nullptr);
    for (const double angle : {0.0, 0.3, 0.7, 1.1, 1.9, 2.3}) {  // radians; any will do
      mesh = triangulated_at(geos, polygon, angle);
      if (mesh) break;
    }
    if (!mesh) ++failed, mesh = unconstrained(geos, polygon);
    meshes.push_back(std::move(mesh));
  });
  if (std::any_of(meshes.begin(), meshes.end(), [](const Geom& m) { return !m; })) {
    return own(geos, nullptr);
  }
  return collection(geos, GEOS_GEOMETRYCOLLECTION, std::move(meshes));
}

}  // namespace gnomon
