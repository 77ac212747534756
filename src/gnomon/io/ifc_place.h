// Where an IFC file stands on Earth: what Assimp does not read.
// What Assimp 5.2.5 does by itself, so that nothing happens twice (checked in ifc_place_test.cpp):
// - it gives y up: (x, y, z) of the file come as (x, z, -y), as rotation of the root node;
// - it applies the prefix of an SI length unit (millimetres come as metres), but *not* a
//   conversion-based one: feet and inches come as if they were metres. See assimp_metres_per_unit;
// - it applies IfcGeometricRepresentationContext.WorldCoordinateSystem;
// - it ignores TrueNorth, IfcSite's latitude, longitude and elevation, and map conversions;
// - it has single precision: of map coordinates in placements, decimetres are left.
// Based on: buildingSMART, IFC2x3 TC1 and IFC4 ADD2 TC1, IfcRepresentationResource;
// buildingSMART Australasia, User Guide for Geo-referencing in IFC, 2020 (property sets of IFC2x3).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <gnomon/core/place.h>
#include <gnomon/core/result.h>
#include <gnomon/core/warnings.h>
#include <gnomon/io/model.h>

namespace gnomon {

// Local metres -> map: east = eastings + scale * (x * x_axis_abscissa - y * x_axis_ordinate),
// north = northings + scale * (x * x_axis_ordinate + y * x_axis_abscissa), up = height + scale * z.
struct IfcMapConversion {
  double eastings = 0, northings = 0, height = 0;   // metres
  double x_axis_abscissa = 1, x_axis_ordinate = 0;  // a unit vector
  double scale = 1;                                 // map metres per metre, near 1
  std::string crs = {};  // as PROJ reads it: "EPSG:25832"; empty where PROJ does not know it
};

struct IfcPlace {
  std::string schema;                 // "IFC2X3", "IFC4"
  double metres_per_unit = 1;         // of the project's length unit
  double assimp_metres_per_unit = 1;  // what Assimp's coordinates are still to be multiplied by
  // Radians clockwise from +y to true north, in the coordinates that Assimp gives (z up), which
  // means after WorldCoordinateSystem; from TrueNorth of the project's 'Model' context.
  std::optional<double> true_north = {};
  std::optional<Place> site = {};  // IfcSite's reference point, taken for the local origin
  // IfcMapConversion and IfcProjectedCRS; else the property sets ePSet_MapConversion and
  // ePSet_ProjectedCRS, which IFC2x3 files have in their place.
  std::optional<IfcMapConversion> conversion = {};
  // Parts that cannot be read; two places that do not agree; units that are not as IFC says.
  Warnings warnings = {};
};

// Call it before Assimp reads the file: it returns the error of check_ifc (ifc_check.h) where
// Assimp would crash. Errors else: those of read_step. What is missing or cannot be read is left
// empty, the latter with a warning.
Result<IfcPlace> read_ifc_place(std::string_view text, const std::string& path);

// Places a model as Assimp gave it, turned z up: multiplies it by assimp_metres_per_unit, so its
// reader must not. With a conversion, its vertices become coordinates of the map and report.crs is
// set; TrueNorth and the site are not used, since the conversion has them in it (as IFC 4.3 asks:
// never turned twice). Where the conversion's CRS is not known (empty), the vertices become
// coordinates of the map and model.site and model.north are set, too. Without a conversion, only
// model.site and model.north are set. Appends the warnings to the model's. Call it once.
void place_ifc(Model& model, const IfcPlace& place);

}  // namespace gnomon
