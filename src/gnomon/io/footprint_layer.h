// Building footprints with heights -> solids: a roof, a floor and a wall for each edge. See
// docs/footprints.md for what is read from which attribute.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <gnomon/core/result.h>
#include <gnomon/io/model.h>

namespace gnomon {

struct FootprintOptions {
  std::string layer;   // empty: the only one with polygons; where there are several, an error
  std::string height;  // attribute with metres above the ground; empty: the usual names
  std::string floors;  // attribute with the number of storeys, where there is no height; empty: the
                       // usual names
  double floor_height = 3.0;  // metres per storey
  std::string base;           // attribute with the footprint's absolute height, metres; empty: the
                              // usual names, else the ground
};

// True for GeoJSON (by its content, also in *.json), GeoJSON text sequences, GeoPackage, Shapefile,
// FlatGeobuf, GML and KML; false for CityJSON and CityGML. `first_bytes`: the beginning of the
// file, some kB; may be empty, then the extension alone decides. Does not open the file.
bool is_footprint_file(const std::filesystem::path& path, std::string_view first_bytes);

// Names as in attributes, in the order in which they are tried, for help texts and messages.
std::string usual_height_attributes();
std::string usual_floor_attributes();
std::string usual_base_attributes();

// The Model's vertices are metres in report.crs (scale 1, translate 0), z up.
// target_crs: the scene's CRS; empty: the file's own where it is projected, in metres and true to
// scale, else the UTM zone of the middle of its footprints. fallback_crs: of files that name none;
// where that is empty too, the coordinates are local metres and report.crs is empty (or
// target_crs). ground: may be empty. It is asked in target_crs, or report.crs where that is empty.
// Objects are named by the feature's id, group "Building", semantic "RoofSurface", "WallSurface" or
// "GroundSurface"; building parts "outline's id/part's id", group "BuildingPart"; what starts above
// the ground has "OuterCeilingSurface" for its floor, and alone it is a "BuildingInstallation", so
// that the made ground does not rise to it. Each solid is closed and wound outwards.
// Errors: unreadable or damaged file; no or several polygon layers; a named attribute that is not
// there; no feature with a height; coordinates that do not fit their CRS; degrees without a CRS; a
// floor_height that is not positive.
Result<Model> read_footprints(const std::filesystem::path& path, const FootprintOptions& options,
                              const std::string& target_crs, const std::string& fallback_crs,
                              const GroundAt& ground);

}  // namespace gnomon
