// How long each sample is in shadow: masks and weights added up. Sums are whole ticks, so the
// result does not depend on the order of additions or the number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gnomon {

// In Profile::first_lit of a sample that the sun never reaches.
inline constexpr std::uint16_t kNeverLit = 0xffff;

struct Profile {
  int width = 0, height = 0;  // samples; row-major, row 0 at the top
  // Ticks in shadow while the sun was up, summed over all days; 0 where there is no sample.
  std::vector<std::uint32_t> shadow_ticks;
  std::vector<std::uint8_t> valid;   // 1 where there is a sample
  std::uint32_t daylight_ticks = 0;  // of all days, in which the sun was above the horizon
  std::uint32_t tick_ms = 1;         // milliseconds of a tick; see shadow_profile()
  int days = 1;                      // hours are the mean per day over so many days

  // First and last sun, where asked for (else empty): per sample, the index into lit_from_ms of the
  // earliest beginning of a step that lights it (kNeverLit: none does, then last_lit means
  // nothing), and the index into lit_to_ms of the latest end of such a step. By the clock alone:
  // over several days the earliest and the latest of all of them.
  std::vector<std::uint16_t> first_lit, last_lit;
  // Milliseconds after 0:00 of the day on the study's clock, ascending; below 0 before that
  // midnight, above 24 h after the next one.
  std::vector<std::int32_t> lit_from_ms, lit_to_ms;
};

// Hours per day of so many ticks: hours of the day where there is only one.
inline double hours_per_day(const Profile& p, std::uint32_t ticks) {
  return static_cast<double>(ticks) * p.tick_ms / (3.6e6 * p.days);
}
inline double daylight_hours(const Profile& p) { return hours_per_day(p, p.daylight_ticks); }

// Hours of sample k, per day. Precondition: valid[k].
inline double shadow_hours(const Profile& p, std::size_t k) {
  return hours_per_day(p, p.shadow_ticks[k]);
}
inline double sun_hours(const Profile& p, std::size_t k) {
  return hours_per_day(p, p.daylight_ticks - p.shadow_ticks[k]);
}

// Clock time in hours of the first and last sun of sample k: 9.25 is 9:15.
// Precondition: valid[k], first_lit[k] != kNeverLit.
inline double first_sun_clock(const Profile& p, std::size_t k) {
  return p.lit_from_ms[p.first_lit[k]] / 3.6e6;
}
inline double last_sun_clock(const Profile& p, std::size_t k) {
  return p.lit_to_ms[p.last_lit[k]] / 3.6e6;
}

}  // namespace gnomon
