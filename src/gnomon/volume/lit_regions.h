// The connected lit regions of a caster set. Each has one indivisible cap and its own silhouette,
// and so a volume of its own, closed by itself: it may be counted with z-pass or with z-fail
// whatever the others do (single loops of it may not, the cap closes all of them at once). After
// Everitt and Kilgard 2002, section 3.4; docs/volumes.md.
//
// Made per light and frame: linear in triangles and edges, a fixed number of allocations.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <gnomon/mesh/edge_table.h>
#include <gnomon/silhouette/silhouette.h>

namespace gnomon {

inline constexpr std::uint32_t kNoRegion = 0xffffffffu;

struct LitRegions {
  // CSR: the triangles of region k are triangles[first_triangle[k] .. first_triangle[k+1]),
  // ascending; regions are ordered by their lowest triangle.
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t> first_triangle{0};
  // CSR: the edges whose multiplicity over the triangles of region k alone is not 0, in the order
  // of the EdgeTable. Balanced at every vertex.
  Silhouette edges;
  std::vector<std::uint32_t> first_edge{0};
  std::vector<std::uint32_t> region_of;  // per triangle of the mesh; kNoRegion: in none

  std::size_t size() const { return first_triangle.size() - 1; }
  std::span<const std::uint32_t> triangles_of(std::size_t k) const {
    return std::span(triangles).subspan(first_triangle[k],
                                        first_triangle[k + 1] - first_triangle[k]);
  }
  std::span<const SilhouetteEdge> silhouette_of(std::size_t k) const {
    return std::span(edges).subspan(first_edge[k], first_edge[k + 1] - first_edge[k]);
  }
};

// Regions of the triangles with cap[t] != 0, connected through edges (sharing a vertex is not
// enough). `sides`: light_sides() of the mesh that `edges` was built from. The prism of each of
// these triangles counts 1, whatever its winding, so all triangles of a soup may be given as well
// as the lit ones of closed parts: multiplicities are those of find_silhouette() for a mesh of the
// region's triangles alone. Precondition: every triangle of the cap is in `edges`.
LitRegions find_lit_regions(const EdgeTable& edges, const std::vector<std::int8_t>& sides,
                            const std::vector<std::uint8_t>& cap);

// The same for the triangles with sides[t] == lit (+1 or -1; of a mesh wound outwards -1 are those
// that face the light) that are selected: `selected` empty means all, else one flag per triangle.
LitRegions find_lit_regions(const EdgeTable& edges, const std::vector<std::int8_t>& sides, int lit,
                            const std::vector<std::uint8_t>& selected = {});

}  // namespace gnomon
