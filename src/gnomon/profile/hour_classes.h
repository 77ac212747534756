// Round levels of hours per day, and the classes between them: what isolines and tables share.
#pragma once

#include <algorithm>
#include <cstdint>

#include <gnomon/profile/profile.h>

namespace gnomon {

// Levels are whole multiples of `step_ms` > 0, milliseconds of shadow per day.

// The least ticks of a sample that has `level_ms` of shadow per day, a level not above the
// daylight. Whole numbers: exact.
inline std::uint32_t least_ticks(const Profile& p, std::uint64_t level_ms) {
  const std::uint64_t all_days = level_ms * static_cast<std::uint64_t>(p.days);
  return static_cast<std::uint32_t>((all_days + p.tick_ms - 1) / p.tick_ms);
}

// Levels above 0 that are not above the daylight per day.
inline std::uint64_t levels(const Profile& p, std::uint64_t step_ms) {
  return std::uint64_t{p.daylight_ticks} * p.tick_ms /
         (step_ms * static_cast<std::uint64_t>(p.days));
}

// Classes [0, step), [step, 2 step), ...; the last one ends with the daylight, which it includes.
// At least one.
inline std::uint64_t classes(const Profile& p, std::uint64_t step_ms) {
  const std::uint64_t step = step_ms * static_cast<std::uint64_t>(p.days);
  return std::max<std::uint64_t>(1,
                                 (std::uint64_t{p.daylight_ticks} * p.tick_ms + step - 1) / step);
}

// The class of sample k, of classes(p, step_ms) == `count`.
inline std::uint64_t class_of(const Profile& p, std::size_t k, std::uint64_t step_ms,
                              std::uint64_t count) {
  return std::min(count - 1, std::uint64_t{p.shadow_ticks[k]} * p.tick_ms /
                                 (step_ms * static_cast<std::uint64_t>(p.days)));
}

}  // namespace gnomon
