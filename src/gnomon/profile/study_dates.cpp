#include <gnomon/profile/study_dates.h>

#include <algorithm>
#include <charconv>

#include <gnomon/profile/take.h>

namespace gnomon {
namespace {

using std::chrono::days;
using std::chrono::sys_days;
using std::chrono::year_month_day;

std::string date_text(year_month_day date) {
  const auto padded = [](int value, std::size_t digits) {
    std::string text = std::to_string(value);
    return std::string(digits - std::min(digits, text.size()), '0') + text;
  };
  return padded(static_cast<int>(date.year()), 4) + "-" +
         padded(static_cast<int>(static_cast<unsigned>(date.month())), 2) + "-" +
         padded(static_cast<int>(static_cast<unsigned>(date.day())), 2);
}

// "7d"; positive.
std::optional<int> read_day_step(std::string_view text) {
  int step = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), step);
  if (error != std::errc() || step < 1) return {};
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (text != "d") return {};
  return step;
}

// Why a date is none: "February 2023 has 28 days", or how it is written here.
std::string why_no_date(std::string_view text) {
  std::string_view rest = text;
  int number[3] = {0, 0, 0};
  std::size_t digits[3] = {0, 0, 0};
  for (int k = 0; k < 3; ++k) {
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number[k]);
    digits[k] = static_cast<std::size_t>(end - rest.data());
    if (error != std::errc() || number[k] < 0) return "it is no date";
    rest.remove_prefix(digits[k]);
    if (k < 2) {
      if (rest.empty() || std::string_view("-/. ").find(rest[0]) == std::string_view::npos) {
        return "it is no date";
      }
      rest.remove_prefix(1);
    }
  }
  if (!rest.empty()) return "it is no date";
  const auto date = [](int year, int month, int day) {
    return year_month_day{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                          std::chrono::day(static_cast<unsigned>(day))};
  };
  if (digits[0] == 4) {
    const year_month_day d = date(number[0], number[1], number[2]);
    if (d.ok()) return "write it as " + date_text(d);
    if (!d.year().ok() || !d.month().ok() || number[2] < 1) return "there is no such month or day";
    const auto last = static_cast<unsigned>((d.year() / d.month() / std::chrono::last).day());
    return "that month has " + std::to_string(last) + " days";
  }
  if (digits[2] != 4) return "it is no date";
  std::string meant;
  for (const bool day_first : {true, false}) {
    const year_month_day d = date(number[2], number[day_first ? 1 : 0], number[day_first ? 0 : 1]);
    if (d.ok() && meant.find(date_text(d)) == std::string::npos) {
      meant += (meant.empty() ? "" : " or ") + date_text(d);
    }
  }
  return meant.empty() ? "there is no such month or day" : "write it as " + meant;
}

Error unreadable(const std::string& entry, const std::string& why) {
  return {"the date '" + entry + "' cannot be read: " + why +
          "; write YYYY-MM-DD, a range YYYY-MM-DD..YYYY-MM-DD, or every 7th day of it "
          "YYYY-MM-DD..YYYY-MM-DD/7d, with days that exist, between the years 0001 and " +
          std::to_string(kLastYear)};
}

}  // namespace

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

Result<std::vector<std::string>> study_dates(const std::string& entry) {
  if (entry.empty()) return Error{"no date given: add --date YYYY-MM-DD"};
  std::string_view rest = entry;
  const std::size_t dots = rest.find("..");
  if (dots == std::string_view::npos) {
    if (!read_date(rest)) {
      const bool has_step = rest.ends_with('d') && rest.find('/') != std::string_view::npos;
      return unreadable(entry, has_step ? "only a range of dates has a step" : why_no_date(rest));
    }
    return std::vector<std::string>{entry};
  }

  const auto first = read_date(rest.substr(0, dots));
  if (!first) return unreadable(entry, "what stands before '..' is no date");
  rest.remove_prefix(dots + 2);
  int step = 1;
  if (const std::size_t slash = rest.find('/'); slash != std::string_view::npos) {
    const auto given = read_day_step(rest.substr(slash + 1));
    if (!given) return unreadable(entry, "what stands after '/' is no number of days such as 7d");
    step = *given;
    rest = rest.substr(0, slash);
  }
  const auto last = read_date(rest);
  if (!last) return unreadable(entry, "what stands after '..' is no date");

  const std::int64_t length = (sys_days{*last} - sys_days{*first}).count();
  if (length < 0) {
    return Error{"the range of dates '" + entry +
                 "' ends before it begins: give the earlier date first"};
  }
  if (length / step + 1 > kMostDates) {
    return Error{"the range of dates '" + entry + "' has " + std::to_string(length / step + 1) +
                 " days, at most " + std::to_string(kMostDates) +
                 " can be computed at once: take every 7th day (add /7d), or a shorter range"};
  }
  std::vector<std::string> dates;
  for (std::int64_t d = 0; d <= length; d += step) {
    dates.push_back(date_text(year_month_day{sys_days{*first} + days(d)}));
  }
  return dates;
}

}  // namespace gnomon
