// Where on Earth, and when.
#pragma once

#include <chrono>
#include <cmath>

namespace gnomon {

struct Place {
  double latitude = 0;   // radians, north positive, geographic (WGS 84)
  double longitude = 0;  // radians, east positive
  double height = 0;     // metres above sea level
};

// An instant in UTC, to the millisecond.
using Instant = std::chrono::sys_time<std::chrono::milliseconds>;

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree = kPi / 180.0;  // radians

// Metres along the great circle of a sphere with the Earth's mean radius: within 0.6 %.
inline double distance_between(const Place& a, const Place& b) {
  constexpr double kEarthRadius = 6371008.8;
  const double s = std::sin((a.latitude - b.latitude) / 2),
               t = std::sin((a.longitude - b.longitude) / 2);
  const double h = s * s + std::cos(a.latitude) * std::cos(b.latitude) * t * t;
  return 2 * kEarthRadius * std::asin(std::sqrt(std::fmin(h, 1.0)));
}

}  // namespace gnomon
