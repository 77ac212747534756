// Triangles over shared vertices: any soup is allowed (open, non-manifold, mis-wound,
// self-intersecting).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <gnomon/core/vec.h>

namespace gnomon {

using Triangle = std::array<std::uint32_t, 3>;  // indices into positions

struct TriMesh {
  std::vector<Vec3> positions;  // metres, scene coordinates (origin subtracted)
  std::vector<Triangle> triangles;
};

}  // namespace gnomon
