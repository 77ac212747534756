// Local clocks and UTC. The zone is an IANA name ("Europe/Vienna"), "UTC", or "solar": true solar
// time at the place, on which the sun's topocentric hour angle is (clock - 12 h) * 15 degrees.
#pragma once

#include <chrono>
#include <string>

#include <gnomon/core/place.h>
#include <gnomon/core/result.h>

namespace gnomon {

// What a local clock and calendar show, to the millisecond.
using ClockTime = std::chrono::local_time<std::chrono::milliseconds>;

struct ClockInstant {
  Instant utc;  // the earlier one of two; the first instant after the gap for a skipped reading
  bool ambiguous = false;  // the clock shows this reading twice (turned back in autumn)
  bool skipped = false;    // the clock never shows it (turned forward in spring)
};

// Errors: no zone given, unknown zone, no time zone database on this machine. Years after 2037
// follow the rules of the last tabulated years. `place` matters to "solar" alone.
Result<ClockInstant> clock_to_utc(const std::string& zone, const Place& place, ClockTime clock);

// Same errors.
Result<ClockTime> utc_to_clock(const std::string& zone, const Place& place, Instant utc);

// ISO 8601: "2024-09-18T07:00:00Z", with ".125" where there are milliseconds; the clock's without
// the Z.
std::string iso_text(Instant utc);
std::string iso_text(ClockTime clock);

}  // namespace gnomon
