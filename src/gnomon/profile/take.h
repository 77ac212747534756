// Reading text from its front: what the readers of dates, times and steps share.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace gnomon {

// A number of `digits` decimal digits at the front of `text`, which it removes.
inline std::optional<int> take_number(std::string_view& text, std::size_t digits) {
  if (text.size() < digits) return {};
  int value = 0;
  for (char c : text.substr(0, digits)) {
    if (c < '0' || c > '9') return {};
    value = value * 10 + (c - '0');
  }
  text.remove_prefix(digits);
  return value;
}

// True where `text` begins with `what`, which it removes.
inline bool take(std::string_view& text, std::string_view what) {
  if (!text.starts_with(what)) return false;
  text.remove_prefix(what.size());
  return true;
}

}  // namespace gnomon
