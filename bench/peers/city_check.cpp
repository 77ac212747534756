#include "city_check.h"

#include <glm/geometric.hpp>

#include <gnomon/shadow/cast_shadows.h>
#include <gnomon/view/view.h>

#include "city_view.h"

namespace gnomon::bench {
namespace {

bool turned_to(const Scene& scene, std::uint32_t triangle, const Vec3& lamp) {
  const Triangle& t = scene.mesh.triangles[triangle];
  const std::vector<Vec3>& p = scene.mesh.positions;
  return glm::dot(glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]), lamp - p[t[0]]) > 0;
}

}  // namespace

CityCheck check_city(const std::vector<std::uint8_t>& shadowed,
                     const std::vector<std::uint8_t>& unshadowed, int size, const Vec3& lamp) {
  const Scene city = scenes::box_city();
  const CityCamera camera;
  const View view = perspective_view(camera.eye, camera.target, camera.up, camera.fov, size, size);
  const Receivers receivers = visible_surfaces(city, view);
  const ShadowMask mask = cast_shadows(prepare_casters(city), receivers, point(lamp));
  CityCheck check;
  for (std::size_t k = 0; k < mask.state.size(); ++k) {
    if (mask.state[k] == ShadowMask::kNoSample || !turned_to(city, receivers.triangle[k], lamp))
      continue;
    bool darker = false;
    for (std::size_t c = 3 * k; c < 3 * k + 3; ++c) darker |= shadowed[c] < unshadowed[c];
    const bool shadow = mask.state[k] == ShadowMask::kShadow;
    ++check.samples;
    check.shadow += shadow ? 1 : 0;
    check.wrong += shadow != darker ? 1 : 0;
  }
  return check;
}

}  // namespace gnomon::bench
