#include <fmt/format.h>
#include <gnomon/core/utf8.h>
#include <gnomon/io/read_text.h>
#include <gnomon/io/step_string.h>

#include <algorithm>
#include <fstream>
#include <limits>

namespace gnomon {

namespace {

Error is_empty(const std::string& name) {
  return {fmt::format("{}: the file is empty; export the model again.", name)};
}

Result<std::string> read_bytes(const std::filesystem::path& path, std::size_t most) {
  const std::string name = path.string();
  std::error_code code;
  const auto status = std::filesystem::status(path, code);
  if (!std::filesystem::exists(status)) {
    return Error{fmt::format("{}: there is no such file; check the path.", name)};
  }
  if (std::filesystem::is_directory(status)) {
    return Error{fmt::format("{}: is a folder; name the model files in it.", name)};
  }
  std::ifstream file(path, std::ios::binary);
  std::string text;
  if (file) {
    const auto size = std::filesystem::file_size(path, code);
    if (!code) text.reserve(std::min<std::uintmax_t>(size, most));
    char block[1 << 16];
    while (text.size() < most && (file.read(block, sizeof block) || file.gcount() > 0)) {
      text.append(block, static_cast<std::size_t>(file.gcount()));
    }
  }
  if (!file.eof() && text.size() < most) {
    return Error{fmt::format("{}: cannot be read; check its permissions.", name)};
  }
  if (text.size() > most) text.resize(most);
  if (text.empty()) return is_empty(name);
  return text;
}

}  // namespace

Result<std::string> read_start(const std::filesystem::path& path, std::size_t bytes) {
  return read_bytes(path, bytes);
}

Result<std::string> read_text(const std::filesystem::path& path) {
  auto read = read_bytes(path, std::numeric_limits<std::size_t>::max());
  if (!read) return read;
  std::string& text = read.value();
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    return Error{fmt::format("{}: is UTF-16 text; save it as UTF-8.", path.string())};
  }
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) return is_empty(path.string());
  return read;
}

std::size_t line_of(std::string_view text, std::size_t offset) {
  std::size_t line = 1;
  for (std::size_t k = 0; k < std::min(offset, text.size()); ++k) {
    const bool crlf = text[k] == '\r' && k + 1 < text.size() && text[k + 1] == '\n';
    if (text[k] == '\n' || (text[k] == '\r' && !crlf)) ++line;
  }
  return line;
}

std::string printable(std::string_view text, std::size_t most) {
  std::string out;
  for (std::size_t k = 0; k < text.size();) {
    const std::size_t length = utf8_length(text.substr(k));
    if (out.size() + std::max<std::size_t>(length, 1) > most) return out + "...";
    const auto first = static_cast<unsigned char>(text[k]);
    if (length == 0 || first < 0x20 || first == 0x7f) {
      out += '?';
      ++k;
    } else {
      out += text.substr(k, length);
      k += length;
    }
  }
  return out;
}

std::string in_quotes(std::string_view text, std::size_t most) {
  std::string out = "\"";
  std::size_t at = 0;
  while (at < text.size()) {
    const Utf8Character c = next_character(text.substr(at));
    if (at + c.bytes > most) break;
    const bool control = c.code < 0x20 || (c.code >= 0x7f && c.code < 0xa0);
    out += c.valid && !control ? text.substr(at, c.bytes) : std::string_view("?");
    at += c.bytes;
  }
  if (at < text.size()) out += "...";
  return out + "\"";
}

}  // namespace gnomon
