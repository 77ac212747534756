#include <gnomon/core/utf8.h>
#include <gnomon/io/html.h>

#include <fmt/format.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <system_error>

namespace gnomon {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

// Characters whose presence in a page is an error (HTML, "Preprocessing the input stream").
bool forbidden(char32_t c) {
  if (c < 0x20) return c != '\t' && c != '\n' && c != '\r';
  return (c >= 0x7F && c <= 0x9F) || (c >= 0xFDD0 && c <= 0xFDEF) || (c & 0xFFFEU) == 0xFFFE;
}

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char c : bytes) value = (value << 8) | static_cast<unsigned char>(c);
  return value;
}

// 0, or the errno of the failure.
int read_all(const std::filesystem::path& path, std::string& out) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return errno;
  char buffer[1 << 16];
  std::size_t count = 0;
  while ((count = std::fread(buffer, 1, sizeof buffer, file)) > 0) out.append(buffer, count);
  const int failure = std::ferror(file) != 0 ? (errno != 0 ? errno : EIO) : 0;
  std::fclose(file);
  return failure;
}

}  // namespace

std::string html_text(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const Utf8Character c = next_character(text);
    if (!c.valid || forbidden(c.code)) {
      out += kReplacement;
    } else if (c.code == '&') {
      out += "&amp;";
    } else if (c.code == '<') {
      out += "&lt;";
    } else if (c.code == '>') {
      out += "&gt;";
    } else if (c.code == '"') {
      out += "&quot;";
    } else if (c.code == '\'') {
      out += "&#39;";
    } else {
      out += text.substr(0, c.bytes);
    }
    text.remove_prefix(c.bytes);
  }
  return out;
}

std::string base64(std::string_view bytes) {
  static constexpr char kLetters[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::string_view group = bytes.substr(k, 3);
    const std::uint32_t bits = big_endian(group) << (8 * (3 - group.size()));
    for (std::size_t i = 0; i < 4; ++i)
      out += i <= group.size() ? kLetters[(bits >> (18 - 6 * i)) & 63U] : '=';
  }
  return out;
}

Result<EmbeddedPicture> embed_png(const std::filesystem::path& png) {
  std::string bytes;
  if (const int failure = read_all(png, bytes); failure != 0) {
    return Error{fmt::format("Cannot read the picture {}: {}; the report needs it to embed it.",
                             png.string(), std::generic_category().message(failure))};
  }
  // Signature, then the header chunk: length, "IHDR", width, height.
  constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
  if (bytes.size() < 33 || !std::string_view(bytes).starts_with(kSignature) ||
      std::string_view(bytes).substr(12, 4) != "IHDR") {
    return Error{
        fmt::format("{} is not a PNG picture: the report embeds PNG alone.", png.string())};
  }
  const std::uint32_t width = big_endian(std::string_view(bytes).substr(16, 4));
  const std::uint32_t height = big_endian(std::string_view(bytes).substr(20, 4));
  return EmbeddedPicture{static_cast<int>(width), static_cast<int>(height),
                         "data:image/png;base64," + base64(bytes)};
}

}  // namespace gnomon
