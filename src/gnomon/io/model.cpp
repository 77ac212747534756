#include <fmt/format.h>
#include <gnomon/io/model.h>
#include <gnomon/io/read_text.h>

#include <bit>

namespace gnomon {

std::size_t ModelBuilder::HashVertex::operator()(const Vec3& p) const {
  std::uint64_t h = 0x9e3779b97f4a7c15u;
  for (int k = 0; k < 3; ++k) {
    h ^= std::bit_cast<std::uint64_t>(p[k]);
    h *= 0xff51afd7ed558ccdu;
    h ^= h >> 32;
  }
  return h;
}

std::uint32_t ModelBuilder::vertex(const Vec3& raw) {
  const Vec3 p = raw + Vec3(0, 0, 0);  // turns -0 into 0: equal vertices have equal hashes
  const auto [at, added] =
      vertices_.try_emplace(p, static_cast<std::uint32_t>(model.vertices.size()));
  if (added) model.vertices.push_back(p);
  return at->second;
}

std::uint32_t ModelBuilder::surface(std::string_view object, std::string_view group,
                                    std::string_view material, std::string_view semantic,
                                    std::size_t whole) {
  std::string key;
  for (const std::string_view name : {object, group, material, semantic}) {
    key += fmt::format("{}:", name.size());  // lengths keep "a","bc" and "ab","c" apart
    key += name;
  }
  const auto [at, added] =
      surfaces_.try_emplace(std::move(key), static_cast<std::uint32_t>(model.surfaces.size()));
  if (added) {
    Surface s;
    s.object = object;
    s.whole = static_cast<std::uint32_t>(whole);
    s.group = group;
    s.material = material;
    s.semantic = semantic;
    model.surfaces.push_back(std::move(s));
  }
  return at->second;
}

void ModelBuilder::polygon(std::uint32_t surface, std::uint32_t number,
                           const std::vector<std::vector<std::uint32_t>>& rings) {
  ModelPolygon p;
  p.surface = surface;
  p.number = number;
  p.first_ring = static_cast<std::uint32_t>(model.ring_begin.size() - 1);
  for (const auto& ring : rings) {
    model.corners.insert(model.corners.end(), ring.begin(), ring.end());
    model.ring_begin.push_back(static_cast<std::uint32_t>(model.corners.size()));
  }
  p.last_ring = static_cast<std::uint32_t>(model.ring_begin.size() - 1);
  model.polygons.push_back(p);
}

std::string name_of(const Model& model, const ModelPolygon& polygon) {
  if (model.report.format == "OBJ") {
    return fmt::format("{}: line {}", model.report.path, polygon.number);
  }
  const std::string object = printable(model.surfaces[polygon.surface].object, 200);
  if (object.empty()) return fmt::format("{}: polygon {}", model.report.path, polygon.number);
  return fmt::format("{}: object \"{}\", polygon {}", model.report.path, object, polygon.number);
}

}  // namespace gnomon
