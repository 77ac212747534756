#include <gnomon/raster/count_shadows.h>

#include <algorithm>

#include <gnomon/silhouette/light_sides.h>
#include <gnomon/silhouette/silhouette.h>
#include <gnomon/view/predicates.h>

namespace gnomon {

std::vector<std::int32_t> count_shadows_reference(const Casters& casters,
                                                  const Receivers& receivers, const Light& given) {
  const Scene& scene = *casters.scene;
  const View& view = receivers.view;
  const Light light = snapped(given);
  ExactStats stats;
  const auto corners_of = [&](std::uint32_t t) {
    const Triangle& v = scene.mesh.triangles[t];
    return triangle_corners(scene.mesh.positions[v[0]], scene.mesh.positions[v[1]],
                            scene.mesh.positions[v[2]]);
  };
  const auto casts_shadow = [&](std::uint32_t t) {
    return casters.selected.empty() || casters.selected[t] != 0;
  };

  struct Face {
    Corners corners;
    int facing;
    std::int32_t add;
  };
  std::vector<Face> faces;
  std::int32_t eye_count = 0;
  const std::vector<std::int8_t> sides = light_sides(scene.mesh, light);
  for (const SilhouetteEdge& e : find_silhouette(casters.edges, sides)) {
    const Corners c = side_corners(scene.mesh.positions[e.a], scene.mesh.positions[e.b]);
    const int f = facing(view, c, light, stats);
    faces.push_back({c, f, -e.multiplicity * f});
  }
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (!casts_shadow(t)) continue;
    const Corners c = corners_of(t);
    const int f = facing(view, c, light, stats);
    faces.push_back({c, f, sides[t] * f});
    if (between_eye_and_light(view, c, light, stats)) ++eye_count;
  }

  std::vector<std::int32_t> counts(receivers.triangle.size(), 0);
  for (int row = 0; row < view.height; ++row) {
    for (int column = 0; column < view.width; ++column) {
      const std::size_t k = static_cast<std::size_t>(row) * static_cast<std::size_t>(view.width) +
                            static_cast<std::size_t>(column);
      const std::uint32_t triangle = receivers.triangle[k];
      if (triangle == kNoTriangle) continue;
      const Corners r = corners_of(triangle);
      const int seen = facing(view, r, light, stats);
      counts[k] = eye_count;
      for (const Face& f : faces) {
        if (!covers(view, column, row, f.corners, f.facing, light, stats)) continue;
        if (in_front(view, column, row, f.corners, f.facing, r, seen, light, stats))
          counts[k] += f.add;
      }
      if (!casts_shadow(triangle) && sides[triangle] != seen) counts[k] = std::max(counts[k], 1);
    }
  }
  return counts;
}

}  // namespace gnomon
