#include <gnomon/gl/gpu_mesh.h>

#include <algorithm>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <gnomon/gl/program.h>

namespace gnomon::gl {
namespace {

struct Corner {
  glm::vec3 position, normal;
  glm::vec2 texture;
};

void upload(const Buffer& buffer, GLenum target, const void* data, std::size_t bytes) {
  glBindBuffer(target, buffer.id());
  glBufferData(target, static_cast<GLsizeiptr>(bytes), data, GL_DYNAMIC_DRAW);
}

Vec3 rounded(const Vec3& p) { return Vec3(glm::vec3(p)); }

void upload_vertices(GpuMesh& m) {
  std::vector<glm::vec4> doubled;
  doubled.reserve(m.mesh.positions.size() * 2);
  for (const Vec3& p : m.mesh.positions) {
    doubled.emplace_back(glm::vec3(p), 1.0f);
    doubled.emplace_back(glm::vec3(p), 0.0f);
  }
  std::vector<Corner> corners;
  corners.reserve(static_cast<std::size_t>(m.surface_count));
  for (const std::uint32_t t : m.drawn) {
    const Triangle& v = m.mesh.triangles[t];
    const Vec3 &a = m.mesh.positions[v[0]], &b = m.mesh.positions[v[1]],
               &c = m.mesh.positions[v[2]];
    const Vec3 n = glm::cross(b - a, c - a);
    const double length = glm::length(n);
    const glm::vec3 facet = length > 0 ? glm::vec3(n / length) : glm::vec3(0, 0, 1);
    for (int i = 0; i < 3; ++i) {
      Corner corner{glm::vec3(m.mesh.positions[v[i]]), facet, glm::vec2(0.0f)};
      if (!m.appearance.normals.empty() && m.appearance.normals[t][i] != glm::vec3(0.0f))
        corner.normal = m.appearance.normals[t][i];
      // Shading normals on the facet's own side: which of them is lit is the facet's to say.
      if (glm::dot(corner.normal, facet) < 0) corner.normal = -corner.normal;
      if (!m.appearance.uv.empty()) corner.texture = m.appearance.uv[t][i];
      corners.push_back(corner);
    }
  }
  glBindVertexArray(0);
  upload(m.doubled, GL_ARRAY_BUFFER, doubled.data(), doubled.size() * sizeof(glm::vec4));
  upload(m.corners, GL_ARRAY_BUFFER, corners.data(), corners.size() * sizeof(Corner));
}

GpuMaterial gpu_material(const Material& m) {
  GpuMaterial g;
  g.base_colour = m.base_colour;
  g.emissive = m.emissive;
  g.specular = m.specular;
  g.shininess = m.specular == Vec3(0.0) ? 0.0f : static_cast<float>(m.shininess);
  g.normal_scale = static_cast<float>(m.normal_scale);
  if (m.base_texture >= 0) g.base_texture = static_cast<std::size_t>(m.base_texture);
  if (m.normal_texture >= 0) g.normal_texture = static_cast<std::size_t>(m.normal_texture);
  return g;
}

GLint wrap_of(TextureEdge edge) {
  return edge == TextureEdge::repeat   ? GL_REPEAT
         : edge == TextureEdge::mirror ? GL_MIRRORED_REPEAT
                                       : GL_CLAMP_TO_EDGE;
}

Texture2D upload_texture(const Texture& t) {
  Texture2D out = Texture2D::make();
  glBindTexture(GL_TEXTURE_2D, out.id());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, t.width, t.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               t.rgba.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap_of(t.edge_u));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap_of(t.edge_v));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
                  t.smooth ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST_MIPMAP_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, t.smooth ? GL_LINEAR : GL_NEAREST);
  return out;
}

// Receiving triangles, those of solid parts first, then by material, each material's in their own
// order.
void sort_drawn(GpuMesh& m) {
  m.drawn.clear();
  for (std::uint32_t t = 0; t < m.mesh.triangles.size(); ++t) {
    if (m.receives[t] != 0) m.drawn.push_back(t);
  }
  const std::vector<std::uint32_t>& of = m.appearance.material_of;
  const auto material = [&](std::uint32_t t) { return of.empty() ? kNoMaterial : of[t]; };
  const auto solid = [&](std::uint32_t t) {
    const std::uint32_t p = m.parts.part_of[t];
    return p != kNoPart && m.part_seen[p] != 0 && m.parts.parts[p].winding > 0;
  };
  std::stable_sort(m.drawn.begin(), m.drawn.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(!solid(a), material(a)) < std::pair(!solid(b), material(b));
  });
  m.materials.clear();
  m.solid_count = 0;
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i < m.drawn.size(); ++i) {
    const std::uint32_t t = m.drawn[i], number = material(t);
    if (i == 0 || material(m.drawn[i - 1]) != number || solid(m.drawn[i - 1]) != solid(t)) {
      m.materials.push_back(
          {number == kNoMaterial ? GpuMaterial{} : gpu_material(m.appearance.materials[number]),
           solid(t), static_cast<GLint>(3 * i), 0});
    }
    m.materials.back().count += 3;
    m.solid_count += solid(t) ? 3 : 0;
    for (const std::uint32_t v : m.mesh.triangles[t]) indices.push_back(2 * v);
  }
  m.surface_count = static_cast<GLsizei>(indices.size());
  glBindVertexArray(m.surface.id());
  upload(m.surface_indices, GL_ELEMENT_ARRAY_BUFFER, indices.data(),
         indices.size() * sizeof(std::uint32_t));
  glBindVertexArray(0);
}

void find_boxes(GpuMesh& m) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  m.lo = m.caster_lo = Vec3(kInf);
  m.hi = m.caster_hi = Vec3(-kInf);
  for (std::size_t t = 0; t < m.mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : m.mesh.triangles[t]) {
      const Vec3& p = m.mesh.positions[v];
      if (m.receives[t] != 0) {
        m.lo = glm::min(m.lo, p);
        m.hi = glm::max(m.hi, p);
      }
      if (m.casts[t] != 0) {
        m.caster_lo = glm::min(m.caster_lo, p);
        m.caster_hi = glm::max(m.caster_hi, p);
      }
    }
  }
}

void find_parts(GpuMesh& m) {
  find_boxes(m);
  m.parts = split_into_parts(m.mesh, m.edges, m.casts);
  m.part_edges = parts_of_edges(m.edges, m.parts, m.mesh.positions.size());
  m.part_seen.assign(m.parts.parts.size(), 1);
  for (std::size_t p = 0; p < m.parts.parts.size(); ++p) {
    for (const std::uint32_t t : m.parts.parts[p].triangles) m.part_seen[p] &= m.receives[t];
  }
}

}  // namespace

GpuMesh make_gpu_mesh(const TriMesh& mesh, std::vector<std::uint8_t> casts,
                      std::vector<std::uint8_t> receives, const Appearance* look) {
  GpuMesh m;
  m.mesh = mesh;
  for (Vec3& p : m.mesh.positions) p = rounded(p);
  m.casts = std::move(casts);
  m.receives = std::move(receives);
  m.casts.resize(mesh.triangles.size(), 1);
  m.receives.resize(mesh.triangles.size(), 1);
  m.edges = build_edge_table(m.mesh, m.casts);
  find_parts(m);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (m.receives[t] != 0 && m.casts[t] == 0) m.only_receive.push_back(t);
  }
  if (look != nullptr) {
    for (const Texture& texture : look->textures) m.textures.push_back(upload_texture(texture));
    m.appearance = *look;
    m.appearance.textures.clear();
    m.smooth = !look->normals.empty();
  }
  m.doubled = Buffer::make();
  m.corners = Buffer::make();
  m.surface_indices = Buffer::make();
  m.surface = VertexArray::make();
  sort_drawn(m);
  upload_vertices(m);
  glBindVertexArray(m.surface.id());
  glBindBuffer(GL_ARRAY_BUFFER, m.doubled.id());
  glEnableVertexAttribArray(kVertex);
  glVertexAttribPointer(kVertex, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  m.shaded = VertexArray::make();
  glBindVertexArray(m.shaded.id());
  glBindBuffer(GL_ARRAY_BUFFER, m.corners.id());
  glEnableVertexAttribArray(kVertex);
  glVertexAttribPointer(kVertex, 3, GL_FLOAT, GL_FALSE, sizeof(Corner), nullptr);
  glEnableVertexAttribArray(kNormal);
  glVertexAttribPointer(kNormal, 3, GL_FLOAT, GL_FALSE, sizeof(Corner),
                        reinterpret_cast<const void*>(sizeof(glm::vec3)));
  glEnableVertexAttribArray(kTexture);
  glVertexAttribPointer(kTexture, 2, GL_FLOAT, GL_FALSE, sizeof(Corner),
                        reinterpret_cast<const void*>(2 * sizeof(glm::vec3)));
  glBindVertexArray(0);
  return m;
}

void move_vertices(GpuMesh& m, std::span<const Vec3> positions) {
  for (std::size_t i = 0; i < m.mesh.positions.size(); ++i)
    m.mesh.positions[i] = rounded(positions[i]);
  vertices_moved(m.silhouettes);
  find_parts(m);
  sort_drawn(m);
  upload_vertices(m);
}

}  // namespace gnomon::gl
