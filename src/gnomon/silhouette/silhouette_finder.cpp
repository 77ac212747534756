#include <gnomon/silhouette/silhouette_finder.h>

#include <gnomon/silhouette/light_sides.h>

namespace gnomon {

void find_silhouette(Silhouette& out, std::vector<std::int8_t>& sides, SilhouetteFinder& finder,
                     SilhouetteBy by, const TriMesh& mesh, const EdgeTable& edges,
                     const Light& light) {
  ++finder.lights;
  if (by == SilhouetteBy::automatic) {
    const std::uint32_t from = finder.current     ? 0
                               : finder.edge_tree ? kLightsBeforeRefresh
                                                  : kLightsBeforeTree;
    by = finder.lights < from ? SilhouetteBy::brute_force : SilhouetteBy::edge_tree;
  }
  finder.last = by;
  sides.clear();
  if (by == SilhouetteBy::brute_force) {
    sides = light_sides(mesh, light);
    out = find_silhouette(edges, sides);
    return;
  }
  if (by == SilhouetteBy::dual_space) {
    if (!finder.dual_space) finder.dual_space = build_hextree(mesh, edges, DualForm::facets);
    find_silhouette(out, *finder.dual_space, mesh, light);
  } else {
    if (!finder.edge_tree) {
      finder.edge_tree = build_edge_tree(mesh, edges);
    } else if (!finder.current) {
      refresh_planes(*finder.edge_tree, mesh);
    }
    finder.current = true;
    find_silhouette(out, *finder.edge_tree, mesh, light, finder.scratch);
  }
}

void vertices_moved(SilhouetteFinder& finder) {
  finder.lights = 0;
  finder.current = false;
  finder.dual_space.reset();
}

}  // namespace gnomon
