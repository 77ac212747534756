// A raster of heights in memory, and how it is read from a file through GDAL.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/core/vec.h>
#include <gnomon/core/warnings.h>

namespace gnomon {

// Cell (column i, row j), row-major, covers the parallelogram between the corners (i, j) and
// (i + 1, j + 1). With t = transform, as GDAL has it, corner (i, j) lies at
//   x = t[0] + i t[1] + j t[2],  y = t[3] + i t[4] + j t[5];
// most rasters have t[2] = t[4] = 0 and t[5] < 0: row 0 in the north.
struct RasterGrid {
  int columns = 0, rows = 0;
  std::array<double, 6> transform{0, 1, 0, 0, 0, 1};
  std::vector<double> z;  // metres; NaN: no data
  std::string crs;        // horizontal part, "EPSG:25830" or WKT; empty: the file names none
  std::string format;     // what a report calls the file's format: "GeoTIFF", "Arc/Info ASCII Grid"
};

inline Vec2 place_of(const RasterGrid& g, double i, double j) {
  const auto& t = g.transform;
  return {t[0] + i * t[1] + j * t[2], t[3] + i * t[4] + j * t[5]};
}

// True for the files that read_raster_grid takes: by content GeoTIFF (also COG and BigTIFF), Arc
// ASCII grid, Erdas Imagine, DTED, Surfer grid; or by the extension of any of these, of SRTM
// (.hgt), USGS (.dem) and ESRI (.bil, .flt). True for .vrt too, so that a user is told why it is
// refused. `first_bytes`: the file's beginning, 32 bytes or more if it has them.
bool is_raster_file(const std::filesystem::path& path, std::string_view first_bytes);

// The CRS that a file names itself, as RasterGrid::crs has it; its cells are not read. Errors: not
// a raster or one of a kind that is not read, a VRT.
Result<std::string> crs_of_raster_file(const std::filesystem::path& path);

// Reads the first band of a file on disk. fallback_crs: what its coordinates are in
// where it names no CRS (may be empty); it becomes grid.crs. `check` is given the grid without its
// values, before they are read; it may refuse. Values get the band's scale and offset and
// become metres by the unit of the band or of the vertical CRS (feet of either kind);
// pixel-is-point is heeded. What the file masks (nodata, mask, alpha) and what is NaN has no data.
// Warnings: a unit that is not understood, or not named where the CRS is in feet; bands not read.
// Errors: not a raster or one of a kind that is not read, a VRT; complex numbers; a
// picture; no georeference; cells of no area; what GDAL reports (a truncated file); a value beyond
// kHighestHeight, which names the cell. Nothing is printed, nothing fetched from a network.
Result<RasterGrid> read_raster_grid(
    const std::filesystem::path& path, const std::string& fallback_crs,
    const std::function<std::optional<Error>(const RasterGrid&)>& check, Warnings& warnings);

// No surface on Earth is higher or deeper (metres): such a value is a nodata value that the file
// does not declare, or something else than heights.
inline constexpr double kHighestHeight = 1e5;

}  // namespace gnomon
