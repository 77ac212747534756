// Strings of ISO 10303-21 -> UTF-8.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace gnomon {

// `raw`: between the outer apostrophes. See arguments_of in step_file.h. Code pages other than A
// (ISO 8859-1) after \P give U+FFFD for their letters.
std::string decode_step_string(std::string_view raw);

// Length of the UTF-8 sequence that `rest` starts with; 0 where it is none. Precondition: `rest` is
// not empty.
std::size_t utf8_length(std::string_view rest);

}  // namespace gnomon
