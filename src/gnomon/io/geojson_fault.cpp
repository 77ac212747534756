#include <gnomon/io/geojson_fault.h>

#include <fmt/format.h>

#include <algorithm>

#include <gnomon/io/cityjson_access.h>
#include <gnomon/io/read_text.h>

namespace gnomon {
namespace {

using cityjson::Json;
using cityjson::member;

constexpr int kDeepest = 4;       // lists within each other, of a MultiPolygon
constexpr int kDeepestParts = 8;  // collections within each other: more than anybody makes

bool are_coordinates(const Json& value, int depth) {
  if (!value.is_array()) return depth > 0 && value.is_number();
  return depth < kDeepest && std::all_of(value.begin(), value.end(), [&](const Json& v) {
           return are_coordinates(v, depth + 1);
         });
}

bool is_sound(const Json* geometry, int depth) {
  if (const Json* coordinates = member(geometry, "coordinates")) {
    return are_coordinates(*coordinates, 0);
  }
  const Json* parts = member(geometry, "geometries");
  if (!parts || !parts->is_array() || depth > kDeepestParts) return true;
  return std::all_of(parts->begin(), parts->end(),
                     [&](const Json& part) { return is_sound(&part, depth + 1); });
}

// " (id way/7)", empty where there is none.
std::string id_of(const Json& feature) {
  const Json* id = member(&feature, "id");
  const std::string name = id && id->is_number() ? id->dump() : cityjson::text(id);
  return name.empty() ? "" : fmt::format(" (id {})", printable(name, 200));
}

// Features stand in lines of their own, or over several lines after a record separator.
std::string first_bad_record(std::string_view text) {
  constexpr char kRecord = '\x1e';
  const char end = text.find(kRecord) == text.npos ? '\n' : kRecord;
  std::size_t line = 1;
  while (!text.empty()) {
    const std::string_view record = text.substr(0, text.find(end));
    const std::size_t first = record.find_first_not_of(" \t\r\n");
    if (first != record.npos) {
      const Json feature = Json::parse(record.begin(), record.end(), nullptr, false);
      if (feature.is_discarded() || !is_sound(member(&feature, "geometry"), 0)) {
        line += static_cast<std::size_t>(std::count(record.begin(), record.begin() + first, '\n'));
        return fmt::format("line {}{}", line, id_of(feature));
      }
    }
    const std::size_t used = std::min(record.size() + 1, text.size());
    line += static_cast<std::size_t>(std::count(text.begin(), text.begin() + used, '\n'));
    text.remove_prefix(used);
  }
  return {};
}

}  // namespace

std::string first_bad_feature(std::string_view json) {
  const Json whole = Json::parse(json.begin(), json.end(), nullptr, false);
  if (whole.is_discarded()) return first_bad_record(json);
  if (!is_sound(member(&whole, "geometry"), 0)) return "feature 1" + id_of(whole);
  const Json* features = member(&whole, "features");
  if (!features || !features->is_array()) return {};
  for (std::size_t k = 0; k < features->size(); ++k) {
    const Json& feature = (*features)[k];
    if (!is_sound(member(&feature, "geometry"), 0)) {
      return fmt::format("feature {}{}", k + 1, id_of(feature));
    }
  }
  return {};
}

}  // namespace gnomon
