// Where on Earth, and when.
#pragma once

#include <chrono>

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

}  // namespace gnomon
