#include <fmt/format.h>
#include <gnomon/core/lower_case.h>
#include <gnomon/io/mesh_text.h>
#include <gnomon/io/mtl.h>
#include <gnomon/io/read_text.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

namespace gnomon {
namespace {

// The words from number `k` on, as they stand in the line.
std::string rest_of(const MeshLines& line, std::size_t k) {
  if (k >= line.words.size()) return {};
  const char *begin = line.words[k].data(), *end = line.words.back().data();
  return std::string(begin, end + line.words.back().size());
}

// What may stand before a map's file: an option and how many words are its values.
int values_of(std::string_view option) {
  constexpr std::array<std::pair<std::string_view, int>, 12> kOptions = {{{"-blendu", 1},
                                                                          {"-blendv", 1},
                                                                          {"-bm", 1},
                                                                          {"-boost", 1},
                                                                          {"-cc", 1},
                                                                          {"-clamp", 1},
                                                                          {"-imfchan", 1},
                                                                          {"-mm", 2},
                                                                          {"-o", 3},
                                                                          {"-s", 3},
                                                                          {"-t", 3},
                                                                          {"-texres", 1}}};
  for (const auto& [name, count] : kOptions) {
    if (option == name) return count;
  }
  return -1;
}

struct Map {
  std::string file;
  double bump = 1;
  PictureEdges edges;
  bool shifted = false;  // -o, -s, -t, which are not read
};

Map map_of(const MeshLines& line) {
  Map map;
  std::size_t k = 1;
  while (k < line.words.size()) {
    const std::string_view option = line.words[k];
    const int most = values_of(option);
    if (most < 0) break;
    const std::size_t value = ++k;
    if (most == 3) {  // -o, -s and -t may have one to three numbers
      while (k < line.words.size() && k < value + 3 && real_number(line.words[k])) ++k;
      map.shifted = true;
    } else {
      k = std::min(k + static_cast<std::size_t>(most), line.words.size());
    }
    if (value >= line.words.size()) break;
    if (option == "-bm") map.bump = real_number(line.words[value]).value_or(1);
    if (option == "-clamp" && line.words[value] == "on") {
      map.edges.u = map.edges.v = TextureEdge::clamp;
    }
  }
  map.file = rest_of(line, k);
  return map;
}

bool is_grey(const Texture& texture) {
  for (std::size_t k = 0; k < texture.rgba.size(); k += 4) {
    if (texture.rgba[k] != texture.rgba[k + 1] || texture.rgba[k] != texture.rgba[k + 2]) {
      return false;
    }
  }
  return true;
}

class Reader {
 public:
  Reader(Model& model, ModelPictures& pictures, MtlNames& names, std::string library)
      : model_(model), pictures_(pictures), names_(names), library_(std::move(library)) {}

  void line(const MeshLines& line) {
    const std::string word = lower_case(line.words[0]);
    if (word.starts_with('#')) return;
    if (word == "newmtl") {
      const auto number = static_cast<std::uint32_t>(model_.looks->materials.size());
      model_.looks->materials.emplace_back().name = rest_of(line, 1);
      names_.try_emplace(rest_of(line, 1), number);
      map_kd_.clear();
      diffuse_ = false;
      started_ = true;
      return;
    }
    if (!started_) return;
    Material& m = model_.looks->materials.back();
    if (word == "kd") {
      diffuse_ = colour(line, m.base_colour);
    } else if (word == "ks") {
      colour(line, m.specular);
    } else if (word == "ke") {
      colour(line, m.emissive);
    } else if (word == "ns") {
      number(line, m.shininess, 0, 1e6);
    } else if (word == "d" && line.words.size() == 2) {
      number(line, m.opacity, 0, 1);
    } else if (word == "tr") {
      double clear = 0;
      if (number(line, clear, 0, 1)) m.opacity = 1 - clear;
    } else if (word == "map_kd") {
      const Map map = map_of(line);
      map_kd_ = map.file;
      m.base_texture = picture(map, line);
      if (m.base_texture >= 0 && !diffuse_) m.base_colour = Vec3(1);
    } else if (word == "map_bump" || word == "bump" || word == "norm") {
      normals(map_of(line), line, m);
    } else if (word == "map_d" && map_of(line).file == map_kd_ && !map_kd_.empty()) {
      m.alpha = TextureAlpha::cut;
    } else if (word.starts_with("map_") || word == "disp" || word == "decal" || word == "refl") {
      warn(
          model_.warnings,
          "Maps of materials but of the base colour and normals (map_Kd, map_Bump, norm) were left "
          "out.",
          where(line));
    }
  }

 private:
  std::string where(const MeshLines& line) const {
    return fmt::format("{}: {}: line {}", model_.report.path, in_quotes(library_, 200),
                       line.number);
  }

  bool number(const MeshLines& line, double& to, double least, double most) {
    const auto value = line.words.size() > 1 ? real_number(line.words[1]) : std::optional<double>();
    if (!value || !std::isfinite(*value)) return not_a_number(line);
    to = std::clamp(*value, least, most);
    return true;
  }

  // "Kd r g b", or "Kd r" for a grey.
  bool colour(const MeshLines& line, Vec3& to) {
    Vec3 rgb(0);
    for (int k = 0; k < 3; ++k) {
      const std::size_t at = line.words.size() == 2 ? 1 : static_cast<std::size_t>(k) + 1;
      const auto value =
          at < line.words.size() ? real_number(line.words[at]) : std::optional<double>();
      if (!value || !std::isfinite(*value)) return not_a_number(line);
      rgb[k] = std::max(0.0, *value);
    }
    to = rgb;
    return true;
  }

  bool not_a_number(const MeshLines& line) {
    warn(model_.warnings, "Values of materials that are no numbers were left out.", where(line));
    return false;
  }

  int picture(const Map& map, const MeshLines& line) {
    if (map.shifted) {
      warn(model_.warnings, "Maps of materials are not moved or scaled (-o, -s, -t).", where(line));
    }
    std::string folder = library_.substr(0, library_.find_last_of("/\\") + 1);
    return pictures_.file(folder + map.file, map.edges);
  }

  void normals(const Map& map, const MeshLines& line, Material& m) {
    const int texture = picture(map, line);
    if (texture < 0) return;
    if (is_grey(model_.looks->textures[static_cast<std::size_t>(texture)])) {
      warn(model_.warnings, "Bump maps that hold heights, not normals, were left out.",
           where(line));
      return;
    }
    m.normal_texture = texture;
    m.normal_scale = map.bump;
  }

  Model& model_;
  ModelPictures& pictures_;
  MtlNames& names_;
  std::string library_, map_kd_;
  bool diffuse_ = false, started_ = false;
};

}  // namespace

void read_mtl(const std::string& library, Model& model, ModelPictures& pictures, MtlNames& names) {
  const auto text = read_beside_model(model.report.path, library);
  if (!text) {
    warn(model.warnings, "Libraries of materials (.mtl) were not found; put them beside the model.",
         fmt::format("{}: {}", model.report.path, in_quotes(library, 200)));
    return;
  }
  read_mtl_text(text.value(), library, model, pictures, names);
}

void read_mtl_text(std::string_view text, const std::string& library, Model& model,
                   ModelPictures& pictures, MtlNames& names) {
  Reader reader(model, pictures, names, library);
  for (MeshLines lines(text); lines.next();) reader.line(lines);
}

}  // namespace gnomon
