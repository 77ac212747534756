#include <fmt/format.h>
#include <gnomon/io/gltf_looks.h>
#include <gnomon/io/gltf_values.h>
#include <gnomon/io/mesh_text.h>
#include <gnomon/io/pbr_looks.h>
#include <gnomon/io/read_picture.h>
#include <gnomon/io/read_text.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gnomon {
namespace {

using cityjson::element;
using cityjson::member;
using Json = nlohmann::json;

double number_or(const Json* value, double otherwise) {
  return cityjson::number(value).value_or(otherwise);
}

Vec3 colour_or(const Json* list, const Vec3& otherwise) {
  const auto rgb = cityjson::vec3(list);
  if (!rgb) return otherwise;
  return {std::max(0.0, rgb->x), std::max(0.0, rgb->y), std::max(0.0, rgb->z)};
}

TextureEdge edge_of(const Json* value) {
  const double code = number_or(value, 10497);
  return code == 33071   ? TextureEdge::clamp
         : code == 33648 ? TextureEdge::mirror
                         : TextureEdge::repeat;
}

bool is_read(const std::string& extension) {
  return extension == "KHR_materials_emissive_strength";
}

}  // namespace

GltfLooks::GltfLooks(const GltfFile& file, Model& model)
    : f_(file), model_(model), pictures_(model) {
  model.looks.emplace();
}

void GltfLooks::warn_of(const char* what, const std::string& where) {
  warn(model_.warnings, what, fmt::format("{}: {}", f_.path, where));
}

std::vector<Vec3> GltfLooks::normals(const Json& attributes, std::size_t count,
                                     const std::string& where) {
  const Json* normal = member(&attributes, "NORMAL");
  if (!normal) return {};
  const auto read = read_accessor(f_, normal, "VEC3");
  std::vector<Vec3> out = read ? vectors_of(read.value()) : std::vector<Vec3>();
  if (out.size() == count && std::all_of(out.begin(), out.end(), is_finite)) return out;
  warn_of("Normals that cannot be read were left out.", where);
  return {};
}

GltfCorners GltfLooks::corners(const Json& primitive, std::size_t count, const std::string& where) {
  GltfCorners out;
  const Json* attributes = member(&primitive, "attributes");
  if (member(attributes, "COLOR_0")) warn_of("Colours of vertices were left out.", where);
  const Json* value = member(&primitive, "material");
  if (!value) return out;
  const auto m = cityjson::index_below(value, size_of(member(&f_.json, "materials")));
  if (!m) {
    warn_of("Primitives name materials that are not in the file.", where);
    return out;
  }
  const Known& known = material(*m);
  out.material = known.material;
  if (!known.textured) return out;
  const Mapping& map = known.mapping;
  const Json* coordinates = member(attributes, fmt::format("TEXCOORD_{}", map.set).c_str());
  const auto read = read_accessor(f_, coordinates, "VEC2");
  if (!read || read.value().size() != 2 * count) {
    warn_of("Primitives have pictures, but no texture coordinates for them.", where);
    return out;
  }
  // Counter-clockwise as the picture is seen, its v downwards: so the extension's text and viewers;
  // the matrix that it prints turns the other way.
  const double c = std::cos(map.rotation), s = std::sin(map.rotation);
  for (std::size_t k = 0; k < count; ++k) {
    const double u = read.value()[2 * k] * map.scale.x, v = read.value()[2 * k + 1] * map.scale.y;
    const glm::dvec2 uv(c * u + s * v + map.offset.x, c * v - s * u + map.offset.y);
    const bool finite = std::isfinite(uv.x) && std::isfinite(uv.y);
    out.uv.push_back(finite ? glm::vec2(uv) : glm::vec2(0));
  }
  return out;
}

const GltfLooks::Known& GltfLooks::material(std::size_t number) {
  const auto [at, added] = materials_.try_emplace(number);
  Known& known = at->second;
  if (!added) return known;
  const Json* json = element(member(&f_.json, "materials"), number);
  const Json none = Json::object();
  const Json& from = json && json->is_object() ? *json : none;
  Material m;
  m.name = cityjson::text(member(&from, "name"));
  const std::string where = fmt::format("material {}", number);
  const Json* extensions = member(&from, "extensions");
  if (extensions && extensions->is_object()) {
    for (const auto& [name, content] : extensions->items()) {
      if (!is_read(name))
        warn_of("Extensions of materials that are not read were left out.",
                fmt::format("{}: {}", where, in_quotes(name)));
    }
  }
  add_metal(from, m);
  const Json* glow = member(extensions, "KHR_materials_emissive_strength");
  const double strength = std::max(0.0, number_or(member(glow, "emissiveStrength"), 1));
  const Vec3 emissive = strength * colour_or(member(&from, "emissiveFactor"), Vec3(0));
  for (int k = 0; k < 3; ++k) m.emissive[k] = srgb_encoded(emissive[k]);
  const Json* two = member(&from, "doubleSided");
  m.double_sided = two && two->is_boolean() && two->get<bool>();
  add_pictures(from, m, known);
  known.material = static_cast<std::uint32_t>(model_.looks->materials.size());
  model_.looks->materials.push_back(std::move(m));
  return known;
}

// Base colour, metallic, roughness, opacity.
void GltfLooks::add_metal(const Json& material, Material& m) {
  const Json* pbr = member(&material, "pbrMetallicRoughness");
  const Json* factor = member(pbr, "baseColorFactor");
  const auto base = numbers_of(factor, 4).value_or(std::vector<double>{1, 1, 1, 1});
  double metallic = number_or(member(pbr, "metallicFactor"), 1);
  double roughness = number_or(member(pbr, "roughnessFactor"), 1);
  if (const Json* info = member(pbr, "metallicRoughnessTexture")) {
    std::string name;
    const auto bytes = bytes_of(image_of(info, name));
    const auto picture = bytes ? read_picture(bytes.value(), name) : Result<Texture>(bytes.error());
    if (picture) {
      double blue = 0, green = 0;
      const std::vector<std::uint8_t>& rgba = picture.value().rgba;
      for (std::size_t k = 0; k < rgba.size(); k += 4) green += rgba[k + 1], blue += rgba[k + 2];
      const double n = 255.0 * double(rgba.size() / 4);
      metallic *= blue / n, roughness *= green / n;
    }
    warn_of("Maps of metal and roughness were replaced by their mean.",
            fmt::format("material {}", in_quotes(m.name)));
  }
  const auto clamped = [&](std::size_t k) { return std::clamp(base[k], 0.0, 1.0); };
  set_metallic_rough(m, {clamped(0), clamped(1), clamped(2)}, metallic, roughness);
  const std::string mode = cityjson::text(member(&material, "alphaMode"));
  if (mode == "BLEND") {
    m.alpha = TextureAlpha::blended;
    m.opacity = clamped(3);
  } else if (mode == "MASK") {
    const double cutoff = number_or(member(&material, "alphaCutoff"), 0.5);
    m.alpha = TextureAlpha::cut;
    m.alpha_cutoff = clamped(3) > 0 ? cutoff / clamped(3) : cutoff > 0 ? 2 : 0;
  }
}

void GltfLooks::add_pictures(const Json& material, Material& m, Known& known) {
  const std::string where = fmt::format("material {}", in_quotes(m.name));
  const Json* normal = member(&material, "normalTexture");
  m.base_texture =
      texture(member(member(&material, "pbrMetallicRoughness"), "baseColorTexture"), known, where);
  m.emissive_texture = texture(member(&material, "emissiveTexture"), known, where);
  m.normal_texture = texture(normal, known, where);
  m.normal_scale = number_or(member(normal, "scale"), 1);
  if (member(&material, "emissiveTexture") && m.emissive_texture < 0) m.emissive = Vec3(0);
  if (member(&material, "occlusionTexture")) {
    warn_of("Maps of occlusion were left out.", where);
  }
}

GltfLooks::Mapping GltfLooks::mapping_of(const Json& info) const {
  Mapping map;
  const Json* transform = member(member(&info, "extensions"), "KHR_texture_transform");
  const Json* set = member(transform, "texCoord");
  if (!set) set = member(&info, "texCoord");
  map.set = cityjson::index_below(set, 1000).value_or(0);
  if (const auto o = numbers_of(member(transform, "offset"), 2)) map.offset = {(*o)[0], (*o)[1]};
  if (const auto s = numbers_of(member(transform, "scale"), 2)) map.scale = {(*s)[0], (*s)[1]};
  map.rotation = number_or(member(transform, "rotation"), 0);
  return map;
}

int GltfLooks::texture(const Json* info, Known& known, const std::string& where) {
  if (!info) return -1;
  const Mapping map = mapping_of(*info);
  if (known.textured && map != known.mapping) {
    warn_of("Pictures that lie otherwise on the surface than the material's first were left out.",
            where);
    return -1;
  }
  std::string name;
  const Json* image = image_of(info, name);
  const Json* textures = member(&f_.json, "textures");
  const auto t = cityjson::index_below(member(info, "index"), size_of(textures));
  const Json* samplers = member(&f_.json, "samplers");
  const auto s =
      t ? cityjson::index_below(member(element(textures, *t), "sampler"), size_of(samplers))
        : std::nullopt;
  const Json* sampler = s ? element(samplers, *s) : nullptr;
  const PictureEdges edges{edge_of(member(sampler, "wrapS")), edge_of(member(sampler, "wrapT")),
                           number_or(member(sampler, "magFilter"), 9729) != 9728};
  const std::string uri = cityjson::text(member(image, "uri"));
  int found = -1;
  if (!uri.empty() && !uri.starts_with("data:")) {
    found = pictures_.file(percent_decoded(uri), edges);
  } else {
    const auto bytes = bytes_of(image);
    found = pictures_.bytes(bytes ? bytes.value() : std::string(), name, name, edges);
  }
  if (found >= 0) known.textured = true, known.mapping = map;
  return found;
}

const Json* GltfLooks::image_of(const Json* info, std::string& name) const {
  const Json *textures = member(&f_.json, "textures"), *images = member(&f_.json, "images");
  const auto t = cityjson::index_below(member(info, "index"), size_of(textures));
  const auto i = t ? cityjson::index_below(member(element(textures, *t), "source"), size_of(images))
                   : std::nullopt;
  name = i ? fmt::format("image {}", *i) : "an image that is not in the file";
  const Json* image = i ? element(images, *i) : nullptr;
  if (const std::string own = cityjson::text(member(image, "name")); !own.empty()) {
    name += fmt::format(" {}", printable(own, 100));
  }
  return image;
}

Result<std::string> GltfLooks::bytes_of(const Json* image) const {
  const std::string uri = cityjson::text(member(image, "uri"));
  if (uri.starts_with("data:")) {
    auto bytes = bytes_of_data_uri(uri);
    if (!bytes) return Error{"its data are no base64"};
    return std::move(*bytes);
  }
  if (!uri.empty()) return read_beside_model(f_.path, percent_decoded(uri));
  return read_buffer_view(f_, member(image, "bufferView"));
}

void add_look(Model& model, const GltfCorners& corners, const std::vector<Vec3>& normals,
              const std::uint32_t (&of)[3]) {
  std::vector<glm::vec2> uv;
  std::vector<glm::vec3> turned;
  for (const std::uint32_t v : of) {
    if (!corners.uv.empty()) uv.push_back(corners.uv[v]);
    if (!normals.empty()) turned.push_back(glm::vec3(z_up(normals[v], 'y')));
  }
  add_look(model, corners.material, uv, turned);
}

}  // namespace gnomon
