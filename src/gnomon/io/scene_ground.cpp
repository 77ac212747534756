#include <gnomon/io/footprints.h>
#include <gnomon/io/ground_at.h>
#include <gnomon/io/scene_ground.h>
#include <gnomon/scene/objects.h>
#include <gnomon/view/view.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace gnomon {
namespace {

struct Foot {
  Bounds2 box{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
              -std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  double z = std::numeric_limits<double>::infinity();
};

std::vector<Foot> feet_of(const Scene& scene) {
  const Objects parts = objects(scene);
  std::vector<Foot> feet(parts.names.size());
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    Foot& foot = feet[parts.of_surface[scene.surface_of[t]]];
    for (const std::uint32_t v : scene.mesh.triangles[t]) {
      const Vec3& p = scene.mesh.positions[v];
      foot.box = {std::min(foot.box.x0, p.x), std::min(foot.box.y0, p.y),
                  std::max(foot.box.x1, p.x), std::max(foot.box.y1, p.y)};
      foot.z = std::min(foot.z, p.z);
    }
  }
  std::erase_if(feet, [](const Foot& f) { return !std::isfinite(f.z); });
  return feet;
}

std::optional<double> nearest_foot(const std::vector<Foot>& feet, double x, double y) {
  double least = std::numeric_limits<double>::infinity();
  std::optional<double> z;
  for (const Foot& f : feet) {
    const double dx = std::max({f.box.x0 - x, 0.0, x - f.box.x1});
    const double dy = std::max({f.box.y0 - y, 0.0, y - f.box.y1});
    const double d = dx * dx + dy * dy;
    if (d < least) least = d, z = f.z;
  }
  return z;
}

}  // namespace

GroundAt ground_of(const Scene& scene) {
  std::vector<std::array<Vec3, 3>> terrain;
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (!is_terrain(scene.surfaces[scene.surface_of[t]])) continue;
    const Triangle& v = scene.mesh.triangles[t];
    terrain.push_back(
        {scene.mesh.positions[v[0]], scene.mesh.positions[v[1]], scene.mesh.positions[v[2]]});
  }
  const GroundAt below = ground_at(std::move(terrain));
  const Vec3 origin = scene.frame.origin;
  return [below, feet = feet_of(scene), origin](double x, double y) -> std::optional<double> {
    auto z = below(x - origin.x, y - origin.y);
    if (!z) z = nearest_foot(feet, x - origin.x, y - origin.y);
    if (z) *z += origin.z;
    return z;
  };
}

}  // namespace gnomon
