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

}  // namespace

std::string first_bad_feature(std::string_view json) {
  const Json whole = Json::parse(json.begin(), json.end(), nullptr, false);
  const Json* features = member(&whole, "features");
  if (!features || !features->is_array()) return {};
  for (std::size_t k = 0; k < features->size(); ++k) {
    const Json& feature = (*features)[k];
    if (is_sound(member(&feature, "geometry"), 0)) continue;
    const Json* id = member(&feature, "id");
    const std::string name = id && id->is_number() ? id->dump() : cityjson::text(id);
    return fmt::format("feature {}{}", k + 1,
                       name.empty() ? "" : fmt::format(" (id {})", printable(name, 200)));
  }
  return {};
}

}  // namespace gnomon
