#include <gnomon/io/geojson_values.h>

#include <algorithm>
#include <iterator>

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

// Members of GeoJSON's own, whose values GDAL must have as they are.
constexpr std::string_view kOwn[] = {"features",    "geometry", "geometries", "properties",
                                     "coordinates", "bbox",     "crs"};

// How long the true, false, list or object is that `rest` begins with; 0 where it does with none,
// or there is no end of it.
std::size_t length_of(std::string_view rest) {
  for (const std::string_view word : {"true", "false"}) {
    if (rest.starts_with(word)) return word.size();
  }
  if (!rest.starts_with('[') && !rest.starts_with('{')) return 0;
  std::size_t depth = 0;
  bool in_text = false;
  for (std::size_t k = 0; k < rest.size(); ++k) {
    const char c = rest[k];
    if (c == '"') in_text = !in_text;
    if (in_text) {
      if (c == '\\') ++k;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if ((c == ']' || c == '}') && --depth == 0) {
      return k + 1;
    }
  }
  return 0;
}

void append_quoted(std::string& out, std::string_view value) {
  out += '"';
  for (const char c : value) {
    if (c == '"' || c == '\\') out += '\\';
    out += kSpace.find(c) == kSpace.npos ? c : ' ';
  }
  out += '"';
}

}  // namespace

std::string odd_values_as_text(std::string_view json, const std::vector<std::string>& names) {
  std::string out;
  std::size_t copied = 0;
  for (std::size_t at = json.find(':'); at != json.npos; at = json.find(':', at + 1)) {
    const std::size_t value = std::min(json.find_first_not_of(kSpace, at + 1), json.size());
    const std::string_view rest = json.substr(value);
    if (rest.empty() || std::string_view("tf[{").find(rest[0]) == std::string_view::npos) continue;
    const std::string name = lower_case(name_at_end_of(json.substr(0, at)));
    if (!std::binary_search(names.begin(), names.end(), name) ||
        std::find(std::begin(kOwn), std::end(kOwn), name) != std::end(kOwn)) {
      continue;
    }
    const std::size_t length = length_of(rest);
    if (length == 0 && (rest[0] == '[' || rest[0] == '{')) break;  // a file that was cut off
    if (length == 0) continue;
    out.append(json.substr(copied, value - copied));
    append_quoted(out, rest.substr(0, length));
    copied = value + length;
    at = copied - 1;  // what stands within it is text now
  }
  if (copied > 0) out.append(json.substr(copied));
  return out;
}

}  // namespace gnomon
