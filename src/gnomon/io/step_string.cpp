#include <gnomon/io/step_string.h>

#include <cstdint>
#include <optional>

namespace gnomon {
namespace {

constexpr std::uint32_t kReplacement = 0xFFFD;

void append_utf8(std::string& out, std::uint32_t c) {
  if (c > 0x10FFFF || (c >= 0xD800 && c < 0xE000)) c = kReplacement;
  const auto byte = [&](std::uint32_t b) { out += static_cast<char>(b); };
  if (c < 0x80) {
    byte(c);
  } else if (c < 0x800) {
    byte(0xC0 | c >> 6);
    byte(0x80 | (c & 0x3F));
  } else if (c < 0x10000) {
    byte(0xE0 | c >> 12);
    byte(0x80 | (c >> 6 & 0x3F));
    byte(0x80 | (c & 0x3F));
  } else {
    byte(0xF0 | c >> 18);
    byte(0x80 | (c >> 12 & 0x3F));
    byte(0x80 | (c >> 6 & 0x3F));
    byte(0x80 | (c & 0x3F));
  }
}

// The next `digits` hexadecimal digits, cut off; nothing where there are fewer.
std::optional<std::uint32_t> hex(std::string_view& rest, std::size_t digits) {
  if (rest.size() < digits) return {};
  std::uint32_t value = 0;
  for (const char c : rest.substr(0, digits)) {
    const std::uint32_t digit = c >= '0' && c <= '9'   ? std::uint32_t(c - '0')
                                : c >= 'A' && c <= 'F' ? std::uint32_t(c - 'A' + 10)
                                : c >= 'a' && c <= 'f' ? std::uint32_t(c - 'a' + 10)
                                                       : 16u;
    if (digit == 16) return {};
    value = value << 4 | digit;
  }
  rest.remove_prefix(digits);
  return value;
}

// \X2\ (UTF-16) or \X4\ up to \X0\; false where it is broken, `rest` and `out` as before.
bool wide(std::string_view& rest, std::size_t digits, std::string& out) {
  std::string_view ahead = rest;
  std::string decoded;
  while (!ahead.starts_with("\\X0\\")) {
    auto c = hex(ahead, digits);
    if (!c) return false;
    if (digits == 4 && *c >= 0xD800 && *c < 0xDC00) {
      std::string_view low_half = ahead;
      const auto low = hex(low_half, 4);
      if (low && *low >= 0xDC00 && *low < 0xE000) {
        c = 0x10000 + ((*c - 0xD800) << 10) + (*low - 0xDC00);
        ahead = low_half;
      }
    }
    append_utf8(decoded, *c);
  }
  rest = ahead.substr(4);
  out += decoded;
  return true;
}

}  // namespace

std::size_t utf8_length(std::string_view rest) {
  const auto first = static_cast<unsigned char>(rest[0]);
  const std::size_t length = first < 0x80                     ? 1
                             : first >= 0xC2 && first <= 0xDF ? 2
                             : first >= 0xE0 && first <= 0xEF ? 3
                             : first >= 0xF0 && first <= 0xF4 ? 4
                                                              : 0;
  if (length > rest.size()) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((static_cast<unsigned char>(rest[k]) & 0xC0) != 0x80) return 0;
  }
  return length;
}

std::string decode_step_string(std::string_view raw) {
  std::string out;
  char page = 'A';
  const auto letter = [&](std::uint32_t c) {
    append_utf8(out, page == 'A' || c < 0xA0 ? c : kReplacement);
  };
  while (!raw.empty()) {
    const char c = raw[0];
    if (c == '\r' || c == '\n') {
      raw.remove_prefix(1);
    } else if (raw.starts_with("''") || raw.starts_with("\\\\")) {
      out += c;
      raw.remove_prefix(2);
    } else if (raw.starts_with("\\S\\") && raw.size() > 3 &&
               static_cast<unsigned char>(raw[3]) < 0x80) {
      letter(static_cast<unsigned char>(raw[3]) + 0x80u);
      raw.remove_prefix(raw.substr(3).starts_with("''") ? 5 : 4);
    } else if (raw.size() >= 4 && raw.starts_with("\\P") && raw[2] >= 'A' && raw[2] <= 'I' &&
               raw[3] == '\\') {
      page = raw[2];
      raw.remove_prefix(4);
    } else if (raw.starts_with("\\X\\")) {
      std::string_view rest = raw.substr(3);
      const auto code = hex(rest, 2);
      if (code) append_utf8(out, *code);
      if (!code) out += "\\X\\";
      raw = rest;
    } else if (raw.starts_with("\\X2\\") || raw.starts_with("\\X4\\")) {
      std::string_view rest = raw.substr(4);
      if (!wide(rest, raw[2] == '2' ? 4 : 8, out)) out += raw.substr(0, 4);
      raw = rest;
    } else if (const std::size_t length = utf8_length(raw)) {
      out += raw.substr(0, length);
      raw.remove_prefix(length);
    } else {
      append_utf8(out, static_cast<unsigned char>(c));
      raw.remove_prefix(1);
    }
  }
  return out;
}

}  // namespace gnomon
