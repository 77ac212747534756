// Sunrise, transit and sunset: appendix A.2 of NREL/TP-560-34302 (see spa.h). The sun's right
// ascension and declination are interpolated over three days; one correction is applied to a first
// guess. m and the results are fractions of a day since 0 UT; angles are degrees, as in the
// publication.
#include <cmath>

#include <gnomon/sun/spa.h>
#include <gnomon/sun/sun.h>

namespace gnomon {

namespace {

using std::chrono::days;
using std::chrono::sys_days;

enum class Event { kTransit, kRise, kSet };

double to_degrees(double radians) { return radians / kDegree; }
double wrap_180(double degrees) { return to_degrees(spa::wrap_half_turn(degrees * kDegree)); }
double fraction(double m) { return m - std::floor(m); }

// What A.2.1 and A.2.2 compute for a UTC day.
struct DaySky {
  double sidereal_time = 0;  // at 0 UT, degrees
  double
      right_ascension[3];  // at 0 TT of the day before, the day, the day after; degrees, continuous
  double declination[3];   // degrees
  double delta_t_days = 0;
  double latitude = 0;   // radians
  double longitude = 0;  // degrees
  double altitude = 0;   // [h0'] of the sun's centre at rise and set, degrees
};

DaySky day_sky(sys_days day, const Place& place, const Atmosphere& air, double delta_t_seconds) {
  const double jd = spa::julian_day(day);
  DaySky sky;
  sky.sidereal_time = to_degrees(spa::geocentric(jd, delta_t_seconds).sidereal_time);
  for (int i = 0; i < 3; ++i) {
    const spa::Geocentric g = spa::geocentric(jd + (i - 1), 0.0);
    sky.right_ascension[i] = to_degrees(g.right_ascension);
    sky.declination[i] = to_degrees(g.declination);
  }
  for (int i : {0, 2})
    sky.right_ascension[i] =
        sky.right_ascension[1] + wrap_180(sky.right_ascension[i] - sky.right_ascension[1]);
  sky.delta_t_days = delta_t_seconds / 86400;
  sky.latitude = place.latitude;
  sky.longitude = to_degrees(place.longitude);
  sky.altitude = -to_degrees(spa::kSunRadius + air.horizon_refraction);
  return sky;
}

// Values at n days after 0 TT of the middle one of three days.
double interpolate(const double (&v)[3], double n) {
  const double a = v[1] - v[0], b = v[2] - v[1];
  return v[1] + n * (a + b + (b - a) * n) / 2;
}

// A.2.3: first guess of the transit, in [0, 1).
double guess_transit(const DaySky& sky) {
  return fraction((sky.right_ascension[1] - sky.longitude - sky.sidereal_time) / 360);
}

// Cosine of the hour angle at rise and set (A.2.4): beyond +-1 the sun stays below or above.
double cos_half_arc(const DaySky& sky) {
  const double delta = sky.declination[1] * kDegree;
  return (std::sin(sky.altitude * kDegree) - std::sin(sky.latitude) * std::sin(delta)) /
         (std::cos(sky.latitude) * std::cos(delta));
}

// A.2.8 to A.2.15: the guess m, corrected once.
double correct(const DaySky& sky, double m, Event event) {
  const double n = m + sky.delta_t_days;
  const double alpha = interpolate(sky.right_ascension, n);
  const double delta = interpolate(sky.declination, n) * kDegree;
  const double h = wrap_180(sky.sidereal_time + 360.985647 * m + sky.longitude - alpha);
  if (event == Event::kTransit) return m - h / 360;
  const double altitude =
      to_degrees(std::asin(std::sin(sky.latitude) * std::sin(delta) +
                           std::cos(sky.latitude) * std::cos(delta) * std::cos(h * kDegree)));
  return m + (altitude - sky.altitude) /
                 (360 * std::cos(delta) * std::cos(sky.latitude) * std::sin(h * kDegree));
}

// The event within the day, in [0, 1). A correction that crosses midnight leads to the event of a
// neighbouring day; the day's own one is then a day's guess away. Empty where the day has none,
// because it comes a little earlier or later from day to day.
std::optional<double> within_day(const DaySky& sky, double guess, Event event) {
  for (int shift : {0, 1, -1}) {
    const double m = correct(sky, guess + shift, event);
    if (m >= 0 && m < 1) return m;
  }
  return {};
}

Instant at(sys_days day, double m) {
  return Instant(day) + std::chrono::milliseconds(std::llround(m * 86400000.0));
}

}  // namespace

SunDay sun_day(sys_days day, const Place& place, const Atmosphere& air,
               std::optional<double> delta_t_seconds) {
  const DaySky sky = day_sky(day, place, air, delta_t_seconds.value_or(delta_t(day)));
  const double m0 = guess_transit(sky);
  const double cos_h0 = cos_half_arc(sky);

  SunDay result;
  // A day of the year has no transit within it (it comes up to 30 s later each day); the next day's
  // first one stands for it.
  result.transit =
      at(day, within_day(sky, m0, Event::kTransit).value_or(correct(sky, m0, Event::kTransit)));
  result.polar_day = cos_h0 < -1;
  result.polar_night = cos_h0 > 1;
  if (result.polar_day || result.polar_night) return result;

  const double half_arc = to_degrees(std::acos(cos_h0)) / 360;
  if (const auto m = within_day(sky, fraction(m0 - half_arc), Event::kRise))
    result.sunrise = at(day, *m);
  if (const auto m = within_day(sky, fraction(m0 + half_arc), Event::kSet))
    result.sunset = at(day, *m);
  return result;
}

}  // namespace gnomon
