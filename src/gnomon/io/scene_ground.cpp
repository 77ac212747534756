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
#include <tuple>
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
  const std::size_t n = parts.names.size();
  std::vector<Foot> feet(n);
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    const Surface& surface = scene.surfaces[scene.surface_of[t]];
    if (is_terrain(surface) || is_height_above_ground(surface)) continue;
    // The nodes of a design are no objects that stand on the ground, but all of it is.
    const std::size_t number =
        surface.city ? parts.of_surface[scene.surface_of[t]] : n + surface.file;
    if (number >= feet.size()) feet.resize(number + 1);
    Foot& foot = feet[number];
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

// The vertices of edges that belong to one triangle only: where the terrain ends, and around its
// holes. Ascending by x.
std::vector<Vec3> border_of(const Scene& scene, const std::vector<std::uint32_t>& terrain) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::vector<Edge> edges;
  edges.reserve(3 * terrain.size());
  for (const std::uint32_t t : terrain) {
    const Triangle& v = scene.mesh.triangles[t];
    for (int k = 0; k < 3; ++k) edges.push_back(std::minmax(v[k], v[(k + 1) % 3]));
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Vec3> border;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (k > 0 && edges[k - 1] == edges[k]) continue;
    if (k + 1 < edges.size() && edges[k + 1] == edges[k]) continue;
    border.push_back(scene.mesh.positions[edges[k].first]);
    border.push_back(scene.mesh.positions[edges[k].second]);
  }
  const auto before = [](const Vec3& a, const Vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  };
  std::sort(border.begin(), border.end(), before);
  border.erase(std::unique(border.begin(), border.end()), border.end());
  return border;
}

// Outwards from x until no vertex can be nearer; of equally near ones the lower.
double nearest_height(const std::vector<Vec3>& border, double x, double y) {
  const auto middle = std::lower_bound(border.begin(), border.end(), x,
                                       [](const Vec3& p, double at) { return p.x < at; });
  double least = std::numeric_limits<double>::infinity(), z = 0;
  const auto look = [&](const Vec3& p) {
    const double dx = p.x - x, dy = p.y - y, d = dx * dx + dy * dy;
    if (d < least || (d == least && p.z < z)) least = d, z = p.z;
    return dx * dx <= least;
  };
  for (auto at = middle; at != border.end() && look(*at);) ++at;
  for (auto at = middle; at != border.begin() && look(*--at);) {
  }
  return z;
}

}  // namespace

GroundAt ground_of(const Scene& scene, GroundSearch search, std::size_t& beside_terrain) {
  std::vector<std::uint32_t> terrain;
  std::vector<std::array<Vec3, 3>> corners;
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (!is_terrain(scene.surfaces[scene.surface_of[t]])) continue;
    const Triangle& v = scene.mesh.triangles[t];
    terrain.push_back(t);
    corners.push_back(
        {scene.mesh.positions[v[0]], scene.mesh.positions[v[1]], scene.mesh.positions[v[2]]});
  }
  const Vec3 origin = scene.frame.origin;
  if (terrain.empty()) {
    return [feet = feet_of(scene), origin](double x, double y) {
      auto z = nearest_foot(feet, x - origin.x, y - origin.y);
      if (z) *z += origin.z;
      return z;
    };
  }
  const auto border = std::make_shared<std::vector<Vec3>>();
  if (search == GroundSearch::nearest) *border = border_of(scene, terrain);
  return [below = ground_at(std::move(corners)), border, origin, &beside_terrain](
             double x, double y) -> std::optional<double> {
    auto z = below(x - origin.x, y - origin.y);
    if (!z && !border->empty()) {
      z = nearest_height(*border, x - origin.x, y - origin.y);
      ++beside_terrain;
    }
    if (z) *z += origin.z;
    return z;
  };
}

}  // namespace gnomon
