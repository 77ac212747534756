// Rows of tables in Markdown.
#pragma once

#include <string>
#include <vector>

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

}  // namespace gnomon::app
