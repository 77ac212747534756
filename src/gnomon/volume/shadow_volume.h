// The shadow volume of a caster set: sides and caps as homogeneous weighted polygons. Everitt and
// Kilgard 2002, section 3.2; weights after Kim et al. 2007.
//
// Notation: A, B vertices, L the light. In oriented homogeneous coordinates the prism behind
// triangle t is the simplex (A, B, C, -L): its side over the edge AB is the triangle (A, B, -L), of
// which only the part with w > 0 is in space (everything behind AB as seen from the light). No
// clipping and no point at infinity is needed: a segment between two points of space crosses the
// side exactly if it crosses that triangle.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <gnomon/core/vec.h>
#include <gnomon/mesh/tri_mesh.h>
#include <gnomon/silhouette/silhouette.h>

namespace gnomon {

// A polygon of the volume's surface. Crossing it along a segment from x to y changes the count by
//   weight * sign |v0; v1; v2; x|.
struct VolumePolygon {
  std::array<Vec4, 4> vertices;  // homogeneous, w >= 0; `size` of them
  int size = 0;                  // 3 or 4
  std::int32_t weight = 0;
};

struct VolumePolygons {
  std::vector<VolumePolygon>
      sides;  // A, B, (B - L), (A - L); a triangle A, B, -L for a directional light
  std::vector<VolumePolygon> light_cap;  // the casters themselves
  std::vector<VolumePolygon>
      dark_cap;  // the casters projected to infinity; empty for a directional light
};

// `casters` empty: all triangles. Preconditions: sides and silhouette belong to this mesh, caster
// set and light.
VolumePolygons build_volume(const TriMesh& mesh, const std::vector<std::uint8_t>& casters,
                            const std::vector<std::int8_t>& sides, const Silhouette& silhouette,
                            const Light& light);

}  // namespace gnomon
