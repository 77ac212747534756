#include <fmt/format.h>
#include <gnomon/io/mesh_text.h>
#include <gnomon/io/ply_header.h>
#include <gnomon/io/read_text.h>

#include <array>
#include <optional>
#include <utility>

namespace gnomon {
namespace {

std::optional<PlyType> type_named(std::string_view name) {
  using enum PlyType;
  constexpr std::array<std::pair<std::string_view, PlyType>, 16> kNames = {{
      {"char", kInt8},
      {"int8", kInt8},
      {"uchar", kUint8},
      {"uint8", kUint8},
      {"short", kInt16},
      {"int16", kInt16},
      {"ushort", kUint16},
      {"uint16", kUint16},
      {"int", kInt32},
      {"int32", kInt32},
      {"uint", kUint32},
      {"uint32", kUint32},
      {"float", kFloat},
      {"float32", kFloat},
      {"double", kDouble},
      {"float64", kDouble},
  }};
  for (const auto& [known, type] : kNames) {
    if (name == known) return type;
  }
  return {};
}

bool is_whole(PlyType type) { return type != PlyType::kFloat && type != PlyType::kDouble; }

std::optional<PlyProperty> property_of(const std::vector<std::string_view>& words) {
  PlyProperty p;
  p.list = words.size() == 5 && words[1] == "list";
  if (!p.list && words.size() != 3) return {};
  const auto type = type_named(words[p.list ? 3 : 1]);
  if (!type) return {};
  p.type = *type;
  p.name = words.back();
  if (p.list) {
    const auto count = type_named(words[2]);
    if (!count || !is_whole(*count)) return {};
    p.count_type = *count;
  }
  return p;
}

}  // namespace

std::size_t bytes_of(PlyType type) {
  constexpr std::array<std::size_t, 8> kBytes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

Result<PlyHeader> read_ply_header(std::string_view bytes, const std::string& path,
                                  Warnings& warnings) {
  PlyHeader header;
  MeshLines lines(bytes);
  const auto at_line = [&](const std::string& what) {
    return Error{fmt::format("{}: line {}: {}", path, lines.number, what)};
  };
  if (!lines.next() || lines.words[0] != "ply") {
    return Error{fmt::format("{}: does not start with \"ply\"; check that the file is PLY.", path)};
  }
  bool format = false;
  while (lines.next()) {
    const auto& words = lines.words;
    if (words[0] == "end_header") {
      if (!format) return at_line("the header has no \"format\" line.");
      header.lines = lines.number;
      header.body = lines.rest();
      return header;
    }
    if (words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "format") {
      const std::string_view name = words.size() > 1 ? words[1] : "";
      if (name == "ascii") {
        header.storage = PlyStorage::kText;
      } else if (name == "binary_little_endian") {
        header.storage = PlyStorage::kLittleEndian;
      } else if (name == "binary_big_endian") {
        header.storage = PlyStorage::kBigEndian;
      } else {
        return at_line(fmt::format("the format {} is not known.", in_quotes(name)));
      }
      format = true;
    } else if (words[0] == "element") {
      const auto count = words.size() == 3 ? whole_number(words[2]) : std::nullopt;
      if (!count) return at_line("\"element\" must be followed by a name and a count.");
      header.elements.push_back({std::string(words[1]), *count, {}});
    } else if (words[0] == "property") {
      auto property = property_of(words);
      if (!property || header.elements.empty()) {
        return at_line(
            "\"property\" must stand under an element, with a type that PLY knows and a name.");
      }
      header.elements.back().properties.push_back(std::move(*property));
    } else {
      warn(warnings, "Lines of a PLY header that are not understood were left out.",
           fmt::format("{}: line {}", path, lines.number));
    }
  }
  return Error{fmt::format("{}: the header has no \"end_header\"; the file is cut off.", path)};
}

}  // namespace gnomon
