#include "shadow_reach.h"

#include <algorithm>
#include <cmath>

#include <gnomon/io/ground.h>

namespace gnomon::app {
namespace {

// A lower sun throws shadows of more than 5.7 heights, without end towards sunrise and sunset: to
// frame them would make a map of nothing else, and buildings that are not in the model would shade
// that ground as well.
constexpr double kLowestFramedSun = 10 * kDegree;

void widen(ShadowReach& r, double east, double north) {
  r.west = std::max(r.west, -east);
  r.east = std::max(r.east, east);
  r.south = std::max(r.south, -north);
  r.north = std::max(r.north, north);
}

}  // namespace

std::optional<ShadowReach> shadow_reach(const std::vector<Light>& lights) {
  const double lowest = std::tan(kLowestFramedSun);
  ShadowReach high, low;
  bool any_high = false, any = false;
  for (const Light& l : lights) {
    if (l.w != 0 || !(l.z > 0)) continue;
    any = true;
    const double level = std::hypot(l.x, l.y);
    if (l.z >= lowest * level) {
      any_high = true;
      widen(high, -l.x / l.z, -l.y / l.z);
    } else {
      widen(low, -l.x / (level * lowest), -l.y / (level * lowest));
    }
  }
  if (!any) return {};
  return any_high ? high : low;
}

bool shadow_at_border(const Scene& scene, const Receivers& receivers,
                      const std::function<bool(std::size_t)>& in_shadow) {
  const auto width = static_cast<std::size_t>(receivers.view.width),
             height = static_cast<std::size_t>(receivers.view.height);
  const auto beyond = [&](std::size_t k) {
    const std::uint32_t t = receivers.triangle[k];
    return t != kNoTriangle && is_made_ground(scene.surfaces[scene.surface_of[t]]) && in_shadow(k);
  };
  for (std::size_t i = 0; i < width; ++i) {
    if (beyond(i) || beyond((height - 1) * width + i)) return true;
  }
  for (std::size_t j = 0; j < height; ++j) {
    if (beyond(j * width) || beyond(j * width + width - 1)) return true;
  }
  return false;
}

}  // namespace gnomon::app
