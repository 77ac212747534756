// Silhouettes of one caster, light after light, by whichever method costs least: one interface over
// brute force, the tree of edges and the second paper's tree. All find the same edges.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <gnomon/mesh/edge_table.h>
#include <gnomon/mesh/tri_mesh.h>
#include <gnomon/silhouette/edge_tree.h>
#include <gnomon/silhouette/hextree.h>
#include <gnomon/silhouette/silhouette.h>

namespace gnomon {

// automatic: brute force, and from the kLightsBeforeTree-th light on the tree of edges; if there is
// one, but vertices have moved, from the kLightsBeforeRefresh-th light since then.
enum class SilhouetteBy : std::uint8_t { automatic, brute_force, dual_space, edge_tree };

// Building the tree costs as much as 20 to 170 extractions by brute force (docs/silhouettes.md);
// who asks so often will probably ask again.
inline constexpr std::uint32_t kLightsBeforeTree = 64;
// Giving it the planes of vertices that have moved: as much as about 12 extractions.
inline constexpr std::uint32_t kLightsBeforeRefresh = 12;

struct SilhouetteFinder {
  std::uint32_t lights = 0;           // asked for since it was made or vertices moved
  std::optional<EdgeTree> edge_tree;  // made when it is first needed; kept when vertices move
  std::optional<Hextree> dual_space;
  bool current = false;                         // the planes of edge_tree are those of the mesh
  SilhouetteBy last = SilhouetteBy::automatic;  // how the last one was found; automatic: none was
  ExtractionScratch scratch;
};

// The edges of find_silhouette(), by brute force in the order of the EdgeTable, else in a tree's.
// `light`: in the mesh's coordinates, snapped. `sides` becomes light_sides() where it was needed to
// find them (brute force), else empty. Preconditions: `edges` is of this mesh, `finder` of both.
void find_silhouette(Silhouette& out, std::vector<std::int8_t>& sides, SilhouetteFinder& finder,
                     SilhouetteBy by, const TriMesh& mesh, const EdgeTable& edges,
                     const Light& light);

// To be called when vertices have moved: the same triangles, other planes.
void vertices_moved(SilhouetteFinder& finder);

}  // namespace gnomon
