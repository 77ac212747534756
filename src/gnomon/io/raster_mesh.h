// Heights on a grid -> triangles. See docs/surface-models.md.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/core/vec.h>

namespace gnomon {

// Cells in rows and columns as in a RasterGrid, row-major.
struct RasterCells {
  int columns = 0, rows = 0;
  std::vector<double> top;   // NaN: there is no cell
  std::vector<double> base;  // how far a wall goes down where there is no neighbour; not
                             // above the tops of the 3 x 3 cells around.
                             // Empty: there are no walls at the border
};

// All triangles look up or, walls, away from the higher cell.
struct RasterTriangles {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> corners;  // three a triangle, indices into vertices
};

// Asked once, before memory is taken for the triangles; may refuse.
using SizeCheck = std::function<std::optional<Error>(std::uint64_t triangles)>;

// `corners`: where the corners of the cells lie, (columns + 1) x (rows + 1), row-major; `centres`:
// where their middles lie, columns x rows. Any grid whose cells are convex and wound alike:
// rotated, mirrored, reprojected. Errors: those of `check`; more than 2^32 vertices or corners.

// Each cell a level square (two triangles), upright walls between cells of different heights. The
// walls have vertices wherever another wall or cell touches them, so that the surface is closed but
// for its border (closed down to the bases, where there are bases).
Result<RasterTriangles> mesh_level_cells(const RasterCells& cells, const std::vector<Vec2>& corners,
                                         const SizeCheck& check);

// Each cell four triangles around its middle, which has the cell's height; corners have the mean
// height of the (up to four) cells around them. So the tops hang together, and cover the same area
// as level cells; walls are only at the border.
Result<RasterTriangles> mesh_sloped_cells(const RasterCells& cells,
                                          const std::vector<Vec2>& corners,
                                          const std::vector<Vec2>& centres, const SizeCheck& check);

// Vertices at the middles of cells, two triangles between four of them (split between those two
// that differ less in height; where they differ alike, between the first and the last), one where
// one of the four is missing. Bases are not looked at. `unused`: cells that got no triangle.
Result<RasterTriangles> mesh_centres(const RasterCells& cells, const std::vector<Vec2>& centres,
                                     const SizeCheck& check, std::uint64_t& unused);

}  // namespace gnomon
