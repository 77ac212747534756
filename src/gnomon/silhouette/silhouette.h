// The silhouette of any triangle soup: the edges whose multiplicity is not zero.
// Based on: Kim et al., Shadow volumes of arbitrary polygon soups, 2007; TECHNIQUES section 1.
// Brute force over all edges is the specification ("Geometry of shadows in real time", section 4).
#pragma once

#include <cstdint>
#include <vector>

#include <gnomon/mesh/edge_table.h>

namespace gnomon {

// Edge (a,b), a < b, with the sum over its incident triangles of (light side) x (+1 where the
// triangle runs a -> b, else -1). 0 inside lit or unlit regions of a consistently wound surface,
// +-2 on its contour, +-1 on a border.
struct SilhouetteEdge {
  std::uint32_t a, b;  // vertices of the mesh
  std::int32_t multiplicity;
};

using Silhouette = std::vector<SilhouetteEdge>;  // ordered as in the EdgeTable

// `sides`: light_sides() of the mesh that `edges` was built from.
Silhouette find_silhouette(const EdgeTable& edges, const std::vector<std::int8_t>& sides);

// Brings edges that were found in another order to that of the EdgeTable, in time linear in them:
// neighbours on the mesh are neighbours in what is made of them. `scratch` is overwritten.
// Precondition: no edge comes twice.
void sort_as_table(Silhouette& silhouette, Silhouette& scratch);

}  // namespace gnomon
