// Options for when and where, the same in every command.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <gnomon/core/place.h>
#include <gnomon/core/warnings.h>
#include <gnomon/profile/study_times.h>
#include <CLI/CLI.hpp>

namespace gnomon::app {

struct TimeOptions {
  StudyTimes times;
  std::vector<std::string> dates;  // of a command with several: one study each, as typed
};

// Whether --date takes one date, or dates and ranges of dates, repeated.
enum class Dates { kOne, kSeveral };

// Adds --date (into times.date, or into dates), --from, --to, --every, --tz (group "Time"). What is
// missing or wrong is said by study_samples().
void add_time_options(CLI::App& command, TimeOptions& options, Dates dates);

// Adds --site LAT,LON[,HEIGHT] (group "Place"); to be read by parse_site().
void add_site_option(CLI::App& command, std::string& site);

// "48.2,16.37" or "48.2,16.37,171": degrees (north and east positive) and metres above sea level.
// Empty text: no place. Throws Failure where it cannot be read or is out of range.
std::optional<Place> parse_site(const std::string& text);

}  // namespace gnomon::app
