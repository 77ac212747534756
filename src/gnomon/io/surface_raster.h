// Surface models: rasters of heights (GeoTIFF and others) as meshes. See docs/surface-models.md.
#pragma once

#include <filesystem>
#include <string>

#include <gnomon/core/result.h>
#include <gnomon/io/model.h>
#include <gnomon/io/raster_grid.h>

namespace gnomon {

enum class RasterMesh {
  cells,     // each cell a level square, upright walls between: what raster shadow casters mean
  triangles  // sloped: vertices at the middles of cells
};

struct RasterOptions {
  RasterMesh mesh = RasterMesh::triangles;
  // Values are heights above the ground (buildings, canopy): a cell above 0 becomes a block from
  // the ground up, with walls down to the lowest ground in the 3 x 3 cells around it; other cells
  // are nothing. Sloped blocks cover the same cells as level ones.
  bool above_ground = false;
};

// The surface as a Model with one Surface: object is the file's name without extension, group
// "TINRelief" (it is the terrain, so no ground is made), or "HeightAboveGround". Coordinates are
// those of the target CRS, report.crs: target_crs; where that is empty the file's own CRS if it is
// projected in metres, else the UTM zone of its middle. A raster in another CRS has its cells'
// corners and middles moved one by one, never its values resampled. fallback_crs: of a file that
// names none; where that is empty too, its coordinates are taken as they are, report.crs is empty.
// Heights keep their vertical datum. `ground` is asked (target CRS) only for above_ground, where it
// may be empty: then, as where it knows nothing, the lowest ground known around the cell serves,
// else 0, with a warning. Warnings: cells without data; cells that got no triangle; those of
// read_raster_grid. Errors: those of read_raster_grid and reproject; no surface at all; a mesh that
// needs more memory than the machine has.
Result<Model> read_surface_raster(const std::filesystem::path& path, const RasterOptions& options,
                                  const std::string& target_crs, const std::string& fallback_crs,
                                  const GroundAt& ground);

// The same for a grid in memory. `name` stands for the
// path.
Result<Model> surface_of_grid(RasterGrid grid, const std::string& name,
                              const RasterOptions& options, const std::string& target_crs,
                              const std::string& fallback_crs, const GroundAt& ground);

}  // namespace gnomon
