// Letters of ASCII in lower case; all other bytes, and so those of UTF-8, stay as they are.
#pragma once

#include <string>
#include <string_view>

namespace gnomon {

constexpr char lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

inline std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = lower_case(c);
  return out;
}

}  // namespace gnomon
