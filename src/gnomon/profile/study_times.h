// From "18 September, 9:00 to 17:00, every hour, Europe/Vienna" to instants, sun positions and
// weights.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gnomon/core/place.h>
#include <gnomon/core/result.h>
#include <gnomon/core/vec.h>
#include <gnomon/core/warnings.h>
#include <gnomon/sun/sun.h>
#include <gnomon/sun/time_zone.h>

namespace gnomon {

struct StudyTimes {
  // "YYYY-MM-DD"; study_samples() takes ranges, too: "2024-04-01..2024-09-30/7d" (study_dates.h).
  std::string date = {};
  std::string from = {};     // "HH:MM[:SS]" on the clock of `zone`; empty: sunrise
  std::string to = {};       // "HH:MM[:SS]"; "24:00" is the end of the day; empty: sunset
  std::string every = "1h";  // "5min", "1h", "90s", "1h30min"
  std::string zone =
      {};  // IANA name ("Europe/Vienna"), "UTC", or "solar" (true solar time). Required.
};

// A length of time such as "1h30min", "5min", "90s": whole numbers with units, largest first.
// Nothing where it cannot be read or is not more than zero.
std::optional<std::chrono::milliseconds> read_step(std::string_view text);

// A date of the local calendar.
struct LocalDay {
  // 0:00 and 24:00 on the clock; a midnight that the clock skips is the first instant after the
  // gap.
  Instant begin, end;
  // The sunrise and sunset that fall between them, and the transit nearest to their middle.
  SunDay sun;
  // That transit, the sunrise before it and the sunset after it, even if beyond midnight.
  SunDay arc;
};

// Errors: no date or an unreadable one, no zone or an unknown one.
Result<LocalDay> local_day(const std::string& date, const std::string& zone, const Place& place,
                           const Atmosphere& air = {});

// A study's window, cut into steps.
struct StudyWindow {
  Instant begin, end;
  std::vector<Instant> edges;  // begin, the edges between the steps, end: ascending, at least two
  std::vector<ClockTime> clocks;  // what the clock shows at the edges; not ascending where it is
                                  // put back
  Warnings warnings;              // e.g. an ambiguous local time, a last step that is shorter
};

// One moment of the study.
struct TimeSample {
  Instant utc;
  std::uint32_t weight_ms = 0;  // length of the step it stands for; 0 for instants
  std::uint32_t day = 0;        // index into Samples::dates
  // Beginning and end of the step (of an instant: itself) on the study's clock, milliseconds after
  // 0:00 of the date; below 0 before that midnight, above 24 h after the next one.
  std::int32_t clock_begin_ms = 0, clock_end_ms = 0;
  SunPosition sun;
  Light light{0, 0, 0, 0};  // towards the apparent sun, scene coordinates, unit length
  bool up = false;          // apparent centre above the horizon; if not, it contributes nothing
};

struct Samples {
  std::vector<std::string> dates;  // of the study, "YYYY-MM-DD", also those without a sunrise
  // The steps' midpoints: what hours are summed over. Day after day.
  std::vector<TimeSample> midpoints;
  // from, from + every, ..., to (both ends) of each day: what pictures of single shadows show.
  std::vector<TimeSample> instants;
  Instant begin, end;  // of the first and last window in UTC
  Warnings warnings;   // e.g. steps with the sun below the horizon, a last shorter step
};

// Steps begin at `from`. They are of elapsed time and do not follow a change of the clock; on the
// solar clock, whose day is up to 30 s longer or shorter than 24 h, they are of solar time. Where
// the sun does not rise or set, an empty `from` or `to` is the beginning or end of the local day,
// with a warning.
//
// Errors: no date, a range of dates, no zone or an unknown one, unreadable date/time/step, from not
// before to, local time that does not exist (spring forward: named), sun down all day and no from
// or to, a step over 24 h, more than 100000 steps. Ambiguous local time (autumn): the earlier one
// is taken, with a warning.
Result<StudyWindow> study_window(const StudyTimes& times, const Place& place,
                                 const Atmosphere& air = {});

// The windows of all dates cut into steps, with the sun's positions. Each date has a window of its
// own, between the same readings of the clock or its own sunrise and sunset; in a range, a date
// without a sunrise has none, with a warning.
// Errors and warnings as study_window, those of dates as study_dates(); no sunrise on any date;
// 100000 steps is the limit for all dates together.
Result<Samples> study_samples(const StudyTimes& times, const Place& place, double true_north,
                              const Atmosphere& air = {});

}  // namespace gnomon
