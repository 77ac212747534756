#include <gnomon/gl/caster_volumes.h>

#include <gnomon/gl/program.h>
#include <gnomon/silhouette/light_sides.h>

namespace gnomon::gl {
namespace {

void append_part(VolumeLists& lists, const GpuMesh& m, std::uint32_t p, const PartPlan& plan,
                 const std::vector<std::int8_t>& sides, bool directional) {
  const Part& part = m.parts.parts[p];
  if (plan.by_polygon) {
    for (const std::uint32_t t : part.triangles) {
      if (casts(plan.casting, sides[t])) append_prism(lists, m.mesh, t, sides[t], directional, p);
    }
    return;
  }
  const std::span<const std::uint32_t> edges(m.part_edges.edge.data() + m.part_edges.first[p],
                                             m.part_edges.first[p + 1] - m.part_edges.first[p]);
  append_volume(lists, m.mesh, m.edges, edges, part.triangles, m.parts.part_of, p, sides,
                directional, plan.casting, p);
}

// The doubled vertices, extruded on the CPU by the same float operations as in the shader.
std::vector<glm::vec4> extrude(const TriMesh& mesh, const Light& light) {
  const glm::vec4 l(light);
  std::vector<glm::vec4> out;
  out.reserve(mesh.positions.size() * 2);
  for (const Vec3& position : mesh.positions) {
    const glm::vec3 p(position);
    out.emplace_back(p, 1.0f);
    out.emplace_back(p.x * l.w - l.x, p.y * l.w - l.y, p.z * l.w - l.z, 0.0f);
  }
  return out;
}

}  // namespace

bool update_volumes(CasterVolumes& v, const GpuMesh& m, std::uint64_t mesh_version,
                    const Light& light, const std::vector<PartPlan>& plan, const Method& method) {
  if (v.array && v.light == light && v.plan == plan && v.extrusion == method.extrusion &&
      v.primitives == method.primitives && v.mesh_version == mesh_version) {
    return false;
  }
  v.light = light;
  v.plan = plan;
  v.extrusion = method.extrusion;
  v.primitives = method.primitives;
  v.mesh_version = mesh_version;

  const std::vector<std::int8_t> sides = light_sides(m.mesh, light);
  const bool directional = light.w == 0;
  v.lists = {};
  v.polygon.clear();
  std::array<std::uint32_t, kListKinds> ends{};
  for (const bool z_fail : {true, false}) {
    for (std::uint32_t p = 0; p < plan.size(); ++p) {
      if (plan[p].z_fail != z_fail) continue;
      append_part(v.lists, m, p, plan[p], sides, directional);
      v.polygon.resize(v.lists.volumes.size(), plan[p].by_polygon ? 1 : 0);
    }
    if (!z_fail) continue;
    v.z_fail_volumes = v.lists.volumes.size();
    for (int k = 0; k < kListKinds; ++k)
      ends[k] = static_cast<std::uint32_t>(v.lists.lists[k].size());
  }
  std::vector<std::uint32_t> indices;
  for (int k = 0; k < kListKinds; ++k) {
    const std::vector<std::uint32_t>& list = v.lists.lists[k];
    v.list_begin[k] = static_cast<std::uint32_t>(indices.size());
    v.z_fail[k] = {v.list_begin[k], ends[k]};
    v.z_pass[k] = {v.list_begin[k] + ends[k], static_cast<std::uint32_t>(list.size()) - ends[k]};
    indices.insert(indices.end(), list.begin(), list.end());
  }
  if (!v.array) {
    v.array = VertexArray::make();
    v.indices = Buffer::make();
    v.extruded = Buffer::make();
  }
  glBindVertexArray(v.array.id());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, v.indices.id());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(),
               GL_STREAM_DRAW);
  if (method.extrusion == Extrusion::cpu) {
    const std::vector<glm::vec4> vertices = extrude(m.mesh, light);
    glBindBuffer(GL_ARRAY_BUFFER, v.extruded.id());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(glm::vec4)),
                 vertices.data(), GL_STREAM_DRAW);
  } else {
    glBindBuffer(GL_ARRAY_BUFFER, m.doubled.id());
  }
  glEnableVertexAttribArray(kVertex);
  glVertexAttribPointer(kVertex, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  glBindVertexArray(0);
  return true;
}

}  // namespace gnomon::gl
