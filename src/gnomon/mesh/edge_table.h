// Every undirected edge once, with all its incident triangles, any number of them.
// Kim, Kim, Baek, Yoon: Shadow volumes of arbitrary polygon soups (2007); TECHNIQUES section 1.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <gnomon/mesh/tri_mesh.h>

namespace gnomon {

struct EdgeTable {
  std::vector<std::array<std::uint32_t, 2>> vertices;  // per edge: a < b, ordered by (a, b)
  std::vector<std::uint32_t>
      first;  // CSR: incidences of edge k are incidence[first[k] .. first[k+1])
  std::vector<std::uint32_t>
      incidence;  // (triangle << 1) | backward; backward: the triangle runs from b to a
};

// Precondition: the mesh is welded (so equal positions have equal indices), at most 2^31-1
// triangles. `selected` empty means all triangles, else one flag per triangle (e.g. only those that
// cast).
EdgeTable build_edge_table(const TriMesh& mesh, const std::vector<std::uint8_t>& selected = {});

}  // namespace gnomon
