// GEOS geometries with an owner, for the sources of this room only: no other room sees a type of
// GEOS.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <geos_c.h>

#include <gnomon/core/vec.h>

namespace gnomon {

struct Geos {
  GEOSContextHandle_t handle = GEOS_init_r();
  std::string message;  // the last thing GEOS complained of
  Geos() {
    GEOSContext_setErrorMessageHandler_r(
        handle, [](const char* text, void* self) { static_cast<Geos*>(self)->message = text; },
        this);
  }
  ~Geos() { GEOS_finish_r(handle); }
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;
};

struct GeomDeleter {
  GEOSContextHandle_t handle;
  void operator()(GEOSGeometry* g) const { GEOSGeom_destroy_r(handle, g); }
};
using Geom = std::unique_ptr<GEOSGeometry, GeomDeleter>;

Geom own(const Geos& geos, GEOSGeometry* g);

Geom line(const Geos& geos, const std::vector<Vec2>& points, bool ring);

// `ring` is closed: the first point repeated at the end.
Geom polygon(const Geos& geos, const std::vector<Vec2>& ring);

Geom collection(const Geos& geos, int type, std::vector<Geom>&& parts);

std::vector<Vec2> points_of(const Geos& geos, const GEOSGeometry* line_or_ring);

void for_each_polygon(const Geos& geos, const GEOSGeometry* g,
                      const std::function<void(const GEOSGeometry*)>& visit);

// Calls visit(ring) for the outer ring and the holes, each with the polygon's inside on its left.
void for_each_ring(const Geos& geos, const GEOSGeometry* poly,
                   const std::function<void(const std::vector<Vec2>&)>& visit);

double area(const Geos& geos, const GEOSGeometry* g);

}  // namespace gnomon
