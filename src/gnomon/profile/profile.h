// How long each sample is in shadow: masks and weights added up. Sums are whole milliseconds, so
// the result does not depend on the order of additions or the number of threads.
#pragma once

#include <cstdint>
#include <vector>

namespace gnomon {

struct Profile {
  int width = 0, height = 0;  // samples; row-major, row 0 at the top
  std::vector<std::uint32_t>
      shadow_ms;  // milliseconds in shadow while the sun was up; 0 where there is no sample
  std::vector<std::uint8_t> valid;  // 1 where there is a sample
  std::uint32_t daylight_ms =
      0;  // milliseconds of the window in which the sun was above the horizon
};

// Hours of sample k. Precondition: valid[k].
inline double shadow_hours(const Profile& p, std::size_t k) { return p.shadow_ms[k] / 3.6e6; }
inline double sun_hours(const Profile& p, std::size_t k) {
  return (p.daylight_ms - p.shadow_ms[k]) / 3.6e6;
}

}  // namespace gnomon
