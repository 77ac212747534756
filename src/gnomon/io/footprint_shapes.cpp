#include <gnomon/io/footprint_shapes.h>

#include <algorithm>
#include <memory>

#include <gnomon/io/geos_geometry.h>

namespace gnomon {
namespace {

bool has_three_distinct(const std::vector<Vec2>& ring) {
  for (const Vec2& p : ring) {
    if (!ring.empty() && p != ring[0]) {
      return std::any_of(ring.begin(), ring.end(),
                         [&](const Vec2& q) { return q != ring[0] && q != p; });
    }
  }
  return false;
}

Geom closed_ring(const Geos& geos, std::vector<Vec2> ring) {
  ring.push_back(ring[0]);
  return line(geos, ring, true);
}

// Precondition: each ring has three distinct points.
Geom with_holes(const Geos& geos, const Rings& rings) {
  std::vector<GEOSGeometry*> holes;
  for (std::size_t k = 1; k < rings.size(); ++k) {
    holes.push_back(closed_ring(geos, rings[k]).release());
  }
  return own(geos, GEOSGeom_createPolygon_r(geos.handle, closed_ring(geos, rings[0]).release(),
                                            holes.data(), static_cast<unsigned>(holes.size())));
}

Rings oriented(const Geos& geos, const GEOSGeometry* polygon) {
  Rings rings;
  for_each_ring(geos, polygon, [&](std::vector<Vec2> ring) {
    ring.pop_back();
    rings.push_back(std::move(ring));
  });
  return rings;
}

Geom made_valid(const Geos& geos, const GEOSGeometry* polygon) {
  GEOSMakeValidParams* params = GEOSMakeValidParams_create_r(geos.handle);
  GEOSMakeValidParams_setMethod_r(geos.handle, params, GEOS_MAKE_VALID_STRUCTURE);
  GEOSMakeValidParams_setKeepCollapsed_r(geos.handle, params, 0);
  Geom valid = own(geos, GEOSMakeValidWithParams_r(geos.handle, polygon, params));
  GEOSMakeValidParams_destroy_r(geos.handle, params);
  return valid;
}

// A footprint as one geometry, its polygons united.
Geom united(const Geos& geos, const std::vector<const std::vector<Rings>*>& footprints) {
  std::vector<Geom> parts;
  for (const auto* polygons : footprints) {
    for (const Rings& rings : *polygons) parts.push_back(with_holes(geos, rings));
  }
  if (parts.size() == 1) return std::move(parts[0]);
  const Geom all = collection(geos, GEOS_GEOMETRYCOLLECTION, std::move(parts));
  return own(geos, GEOSUnaryUnion_r(geos.handle, all.get()));
}

double shared_area(const Geos& geos, const Geom& a, const Geom& b) {
  if (!a || !b) return 0;
  const Geom both = own(geos, GEOSIntersection_r(geos.handle, a.get(), b.get()));
  return both ? area(geos, both.get()) : 0;
}

}  // namespace

CleanPolygons clean_polygons(const std::vector<Rings>& polygons) {
  const Geos geos;
  CleanPolygons out;
  for (const Rings& rings : polygons) {
    Rings usable;
    for (std::size_t k = 0; k < rings.size(); ++k) {
      if (has_three_distinct(rings[k])) {
        usable.push_back(rings[k]);
      } else {
        ++out.without_area;
        if (k == 0) break;
      }
    }
    if (usable.empty()) continue;
    Geom polygon = with_holes(geos, usable);
    if (GEOSisValid_r(geos.handle, polygon.get()) != 1) {
      char* const reason = GEOSisValidReason_r(geos.handle, polygon.get());
      out.repaired = reason ? reason : "invalid";
      GEOSFree_r(geos.handle, reason);
      polygon = made_valid(geos, polygon.get());
    }
    const std::size_t before = out.polygons.size();
    if (polygon) {
      for_each_polygon(geos, polygon.get(),
                       [&](const GEOSGeometry* p) { out.polygons.push_back(oriented(geos, p)); });
    }
    if (out.polygons.size() == before) ++out.without_area;
  }
  return out;
}

std::vector<std::size_t> outlines_of_parts(const std::vector<const std::vector<Rings>*>& parts,
                                           const std::vector<const std::vector<Rings>*>& outlines) {
  const Geos geos;
  std::vector<std::size_t> result(parts.size(), kNoOutline);
  if (parts.empty() || outlines.empty()) return result;

  std::vector<Geom> shapes;
  for (const auto* outline : outlines) shapes.push_back(united(geos, {outline}));
  constexpr std::size_t kNodeCapacity = 10;  // GEOS' own default
  const auto destroy = [&](GEOSSTRtree* t) { GEOSSTRtree_destroy_r(geos.handle, t); };
  const std::unique_ptr<GEOSSTRtree, decltype(destroy)> tree(
      GEOSSTRtree_create_r(geos.handle, kNodeCapacity), destroy);
  std::vector<std::size_t> indices(shapes.size());
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    indices[k] = k;
    if (shapes[k]) GEOSSTRtree_insert_r(geos.handle, tree.get(), shapes[k].get(), &indices[k]);
  }
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Geom part = united(geos, {parts[k]});
    if (!part) continue;
    std::vector<std::size_t> near;
    GEOSSTRtree_query_r(
        geos.handle, tree.get(), part.get(),
        [](void* item, void* found) {
          static_cast<std::vector<std::size_t>*>(found)->push_back(
              *static_cast<std::size_t*>(item));
        },
        &near);
    std::sort(near.begin(), near.end());  // the same choice whatever the tree's order
    double most = area(geos, part.get()) / 2;
    for (const std::size_t outline : near) {
      const double inside = shared_area(geos, part, shapes[outline]);
      if (inside > most) result[k] = outline, most = inside;
    }
  }
  return result;
}

double covered_share(const std::vector<Rings>& outline,
                     const std::vector<const std::vector<Rings>*>& parts) {
  const Geos geos;
  const Geom whole = united(geos, {&outline});
  const double all = whole ? area(geos, whole.get()) : 0;
  return all > 0 ? shared_area(geos, whole, united(geos, parts)) / all : 0;
}

}  // namespace gnomon
