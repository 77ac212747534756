#include <gnomon/io/picture_shading.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include <glm/geometric.hpp>

#include <gnomon/core/parallel.h>
#include <gnomon/core/place.h>
#include <gnomon/scene/objects.h>

namespace gnomon {
namespace {

// Two faces that meet at more than this are drawn with an edge; less is curvature that shading
// shows.
const double kCreaseCosine = std::cos(25 * kDegree);
// A step in nearness between neighbours of one object, beyond what the slope of the surface
// explains, is one part hiding another. Share of the nearness; pictures only.
constexpr float kHiddenStep = 0.03F;

enum class Kind { roof, wall, ground, water, plants, traffic, other };

bool has(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

// CityJSON 2.0 types of objects and surfaces.
Kind kind_of(const Surface& s) {
  if (has(s.semantic, "Roof")) return Kind::roof;
  if (has(s.semantic, "Wall") || has(s.semantic, "Window") || has(s.semantic, "Door"))
    return Kind::wall;
  if (has(s.group, "Water") || has(s.semantic, "Water")) return Kind::water;
  if (has(s.group, "Plant") || has(s.group, "Vegetation")) return Kind::plants;
  if (has(s.group, "Road") || has(s.group, "Rail") || has(s.group, "Transport") ||
      has(s.semantic, "Traffic")) {
    return Kind::traffic;
  }
  if (has(s.semantic, "Ground") || has(s.group, "TINRelief") || has(s.group, "LandUse"))
    return Kind::ground;
  return Kind::other;
}

Rgb colour_of(Kind kind, const Vec3& up_normal) {
  switch (kind) {
    case Kind::roof:
      return {226, 196, 178};  // fired clay, pale
    case Kind::wall:
      return {240, 234, 224};  // lime plaster
    case Kind::ground:
      return {220, 217, 209};  // paving
    case Kind::water:
      return {189, 208, 220};
    case Kind::plants:
      return {196, 209, 178};
    case Kind::traffic:
      return {204, 203, 201};
    case Kind::other:
      break;
  }
  return up_normal.z > 0.5 ? Rgb{229, 210, 194} : Rgb{238, 232, 222};
}

struct Face {
  Vec3 normal{0, 0, 0};  // unit, by the winding
  std::uint32_t object = kNoObject;
  Kind kind = Kind::other;
};

std::vector<Face> faces_of(const Scene& scene, int threads) {
  const Objects whole = whole_objects(scene);
  std::vector<Kind> kind(scene.surfaces.size());
  for (std::size_t k = 0; k < scene.surfaces.size(); ++k) kind[k] = kind_of(scene.surfaces[k]);
  std::vector<Face> faces(scene.mesh.triangles.size());
  constexpr int kChunk = 4096;
  const int chunks = static_cast<int>((faces.size() + kChunk - 1) / kChunk);
  parallel_for(chunks, threads, [&](int chunk) {
    const std::size_t begin = static_cast<std::size_t>(chunk) * kChunk;
    for (std::size_t t = begin; t < std::min(faces.size(), begin + kChunk); ++t) {
      const Triangle& corner = scene.mesh.triangles[t];
      const Vec3& a = scene.mesh.positions[corner[0]];
      const Vec3 n =
          glm::cross(scene.mesh.positions[corner[1]] - a, scene.mesh.positions[corner[2]] - a);
      const double length = glm::length(n);
      if (length > 0) faces[t].normal = n / length;
      faces[t].object = whole.of_surface[scene.surface_of[t]];
      faces[t].kind = kind[scene.surface_of[t]];
    }
  });
  return faces;
}

Vec3 turned_towards(const Vec3& normal, const Vec3& to_eye) {
  return glm::dot(normal, to_eye) < 0 ? -normal : normal;
}

}  // namespace

Rgb surface_colour(const Surface& surface) { return colour_of(kind_of(surface), Vec3(0, 0, 0)); }

PlanRelief plan_relief(const Scene& scene, const Receivers& receivers, int threads) {
  const std::vector<Face> faces = faces_of(scene, threads);
  const Vec3 to_eye(receivers.view.eye.x, receivers.view.eye.y, receivers.view.eye.z);
  // 45 degrees high in the north-west: a level surface gets cos 45 degrees, which becomes
  // kLevelShade.
  const Vec3 light(-0.5, 0.5, std::sqrt(0.5));
  std::vector<std::uint8_t> shade_of(faces.size());
  for (std::size_t t = 0; t < faces.size(); ++t) {
    const double lit = std::max(0.0, glm::dot(turned_towards(faces[t].normal, to_eye), light));
    shade_of[t] =
        static_cast<std::uint8_t>(std::lround(std::min(255.0, kLevelShade * lit / std::sqrt(0.5))));
  }
  PlanRelief relief;
  relief.shade.assign(receivers.triangle.size(), kLevelShade);
  relief.object.assign(receivers.triangle.size(), kNoObject);
  const std::size_t width = static_cast<std::size_t>(receivers.view.width);
  parallel_for(receivers.view.height, threads, [&](int row) {
    for (std::size_t k = static_cast<std::size_t>(row) * width;
         k < static_cast<std::size_t>(row + 1) * width; ++k) {
      const std::uint32_t t = receivers.triangle[k];
      if (t == kNoTriangle) continue;
      relief.shade[k] = shade_of[t];
      relief.object[k] = faces[t].object;
    }
  });
  return relief;
}

ViewShading view_shading(const Scene& scene, const Receivers& receivers, int threads) {
  const std::vector<Face> faces = faces_of(scene, threads);
  const View& view = receivers.view;
  const std::size_t width = static_cast<std::size_t>(view.width);
  const std::size_t samples = receivers.triangle.size();
  ViewShading out{std::vector<float>(samples, 0.0F), std::vector<Rgb>(samples),
                  std::vector<std::uint8_t>(samples, 0)};

  // Light over the viewer's left shoulder, so that the walls seen differ in tone whichever way the
  // camera looks.
  const Vec4 middle = pixel_point(view, view.width / 2, view.height / 2);
  const Vec3 ahead = is_parallel(view) ? -Vec3(view.eye.x, view.eye.y, view.eye.z)
                                       : Vec3(middle.x, middle.y, middle.z);
  const Vec3 right = glm::normalize(Vec3(view.right.x, view.right.y, view.right.z));
  const Vec3 light =
      glm::normalize(-0.35 * glm::normalize(ahead) - 0.75 * right + Vec3(0, 0, 0.55));

  const auto differs = [&](std::size_t a, std::size_t b) {
    const std::uint32_t s = receivers.triangle[a], t = receivers.triangle[b];
    if (s == t) return false;
    if (s == kNoTriangle || t == kNoTriangle) return true;
    if (faces[s].object != faces[t].object) return true;
    const double cosine = std::abs(glm::dot(faces[s].normal, faces[t].normal));
    if (faces[s].kind == Kind::ground && faces[t].kind == Kind::ground)
      return false;  // no net of terrain triangles
    if (cosine < kCreaseCosine) return true;
    const float near = receivers.nearness[a], far = receivers.nearness[b];
    return !is_parallel(view) && std::abs(near - far) > kHiddenStep * std::max(near, far);
  };

  parallel_for(view.height, threads, [&](int row) {
    for (int column = 0; column < view.width; ++column) {
      const std::size_t k =
          static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column);
      if ((column + 1 < view.width && differs(k, k + 1)) ||
          (row + 1 < view.height && differs(k, k + width))) {
        out.edge[k] = 1;
      }
      const std::uint32_t t = receivers.triangle[k];
      if (t == kNoTriangle) continue;
      const Vec4 q = pixel_point(view, column, row);
      const Vec3 to_eye =
          is_parallel(view) ? Vec3(view.eye.x, view.eye.y, view.eye.z) : -Vec3(q.x, q.y, q.z);
      const Vec3 n = turned_towards(faces[t].normal, to_eye);
      const double sky = 0.5 + 0.5 * n.z;  // the part of the sky's dome that a free face sees
      const double direct = 0.5 + 0.5 * glm::dot(n, light);
      out.shade[k] = static_cast<float>(std::min(1.0, 0.42 + 0.28 * sky + 0.36 * direct));
      out.colour[k] = colour_of(faces[t].kind, n);
    }
  });
  return out;
}

}  // namespace gnomon
