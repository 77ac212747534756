// outlines.geojson, outlines.gpkg: the shadows of a plan as polygons.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/core/vec.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/scene/scene.h>
#include <gnomon/view/shadow_mask.h>
#include <gnomon/view/view.h>

namespace gnomon {

// Samples in shadow that are neighbours (side by side, not corner to corner), as one polygon along
// their pixels' edges.
struct Outline {
  // Closed (first == last); [0] is the outer ring, counter-clockwise in the map, the others are
  // holes, clockwise. In metres of the model's CRS (scene coordinates + frame.origin).
  std::vector<std::vector<Vec2>> rings;
  std::uint64_t samples = 0;  // pixels that it covers
};

// Based on: GDALPolygonize, 4-connected. Polygons are valid, do not overlap and cover the samples
// in shadow exactly: their samples add up to the mask's. In the order in which GDAL finds them,
// which is the same for the same mask. Preconditions: is_plan(view) (write_geotiff.h); mask and
// view have the same size > 0. Errors: GDAL's, such as out of memory.
Result<std::vector<Outline>> shadow_outlines(const ShadowMask& mask, const View& view,
                                             const Frame& frame);

// A column of the table that goes with the polygons: the same value for all; empty text: null.
using OutlineProperty = std::pair<std::string, std::variant<double, std::string>>;

enum class OutlineFormat { geojson, geopackage };

// One feature for each outline, in order, with area_m2 (samples x pixel_area) and `properties`.
// Layer `shadows`. GeoJSON has the scene's CRS (its horizontal part) in a "crs" member (GeoJSON
// 2008; RFC 7946 knows longitude and latitude only) where the CRS has an authority's code.
// GeoPackage carries any CRS, and the time of writing. Errors: as write_text_file; a CRS that PROJ
// does not know; anything that GDAL reports, in its words.
Result<FileWritten> write_outlines(const std::filesystem::path& path, OutlineFormat format,
                                   const std::vector<Outline>& outlines, double pixel_area,
                                   const View& view, const Frame& frame,
                                   const std::vector<OutlineProperty>& properties);

}  // namespace gnomon
