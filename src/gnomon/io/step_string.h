// Strings of ISO 10303-21 -> UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace gnomon {

// `raw`: between the outer apostrophes. See arguments_of in step_file.h. Code pages other than A
// (ISO 8859-1) after \P give U+FFFD for their letters.
std::string decode_step_string(std::string_view raw);

}  // namespace gnomon
