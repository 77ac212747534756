#include <gnomon/profile/study_times.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include <gnomon/profile/study_dates.h>
#include <gnomon/profile/take.h>
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
// A second's step over a day, and a little more; five minutes over a year.
constexpr std::int64_t kMostSteps = 100000;

// The sun's transit on a clock that suits the place: China's reaches 15:10.
constexpr milliseconds kStrangeNoon = minutes(210);

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

// For messages: "2024-06-10 17:00:00 Europe/Vienna".
std::string on_clock(ClockTime clock, const std::string& zone) {
  std::string text = iso_text(ClockTime(std::chrono::round<seconds>(clock)));
  text[text.find('T')] = ' ';
  return text + " " + (zone == "solar" ? "true solar time" : zone);
}

struct Date {
  year_month_day date;
  LocalDay day;
};

Result<Date> find_day(const std::string& text, const std::string& zone, const Place& place,
                      const Atmosphere& air) {
  if (text.empty()) return Error{"no date given: add --date YYYY-MM-DD"};
  const auto date = read_date(text);
  if (!date && text.find("..") != std::string::npos)
    return Error{"'" + text + "' is a range of dates where one date is wanted: write YYYY-MM-DD"};
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

// Sets `night` where the error is that the sun does not rise.
Result<FoundEnd> find_end(const End& end, const Date& date, const StudyTimes& times,
                          const Place& place, Warnings& warnings, bool& night) {
  const bool is_from = std::string_view(end.option) == "--from";
  if (end.text.empty()) {
    if (end.event) return FoundEnd{*end.event, utc_to_clock(times.zone, place, *end.event).value()};
    if (date.day.arc.polar_night || date.day.sun.polar_night) {
      night = true;
      return Error{"the sun does not rise on " + times.date +
                   " at this place: choose another date, or give --from and --to"};
    }
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

struct DayWindow {
  year_month_day date;
  StudyWindow window;
};

// The window and its day. Sets `night` where the error is that the sun does not rise.
Result<DayWindow> day_window(const StudyTimes& times, const Place& place, const Atmosphere& air,
                             bool& night) {
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
  const Result<FoundEnd> begin = find_end(from, date, times, place, window.warnings, night);
  if (!begin) return begin.error();
  const End to{"--to", times.to, date.day.arc.sunset, date.day.end};
  const Result<FoundEnd> end = find_end(to, date, times, place, window.warnings, night);
  if (!end) return end.error();
  window.begin = begin.value().utc;
  window.end = end.value().utc;
  if (window.begin >= window.end)
    return Error{"the window is empty: it begins at " + on_clock(begin.value().clock, times.zone) +
                 " and ends at " + on_clock(end.value().clock, times.zone) +
                 "; give --from earlier than --to, on the date's own clock"};

  const bool solar = times.zone == "solar";
  const milliseconds length =
      solar ? end.value().clock - begin.value().clock : window.end - window.begin;
  const bool remainder = length % *step != milliseconds(0);
  const std::int64_t steps = length / *step + (remainder ? 1 : 0);
  if (steps > kMostSteps)
    return Error{"the step '" + times.every + "' cuts the window into more than " +
                 std::to_string(kMostSteps) + " steps: give a longer --every"};
  const auto edge = [&](Instant utc, ClockTime clock) {
    window.edges.push_back(utc);
    window.clocks.push_back(clock);
  };
  edge(window.begin, begin.value().clock);
  for (std::int64_t k = 1; k < steps; ++k) {
    const milliseconds passed = k * *step;
    if (solar) {
      const ClockTime clock = begin.value().clock + passed;
      edge(clock_to_utc(times.zone, place, clock).value().utc, clock);
    } else {
      const Instant utc = window.begin + passed;
      edge(utc, utc_to_clock(times.zone, place, utc).value());
    }
  }
  edge(window.end, end.value().clock);
  // From sunrise or to sunset it hardly ever is.
  if (remainder && !times.from.empty() && !times.to.empty())
    warn(window.warnings, "the window is not a whole number of steps: the last step is shorter",
         times.every);

  const Instant noon = date.day.begin + (date.day.end - date.day.begin) / 2;
  if (times.zone != "UTC" && std::chrono::abs(date.day.arc.transit - noon) > kStrangeNoon)
    warn(window.warnings,
         "the sun is highest more than 3.5 hours from 12:00 on this clock: check --tz and the "
         "place's longitude",
         times.zone);
  return DayWindow{date.date, std::move(window)};
}

// Adds the steps of the study's `day`-th date.
void add_day(Samples& samples, const DayWindow& on, std::size_t day, const Place& place,
             const std::string& zone, double true_north, const Atmosphere& air) {
  const StudyWindow& window = on.window;
  if (samples.midpoints.empty()) samples.begin = window.begin;
  samples.end = window.end;
  append(samples.warnings, window.warnings);
  const ClockTime midnight{std::chrono::sys_days{on.date}.time_since_epoch()};
  const auto on_clock_ms = [&](std::size_t edge) {
    return static_cast<std::int32_t>((window.clocks[edge] - midnight).count());
  };
  const auto sample = [&](Instant utc, milliseconds weight, std::size_t first, std::size_t last) {
    TimeSample s;
    s.utc = utc;
    s.weight_ms = static_cast<std::uint32_t>(weight.count());
    s.day = static_cast<std::uint32_t>(day);
    s.clock_begin_ms = on_clock_ms(first);
    s.clock_end_ms = on_clock_ms(last);
    s.sun = sun_position(utc, place, air);
    s.light = sun_direction(s.sun, true_north);
    s.up = s.sun.altitude_apparent > 0;
    return s;
  };
  std::size_t nights = 0;
  std::string first_night;
  const std::size_t steps = window.edges.size() - 1;
  for (std::size_t k = 0; k < steps; ++k) {
    const Instant t = window.edges[k];
    const milliseconds length = window.edges[k + 1] - t;
    samples.midpoints.push_back(sample(t + length / 2, length, k, k + 1));
    samples.instants.push_back(sample(t, milliseconds(0), k, k));
    const TimeSample& middle = samples.midpoints.back();
    if (!middle.up && nights++ == 0)
      first_night = on_clock(utc_to_clock(zone, place, middle.utc).value(), zone);
  }
  samples.instants.push_back(sample(window.end, milliseconds(0), steps, steps));
  warn(samples.warnings,
       "the sun is down in the middle of a step: the step counts as night, neither as sun nor as "
       "shadow; the last one before sunset often does",
       first_night, nights);
}

}  // namespace

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

Result<LocalDay> local_day(const std::string& date, const std::string& zone, const Place& place,
                           const Atmosphere& air) {
  const Result<Date> found = find_day(date, zone, place, air);
  if (!found) return found.error();
  return found.value().day;
}

Result<StudyWindow> study_window(const StudyTimes& times, const Place& place,
                                 const Atmosphere& air) {
  bool night = false;
  Result<DayWindow> found = day_window(times, place, air, night);
  if (!found) return found.error();
  return std::move(found).value().window;
}

Result<Samples> study_samples(const StudyTimes& times, const Place& place, double true_north,
                              const Atmosphere& air) {
  Result<std::vector<std::string>> dates = study_dates(times.date);
  if (!dates) return dates.error();
  Samples samples;
  samples.dates = std::move(dates).value();
  StudyTimes of_day = times;
  for (std::size_t k = 0; k < samples.dates.size(); ++k) {
    of_day.date = samples.dates[k];
    bool night = false;
    const Result<DayWindow> found = day_window(of_day, place, air, night);
    if (!found) {
      if (!night || samples.dates.size() == 1) return found.error();
      warn(samples.warnings,
           "the sun does not rise on this date: it counts as a day without daylight", of_day.date);
      continue;
    }
    add_day(samples, found.value(), k, place, times.zone, true_north, air);
    if (static_cast<std::int64_t>(samples.midpoints.size()) > kMostSteps)
      return Error{"the step '" + times.every + "' cuts the dates '" + times.date +
                   "' into more than " + std::to_string(kMostSteps) +
                   " steps: give a longer --every, or take every 7th day (/7d)"};
  }
  if (samples.midpoints.empty())
    return Error{"the sun does not rise on any day of " + times.date +
                 " at this place: choose other dates, or give --from and --to"};
  return samples;
}

}  // namespace gnomon
