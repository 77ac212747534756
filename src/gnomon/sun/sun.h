// Position of the sun, sunrise, transit and sunset, true solar time.
// Based on: Reda, Andreas, Solar Position Algorithm for Solar Radiation Applications,
// NREL/TP-560-34302, 2003, revised 2008 (corrigendum 2007); written from the publication. Good to
// 0.0003 degrees for the years -2000 to 6000.
#pragma once

#include <optional>

#include <gnomon/core/place.h>
#include <gnomon/core/vec.h>

namespace gnomon {

// What refracts the light: yearly means at the place.
struct Atmosphere {
  double pressure =
      1013.25;  // mbar; standard at sea level. Callers that know the height may lower it.
  double temperature = 10.0;                     // Celsius
  double horizon_refraction = 0.5667 * kDegree;  // radians, at sunrise and sunset
};

struct SunPosition {
  double azimuth = 0;  // radians in [0, 2 pi), from true north, clockwise
  double altitude_geometric =
      0;  // radians above the horizon, the sun's centre, without refraction (topocentric)
  double altitude_apparent =
      0;  // with refraction; equals the geometric one below the horizon's refraction limit
  double declination = 0;  // radians, topocentric
  double hour_angle =
      0;  // radians in (-pi, pi], topocentric; 0 at true noon, positive in the afternoon
  double equation_of_time = 0;  // radians of rotation: true minus mean solar time (2 pi = a day)
};

// TT - UT1 in seconds (delta T): polynomials of Espenak and Meeus with Espenak's revision of
// 2014. 2.3 s above the measured value in 2024, which moves the sun by 0.00003 degrees.
double delta_t(Instant t);

// `delta_t_seconds`: empty takes delta_t(t).
SunPosition sun_position(Instant t, const Place& place, const Atmosphere& air = {},
                         std::optional<double> delta_t_seconds = {});

// Unit vector towards the (apparent) sun in scene coordinates, [x east, y grid north, z up], for a
// scene whose true north lies `true_north` radians clockwise of +y (Frame::true_north).
Vec4 sun_direction(const SunPosition& sun, double true_north);

// Sunrise, transit and sunset of the UTC day that `day` falls on (empty: the sun does not rise or
// set that day; of two, minutes after the day's beginning and before its end, one is given).
struct SunDay {
  std::optional<Instant> sunrise, sunset;
  Instant transit;
  bool polar_day = false;    // up all day
  bool polar_night = false;  // down all day
};

// Rises and sets where the upper limb touches the refracted horizon: the centre's altitude is
// -0.8333 degrees (Atmosphere::horizon_refraction + 16' of the sun's radius). The publication's
// appendix A.2: seen from the Earth's centre and with one correction of a first guess, so that it
// matches NREL's tables to the second; docs/sun.md says how far it is from the instant at which
// sun_position() has that altitude (a second below 50 degrees of latitude, minutes on the last days
// before and after a polar day or night).
SunDay sun_day(std::chrono::sys_days day, const Place& place, const Atmosphere& air = {},
               std::optional<double> delta_t_seconds = {});

// The transit nearest to `noon`, the sunrise before it and the sunset after it, whatever UTC days
// they fall on: the daylight of one local day. Otherwise as sun_day; where sun_day finds the same
// event, the same value.
SunDay sun_arc(Instant noon, const Place& place, const Atmosphere& air = {},
               std::optional<double> delta_t_seconds = {});

}  // namespace gnomon
