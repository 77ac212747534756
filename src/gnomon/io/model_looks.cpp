#include <gnomon/io/model.h>
#include <gnomon/io/model_looks.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace gnomon {
namespace {

glm::vec3 unit(const glm::vec3& v) {
  const float length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  return length > 0 && std::isfinite(length) ? v / length : glm::vec3(0);
}

}  // namespace

void add_look(Model& model, std::uint32_t material, const std::vector<glm::vec2>& uv,
              const std::vector<glm::vec3>& normals) {
  ModelLooks& looks = *model.looks;
  const ModelPolygon& p = model.polygons.back();
  const std::size_t first = model.ring_begin[p.first_ring];
  looks.material_of.resize(model.polygons.size(), kNoMaterial);
  looks.material_of.back() = material;
  if (!uv.empty()) {
    looks.uv.resize(first, glm::vec2(0));
    looks.uv.insert(looks.uv.end(), uv.begin(), uv.end());
  }
  if (!normals.empty()) {
    looks.normals.resize(first, glm::vec3(0));
    looks.normals.insert(looks.normals.end(), normals.begin(), normals.end());
  }
}

void turn_normals(Model& model, double clockwise) {
  if (!model.looks) return;
  const auto c = static_cast<float>(std::cos(clockwise)),
             s = static_cast<float>(std::sin(clockwise));
  for (glm::vec3& n : model.looks->normals) n = {n.x * c + n.y * s, n.y * c - n.x * s, n.z};
}

std::uint32_t add_materials(Appearance& appearance, ModelLooks& looks) {
  const auto first = static_cast<std::uint32_t>(appearance.materials.size());
  const int first_texture = static_cast<int>(appearance.textures.size());
  for (Material& m : looks.materials) {
    if (m.base_texture >= 0) m.base_texture += first_texture;
    if (m.normal_texture >= 0) m.normal_texture += first_texture;
    if (m.emissive_texture >= 0) m.emissive_texture += first_texture;
    appearance.materials.push_back(std::move(m));
  }
  std::move(looks.textures.begin(), looks.textures.end(), std::back_inserter(appearance.textures));
  looks.materials.clear();
  looks.textures.clear();
  return first;
}

void add_triangle_looks(Appearance& appearance, const Model& model, const ModelPolygon& polygon,
                        const Triangle* triangles, std::size_t count, std::uint32_t first_vertex,
                        std::uint32_t first_material) {
  const ModelLooks& looks = *model.looks;
  const auto number = static_cast<std::size_t>(&polygon - model.polygons.data());
  const std::uint32_t material =
      number < looks.material_of.size() ? looks.material_of[number] : kNoMaterial;
  const std::uint32_t begin = model.ring_begin[polygon.first_ring],
                      end = model.ring_begin[polygon.last_ring];
  const std::uint32_t* corners = model.corners.data();
  // Corners of the polygon by their vertices, the first of each at its place.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> by_vertex;
  for (std::uint32_t c = begin; c < end; ++c) by_vertex.emplace_back(corners[c], c);
  std::sort(by_vertex.begin(), by_vertex.end());

  std::size_t t = appearance.material_of.size();
  const bool uv = begin < looks.uv.size(), normals = begin < looks.normals.size();
  if (uv) appearance.uv.resize(t + count, {});
  if (normals) appearance.normals.resize(t + count, {});
  appearance.material_of.resize(t + count,
                                material == kNoMaterial ? material : first_material + material);
  if (!uv && !normals) return;
  for (std::size_t k = 0; k < count; ++k, ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::pair<std::uint32_t, std::uint32_t> first{triangles[k][c] - first_vertex, 0};
      const std::uint32_t at = std::lower_bound(by_vertex.begin(), by_vertex.end(), first)->second;
      if (at < looks.uv.size()) appearance.uv[t][c] = looks.uv[at];
      if (at < looks.normals.size()) appearance.normals[t][c] = unit(looks.normals[at]);
    }
  }
}

void finish_looks(Appearance& appearance, std::size_t triangles) {
  const bool textured =
      std::any_of(appearance.materials.begin(), appearance.materials.end(), [](const Material& m) {
        return m.base_texture >= 0 || m.normal_texture >= 0 || m.emissive_texture >= 0;
      });
  if (!textured) appearance.uv.clear();
  const bool shaded =
      std::any_of(appearance.normals.begin(), appearance.normals.end(), [](const auto& corners) {
        return corners[0] != glm::vec3(0) || corners[1] != glm::vec3(0) ||
               corners[2] != glm::vec3(0);
      });
  if (!shaded) appearance.normals.clear();
  if (triangles > 0 && appearance.material_of.empty()) {
    appearance.material_of.assign(triangles, kNoMaterial);
  }
  fill_up(appearance, triangles);
}

}  // namespace gnomon
