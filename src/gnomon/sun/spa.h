// The steps of NREL's Solar Position Algorithm, one by one, so that its published example can be
// checked at each of them. Based on: Reda, Andreas, Solar Position Algorithm for Solar Radiation
// Applications, NREL/TP-560-34302, 2003, revised 2008 (corrigendum 2007), section 3 and appendix
// A.1. Angles are radians, wrapped into [0, 2 pi) where they are directions; names follow the
// publication's symbols, given in brackets.
#pragma once

#include <gnomon/core/place.h>
#include <gnomon/sun/sun.h>

namespace gnomon::spa {

// The sun seen from the centre of the Earth.
struct Geocentric {
  double julian_day = 0;              // [JD] days, UT
  double heliocentric_longitude = 0;  // [L] of the Earth
  double heliocentric_latitude = 0;   // [B] of the Earth, small, signed
  double distance = 0;                // [R] astronomical units
  double nutation_longitude = 0;      // [delta psi] signed
  double nutation_obliquity = 0;      // [delta epsilon] signed
  double obliquity = 0;               // [epsilon] true obliquity of the ecliptic
  double apparent_longitude = 0;      // [lambda]
  double sidereal_time = 0;           // [nu] apparent, at Greenwich
  double right_ascension = 0;         // [alpha]
  double declination = 0;             // [delta] signed
  double equation_of_time = 0;        // [E] signed, within half a turn
};

// The sun seen from a place, without refraction.
struct Topocentric {
  double hour_angle_geocentric = 0;  // [H], in (-pi, pi]
  double parallax = 0;               // [xi] equatorial horizontal parallax
  double right_ascension = 0;        // [alpha']
  double declination = 0;            // [delta'] signed
  double hour_angle = 0;             // [H'], in (-pi, pi]
  double altitude = 0;               // [e0] signed
  double azimuth = 0;                // [Phi] from north, clockwise
};

// Julian day of an instant, UTC taken for UT1 (they differ by less than 0.9 s: 0.004 degrees of
// rotation).
double julian_day(Instant t);

// `julian_day` in UT; `delta_t` = TT - UT1 in seconds.
Geocentric geocentric(double julian_day, double delta_t);

Topocentric topocentric(const Geocentric& sun, const Place& place);

// Altitude and azimuth (from north, clockwise, in [0, 2 pi)) of a direction of given declination
// and hour angle (0 in the south, positive westwards) at a latitude. All radians.
struct Horizontal {
  double altitude = 0, azimuth = 0;
};
Horizontal horizontal(double latitude, double declination, double hour_angle);

// Atmospheric refraction [delta e], radians, of a body at geometric altitude `altitude`; 0 once the
// sun's whole disc is below the refracted horizon, where the formula does not hold.
double refraction(double altitude, const Atmosphere& air);

// The sun's radius, the constant of the publication's rise and set (16 arc minutes), radians.
inline constexpr double kSunRadius = 0.26667 * kDegree;

// `angle` (radians) moved by whole turns into [0, 2 pi), or into (-pi, pi].
double wrap_turn(double angle);
double wrap_half_turn(double angle);

}  // namespace gnomon::spa
