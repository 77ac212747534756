#include <cmath>

#include <gnomon/sun/spa.h>
#include <gnomon/sun/spa_tables.h>

namespace gnomon::spa {

namespace {

constexpr double kJ2000 = 2451545.0;           // Julian day of 2000-01-01 12:00
constexpr double kDaysPerCentury = 36525.0;    // Julian
constexpr double kArcSecond = kDegree / 3600;  // radians

// c0 + c1 t + c2 t^2 + ...
template <std::size_t N>
double polynomial(const double (&c)[N], double t) {
  double sum = 0;
  for (std::size_t i = N; i-- > 0;) sum = sum * t + c[i];
  return sum;
}

// (S0 + S1 t + S2 t^2 + ...) / 1e8 with Si the sum of the i-th table's terms.
template <std::size_t N>
double series(const std::span<const Term> (&tables)[N], double millennia) {
  double sums[N];
  for (std::size_t i = 0; i < N; ++i) {
    sums[i] = 0;
    for (const Term& term : tables[i]) sums[i] += term.a * std::cos(term.b + term.c * millennia);
  }
  return polynomial(sums, millennia) * 1e-8;
}

struct Nutation {
  double longitude = 0, obliquity = 0;  // radians
};

Nutation nutation(double centuries) {
  // X0..X4, degrees.
  const double x[5] = {polynomial({297.85036, 445267.111480, -0.0019142, 1.0 / 189474}, centuries),
                       polynomial({357.52772, 35999.050340, -0.0001603, -1.0 / 300000}, centuries),
                       polynomial({134.96298, 477198.867398, 0.0086972, 1.0 / 56250}, centuries),
                       polynomial({93.27191, 483202.017538, -0.0036825, 1.0 / 327270}, centuries),
                       polynomial({125.04452, -1934.136261, 0.0020708, 1.0 / 450000}, centuries)};
  Nutation sum;
  for (const NutationTerm& term : kNutation) {
    double argument = 0;
    for (int i = 0; i < 5; ++i) argument += term.y[i] * x[i];
    argument *= kDegree;
    sum.longitude += (term.a + term.b * centuries) * std::sin(argument);
    sum.obliquity += (term.c + term.d * centuries) * std::cos(argument);
  }
  sum.longitude *= 1e-4 * kArcSecond;
  sum.obliquity *= 1e-4 * kArcSecond;
  return sum;
}

// Mean obliquity of the ecliptic, radians.
double mean_obliquity(double millennia) {
  return polynomial({84381.448, -4680.93, -1.55, 1999.25, -51.38, -249.67, -39.05, 7.12, 27.87,
                     5.79, 2.45},
                    millennia / 10) *
         kArcSecond;
}

// Mean sidereal time at Greenwich, radians, unwrapped.
double mean_sidereal_time(double jd) {
  const double t = (jd - kJ2000) / kDaysPerCentury;
  return (280.46061837 + 360.98564736629 * (jd - kJ2000) + t * t * (0.000387933 - t / 38710000)) *
         kDegree;
}

// Mean longitude of the sun, radians, unwrapped.
double mean_longitude(double millennia) {
  return polynomial(
             {280.4664567, 360007.6982779, 0.03032028, 1.0 / 49931, -1.0 / 15300, -1.0 / 2000000},
             millennia) *
         kDegree;
}

}  // namespace

double wrap_turn(double angle) {
  const double wrapped = angle - 2 * kPi * std::floor(angle / (2 * kPi));
  return wrapped < 2 * kPi ? wrapped : 0.0;  // a tiny negative angle rounds up to a whole turn
}

double wrap_half_turn(double angle) {
  const double wrapped = wrap_turn(angle);
  return wrapped > kPi ? wrapped - 2 * kPi : wrapped;
}

double julian_day(Instant t) {
  constexpr double unix_epoch = 2440587.5;
  return unix_epoch + static_cast<double>(t.time_since_epoch().count()) / 86400000.0;
}

Geocentric geocentric(double jd, double delta_t) {
  const double centuries = (jd + delta_t / 86400 - kJ2000) / kDaysPerCentury;
  const double millennia = centuries / 10;

  Geocentric g;
  g.julian_day = jd;
  g.heliocentric_longitude = wrap_turn(series(kL, millennia));
  g.heliocentric_latitude = series(kB, millennia);
  g.distance = series(kR, millennia);

  const Nutation nut = nutation(centuries);
  g.nutation_longitude = nut.longitude;
  g.nutation_obliquity = nut.obliquity;
  g.obliquity = mean_obliquity(millennia) + nut.obliquity;

  const double aberration = -20.4898 * kArcSecond / g.distance;
  g.apparent_longitude = wrap_turn(g.heliocentric_longitude + kPi + nut.longitude + aberration);
  const double latitude = -g.heliocentric_latitude;
  g.sidereal_time = wrap_turn(mean_sidereal_time(jd) + nut.longitude * std::cos(g.obliquity));

  const double sin_l = std::sin(g.apparent_longitude), cos_l = std::cos(g.apparent_longitude);
  const double sin_e = std::sin(g.obliquity), cos_e = std::cos(g.obliquity);
  g.right_ascension = wrap_turn(std::atan2(sin_l * cos_e - std::tan(latitude) * sin_e, cos_l));
  g.declination = std::asin(std::sin(latitude) * cos_e + std::cos(latitude) * sin_e * sin_l);

  g.equation_of_time = wrap_half_turn(mean_longitude(millennia) - 0.0057183 * kDegree -
                                      g.right_ascension + nut.longitude * cos_e);
  return g;
}

Topocentric topocentric(const Geocentric& sun, const Place& place) {
  constexpr double flattening = 0.99664719;      // polar over equatorial radius
  constexpr double equatorial_radius = 6378140;  // metres

  const double phi = place.latitude;
  const double u = std::atan(flattening * std::tan(phi));
  const double x = std::cos(u) + place.height / equatorial_radius * std::cos(phi);
  const double y = flattening * std::sin(u) + place.height / equatorial_radius * std::sin(phi);

  Topocentric t;
  const double h = sun.sidereal_time + place.longitude - sun.right_ascension;
  t.hour_angle_geocentric = wrap_half_turn(h);
  t.parallax = 8.794 * kArcSecond / sun.distance;
  const double sin_xi = std::sin(t.parallax);
  const double toward = std::cos(sun.declination) - x * sin_xi * std::cos(h);
  const double shift = std::atan2(-x * sin_xi * std::sin(h), toward);  // [delta alpha]
  t.right_ascension = wrap_turn(sun.right_ascension + shift);
  t.declination = std::atan2((std::sin(sun.declination) - y * sin_xi) * std::cos(shift), toward);
  t.hour_angle = wrap_half_turn(h - shift);

  const Horizontal position = horizontal(phi, t.declination, t.hour_angle);
  t.altitude = position.altitude;
  t.azimuth = position.azimuth;
  return t;
}

Horizontal horizontal(double latitude, double declination, double hour_angle) {
  const double sin_phi = std::sin(latitude), cos_phi = std::cos(latitude);
  const double sin_d = std::sin(declination), cos_d = std::cos(declination);
  // Up, and south and west in the horizon's plane. The altitude by atan2: asin loses half its
  // digits near the zenith.
  const double up = sin_phi * sin_d + cos_phi * cos_d * std::cos(hour_angle);
  const double south = sin_phi * cos_d * std::cos(hour_angle) - cos_phi * sin_d;
  const double west = cos_d * std::sin(hour_angle);
  return {std::atan2(up, std::hypot(south, west)), wrap_turn(std::atan2(west, south) + kPi)};
}

double refraction(double altitude, const Atmosphere& air) {
  if (altitude < -(kSunRadius + air.horizon_refraction)) return 0;
  const double e0 = altitude / kDegree;
  return air.pressure / 1010 * 283 / (273 + air.temperature) * 1.02 /
         (60 * std::tan((e0 + 10.3 / (e0 + 5.11)) * kDegree)) * kDegree;
}

}  // namespace gnomon::spa
