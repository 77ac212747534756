// light_sides() for many suns over one mesh: its normals once, in float, then a dot product a
// triangle. What float cannot tell is decided as light_sides() decides it; the results are the
// same.
#pragma once

#include <cstdint>
#include <vector>

#include <gnomon/core/exact.h>
#include <gnomon/core/vec.h>
#include <gnomon/mesh/tri_mesh.h>

namespace gnomon {

// Normals (B-A) x (C-A) of a mesh's triangles, each times a positive number that makes its largest
// component about 1.
struct SunPlanes {
  std::vector<float> x, y, z;
  std::vector<float> error;  // of each component, beyond rounding to float; infinity: not known
};

// Precondition: welded mesh (no triangle of zero area).
SunPlanes sun_planes(const TriMesh& mesh, int threads);

// The same as light_sides(mesh, light). Preconditions: planes are the mesh's; light.w = 0; light
// components snapped.
void sun_sides(std::vector<std::int8_t>& sides, const TriMesh& mesh, const SunPlanes& planes,
               const Light& light, ExactStats* stats = nullptr);

}  // namespace gnomon
