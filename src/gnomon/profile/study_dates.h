// One date or a range of dates, as a user writes them.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gnomon/core/result.h>

namespace gnomon {

inline constexpr int kLastYear = 6000;   // of the sun's algorithm
inline constexpr int kMostDates = 3660;  // of one range: ten years of days

// "YYYY-MM-DD" of a day that exists, years 1 to kLastYear; else nothing.
std::optional<std::chrono::year_month_day> read_date(std::string_view text);

// The dates of "2024-03-21" (one), "2024-04-01..2024-09-30" (every day, both ends included) or
// "2024-04-01..2024-09-30/7d" (every seventh day from the first on), ascending, as "YYYY-MM-DD".
// Errors: nothing given, unreadable, the end before the beginning, more than kMostDates.
Result<std::vector<std::string>> study_dates(const std::string& entry);

}  // namespace gnomon
