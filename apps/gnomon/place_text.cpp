#include "place_text.h"

#include <cmath>

#include <fmt/format.h>
#include <gnomon/sun/zone_place.h>

namespace gnomon::app {
namespace {

// Zones are large: within Europe's the farthest places are some 2500 km from the zone's own, within
// China's 4000 km.
constexpr double kFar = 5000e3;      // metres: of no zone
constexpr double kSwapped = 1000e3;  // metres: worth a look at the other order
constexpr double kMuchNearer = 1.0 / 3;

std::string degrees_text(const Place& place) {
  return fmt::format("{:.4f} {}, {:.4f} {}", std::abs(place.latitude) / kDegree,
                     place.latitude < 0 ? 'S' : 'N', std::abs(place.longitude) / kDegree,
                     place.longitude < 0 ? 'W' : 'E');
}

}  // namespace

std::string place_line(const LoadedScene& loaded) {
  const auto& place = loaded.scene.frame.place;
  if (!place) return "";
  return fmt::format("place {}{}", degrees_text(*place),
                     loaded.place_by.empty() ? "" : ", from " + loaded.place_by);
}

void check_place(Warnings& warnings, const Place& place, const std::string& zone) {
  const auto home = zone_reference(zone);
  if (!home) return;
  const double distance = distance_between(place, *home);
  if (distance <= kSwapped) return;
  const Place swapped{place.longitude, place.latitude, 0};
  const bool nearer = std::abs(swapped.latitude) <= kPi / 2 &&
                      distance_between(swapped, *home) < kMuchNearer * distance;
  if (!nearer && distance <= kFar) return;
  warn(warnings,
       fmt::format("the place {} lies {:.0f} km from {}'s own: {}", degrees_text(place),
                   std::round(distance / 1e5) * 100, zone,
                   nearer ? "are latitude and longitude swapped?" : "check the place and --tz"),
       "");
}

}  // namespace gnomon::app
