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

// A.2.8 to A.2.15: the guess m, corrected once. Empty where the correction of a rise or set leads
// past the transit or the lowest point: the sun only grazes the horizon, and the step, a division
// by the sine of the hour angle, means nothing.
std::optional<double> correct(const DaySky& sky, double m, Event event) {
  const double n = m + sky.delta_t_days;
  const double alpha = interpolate(sky.right_ascension, n);
  const double delta = interpolate(sky.declination, n) * kDegree;
  const double h = wrap_180(sky.sidereal_time + 360.985647 * m + sky.longitude - alpha);
  if (event == Event::kTransit) return m - h / 360;
  const double altitude =
      to_degrees(std::asin(std::sin(sky.latitude) * std::sin(delta) +
                           std::cos(sky.latitude) * std::cos(delta) * std::cos(h * kDegree)));
  const double step = (altitude - sky.altitude) /
                      (360 * std::cos(delta) * std::cos(sky.latitude) * std::sin(h * kDegree));
  const double corrected = (h + 360 * step) * (event == Event::kRise ? -1 : 1);
  if (!(corrected > 0 && corrected < 180)) return {};
  return m + step;
}

// First guesses of the day's events, fractions of the day in [0, 1) (A.2.5, A.2.6); rise and set
// only where |cos_half_arc| <= 1.
double guess(const DaySky& sky, Event event) {
  const double m0 = guess_transit(sky);
  if (event == Event::kTransit) return m0;
  const double half_arc = to_degrees(std::acos(cos_half_arc(sky))) / 360;
  return fraction(event == Event::kRise ? m0 - half_arc : m0 + half_arc);
}

// The event within the day, in [0, 1). A correction that crosses midnight leads to the event of a
// neighbouring day; the day's own one is then a day's guess away. Empty where the day has none,
// because it comes a little earlier or later from day to day.
std::optional<double> within_day(const DaySky& sky, Event event) {
  const double first = guess(sky, event);
  for (int shift : {0, 1, -1}) {
    const std::optional<double> m = correct(sky, first + shift, event);
    if (m && *m >= 0 && *m < 1) return m;
  }
  return {};
}

Instant at(sys_days day, double m) {
  return Instant(day) + std::chrono::milliseconds(std::llround(m * 86400000.0));
}

bool rises_and_sets(const DaySky& sky) { return std::abs(cos_half_arc(sky)) <= 1; }

}  // namespace

SunDay sun_day(sys_days day, const Place& place, const Atmosphere& air,
               std::optional<double> delta_t_seconds) {
  const DaySky sky = day_sky(day, place, air, delta_t_seconds.value_or(delta_t(day)));
  SunDay result;
  // Once a year or so a day has no transit, because it comes up to 30 s later from day to day; the
  // one just outside stands for it.
  const double m0 = *correct(sky, guess(sky, Event::kTransit), Event::kTransit);
  result.transit = at(day, within_day(sky, Event::kTransit).value_or(m0));
  const double cos_h0 = cos_half_arc(sky);
  result.polar_day = cos_h0 < -1;
  result.polar_night = cos_h0 > 1;
  if (!rises_and_sets(sky)) return result;
  if (const auto m = within_day(sky, Event::kRise)) result.sunrise = at(day, *m);
  if (const auto m = within_day(sky, Event::kSet)) result.sunset = at(day, *m);
  return result;
}

SunDay sun_arc(Instant noon, const Place& place, const Atmosphere& air,
               std::optional<double> delta_t_seconds) {
  const double dt = delta_t_seconds.value_or(delta_t(noon));
  const sys_days middle = std::chrono::floor<days>(noon);
  SunDay result;
  for (int d : {0, -1, 1}) {
    const sys_days day = middle + days(d);
    const DaySky sky = day_sky(day, place, air, dt);
    const Instant transit = at(day, *correct(sky, guess(sky, Event::kTransit), Event::kTransit));
    if (d == 0 || std::chrono::abs(transit - noon) < std::chrono::abs(result.transit - noon))
      result.transit = transit;
  }

  const sys_days day = std::chrono::floor<days>(result.transit);
  const DaySky sky = day_sky(day, place, air, dt);
  const double cos_h0 = cos_half_arc(sky);
  result.polar_day = cos_h0 < -1;
  result.polar_night = cos_h0 > 1;
  if (!rises_and_sets(sky)) return result;

  const double m0 = static_cast<double>((result.transit - Instant(day)).count()) / 86400000.0;
  const double half_arc = to_degrees(std::acos(cos_h0)) / 360;
  const auto event = [&](double expected, Event kind) -> std::optional<Instant> {
    // The day on which the event is expected gives the value, so that it is the same as sun_day's.
    const sys_days own = day + days(static_cast<int>(std::floor(expected)));
    const DaySky own_sky = day_sky(own, place, air, dt);
    double m = fraction(expected);
    if (rises_and_sets(own_sky)) {
      const double first = guess(own_sky, kind);
      m = first + std::round(m - first);
    }
    const std::optional<double> corrected = correct(own_sky, m, kind);
    if (!corrected) return {};
    return at(own, *corrected);
  };
  result.sunrise = event(m0 - half_arc, Event::kRise);
  result.sunset = event(m0 + half_arc, Event::kSet);
  return result;
}

}  // namespace gnomon
