// Polygons with holes in space -> triangles, through GEOS' constrained Delaunay triangulation.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <gnomon/core/vec.h>

namespace gnomon {

struct Triangulation {
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into positions
  std::string problem;                                  // empty if all is well
};

// rings[0] is the outer ring, the others are holes (wound either way); entries are indices into
// `positions`; not closed (first != last; a repeated last is tolerated, so are repeated corners).
// The polygon is projected along the largest component of its Newell normal. Triangles use only the
// given vertices and keep the polygon's winding; they cover the projected polygon exactly once,
// which is checked exactly. Rings that touch themselves, as slits to a hole do, are fine. Where
// such a cover cannot be had `problem` says why: holes that cross or touch too much are left out, a
// ring that crosses itself or has no area becomes a fan of its corners. An outer ring of fewer than
// 3 distinct vertices, or one that goes back on all its own edges, gives no triangles and a
// problem; such a hole is left out, with a problem. Three corners without holes are one triangle,
// whatever its area. Preconditions: indices in range; coordinates finite, at most
// kLargestCoordinate (core/exact.h).
Triangulation triangulate(const std::vector<Vec3>& positions,
                          const std::vector<std::vector<std::uint32_t>>& rings);

}  // namespace gnomon
