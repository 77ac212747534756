// Building blocks of a self-contained HTML page: escaped text, pictures inside of the page.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <gnomon/core/result.h>

namespace gnomon {

// `text` for the content of an element or a quoted attribute of HTML or SVG: & < > " ' are escaped;
// bytes that are not UTF-8, and characters that HTML forbids (controls but tab and line ends,
// noncharacters), become U+FFFD, the replacement character. The result is valid UTF-8.
std::string html_text(std::string_view text);

// RFC 4648, with padding, without line breaks.
std::string base64(std::string_view bytes);

struct EmbeddedPicture {
  int width = 0, height = 0;  // pixels
  std::string uri;            // "data:image/png;base64,..."
};

// Errors: no such file, unreadable, not a PNG.
Result<EmbeddedPicture> embed_png(const std::filesystem::path& png);

}  // namespace gnomon
