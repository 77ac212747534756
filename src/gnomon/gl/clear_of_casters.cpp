// A lamp that touches a caster: prisms whose corner, edge or face holds the light have no shape
// that floats could draw.
#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <gnomon/gl/renderer_state.h>

namespace gnomon::gl {
namespace {

// Shares of the largest coordinate. Differences of floats (24 bits) keep five bits at the distance
// that counts as touching; the lamp is moved so far that seven are left along z, eleven along x.
constexpr double kTouching = 0x1p-19, kMove = 0x1p-13;

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double s = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0, 1.0);
  return glm::distance(p, a + s * ab);
}

double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = glm::cross(b - a, c - a);
  const double area = glm::length(n);
  if (area > 0 && glm::dot(glm::cross(b - a, p - a), n) >= 0 &&
      glm::dot(glm::cross(c - b, p - b), n) >= 0 && glm::dot(glm::cross(a - c, p - c), n) >= 0) {
    return std::fabs(glm::dot(p - a, n)) / area;
  }
  return std::min(
      {distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

// The largest coordinate of what the light touches, in the mesh's coordinates; 0: nothing.
double touches(const GpuMesh& mesh, const Vec3& light) {
  for (const Part& part : mesh.parts.parts) {
    double size = 0;
    for (int k = 0; k < 3; ++k)
      size = std::max({size, std::fabs(part.lo[k]), std::fabs(part.hi[k]), std::fabs(light[k])});
    const double near = kTouching * size;
    if (glm::any(glm::lessThan(light, part.lo - near)) ||
        glm::any(glm::greaterThan(light, part.hi + near))) {
      continue;
    }
    for (const std::uint32_t t : part.triangles) {
      const Triangle& v = mesh.mesh.triangles[t];
      const std::vector<Vec3>& p = mesh.mesh.positions;
      if (distance_to_triangle(light, p[v[0]], p[v[1]], p[v[2]]) <= near) return size;
    }
  }
  return 0;
}

}  // namespace

Light clear_of_casters(const Frame& frame, const Light& light) {
  if (light.w == 0) return light;
  Vec3 at = Vec3(light) / light.w;
  for (int tries = 0; tries < 4; ++tries) {  // a move may end at another caster; each is longer
    double size = 0;
    for (const InstanceSlot& instance : frame.state->instances) {
      if (!instance.alive) continue;
      const double scale = glm::length(Vec3(instance.to_scene[0]));
      const Vec3 in_mesh(glm::inverse(instance.to_scene) * point(at));
      size = std::max(size, scale * touches(frame.state->meshes[instance.mesh].gpu, in_mesh));
    }
    if (size == 0) break;
    if (tries == 0) ++frame.stats->moved_lights;
    // Along x most and along z least, as infinitesimals do (core/exact.h).
    at += kMove * size * (1 << tries) * Vec3(1, 1.0 / 4, 1.0 / 16);
  }
  return point(at);
}

}  // namespace gnomon::gl
