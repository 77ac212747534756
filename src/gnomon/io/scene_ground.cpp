#include <gnomon/io/box_finder.h>
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

// Where the terrain ends, and around its holes.
struct Border {
  std::vector<Vec3> vertices;  // ascending by x
  double half_cell = 0;        // across: half of the median edge's length, times the root of 2
};

// Of the edges that belong to one triangle only.
Border border_of(const Scene& scene) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::vector<Edge> edges;
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (!is_terrain(scene.surfaces[scene.surface_of[t]])) continue;
    const Triangle& v = scene.mesh.triangles[t];
    for (int k = 0; k < 3; ++k) edges.push_back(std::minmax(v[k], v[(k + 1) % 3]));
  }
  std::sort(edges.begin(), edges.end());
  Border border;
  std::vector<double> lengths;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (k > 0 && edges[k - 1] == edges[k]) continue;
    if (k + 1 < edges.size() && edges[k + 1] == edges[k]) continue;
    const Vec3 &a = scene.mesh.positions[edges[k].first],
               &b = scene.mesh.positions[edges[k].second];
    border.vertices.push_back(a);
    border.vertices.push_back(b);
    lengths.push_back(std::hypot(a.x - b.x, a.y - b.y));
  }
  if (lengths.empty()) return border;
  const auto median = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), median, lengths.end());
  border.half_cell = *median * std::sqrt(0.5);
  std::sort(border.vertices.begin(), border.vertices.end(), [](const Vec3& a, const Vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  });
  border.vertices.erase(std::unique(border.vertices.begin(), border.vertices.end()),
                        border.vertices.end());
  return border;
}

// Outwards from x until no vertex can be nearer; of equally near ones the lower. Precondition:
// there is one.
Vec3 nearest_vertex(const std::vector<Vec3>& border, double x, double y) {
  const auto middle = std::lower_bound(border.begin(), border.end(), x,
                                       [](const Vec3& p, double at) { return p.x < at; });
  double least = std::numeric_limits<double>::infinity();
  Vec3 nearest = border[0];
  const auto look = [&](const Vec3& p) {
    const double dx = p.x - x, dy = p.y - y, d = dx * dx + dy * dy;
    if (d < least || (d == least && p.z < nearest.z)) least = d, nearest = p;
    return dx * dx <= least;
  };
  for (auto at = middle; at != border.end() && look(*at);) ++at;
  for (auto at = middle; at != border.begin() && look(*--at);) {
  }
  return nearest;
}

}  // namespace

GroundAt terrain_at(const Scene& scene) {
  std::vector<std::array<Vec3, 3>> corners;
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (!is_terrain(scene.surfaces[scene.surface_of[t]])) continue;
    const Triangle& v = scene.mesh.triangles[t];
    corners.push_back(
        {scene.mesh.positions[v[0]], scene.mesh.positions[v[1]], scene.mesh.positions[v[2]]});
  }
  return corners.empty() ? GroundAt() : ground_at(std::move(corners));
}

GroundAt ground_of(const Scene& scene, std::size_t& beside_terrain) {
  const Vec3 origin = scene.frame.origin;
  const GroundAt terrain = terrain_at(scene);
  if (!terrain) {
    const auto feet = std::make_shared<const std::vector<Foot>>(feet_of(scene));
    std::vector<Bounds2> boxes;
    for (const Foot& f : *feet) boxes.push_back(f.box);
    const auto finder = std::make_shared<const BoxFinder>(std::move(boxes));
    return [feet, finder, origin](double x, double y) -> std::optional<double> {
      const auto nearest = finder->nearest(x - origin.x, y - origin.y);
      if (!nearest) return std::nullopt;
      return (*feet)[*nearest].z + origin.z;
    };
  }
  const auto border = std::make_shared<const Border>(border_of(scene));
  return [terrain, border, origin, &beside_terrain](double x, double y) -> std::optional<double> {
    const Vec2 p(x - origin.x, y - origin.y);
    auto z = terrain(p.x, p.y);
    if (!z && !border->vertices.empty()) {
      const Vec3 nearest = nearest_vertex(border->vertices, p.x, p.y);
      if (std::hypot(nearest.x - p.x, nearest.y - p.y) > border->half_cell) ++beside_terrain;
      z = nearest.z;
    }
    if (z) *z += origin.z;
    return z;
  };
}

}  // namespace gnomon
