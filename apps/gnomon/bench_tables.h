// Rows and numbers of tables in Markdown.
#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

namespace gnomon::app {

inline std::string row(const std::string& first, const std::vector<std::string>& cells) {
  std::string out = "| " + first;
  for (const std::string& c : cells) out += " | " + c;
  return out + " |\n";
}

// Numbers in all columns but the first.
inline std::string header(const std::string& first, const std::vector<std::string>& cells) {
  return row(first, cells) + row("---", std::vector<std::string>(cells.size(), "--:"));
}

inline std::string significant(double value) {  // three digits
  return fmt::format("{:.{}f}", value, value < 0.0995 ? 4 : value < 0.995 ? 3 : 2);
}

inline std::string ratio(double a, double b) {
  return fmt::format("{:.{}f}", a / b, a / b < 0.0995 ? 3 : 2);
}

}  // namespace gnomon::app
