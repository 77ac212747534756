#include <date/tz.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <set>
#include <string_view>

#include <gnomon/core/nearest_names.h>
#include <gnomon/sun/spa.h>
#include <gnomon/sun/sun.h>
#include <gnomon/sun/time_zone.h>

namespace gnomon {

namespace {

using std::chrono::days;
using std::chrono::milliseconds;

constexpr double kMillisecondsPerRadian =
    86400000.0 / (2 * kPi);  // of the Earth's rotation against the sun

milliseconds rotation_time(double radians) {
  return milliseconds(std::llround(radians * kMillisecondsPerRadian));
}

// The system's tables end with 2037. A later date takes the offset of the latest tabulated date
// with the same month, day and day of the week, by which the rules of daylight saving go; the
// function returns the distance to it.
template <class Clock>
days to_tabulated(std::chrono::time_point<Clock, milliseconds> t) {
  const auto day = std::chrono::floor<days>(t);
  const std::chrono::year_month_day date{std::chrono::sys_days{day.time_since_epoch()}};
  constexpr std::chrono::year last{2037};
  if (date.year() <= last) return days(0);
  // 29 February has no equal in every year: the day before it tells.
  const bool leap_day = date.month() == std::chrono::February && date.day() == std::chrono::day(29);
  const days back(leap_day ? 1 : 0);
  const auto month = date.month();
  const auto month_day = leap_day ? std::chrono::day(28) : date.day();
  std::chrono::year year = last;
  for (;; --year) {
    const days distance = std::chrono::sys_days{year / month / month_day}.time_since_epoch() -
                          (day.time_since_epoch() - back);
    if (distance.count() % 7 == 0) return distance;
  }
}

Result<const date::time_zone*> find_zone(const std::string& zone) {
  if (zone.empty())
    return Error{
        "no time zone given: add --tz Europe/Vienna (an IANA name) or --tz solar (true solar "
        "time)"};
  try {
    date::get_tzdb();
  } catch (const std::exception& e) {
    return Error{"the time zone database of this machine cannot be read (" + std::string(e.what()) +
                 "): install the package tzdata, or use --tz solar"};
  }
  try {
    return date::locate_zone(zone);
  } catch (const std::exception&) {
    std::set<std::string_view> names = {"UTC", "solar"};
    for (const date::time_zone& known : date::get_tzdb().zones) names.insert(known.name());
    return Error{"the time zone '" + zone + "' is unknown; the nearest are " +
                 nearest_names(zone, names) +
                 ": give an IANA name such as Europe/Vienna, UTC, or solar (true solar time)"};
  }
}

// Solar clock minus UTC at an instant: the difference of the mean sun's clock, which names the day,
// and the rest of the true sun's within half a day.
milliseconds solar_offset(const Place& place, Instant utc) {
  const milliseconds mean = rotation_time(place.longitude);
  const milliseconds of_day = (utc + mean) - std::chrono::floor<days>(utc + mean);
  const double mean_hour_angle = static_cast<double>(of_day.count()) / kMillisecondsPerRadian - kPi;
  const double hour_angle = sun_position(utc, place).hour_angle;
  return mean + rotation_time(spa::wrap_half_turn(hour_angle - mean_hour_angle));
}

// The offset changes by at most 30 s a day, so every round shrinks the error 2000 times or more:
// from half an hour to less than the last millisecond in three.
Instant solar_to_utc(const Place& place, ClockTime clock) {
  Instant utc{clock.time_since_epoch() - rotation_time(place.longitude)};
  for (int round = 0; round < 4; ++round)
    utc = Instant(clock.time_since_epoch() - solar_offset(place, utc));
  return utc;
}

std::string iso_text(milliseconds since_epoch) {
  const auto day = std::chrono::floor<days>(since_epoch);
  const std::chrono::year_month_day date{std::chrono::sys_days{day}};
  const std::chrono::hh_mm_ss<milliseconds> time{since_epoch - day};
  char text[48];
  int length = std::snprintf(
      text, sizeof text, "%04d-%02u-%02uT%02d:%02d:%02d", static_cast<int>(date.year()),
      static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
      static_cast<int>(time.hours().count()), static_cast<int>(time.minutes().count()),
      static_cast<int>(time.seconds().count()));
  std::string result(text, static_cast<std::size_t>(length));
  if (time.subseconds().count() != 0) {
    length = std::snprintf(text, sizeof text, ".%03d", static_cast<int>(time.subseconds().count()));
    result.append(text, static_cast<std::size_t>(length));
  }
  return result;
}

}  // namespace

Result<ClockInstant> clock_to_utc(const std::string& zone, const Place& place, ClockTime clock) {
  if (zone == "solar") return ClockInstant{solar_to_utc(place, clock)};
  const Result<const date::time_zone*> found = find_zone(zone);
  if (!found) return found.error();

  const days shift = to_tabulated(clock);
  const date::local_time<milliseconds> tabulated{clock.time_since_epoch() + shift};
  const date::local_info info = found.value()->get_info(tabulated);
  ClockInstant result;
  result.ambiguous = info.result == date::local_info::ambiguous;
  result.skipped = info.result == date::local_info::nonexistent;
  result.utc = result.skipped ? Instant(info.first.end.time_since_epoch() - shift)
                              : Instant(clock.time_since_epoch() - info.first.offset);
  return result;
}

Result<ClockTime> utc_to_clock(const std::string& zone, const Place& place, Instant utc) {
  if (zone == "solar") return ClockTime(utc.time_since_epoch() + solar_offset(place, utc));
  const Result<const date::time_zone*> found = find_zone(zone);
  if (!found) return found.error();
  const date::sys_time<milliseconds> tabulated{utc.time_since_epoch() + to_tabulated(utc)};
  return ClockTime(utc.time_since_epoch() + found.value()->get_info(tabulated).offset);
}

std::string iso_text(Instant utc) { return iso_text(utc.time_since_epoch()) + "Z"; }
std::string iso_text(ClockTime clock) { return iso_text(clock.time_since_epoch()); }

}  // namespace gnomon
