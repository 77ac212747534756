// Based on: the table zone.tab of the IANA time zone database; its coordinates are ISO 6709,
// +-DDMM+-DDDMM or +-DDMMSS+-DDDMMSS.
#include <gnomon/sun/zone_place.h>

#include <charconv>
#include <fstream>
#include <sstream>
#include <string_view>

namespace gnomon {
namespace {

// Where the date library finds the compiled zones, as well.
constexpr const char* kZoneTable = "/usr/share/zoneinfo/zone.tab";

// "+4813" or "+481234" -> radians.
std::optional<double> read_angle(std::string_view text, std::size_t degree_digits) {
  const bool seconds = text.size() == degree_digits + 5;
  if (!seconds && text.size() != degree_digits + 3) return {};
  const auto number = [&](std::size_t from, std::size_t length) -> std::optional<double> {
    int value = 0;
    const char* begin = text.data() + from;
    const auto [end, error] = std::from_chars(begin, begin + length, value);
    if (error != std::errc() || end != begin + length || value < 0) return {};
    return value;
  };
  const auto degree = number(1, degree_digits), minute = number(1 + degree_digits, 2),
             second = seconds ? number(3 + degree_digits, 2) : std::optional<double>(0);
  if (!degree || !minute || !second) return {};
  const double angle = *degree + *minute / 60 + *second / 3600;
  return (text[0] == '-' ? -angle : angle) * kDegree;
}

std::optional<Place> read_coordinates(std::string_view text) {
  const std::size_t second = text.find_first_of("+-", 1);
  if (second == std::string_view::npos) return {};
  const auto latitude = read_angle(text.substr(0, second), 2),
             longitude = read_angle(text.substr(second), 3);
  if (!latitude || !longitude) return {};
  return Place{*latitude, *longitude, 0};
}

}  // namespace

std::optional<Place> zone_reference(const std::string& zone) {
  std::ifstream table(kZoneTable);
  for (std::string line; std::getline(table, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream fields(line);
    std::string country, coordinates, name;
    if (fields >> country >> coordinates >> name && name == zone) {
      return read_coordinates(coordinates);
    }
  }
  return {};
}

}  // namespace gnomon
