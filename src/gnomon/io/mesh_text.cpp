#include <fmt/format.h>
#include <gnomon/io/mesh_text.h>

#include <cstdlib>

namespace gnomon {

bool MeshLines::next() {
  constexpr std::string_view kSpace = " \t\v\f";
  words.clear();
  while (!rest_.empty()) {
    ++number;
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    all = rest_.substr(0, end);
    const bool two = rest_.substr(end).starts_with("\r\n");
    rest_.remove_prefix(std::min(rest_.size(), end + (two ? 2 : 1)));
    std::string_view line = comment_ ? all.substr(0, all.find(comment_)) : all;
    while (true) {
      const std::size_t begin = line.find_first_not_of(kSpace);
      if (begin == std::string_view::npos) break;
      line.remove_prefix(begin);
      const std::size_t length = std::min(line.find_first_of(kSpace), line.size());
      words.push_back(line.substr(0, length));
      line.remove_prefix(length);
    }
    if (!words.empty()) return true;
  }
  return false;
}

std::optional<double> real_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double d = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), d);
  if (end != word.data() + word.size() || word.empty()) return {};
  if (error == std::errc::result_out_of_range)
    return std::strtod(std::string(word).c_str(), nullptr);
  if (error != std::errc()) return {};
  return d;
}

std::optional<std::uint64_t> whole_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  std::uint64_t n = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), n);
  if (end != word.data() + word.size() || word.empty() || error != std::errc()) return {};
  return n;
}

std::string counted(std::uint64_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

}  // namespace gnomon
