#include "fuzz/check.h"

#include <gnomon/core/exact.h>
#include <gnomon/io/mesh_text.h>
#include <gnomon/io/triangulate.h>
#include <gnomon/mesh/weld.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace gnomon::fuzz {
namespace {

// Models above this are read, but not triangulated: a fuzzer needs many inputs a second.
constexpr std::size_t kMostCorners = 5000;

bool one_line(const std::string& text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f; });
}

void check_indices(const Model& m) {
  require(!m.ring_begin.empty() && m.ring_begin.front() == 0, "the first ring begins at corner 0");
  require(std::is_sorted(m.ring_begin.begin(), m.ring_begin.end()), "rings follow each other");
  require(m.ring_begin.back() == m.corners.size(), "the last ring ends with the last corner");
  for (const std::uint32_t v : m.corners) {
    require(v < m.vertices.size(), "a corner is a vertex");
  }
  for (const ModelPolygon& p : m.polygons) {
    require(p.surface < m.surfaces.size(), "a polygon has a surface");
    require(p.first_ring < p.last_ring && p.last_ring < m.ring_begin.size(),
            "a polygon has rings of its own");
  }
}

void check_looks(const Model& m) {
  if (!m.looks) return;
  const ModelLooks& l = *m.looks;
  require(l.material_of.size() <= m.polygons.size(), "no more materials than polygons");
  require(l.uv.size() <= m.corners.size() && l.normals.size() <= m.corners.size(),
          "no more looks than corners");
  for (const std::uint32_t k : l.material_of) {
    require(k == kNoMaterial || k < l.materials.size(), "a polygon's material is there");
  }
  for (const glm::vec2& uv : l.uv) {
    require(std::isfinite(uv.x) && std::isfinite(uv.y), "texture coordinates are finite");
  }
  const auto is_texture = [&](int k) { return k >= -1 && k < static_cast<int>(l.textures.size()); };
  for (const Material& k : l.materials) {
    require(is_texture(k.base_texture) && is_texture(k.normal_texture) &&
                is_texture(k.emissive_texture),
            "a material's pictures are there");
    require(k.opacity >= 0 && k.opacity <= 1 && k.shininess >= 0 && std::isfinite(k.shininess) &&
                std::isfinite(k.base_colour.x + k.specular.x + k.emissive.x + k.normal_scale),
            "a material's numbers are in range");
  }
}

// False where load_scene refuses the model because of it.
bool fits_exact_arithmetic(const Model& m) {
  bool fits = true;
  for (const std::uint32_t v : m.corners) {
    require(is_finite(m.vertices[v]), "a corner's coordinates are finite");
    const Vec3 at = m.vertices[v] * m.scale + m.translate;
    for (int k = 0; k < 3; ++k) fits = fits && std::fabs(at[k]) <= kLargestCoordinate;
  }
  return fits;
}

void triangulate_and_weld(const Model& m) {
  TriMesh mesh;
  for (const Vec3& v : m.vertices) mesh.positions.push_back(v * m.scale + m.translate);
  std::vector<std::uint32_t> surface_of;
  for (const ModelPolygon& p : m.polygons) {
    std::vector<std::vector<std::uint32_t>> rings;
    for (std::uint32_t r = p.first_ring; r < p.last_ring; ++r) {
      rings.emplace_back(m.corners.begin() + m.ring_begin[r],
                         m.corners.begin() + m.ring_begin[r + 1]);
    }
    const Triangulation result = triangulate(mesh.positions, rings);
    require(!result.triangles.empty() || !result.problem.empty(),
            "a polygon without triangles has a problem");
    for (const Triangle& t : result.triangles) {
      for (const std::uint32_t v : t) {
        const bool own = std::any_of(rings.begin(), rings.end(), [&](const auto& ring) {
          return std::find(ring.begin(), ring.end(), v) != ring.end();
        });
        require(own, "triangles use only the polygon's corners");
      }
      mesh.triangles.push_back(t);
      surface_of.push_back(p.surface);
    }
  }
  // load_scene refuses what corners have; vertices that no corner uses may be anywhere.
  for (Vec3& v : mesh.positions) {
    for (int k = 0; k < 3; ++k) {
      if (!(std::fabs(v[k]) <= kLargestCoordinate)) v[k] = 0;
    }
  }
  const std::size_t before = mesh.triangles.size();
  const WeldReport report = weld(mesh, surface_of);
  require(mesh.triangles.size() + report.zero_area_triangles == before,
          "welding drops only triangles of no area");
  require(surface_of.size() == mesh.triangles.size(), "each triangle keeps its surface");
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) require(v < mesh.positions.size(), "welded corners are there");
    require(t[0] != t[1] && t[1] != t[2] && t[2] != t[0], "welded triangles have three corners");
  }
}

}  // namespace

void require(bool kept, const std::string& promise) {
  if (!kept) throw Finding("broken promise: " + promise);
}

void check_message(const Error& error, const std::string& path) {
  require(error.message.starts_with(path + ": "), "a message names the file: " + error.message);
  require(one_line(error.message), "a message is one line: " + error.message);
}

void check_warnings(const Warnings& warnings) {
  for (const Warning& w : warnings) {
    require(w.count > 0 && !w.what.empty(), "a warning says what happened how often");
    require(one_line(w.what), "a warning is one line: " + w.what);
    require(one_line(w.first), "a warning's element is one line: " + w.first);
  }
}

void check_model(const Model& model) {
  check_indices(model);
  check_looks(model);
  check_warnings(model.warnings);
  if (fits_exact_arithmetic(model) && model.corners.size() <= kMostCorners) {
    triangulate_and_weld(model);
  }
}

void check(const Result<Model>& read, const std::string& path) {
  if (read) {
    check_model(read.value());
  } else {
    check_message(read.error(), path);
  }
}

}  // namespace gnomon::fuzz
