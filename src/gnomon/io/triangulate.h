// Polygons with holes in space -> triangles, through GEOS' constrained Delaunay triangulation.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <gnomon/core/vec.h>

namespace gnomon {

// rings[0] is the outer ring, the others are holes; entries are indices into `positions`; not closed (first != last; a repeated last
// is tolerated). The polygon is projected along the largest component of its Newell normal. Triangles use only the given
// vertices and keep the polygon's winding. A polygon that is not simple (self-touching, crossing, zero area ring) is
// triangulated as a fan of its outer ring and `problem` says why (empty if all is well); rings of fewer than 3 distinct vertices
// give no triangles and a problem.
struct Triangulation {
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into positions
  std::string problem;
};
Triangulation triangulate(const std::vector<Vec3>& positions, const std::vector<std::vector<std::uint32_t>>& rings);

}  // namespace gnomon
