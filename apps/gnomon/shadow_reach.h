// How far the shadows of a study fall: what a map's frame should hold.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <gnomon/scene/scene.h>
#include <gnomon/view/receivers.h>

namespace gnomon::app {

// The farthest tips of shadows towards each side of the scene's grid (north: +y), in heights of
// what throws them; all >= 0.
struct ShadowReach {
  double west = 0, south = 0, east = 0, north = 0;
};

// Of suns (directions, w = 0). Those lower than kLowestFramedSun are left out; where none is
// higher, they are taken as if they stood there. Nothing where no light is a sun above the horizon.
std::optional<ShadowReach> shadow_reach(const std::vector<Light>& lights);

// True if a sample of the outermost rows and columns lies in shadow on the ground that Gnomon made:
// the shadow goes on beyond the map. `in_shadow(k)`: of sample k.
bool shadow_at_border(const Scene& scene, const Receivers& receivers,
                      const std::function<bool(std::size_t)>& in_shadow);

// What then is said, a fact and no fault.
inline constexpr const char* kShadowAtBorder =
    "Shadows reach the border of the map: areas and shares are those inside it; larger "
    "--bounds show more.";

}  // namespace gnomon::app
