#include <fmt/format.h>
#include <gnomon/io/cityjson_looks.h>
#include <gnomon/io/read_text.h>

#include <optional>

namespace gnomon::cityjson {
namespace {

// CityJSON's shininess goes from 0 to 1, as in X3D, whose exponent is 128 times as much.
constexpr double kShininess = 128;

}  // namespace

std::uint32_t material_of(Reading& reading, const Json& material) {
  Model& model = reading.builder.model;
  const auto [at, added] =
      reading.materials.try_emplace(material.dump(-1, ' ', true, Json::error_handler_t::replace),
                                    static_cast<std::uint32_t>(model.looks->materials.size()));
  if (!added) return at->second;
  Material m;
  m.name = text(member(&material, "name"));
  const auto refused = [&](const char* key) {
    warn(model.warnings, "Values of materials that are no numbers from 0 to 1 were left out.",
         fmt::format("{}: material {}, {}", reading.path, in_quotes(m.name, 200), key));
  };
  const auto unit = [](double d) { return d >= 0 && d <= 1; };
  const auto colour = [&](const char* key, Vec3& to) {
    const Json* value = member(&material, key);
    if (!value) return;
    const auto rgb = vec3(value);
    if (rgb && unit(rgb->x) && unit(rgb->y) && unit(rgb->z)) {
      to = *rgb;
    } else {
      refused(key);
    }
  };
  const auto part = [&](const char* key) -> std::optional<double> {
    const Json* value = member(&material, key);
    if (!value) return {};
    const auto d = number(value);
    if (d && unit(*d)) return d;
    refused(key);
    return {};
  };
  colour("diffuseColor", m.base_colour);
  colour("emissiveColor", m.emissive);
  colour("specularColor", m.specular);
  if (const auto shininess = part("shininess")) m.shininess = kShininess * *shininess;
  if (const auto transparency = part("transparency")) m.opacity = 1 - *transparency;
  model.looks->materials.push_back(std::move(m));
  return at->second;
}

}  // namespace gnomon::cityjson
