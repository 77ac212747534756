#include <gnomon/profile/study_times.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include <gnomon/sun/spa.h>
#include <gnomon/sun/time_zone.h>

namespace gnomon {

namespace {

using std::chrono::days;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using std::chrono::year_month_day;

constexpr milliseconds kLongestStep = hours(24);
constexpr std::int64_t kMostSteps = 100000;  // a second's step over a day, and a little more
constexpr int kLastYear = 6000;              // of the sun's algorithm

// The sun's transit on a clock that suits the place: China's reaches 15:10.
constexpr milliseconds kStrangeNoon = hours(5);

// A number of `digits` decimal digits at the front of `text`, which it removes.
std::optional<int> take_number(std::string_view& text, std::size_t digits) {
  if (text.size() < digits) return {};
  int value = 0;
  for (char c : text.substr(0, digits)) {
    if (c < '0' || c > '9') return {};
    value = value * 10 + (c - '0');
  }
  text.remove_prefix(digits);
  return value;
}

bool take(std::string_view& text, std::string_view what) {
  if (!text.starts_with(what)) return false;
  text.remove_prefix(what.size());
  return true;
}

std::optional<year_month_day> read_date(std::string_view text) {
  const auto year = take_number(text, 4);
  if (!year || !take(text, "-")) return {};
  const auto month = take_number(text, 2);
  if (!month || !take(text, "-")) return {};
  const auto day = take_number(text, 2);
  if (!day || !text.empty() || *year < 1 || *year > kLastYear) return {};
  const year_month_day date{std::chrono::year(*year),
                            std::chrono::month(static_cast<unsigned>(*month)),
                            std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return {};
  return date;
}

// Time since the clock's midnight, up to 24:00.
std::optional<milliseconds> read_clock(std::string_view text) {
  // "9:00" is what people write.
  const std::size_t digits = text.size() > 1 && text[1] == ':' ? 1 : 2;
  const auto hour = take_number(text, digits);
  if (!hour || !take(text, ":")) return {};
  const auto minute = take_number(text, 2);
  if (!minute || *minute > 59) return {};
  int second = 0;
  if (take(text, ":")) {
    const auto given = take_number(text, 2);
    if (!given || *given > 59) return {};
    second = *given;
  }
  if (!text.empty()) return {};
  const milliseconds time = hours(*hour) + minutes(*minute) + seconds(second);
  if (time > hours(24)) return {};
  return time;
}

// "1h30min", "90s": whole numbers with units, largest first; positive.
std::optional<milliseconds> read_step(std::string_view text) {
  struct Unit {
    std::string_view name;
    milliseconds length;
  };
  constexpr Unit units[] = {
      {"h", hours(1)}, {"min", minutes(1)}, {"m", minutes(1)}, {"s", seconds(1)}};
  milliseconds sum{0}, last = kLongestStep + milliseconds(1);
  while (!text.empty()) {
    int count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    // A million of the largest unit is far beyond what is accepted, and far from an overflow.
    if (error != std::errc() || count < 0 || count > 1000000) return {};
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    const Unit* unit = std::find_if(std::begin(units), std::end(units),
                                    [&](const Unit& u) { return take(text, u.name); });
    if (unit == std::end(units) || unit->length >= last) return {};
    sum += count * unit->length;
    last = unit->length;
  }
  if (sum <= milliseconds(0)) return {};
  return sum;
}

// For messages.
std::string on_clock(ClockTime clock, const std::string& zone) {
  return iso_text(clock) + " " + zone;
}

struct Date {
  year_month_day date;
  LocalDay day;
};

Result<Date> find_day(const std::string& text, const std::string& zone, const Place& place,
                      const Atmosphere& air) {
  if (text.empty()) return Error{"no date given: add --date YYYY-MM-DD"};
  const auto date = read_date(text);
  if (!date)
    return Error{
        "the date '" + text +
        "' cannot be read: write YYYY-MM-DD with a day that exists, between the years 0001 and " +
        std::to_string(kLastYear)};

  const ClockTime midnight{std::chrono::sys_days{*date}.time_since_epoch()};
  const Result<ClockInstant> begin = clock_to_utc(zone, place, midnight);
  if (!begin) return begin.error();
  const Result<ClockInstant> end = clock_to_utc(zone, place, midnight + days(1));
  if (!end) return end.error();

  LocalDay day;
  day.begin = begin.value().utc;
  day.end = end.value().utc;
  // The middle of the clock's day: half way between its ends, also where the clock is changed in
  // between.
  const Instant noon = day.begin + (day.end - day.begin) / 2;
  day.arc = sun_arc(noon, place, air);
  day.sun.transit = day.arc.transit;
  // A day in which the sun sets after midnight begins with the sunset of the day before.
  for (const Instant near : {noon, noon - days(1), noon + days(1)}) {
    const SunDay arc = near == noon ? day.arc : sun_arc(near, place, air);
    const auto within = [&](const std::optional<Instant>& t) {
      return t && *t >= day.begin && *t < day.end;
    };
    if (!day.sun.sunrise && within(arc.sunrise)) day.sun.sunrise = arc.sunrise;
    if (!day.sun.sunset && within(arc.sunset)) day.sun.sunset = arc.sunset;
  }
  if (!day.sun.sunrise && !day.sun.sunset) {
    const double rises_at = -(spa::kSunRadius + air.horizon_refraction);
    day.sun.polar_day = sun_position(day.arc.transit, place, air).altitude_geometric > rises_at;
    day.sun.polar_night = !day.sun.polar_day;
  }
  return Date{*date, day};
}

// One end of the window. `text` is the clock's reading or empty, `event` the sunrise or sunset that
// an empty one means, `bound` the day's end that stands for it where there is none.
struct End {
  const char* option;
  const std::string& text;
  std::optional<Instant> event;
  Instant bound;
};

struct FoundEnd {
  Instant utc;
  ClockTime clock;  // as given, not by way of UTC and its rounding
};

Result<FoundEnd> find_end(const End& end, const Date& date, const StudyTimes& times,
                          const Place& place, Warnings& warnings) {
  const bool is_from = std::string_view(end.option) == "--from";
  if (end.text.empty()) {
    if (end.event) return FoundEnd{*end.event, utc_to_clock(times.zone, place, *end.event).value()};
    if (date.day.arc.polar_night || date.day.sun.polar_night)
      return Error{"the sun does not rise on " + times.date +
                   " at this place: choose another date, or give --from and --to"};
    warn(warnings,
         is_from
             ? "the sun does not rise on this date, it is already up: the window begins at 00:00"
             : "the sun does not set on this date: the window ends at 24:00",
         times.date);
    return FoundEnd{end.bound, utc_to_clock(times.zone, place, end.bound).value()};
  }

  const auto time = read_clock(end.text);
  if (!time)
    return Error{std::string(end.option) + " '" + end.text +
                 "' cannot be read: write HH:MM or HH:MM:SS, 00:00 to 24:00"};
  const ClockTime clock{std::chrono::sys_days{date.date}.time_since_epoch() + *time};
  const Result<ClockInstant> found = clock_to_utc(times.zone, place, clock);
  if (!found) return found.error();
  const Instant utc = found.value().utc;
  if (found.value().skipped) {
    const ClockTime next = utc_to_clock(times.zone, place, utc).value();
    // A day's beginning or end is a fact, whatever the clock shows then.
    if (*time == milliseconds(0) || *time == hours(24)) {
      warn(warnings, "the clock skips this midnight: the first instant after it is taken",
           on_clock(next, times.zone));
      return FoundEnd{utc, clock};
    }
    return Error{"the local time " + on_clock(clock, times.zone) + " given with " + end.option +
                 " does not exist: the clock is put forward there; take " +
                 iso_text(next).substr(11) + " or later"};
  }
  if (found.value().ambiguous)
    warn(warnings,
         "the clock shows this local time twice (it is put back there): the earlier one is taken; "
         "a UTC time has no such doubt (--tz UTC)",
         on_clock(clock, times.zone));
  return FoundEnd{utc, clock};
}

}  // namespace

Result<LocalDay> local_day(const std::string& date, const std::string& zone, const Place& place,
                           const Atmosphere& air) {
  const Result<Date> found = find_day(date, zone, place, air);
  if (!found) return found.error();
  return found.value().day;
}

Result<StudyWindow> study_window(const StudyTimes& times, const Place& place,
                                 const Atmosphere& air) {
  const auto step = read_step(times.every);
  if (!step)
    return Error{"the step '" + times.every +
                 "' cannot be read: write whole numbers with units, as 1h, 30min, 90s or 1h30min, "
                 "more than zero"};
  if (*step > kLongestStep) return Error{"the step '" + times.every + "' is too long: at most 24h"};

  const Result<Date> found = find_day(times.date, times.zone, place, air);
  if (!found) return found.error();
  const Date& date = found.value();

  StudyWindow window;
  const End from{"--from", times.from, date.day.arc.sunrise, date.day.begin};
  const Result<FoundEnd> begin = find_end(from, date, times, place, window.warnings);
  if (!begin) return begin.error();
  const End to{"--to", times.to, date.day.arc.sunset, date.day.end};
  const Result<FoundEnd> end = find_end(to, date, times, place, window.warnings);
  if (!end) return end.error();
  window.begin = begin.value().utc;
  window.end = end.value().utc;
  if (window.begin >= window.end)
    return Error{"the window is empty: it begins at " + iso_text(window.begin) + " and ends at " +
                 iso_text(window.end) + "; give --from earlier than --to, on the date's own clock"};

  const bool solar = times.zone == "solar";
  const milliseconds length =
      solar ? end.value().clock - begin.value().clock : window.end - window.begin;
  const bool remainder = length % *step != milliseconds(0);
  const std::int64_t steps = length / *step + (remainder ? 1 : 0);
  if (steps > kMostSteps)
    return Error{"the step '" + times.every + "' cuts the window into more than " +
                 std::to_string(kMostSteps) + " steps: give a longer --every"};
  window.edges.push_back(window.begin);
  for (std::int64_t k = 1; k < steps; ++k) {
    const milliseconds passed = k * *step;
    window.edges.push_back(
        solar ? clock_to_utc(times.zone, place, begin.value().clock + passed).value().utc
              : window.begin + passed);
  }
  window.edges.push_back(window.end);
  if (remainder)
    warn(window.warnings, "the window is not a whole number of steps: the last step is shorter",
         times.every);

  const Instant noon = date.day.begin + (date.day.end - date.day.begin) / 2;
  if (times.zone != "UTC" && std::chrono::abs(date.day.arc.transit - noon) > kStrangeNoon)
    warn(window.warnings,
         "the sun is highest more than 5 hours from 12:00 on this clock: check --tz and the "
         "place's longitude",
         times.zone);
  return window;
}

Result<Samples> study_samples(const StudyTimes& times, const Place& place, double true_north,
                              const Atmosphere& air) {
  const Result<StudyWindow> found = study_window(times, place, air);
  if (!found) return found.error();
  const StudyWindow& window = found.value();

  Samples samples;
  samples.begin = window.begin;
  samples.end = window.end;
  samples.warnings = window.warnings;
  const auto sample = [&](Instant utc, milliseconds weight) {
    TimeSample s;
    s.utc = utc;
    s.weight_ms = static_cast<std::uint32_t>(weight.count());
    s.sun = sun_position(utc, place, air);
    s.light = sun_direction(s.sun, true_north);
    s.up = s.sun.altitude_apparent > 0;
    return s;
  };
  std::size_t nights = 0;
  std::string first_night;
  for (std::size_t k = 0; k + 1 < window.edges.size(); ++k) {
    const Instant t = window.edges[k];
    const milliseconds length = window.edges[k + 1] - t;
    samples.midpoints.push_back(sample(t + length / 2, length));
    samples.instants.push_back(sample(t, milliseconds(0)));
    const TimeSample& middle = samples.midpoints.back();
    if (!middle.up && nights++ == 0) first_night = iso_text(middle.utc);
  }
  samples.instants.push_back(sample(window.end, milliseconds(0)));
  warn(samples.warnings,
       "the sun is below the horizon in the middle of this step: the step contributes nothing",
       first_night, nights);
  return samples;
}

}  // namespace gnomon
