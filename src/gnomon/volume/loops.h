// Silhouettes as closed loops: the form in which sides are sent as strips (point light) or fans
// (directional light). Everitt and Kilgard 2002, section 3.4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <gnomon/silhouette/silhouette.h>

namespace gnomon {

// Loop k runs through vertices[first[k]], ..., vertices[first[k+1]-1] and back to the first. No
// vertex comes twice in one loop; a loop has at least three.
struct Loops {
  std::vector<std::uint32_t> vertices;  // of the mesh
  std::vector<std::uint32_t> first{0};  // CSR

  std::size_t size() const { return first.size() - 1; }
  std::span<const std::uint32_t> loop(std::size_t k) const {
    return std::span(vertices).subspan(first[k], first[k + 1] - first[k]);
  }
};

// Memory that calls can share, so that a call costs time by its silhouette, not by the mesh.
struct LoopScratch {
  std::vector<std::uint32_t> slot_of;  // per vertex of the mesh; kept at "none" between calls
};

// Every edge (a, b) of multiplicity m becomes |m| directed edges, a -> b if m > 0, b -> a if m < 0,
// each in exactly one loop: so the loops' edges add up to the silhouette, and the side over each
// directed edge p -> q counts as an edge (p, q) of multiplicity +1.
//
// Deterministic: the walk starts at the silhouette's vertices in the order in which its edges name
// them, takes edges in the silhouette's order, and cuts a loop off as soon as it meets itself.
// Linear in the sum of |m|. Precondition: multiplicities balance at every vertex, as those of
// find_silhouette() and of LitRegions do (asserted); no edge comes twice.
Loops find_loops(std::span<const SilhouetteEdge> silhouette, LoopScratch* scratch = nullptr);

}  // namespace gnomon
