// Text as UTF-8, one character at a time.
#pragma once

#include <cstddef>
#include <string_view>

namespace gnomon {

struct Utf8Character {
  char32_t code = 0;
  std::size_t bytes = 1;  // consumed
  bool valid = false;
};

// The character at the front of `text`. What is not UTF-8 is consumed as Unicode recommends: the
// longest beginning of a valid sequence counts as one error (The Unicode Standard, section 3.9).
// Precondition: `text` is not empty.
Utf8Character next_character(std::string_view text);

}  // namespace gnomon
