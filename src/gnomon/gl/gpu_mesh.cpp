#include <gnomon/gl/gpu_mesh.h>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <gnomon/gl/program.h>

namespace gnomon::gl {
namespace {

struct Corner {
  glm::vec3 position, normal;
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
  for (std::size_t t = 0; t < m.mesh.triangles.size(); ++t) {
    if (m.receives[t] == 0) continue;
    const Triangle& v = m.mesh.triangles[t];
    const Vec3 &a = m.mesh.positions[v[0]], &b = m.mesh.positions[v[1]],
               &c = m.mesh.positions[v[2]];
    const Vec3 n = glm::cross(b - a, c - a);
    const double length = glm::length(n);
    const glm::vec3 normal = length > 0 ? glm::vec3(n / length) : glm::vec3(0, 0, 1);
    for (const Vec3& p : {a, b, c}) corners.push_back({glm::vec3(p), normal});
  }
  glBindVertexArray(0);
  upload(m.doubled, GL_ARRAY_BUFFER, doubled.data(), doubled.size() * sizeof(glm::vec4));
  upload(m.corners, GL_ARRAY_BUFFER, corners.data(), corners.size() * sizeof(Corner));
}

void find_parts(GpuMesh& m) {
  m.parts = split_into_parts(m.mesh, m.edges, m.casts);
  m.part_edges = edges_of_parts(m.edges, m.parts.part_of, m.parts.parts.size());
  m.part_seen.assign(m.parts.parts.size(), 1);
  for (std::size_t p = 0; p < m.parts.parts.size(); ++p) {
    for (const std::uint32_t t : m.parts.parts[p].triangles) m.part_seen[p] &= m.receives[t];
  }
}

}  // namespace

GpuMesh make_gpu_mesh(const TriMesh& mesh, std::vector<std::uint8_t> casts,
                      std::vector<std::uint8_t> receives) {
  GpuMesh m;
  m.mesh = mesh;
  for (Vec3& p : m.mesh.positions) p = rounded(p);
  m.casts = std::move(casts);
  m.receives = std::move(receives);
  m.casts.resize(mesh.triangles.size(), 1);
  m.receives.resize(mesh.triangles.size(), 1);
  m.edges = build_edge_table(m.mesh, m.casts);
  find_parts(m);
  std::vector<std::uint32_t> surface;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (m.receives[t] == 0) continue;
    for (const std::uint32_t v : mesh.triangles[t]) surface.push_back(2 * v);
    if (m.casts[t] == 0) m.only_receive.push_back(t);
  }
  m.surface_count = static_cast<GLsizei>(surface.size());

  m.doubled = Buffer::make();
  m.corners = Buffer::make();
  m.surface_indices = Buffer::make();
  upload_vertices(m);
  m.surface = VertexArray::make();
  glBindVertexArray(m.surface.id());
  upload(m.surface_indices, GL_ELEMENT_ARRAY_BUFFER, surface.data(),
         surface.size() * sizeof(std::uint32_t));
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
  glBindVertexArray(0);
  return m;
}

void move_vertices(GpuMesh& m, std::span<const Vec3> positions) {
  for (std::size_t i = 0; i < m.mesh.positions.size(); ++i)
    m.mesh.positions[i] = rounded(positions[i]);
  find_parts(m);
  upload_vertices(m);
}

}  // namespace gnomon::gl
