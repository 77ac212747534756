// light_sides() for light after light over one mesh, suns and lamps alike: the planes of its
// triangles once, in float, then a dot product a triangle. What float cannot tell is decided as
// light_sides() decides it; the results are the same.
#pragma once

#include <cstdint>
#include <vector>

#include <gnomon/core/exact.h>
#include <gnomon/core/vec.h>
#include <gnomon/mesh/tri_mesh.h>

namespace gnomon {

// Per triangle (A,B,C) the dual point of its plane (certified_plane.h): s (-n, n.(A - centre)) with
// n = (B-A) x (C-A) and a positive s that makes n's largest component 1. All zero where double does
// not know it: needles some 10^7 times as long as wide. 16 bytes a triangle.
struct LightPlanes {
  Vec3 centre{0, 0, 0};
  double largest_w = 0;           // of all |w|, and of all |vertex - centre| along an axis
  std::vector<float> x, y, z, w;  // zeros follow up to a whole number of vectors
};

LightPlanes light_planes(const TriMesh& mesh, int threads);

// `sides` becomes light_sides(mesh, light). Preconditions: planes are the mesh's; coordinates and
// light components snapped.
void sides_from_planes(std::vector<std::int8_t>& sides, const TriMesh& mesh,
                       const LightPlanes& planes, const Light& light, int threads,
                       ExactStats* stats = nullptr);

}  // namespace gnomon
