#include <gnomon/io/geos_geometry.h>

#include <algorithm>

namespace gnomon {

Geom own(const Geos& geos, GEOSGeometry* g) { return Geom(g, GeomDeleter{geos.handle}); }

Geom line(const Geos& geos, const std::vector<Vec2>& points, bool ring) {
  GEOSCoordSequence* s =
      GEOSCoordSeq_create_r(geos.handle, static_cast<unsigned>(points.size()), 2);
  for (unsigned k = 0; k < points.size(); ++k) {
    GEOSCoordSeq_setXY_r(geos.handle, s, k, points[k].x, points[k].y);
  }
  return own(geos, ring ? GEOSGeom_createLinearRing_r(geos.handle, s)
                        : GEOSGeom_createLineString_r(geos.handle, s));
}

Geom polygon(const Geos& geos, const std::vector<Vec2>& ring) {
  return own(geos,
             GEOSGeom_createPolygon_r(geos.handle, line(geos, ring, true).release(), nullptr, 0));
}

Geom collection(const Geos& geos, int type, std::vector<Geom>&& parts) {
  std::vector<GEOSGeometry*> raw;
  for (Geom& g : parts) raw.push_back(g.release());
  return own(geos, GEOSGeom_createCollection_r(geos.handle, type, raw.data(),
                                               static_cast<unsigned>(raw.size())));
}

std::vector<Vec2> points_of(const Geos& geos, const GEOSGeometry* line_or_ring) {
  const GEOSCoordSequence* s = GEOSGeom_getCoordSeq_r(geos.handle, line_or_ring);
  unsigned n = 0;
  GEOSCoordSeq_getSize_r(geos.handle, s, &n);
  std::vector<Vec2> points(n);
  for (unsigned k = 0; k < n; ++k) {
    GEOSCoordSeq_getXY_r(geos.handle, s, k, &points[k].x, &points[k].y);
  }
  return points;
}

void for_each_polygon(const Geos& geos, const GEOSGeometry* g,
                      const std::function<void(const GEOSGeometry*)>& visit) {
  if (GEOSGeomTypeId_r(geos.handle, g) == GEOS_POLYGON) {
    if (GEOSisEmpty_r(geos.handle, g) == 0) visit(g);
    return;
  }
  const int n = GEOSGetNumGeometries_r(geos.handle, g);
  if (GEOSGeomTypeId_r(geos.handle, g) < GEOS_MULTIPOINT) return;  // a point or a line
  for (int k = 0; k < n; ++k) for_each_polygon(geos, GEOSGetGeometryN_r(geos.handle, g, k), visit);
}

void for_each_ring(const Geos& geos, const GEOSGeometry* poly,
                   const std::function<void(const std::vector<Vec2>&)>& visit) {
  const int holes = GEOSGetNumInteriorRings_r(geos.handle, poly);
  for (int k = -1; k < holes; ++k) {
    const GEOSGeometry* ring = k < 0 ? GEOSGetExteriorRing_r(geos.handle, poly)
                                     : GEOSGetInteriorRingN_r(geos.handle, poly, k);
    std::vector<Vec2> points = points_of(geos, ring);
    char counter_clockwise = 1;
    GEOSCoordSeq_isCCW_r(geos.handle, GEOSGeom_getCoordSeq_r(geos.handle, ring),
                         &counter_clockwise);
    if ((counter_clockwise != 0) != (k < 0)) std::reverse(points.begin(), points.end());
    visit(points);
  }
}

double area(const Geos& geos, const GEOSGeometry* g) {
  double a = 0;
  GEOSArea_r(geos.handle, g, &a);
  return a;
}

}  // namespace gnomon
