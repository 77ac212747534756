#include "study_text.h"

#include <algorithm>

#include <fmt/format.h>
#include <gnomon/sun/time_zone.h>

#include "commands.h"

namespace gnomon::app {
namespace {

std::string date_text(const std::string& date) {
  static constexpr const char* kMonths[] = {"January",   "February", "March",    "April",
                                            "May",       "June",     "July",     "August",
                                            "September", "October",  "November", "December"};
  const int month = std::stoi(date.substr(5, 2));
  return fmt::format("{} {} {}", std::stoi(date.substr(8, 2)), kMonths[month - 1],
                     date.substr(0, 4));
}

std::string ordinal(const std::string& n) {
  const bool teen = n.size() > 1 && n[n.size() - 2] == '1';
  const char last = teen ? '0' : n.back();
  return n + (last == '1' ? "st" : last == '2' ? "nd" : last == '3' ? "rd" : "th");
}

}  // namespace

std::string window_text(const StudyTimes& t, const Samples& s, const Place& place) {
  const std::string zone = t.zone == "solar" ? "true solar time" : t.zone;
  if (s.dates.size() == 1) {
    const auto clock = [&](Instant utc) {
      return iso_text(take(utc_to_clock(t.zone, place, utc))).substr(11, 5);
    };
    const std::string end = t.to == "24:00" ? t.to : clock(s.end);
    return fmt::format("{}, {} \u2013 {} {}", date_text(s.dates[0]), clock(s.begin), end, zone);
  }
  std::string every;
  if (const std::size_t slash = t.date.find('/'); slash != std::string::npos) {
    const std::string days = t.date.substr(slash + 1, t.date.size() - slash - 2);  // "/7d"
    if (days != "1") every = ", every " + ordinal(days) + " day";
  }
  return fmt::format("{} \u2013 {}{}, {} \u2013 {} {}", date_text(s.dates.front()),
                     date_text(s.dates.back()), every, t.from.empty() ? "sunrise" : t.from,
                     t.to.empty() ? "sunset" : t.to, zone);
}

std::string steps_text(const StudyTimes& t, const Samples& s) {
  const std::string steps = fmt::format("{} step{} of {}", s.midpoints.size(),
                                        s.midpoints.size() == 1 ? "" : "s", t.every);
  if (s.dates.size() == 1) return steps;
  return fmt::format("mean per day over {} days, {}", s.dates.size(), steps);
}

std::string overlay_text(const Samples& s, int shown) {
  const std::string shadows =
      shown == 1 ? std::string("1 shadow") : fmt::format("{} shadows laid over each other", shown);
  if (s.dates.size() > 1) {
    return fmt::format("{}, at times spread over {} days", shadows, s.dates.size());
  }
  const std::size_t all = s.instants.size();
  const auto up = static_cast<std::size_t>(std::count_if(s.instants.begin(), s.instants.end(),
                                                         [](const TimeSample& t) { return t.up; }));
  if (static_cast<std::size_t>(shown) < up) {
    return fmt::format("{}, at {} of the {} ends of steps", shadows, shown, up);
  }
  return shadows + ", at the ends of the steps" +
         (up < all ? fmt::format(" ({} of {} without sun)", all - up, all) : std::string());
}

std::string folder_name(const std::string& date) {
  std::string name = date;
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

}  // namespace gnomon::app
