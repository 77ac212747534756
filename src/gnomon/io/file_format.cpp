#include <gnomon/core/lower_case.h>
#include <gnomon/io/assimp_model.h>
#include <gnomon/io/file_format.h>
#include <gnomon/io/footprint_layer.h>
#include <gnomon/io/surface_raster.h>

#include <algorithm>
#include <array>
#include <string>

namespace gnomon {
namespace {

// The value of the member "type" of the outermost object, as far as `text` reaches; empty where it
// is not seen. The text need not be whole, nor valid beyond.
std::string_view json_type(std::string_view text) {
  int depth = 0;
  bool is_key = false;
  std::string_view key;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (c == '{' || c == '[') {
      ++depth;
      is_key = c == '{';
    } else if (c == '}' || c == ']') {
      if (--depth <= 0) return {};
    } else if (c == ',') {
      is_key = true;  // in arrays too, where what follows is no key of depth 1
    } else if (c == ':') {
      is_key = false;
    } else if (c == '"') {
      std::size_t end = k + 1;
      while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2 : 1;
      if (end >= text.size()) return {};
      const std::string_view word = text.substr(k + 1, end - k - 1);
      if (depth == 1 && is_key) key = word;
      if (depth == 1 && !is_key && key == "type") return word;
      k = end;
    }
  }
  return {};
}

// An OBJ's first line that is no comment starts with one of its keywords.
bool starts_as_obj(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(text.size(), end + 1));
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (line.empty() || line[0] == '#') continue;
    const std::string_view word = line.substr(0, line.find_first_of(" \t"));
    constexpr std::array<std::string_view, 14> kKeywords = {
        "v", "vn", "vt", "vp", "f", "o", "g", "s", "l", "p", "mtllib", "usemtl", "cstype", "mg"};
    return std::find(kKeywords.begin(), kKeywords.end(), word) != kKeywords.end();
  }
  return false;
}

}  // namespace

std::optional<FileFormat> format_of(const std::filesystem::path& path, std::string_view start) {
  const std::string extension = lower_case(path.extension().string());
  if (start.starts_with("\xEF\xBB\xBF")) start.remove_prefix(3);
  const std::size_t first = start.find_first_not_of(" \t\r\n");
  const std::string_view text = first == start.npos ? std::string_view() : start.substr(first);
  if (text.starts_with("ISO-10303-21") || extension == ".ifc") return FileFormat::ifc;
  if (text.starts_with('{')) {
    const std::string_view type = json_type(text);
    if (type.starts_with("CityJSON")) return FileFormat::city_json;
    if (type == "FeatureCollection" || type == "Feature" || type.ends_with("Polygon") ||
        extension == ".geojson") {
      return FileFormat::footprints;
    }
    if (extension == ".gltf") return FileFormat::assimp;
    return FileFormat::city_json;  // which says what it misses
  }
  if (is_raster_file(path, start)) return FileFormat::raster;
  if (is_footprint_file(path, start)) return FileFormat::footprints;
  if (extension != ".obj" && is_assimp_file(path)) return FileFormat::assimp;
  if (extension == ".obj") return FileFormat::obj;
  if (extension == ".json" || extension == ".jsonl") return FileFormat::city_json;
  if (start.find('\0') == start.npos && starts_as_obj(start)) return FileFormat::obj;
  return std::nullopt;
}

}  // namespace gnomon
