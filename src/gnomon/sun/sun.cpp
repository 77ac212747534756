#include <cmath>

#include <gnomon/sun/spa.h>
#include <gnomon/sun/sun.h>

namespace gnomon {

SunPosition sun_position(Instant t, const Place& place, const Atmosphere& air,
                         std::optional<double> delta_t_seconds) {
  const spa::Geocentric from_centre =
      spa::geocentric(spa::julian_day(t), delta_t_seconds.value_or(delta_t(t)));
  const spa::Topocentric from_place = spa::topocentric(from_centre, place);
  SunPosition position;
  position.azimuth = from_place.azimuth;
  position.altitude_geometric = from_place.altitude;
  position.altitude_apparent = from_place.altitude + spa::refraction(from_place.altitude, air);
  position.declination = from_place.declination;
  position.hour_angle = from_place.hour_angle;
  position.equation_of_time = from_centre.equation_of_time;
  return position;
}

Vec4 sun_direction(const SunPosition& sun, double true_north) {
  const double azimuth = sun.azimuth + true_north;
  const double level = std::cos(sun.altitude_apparent);
  return direction(
      {level * std::sin(azimuth), level * std::cos(azimuth), std::sin(sun.altitude_apparent)});
}

}  // namespace gnomon
