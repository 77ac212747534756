// Vertices with exactly equal coordinates become one; triangles of zero area go.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <gnomon/mesh/tri_mesh.h>

namespace gnomon {

struct WeldReport {
  std::size_t merged_vertices = 0;      // vertices that were equal to an earlier one, or unused
  std::size_t zero_area_triangles = 0;  // dropped; decided exactly
  std::size_t first_zero_area = 0;  // index before welding of the first dropped triangle (if any)
  std::size_t snapped_coordinates = 0;  // |c| < kSmallestCoordinate, stored as 0 (see core/exact.h)
};

// Welds in place. `per_triangle` (one entry per triangle) loses the entries of the dropped
// triangles, order is kept. Preconditions: indices are in range, coordinates finite and |c| <=
// kLargestCoordinate (io checks and reports them).
WeldReport weld(TriMesh& mesh, std::vector<std::uint32_t>& per_triangle);

struct Coincident {
  std::size_t triangles = 0;  // that have the same three vertices as an earlier one, in any order
  std::size_t first = 0;      // index of the first of them (if any)
};

// Triangles of a welded mesh that lie exactly on others. All of them stay: each casts, and none
// shades another one's samples.
Coincident find_coincident(const TriMesh& mesh);

}  // namespace gnomon
