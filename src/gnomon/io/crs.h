// Coordinate reference systems through PROJ: where a scene stands on Earth, and where true north
// lies in its grid.
#pragma once

#include <string>

#include <gnomon/core/place.h>
#include <gnomon/core/result.h>
#include <gnomon/core/vec.h>

namespace gnomon {

struct CrsPlace {
  Place place;             // of the point given, WGS 84
  double true_north;       // radians clockwise from the grid's +y to true north (minus the meridian
                           // convergence)
  double metres_per_unit;  // of the horizontal axes; 1 for metres
  std::string name;        // "MGI / Austria GK East"
};

// `crs`: anything PROJ reads ("EPSG:31256", an OGC URN/URL, WKT); a compound CRS uses its
// horizontal part. `p` in that CRS, axis order east, north (as GIS files have it). Errors: unknown
// CRS, geographic (degrees: not supported as scene coordinates, says what to do), point outside the
// CRS's reach.
Result<CrsPlace> locate(const std::string& crs, const Vec3& p);

// "https://www.opengis.net/def/crs/EPSG/0/7415", "urn:ogc:def:crs:EPSG::7415", "epsg:7415" ->
// "EPSG:7415"; else unchanged.
std::string short_crs(const std::string& crs);

}  // namespace gnomon
