// Coordinate reference systems through PROJ: where a scene stands on Earth, and where true north
// lies in its grid.
#pragma once

#include <string>
#include <vector>

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

// For people: short_crs(), or of WKT the name that it gives the CRS, in quotes.
std::string crs_in_words(const std::string& crs);

// True for a CRS whose coordinates are longitude and latitude in degrees. False where it is
// unknown.
bool is_geographic_crs(const std::string& crs);

// The UTM zone (WGS 84) of a place: "EPSG:32633"; beyond 84 N and 80 S, UPS ("EPSG:32661",
// "EPSG:32761").
std::string utm_crs(const Place& place);

// Points of one CRS in another, axis order east, north (longitude, latitude in degrees for a
// geographic one). Heights do not take part. The most accurate operation that PROJ has for the
// first point, without network grids, is used for all. Errors: unknown CRS, no way between them, a
// point outside of their reach (names it).
Result<std::vector<Vec2>> reproject(const std::string& from, const std::string& to,
                                    std::vector<Vec2> points);

}  // namespace gnomon
