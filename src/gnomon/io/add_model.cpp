#include <fmt/format.h>
#include <gnomon/io/add_model.h>
#include <gnomon/io/triangulate.h>

#include <utility>
#include <vector>

namespace gnomon {
namespace {

bool is_triangle(const Model& m, const ModelPolygon& p) {
  const std::uint32_t first = m.ring_begin[p.first_ring];
  if (p.last_ring - p.first_ring != 1 || m.ring_begin[p.last_ring] - first != 3) return false;
  const std::uint32_t* c = m.corners.data() + first;
  return c[0] != c[1] && c[1] != c[2] && c[2] != c[0];
}

}  // namespace

void add_model(Scene& scene, Model& m, std::uint32_t file, bool city) {
  TriMesh& mesh = scene.mesh;
  const auto first_vertex = static_cast<std::uint32_t>(mesh.positions.size());
  const auto first_surface = static_cast<std::uint32_t>(scene.surfaces.size());
  // Equal numbers in the file must give equal positions, and small ones exact differences: the
  // large offsets are subtracted from each other first.
  const Vec3 offset = m.translate - scene.frame.origin;
  mesh.positions.reserve(mesh.positions.size() + m.vertices.size());
  for (const Vec3& v : m.vertices) mesh.positions.push_back(v * m.scale + offset);

  Appearance& appearance = scene.appearance;
  std::uint32_t first_material = 0;
  if (m.looks) {
    first_material = add_materials(appearance, *m.looks);
    appearance.material_of.resize(mesh.triangles.size(), kNoMaterial);  // files without looks
  }
  const auto look = [&](const ModelPolygon& p, std::size_t count) {
    if (!m.looks) return;
    const Triangle* triangles = mesh.triangles.data() + mesh.triangles.size() - count;
    add_triangle_looks(appearance, m, p, triangles, count, first_vertex, first_material);
  };

  std::vector<std::vector<std::uint32_t>> rings;
  for (const ModelPolygon& p : m.polygons) {
    if (is_triangle(m, p)) {  // as triangulate() has it; surface models have millions of them
      const std::uint32_t* c = m.corners.data() + m.ring_begin[p.first_ring];
      mesh.triangles.push_back({first_vertex + c[0], first_vertex + c[1], first_vertex + c[2]});
      scene.surface_of.push_back(first_surface + p.surface);
      ++m.report.triangles;
      look(p, 1);
      continue;
    }
    rings.clear();
    for (std::uint32_t r = p.first_ring; r < p.last_ring; ++r) {
      auto& ring = rings.emplace_back();
      for (std::uint32_t c = m.ring_begin[r]; c < m.ring_begin[r + 1]; ++c) {
        ring.push_back(first_vertex + m.corners[c]);
      }
    }
    const Triangulation result = triangulate(mesh.positions, rings);
    for (const Triangle& t : result.triangles) {
      mesh.triangles.push_back(t);
      scene.surface_of.push_back(first_surface + p.surface);
    }
    m.report.triangles += result.triangles.size();
    look(p, result.triangles.size());
    if (result.problem.empty()) continue;
    warn(scene.warnings,
         result.triangles.empty()
             ? "Polygons of fewer than 3 distinct corners or without an area were left out."
             : "Polygons that are not simple could not be triangulated exactly.",
         fmt::format("{}: {}", name_of(m, p), result.problem));
  }
  for (Surface& s : m.surfaces) {
    s.file = file;
    s.city = city;
    scene.surfaces.push_back(std::move(s));
  }
  append(scene.warnings, m.warnings);
}

}  // namespace gnomon
