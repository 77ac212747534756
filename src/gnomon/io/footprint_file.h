// Polygons with attributes out of files that GDAL reads, as they stand there.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/core/vec.h>
#include <gnomon/core/warnings.h>

namespace gnomon {

using Rings = std::vector<std::vector<Vec2>>;  // the outer one first; none closed

struct FootprintFeature {
  std::size_t number = 0;                                       // in the layer, from 1
  std::string id;                                               // empty where the file has none
  std::vector<std::pair<std::string, std::string>> attributes;  // wanted ones; names in lower case
  std::vector<Rings> polygons;  // east, north or longitude, latitude
  bool has_geometry = false;
  bool has_other_geometry = false;  // points, lines, ...
  bool has_heights = false;         // z in its coordinates
};

struct FootprintFile {
  std::string format;  // "GeoJSON", "GeoPackage", "Shapefile", ...
  std::string layer;
  bool several_layers = false;
  std::string crs;                      // empty: the file names none
  double metres_per_unit = 1;           // where crs is empty but the file knows its unit
  std::vector<std::string> attributes;  // all that the layer has, as the file writes them
  std::vector<FootprintFeature> features;
  Warnings warnings;
};

// The CRS that a file names itself for the layer (as for read_footprint_file), as
// FootprintFile::crs has it; features are not read, but GDAL parses a GeoJSON file whole to open
// it. Errors: as read_footprint_file.
Result<std::string> crs_of_footprint_file(const std::filesystem::path& path,
                                          const std::string& layer);

// Reads a layer. `wanted`: names of attributes to keep, in lower case. Attributes named tags,
// other_tags or all_tags are taken apart (osm_tags.h); an attribute of the feature itself goes
// before a tag of the same name. Curves become lines (4 degrees a step). Never opens anything but
// the file and its companions (.shx, .dbf, .prj, ...), and writes nothing. Errors: not a file; not
// read by any of the drivers; damaged; see read_footprints().
Result<FootprintFile> read_footprint_file(const std::filesystem::path& path,
                                          const std::string& layer,
                                          const std::vector<std::string>& wanted);

// "a, b, c"; after `most` of them ", ... (12 more)".
std::string listed(const std::vector<std::string>& names, std::size_t most = 40);

}  // namespace gnomon
