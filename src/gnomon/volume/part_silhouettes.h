// The silhouette of a whole mesh, part by part: found at once, which is faster than one by one, and
// then given out.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include <gnomon/mesh/edge_table.h>
#include <gnomon/silhouette/silhouette.h>
#include <gnomon/volume/parts.h>

namespace gnomon {

// Which part each edge of a mesh is of, made once. Parts share vertices, but no edges.
struct PartsOfEdges {
  std::vector<std::uint32_t> of_vertex;  // kNoPart: of none; kManyParts: the edge says
  std::unordered_map<std::uint64_t, std::uint32_t> of_edge;  // between two vertices of many parts
};
inline constexpr std::uint32_t kManyParts = kNoPart - 1;

// Precondition: `edges` are of the triangles that `parts` was made of, and no others.
PartsOfEdges parts_of_edges(const EdgeTable& edges, const Parts& parts, std::size_t vertices);

// Which triangles of a part cast, each of which counts 1: none, those of one light side, or all.
// One side only of closed parts which the light is outside of (of their boxes is enough; a sun
// always is): a ray to it crosses as many triangles of one side as of the other.
enum class CastingSides : std::uint8_t { none, one, both };

// CSR over the parts.
struct PartSilhouettes {
  Silhouette edges;
  std::vector<std::uint32_t> first{0};

  std::span<const SilhouetteEdge> of(std::size_t part) const {
    return std::span(edges).subspan(first[part], first[part + 1] - first[part]);
  }
};

// `silhouette`: of all triangles of all parts, whose order is kept. `sides`: per part; where one
// side casts, multiplicities are those of that side alone, half of the whole: over an edge of a
// closed part its triangles' directions add up to 0.
PartSilhouettes split_by_part(const Silhouette& silhouette, const PartsOfEdges& parts,
                              std::span<const CastingSides> sides);

}  // namespace gnomon
