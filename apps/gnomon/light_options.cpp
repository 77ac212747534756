#include "light_options.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gnomon/core/exact.h>
#include <gnomon/profile/study_times.h>
#include <gnomon/sun/time_zone.h>

#include "commands.h"

namespace gnomon::app {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

// Time since the clock's midnight.
milliseconds parse_clock(const std::string& text) {
  int hour = 0, minute = 0, second = 0, used = 0;
  const char* form = "%2d:%2d%n";
  const bool with_seconds = text.find(':') != text.rfind(':');
  const int read = with_seconds
                       ? std::sscanf(text.c_str(), "%2d:%2d:%2d%n", &hour, &minute, &second, &used)
                       : std::sscanf(text.c_str(), form, &hour, &minute, &used);
  const bool digits = text.find_first_not_of("0123456789:") == std::string::npos;
  const milliseconds time = hours(hour) + minutes(minute) + seconds(second);
  if (read != (with_seconds ? 3 : 2) || !digits || static_cast<std::size_t>(used) != text.size() ||
      minute > 59 || second > 59 || time > hours(24)) {
    throw Failure(fmt::format(
        "--at '{}' cannot be read: write HH:MM or HH:MM:SS, 00:00 to 24:00, on the local clock",
        text));
  }
  return time;
}

std::string clock_text(const std::string& zone, const Place& place, Instant utc) {
  const std::string text = iso_text(take(utc_to_clock(zone, place, utc))).substr(11, 8);
  return text.ends_with(":00") ? text.substr(0, 5) : text;
}

std::string zone_text(const std::string& zone) {
  return zone == "solar" ? "true solar time" : zone;
}

// "18 September 2024"; `date` has been read by local_day() before.
std::string date_text(const std::string& date) {
  static constexpr const char* kMonths[] = {"January",   "February", "March",    "April",
                                            "May",       "June",     "July",     "August",
                                            "September", "October",  "November", "December"};
  return fmt::format("{} {} {}", std::stoi(date.substr(8, 2)),
                     kMonths[std::stoi(date.substr(5, 2)) - 1], date.substr(0, 4));
}

// When the sun is up on that day, for the message that it is not.
std::string daylight_text(const LightOptions& o, const LocalDay& day, const Place& place) {
  const SunDay& sun = day.sun;
  if (sun.polar_night) return "on that day it does not rise at all: choose another date";
  const auto at = [&](Instant utc) { return clock_text(o.zone, place, utc); };
  const std::string clock = zone_text(o.zone);
  if (sun.sunrise && sun.sunset && *sun.sunrise < *sun.sunset) {
    return fmt::format("on that day it is up from {} to {} {}", at(*sun.sunrise), at(*sun.sunset),
                       clock);
  }
  if (sun.sunrise && sun.sunset) {
    return fmt::format("on that day it is up until {} and from {} on, {}", at(*sun.sunset),
                       at(*sun.sunrise), clock);
  }
  if (sun.sunrise)
    return fmt::format("on that day it is up from {} {} on", at(*sun.sunrise), clock);
  if (sun.sunset) return fmt::format("on that day it is up until {} {}", at(*sun.sunset), clock);
  return "its upper limb alone is up all that day";
}

ChosenLight of_instant(const LightOptions& o, const Scene& scene) {
  if (!scene.frame.place) {
    throw Failure(
        "where on Earth is the model? Its file names no coordinate reference system: add --crs "
        "EPSG:..., or --site LAT,LON (degrees) for a model in local metres, or give a --light");
  }
  const Place& place = *scene.frame.place;
  const LocalDay day = take(local_day(o.date, o.zone, place));
  const std::chrono::year_month_day date{std::chrono::year(std::stoi(o.date.substr(0, 4))),
                                         std::chrono::month(std::stoi(o.date.substr(5, 2))),
                                         std::chrono::day(std::stoi(o.date.substr(8, 2)))};
  const ClockTime clock{std::chrono::sys_days{date}.time_since_epoch() + parse_clock(o.at)};
  const ClockInstant found = take(clock_to_utc(o.zone, place, clock));
  if (found.skipped) {
    throw Failure(fmt::format(
        "the local time {} {} does not exist: the clock is put forward there; take {} or later",
        iso_text(clock), o.zone, clock_text(o.zone, place, found.utc)));
  }
  ChosenLight out;
  out.utc = found.utc;
  out.words = fmt::format("{}, {} {}", date_text(o.date), o.at, zone_text(o.zone));
  if (found.ambiguous) {
    warn(out.warnings,
         "the clock shows this local time twice (it is put back there): the earlier one is taken; "
         "a UTC time has no such doubt (--tz UTC)",
         iso_text(clock) + " " + o.zone);
  }
  const SunPosition sun = sun_position(found.utc, place);
  out.azimuth = sun.azimuth;
  out.altitude = sun.altitude_apparent;
  out.altitude_geometric = sun.altitude_geometric;
  out.light = sun_direction(sun, scene.frame.true_north);
  if (!(out.altitude > 0)) {
    throw Failure(
        fmt::format("it is night at {}: the sun's centre is {:.2f} degrees below the horizon; {}",
                    out.words, -out.altitude / kDegree, daylight_text(o, day, place)));
  }
  return out;
}

struct GivenLight {
  Vec3 at{0, 0, 0};
  bool sun = false;
};

GivenLight parse_light(const std::string& text) {
  std::vector<std::string_view> parts;
  for (std::string_view rest = text;;) {
    const std::size_t comma = rest.find(',');
    parts.push_back(rest.substr(0, comma));
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  GivenLight out;
  bool good = parts.size() == 3 || parts.size() == 4;
  for (std::size_t k = 0; good && k < 3; ++k) {
    std::string_view part = parts[k];
    while (part.starts_with(' ')) part.remove_prefix(1);
    while (part.ends_with(' ')) part.remove_suffix(1);
    if (part.starts_with('+')) part.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    good = error == std::errc() && end == part.data() + part.size() && std::isfinite(value);
    out.at[static_cast<int>(k)] = value;
  }
  if (good && parts.size() == 4) {
    out.sun = parts[3] == "sun";
    good = out.sun || parts[3] == "point";
  }
  if (!good) {
    throw Failure(fmt::format(
        "--light '{}' cannot be read: write X,Y,Z or X,Y,Z,point for a light at that place in the "
        "model's coordinates, or X,Y,Z,sun for a direction towards the sun",
        text));
  }
  return out;
}

ChosenLight of_given(const LightOptions& o, const Frame& frame) {
  const GivenLight given = parse_light(o.light);
  ChosenLight out;
  const Vec3 at = given.sun ? given.at : given.at - frame.origin;
  out.light = snapped(given.sun ? direction(at) : point(at));
  for (int k = 0; k < 3; ++k) {
    if (!(std::fabs(out.light[k]) <= kLargestCoordinate)) {
      throw Failure(fmt::format("--light '{}' is too far away: its coordinates reach beyond {:g} m",
                                o.light, kLargestCoordinate));
    }
  }
  const std::string where =
      fmt::format("{:.12g}, {:.12g}, {:.12g}", given.at.x, given.at.y, given.at.z);
  if (!given.sun) {
    out.kind = LightKind::point;
    out.words = "light at " + where;
    return out;
  }
  out.kind = LightKind::sun;
  if (out.light == Light(0, 0, 0, 0)) {
    throw Failure(fmt::format("--light '{}' is no direction: all its components are 0", o.light));
  }
  const Light& d = out.light;
  out.altitude = std::atan2(d.z, std::hypot(d.x, d.y));
  out.azimuth = std::fmod(std::atan2(d.x, d.y) - frame.true_north + 4 * kPi, 2 * kPi);
  out.words = "sun towards " + where;
  if (!(d.z > 0))
    warn(out.warnings, "the sun given with --light is not above the horizon", o.light);
  return out;
}

}  // namespace

void add_light_options(CLI::App& command, LightOptions& options) {
  constexpr const char* kGroup = "Light";
  command.add_option("--date", options.date, "Date on the local calendar, YYYY-MM-DD")
      ->group(kGroup);
  command.add_option("--at", options.at, "Time on the local clock, HH:MM[:SS]")->group(kGroup);
  command
      .add_option("--tz", options.zone,
                  "Clock: an IANA time zone (Europe/Vienna), UTC, or solar (true solar time)")
      ->group(kGroup);
  command
      .add_option(
          "--light", options.light,
          "Instead of an instant: a light at this place in the model's coordinates, z up, or the "
          "direction towards the sun")
      ->type_name("X,Y,Z[,point|sun]")
      ->group(kGroup);
}

void check_light_options(const LightOptions& o) {
  const bool instant = !o.date.empty() || !o.at.empty() || !o.zone.empty();
  if (!o.light.empty()) {
    if (instant) {
      throw Failure(
          "--light cannot be combined with --date, --at and --tz: give one light, or one instant");
    }
    (void)parse_light(o.light);
    return;
  }
  if (!instant) {
    throw Failure(
        "no light given: add an instant, such as --date 2024-09-18 --at 14:00 --tz Europe/Vienna, "
        "or a --light X,Y,Z");
  }
  if (o.date.empty()) {
    throw Failure("no date given: add --date YYYY-MM-DD, such as --date 2024-09-18");
  }
  if (o.at.empty()) throw Failure("no time of day given: add --at HH:MM, such as --at 14:00");
  if (o.zone.empty()) {
    throw Failure(
        "no time zone given: add --tz Europe/Vienna (an IANA name) or --tz solar (true solar "
        "time)");
  }
  (void)parse_clock(o.at);
}

ChosenLight choose_light(const LightOptions& options, const Scene& scene) {
  return options.light.empty() ? of_instant(options, scene) : of_given(options, scene.frame);
}

}  // namespace gnomon::app
