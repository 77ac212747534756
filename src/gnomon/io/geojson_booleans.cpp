#include <gnomon/io/geojson_booleans.h>

#include <algorithm>

#include <gnomon/core/lower_case.h>

namespace gnomon {
namespace {

constexpr std::string_view kSpace = " \t\r\n";

// The text in quotes that `before` ends with, spaces aside; else empty. Within a text of JSON, a
// quote has a backslash before it, so that what is found before a colon is never a part of one.
std::string_view name_at_end_of(std::string_view before) {
  const std::size_t last = before.find_last_not_of(kSpace);
  if (last == before.npos || before[last] != '"') return {};
  before = before.substr(0, last);
  return before.substr(before.rfind('"') + 1);  // npos + 1 is 0
}

}  // namespace

std::string booleans_as_text(std::string_view json, const std::vector<std::string>& names) {
  std::string out;
  std::size_t copied = 0;
  for (std::size_t at = json.find(':'); at != json.npos; at = json.find(':', at + 1)) {
    const std::size_t value = std::min(json.find_first_not_of(kSpace, at + 1), json.size());
    const std::string_view rest = json.substr(value);
    const std::string_view word = rest.starts_with("true")    ? "true"
                                  : rest.starts_with("false") ? "false"
                                                              : "";
    if (word.empty()) continue;
    const std::string name = lower_case(name_at_end_of(json.substr(0, at)));
    if (!std::binary_search(names.begin(), names.end(), name)) continue;
    out.append(json.substr(copied, value - copied)).append(1, '"').append(word).append(1, '"');
    copied = value + word.size();
  }
  if (copied > 0) out.append(json.substr(copied));
  return out;
}

}  // namespace gnomon
