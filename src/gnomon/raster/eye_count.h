// C(e): the casters between the eye and a light. DEFINITIONS "The prism and the count".
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <gnomon/core/exact.h>
#include <gnomon/core/vec.h>
#include <gnomon/mesh/tri_mesh.h>
#include <gnomon/view/view.h>

namespace gnomon {

// Boxes of runs of triangles as they follow each other in the mesh, where neighbours mostly are
// neighbours in space. Of a mesh in random order boxes are large, and all triangles are looked at.
inline constexpr std::size_t kBoxRun = 32;  // triangles a box: less than a byte a triangle
struct RunBox {
  std::array<float, 3> lo, hi;  // not smaller than the box in double; run without casters: lo > hi
};
struct RunBoxes {
  std::vector<RunBox> boxes;
  Vec3 largest{0, 0, 0};  // bounds of the boxes' coordinates' magnitudes
};

// `selected`: per triangle 1 if it casts; empty: all cast.
RunBoxes run_boxes(const TriMesh& mesh, const std::vector<std::uint8_t>& selected);

// How many of the casters cross the segment from the eye to the light (between_eye_and_light(),
// exactly); of an eye or a light at infinity, the ray that goes there; between two at infinity
// none. Precondition: `boxes` are the mesh's and the selection's; eye and light are snapped.
std::int32_t count_between_eye_and_light(const TriMesh& mesh,
                                         const std::vector<std::uint8_t>& selected,
                                         const RunBoxes& boxes, const View& view,
                                         const Light& light, int threads, ExactStats& stats);

}  // namespace gnomon
