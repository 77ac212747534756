// On which side of each triangle the light is: computed once per triangle, read everywhere.
#pragma once

#include <cstdint>
#include <vector>

#include <gnomon/core/exact.h>
#include <gnomon/core/vec.h>
#include <gnomon/mesh/tri_mesh.h>

namespace gnomon {

// Per triangle (A,B,C): +1 or -1, the exact sign of |A; B; C; light| under the tie rule; -1 for one
// without area, as vertices that move may leave.
// Preconditions: coordinates and light components snapped (snapped(), exact.h).
std::vector<std::int8_t> light_sides(const TriMesh& mesh, const Light& light,
                                     ExactStats* stats = nullptr);

}  // namespace gnomon
