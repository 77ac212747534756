#include <gnomon/raster/strip.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <gnomon/raster/polygon.h>

namespace gnomon {
namespace {

constexpr double kSure = kStripMargin / 16;  // pixels, of points and lights
// Flatter sweeps run too far in a row for float.
constexpr double kLargestSlope = 1024;
// Rounding of sums of few terms in double, as a share of their magnitudes.
constexpr double kRoundoff = 16 * kUnitRoundoff;

// f and the numerators of ga and gb.
template <class T>
struct Numerators {
  T f, ga, gb;
};
template <class T>
Numerators<T> numerators(const ScreenPoint<T>& a, const ScreenPoint<T>& b,
                         const ScreenPoint<T>& l) {
  const T x = b.x - a.x, y = b.y - a.y, z = b.z - a.z;
  return {x * l.y - y * l.x, z * l.y - y * l.z, x * l.z - z * l.x};
}

}  // namespace

StripLight strip_light(const ScreenPoint<double>& minus_light, const ScreenPoint<Bound>& point,
                       const ScreenPoint<Bound>& light, double nearness_floor, int width,
                       int height) {
  StripLight s;
  s.l = minus_light;
  s.point = point;
  s.light = light;
  s.nearness_floor = nearness_floor;
  s.width = width;
  s.height = height;
  const Numerators<Bound> n = numerators(point, point, light);
  s.f_error = n.f.error;
  s.ga_error = n.ga.error;
  s.gb_error = n.gb.error;
  s.sinks = -minus_light.z - light.z.error;
  s.inverse_sinks = 1 / s.sinks;
  const double y = std::fabs(minus_light.y) - light.y.error;
  if (!(s.sinks > 0) || !(y > 0) || height > 65535 || width > (1 << 23)) return s;
  s.k = minus_light.x / minus_light.y;
  s.inverse_y = 1 / minus_light.y;
  if (!(std::fabs(s.k) < kLargestSlope)) return s;
  // x + (row - y) k, with all that points and the slope may be off by, over the largest distance.
  const double reach = point.y.magnitude + height;
  const double k_error = (light.x.error + std::fabs(s.k) * light.y.error) / y;
  s.sweep_error = (point.x.error + std::fabs(s.k) * point.y.error + k_error * reach +
                   kRoundoff * (point.x.magnitude + std::fabs(s.k) * reach + width)) *
                  kInflate;
  // A strip's ends, along l as far as anything can be deep.
  const double longest = 2.01 * (point.z.magnitude + nearness_floor) / s.sinks;
  const double unsure =
      std::max(point.x.error, point.y.error) +
      longest * (std::max(light.x.error, light.y.error) +
                 kRoundoff * std::max(std::fabs(minus_light.x), std::fabs(minus_light.y))) +
      s.sweep_error;
  s.usable = unsure < kSure;
  return s;
}

}  // namespace gnomon
