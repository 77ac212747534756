// Which files are read as footprints: by what is in them, by their extension only where that could
// be anything.
#include <algorithm>
#include <array>

#include <gnomon/core/lower_case.h>
#include <gnomon/io/footprint_layer.h>

namespace gnomon {
namespace {

using std::string_view;

constexpr std::array<string_view, 9> kExtensions = {
    ".geojson", ".geojsonl", ".geojsons", ".gpkg", ".shp", ".fgb", ".gml", ".kml", ".kmz"};

constexpr std::array<string_view, 9> kGeoJson = {
    "FeatureCollection", "Feature",    "Polygon", "MultiPolygon",      "LineString",
    "MultiLineString",   "MultiPoint", "Point",   "GeometryCollection"};

constexpr string_view kShapefile("\x00\x00\x27\x0a", 4);
constexpr string_view kFlatGeobuf(
    "fgb\x03"
    "fgb",
    7);
constexpr string_view kSqlite("SQLite format 3\0", 16);
constexpr std::size_t kApplicationId = 68;  // in the header of an SQLite file

bool contains(string_view text, string_view what) { return text.find(what) != text.npos; }

// Some "type": "..." of the text is one of GeoJSON's, and none is CityJSON's.
bool is_geojson(string_view text) {
  bool found = false;
  constexpr string_view kType = "\"type\"";
  for (std::size_t at = text.find(kType); at != text.npos; at = text.find(kType, at + 1)) {
    std::size_t k = text.find_first_not_of(" \t\r\n", at + kType.size());
    if (k == text.npos || text[k] != ':') continue;
    k = text.find_first_not_of(" \t\r\n", k + 1);
    if (k == text.npos || text[k] != '"') continue;
    const string_view value = text.substr(k + 1, text.find('"', k + 1) - k - 1);
    if (value.starts_with("CityJSON")) return false;
    found = found || std::find(kGeoJson.begin(), kGeoJson.end(), value) != kGeoJson.end();
  }
  return found;
}

}  // namespace

bool is_footprint_file(const std::filesystem::path& path, std::string_view first_bytes) {
  const std::string extension = lower_case(path.extension().string());
  const bool named =
      std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
  string_view text = first_bytes;
  if (text.starts_with(kShapefile) || text.starts_with(kFlatGeobuf)) return true;
  if (text.starts_with(kSqlite)) {
    return named ||
           (text.size() >= kApplicationId + 4 && text.substr(kApplicationId).starts_with("GP"));
  }
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n\x1e"), text.size()));
  if (text.starts_with("{")) {
    const bool city = contains(text.substr(0, text.find('\n')), "CityJSON") && !is_geojson(text);
    return is_geojson(text) || (named && !city);
  }
  if (text.starts_with("<")) {
    if (contains(text, "opengis.net/citygml")) return false;
    return named || contains(text, "opengis.net/kml") || contains(text, "opengis.net/gml");
  }
  return named;
}

}  // namespace gnomon
