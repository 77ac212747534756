#include <gnomon/gl/caster_volumes.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include <gnomon/gl/program.h>
#include <gnomon/gl/screen_rectangle.h>
#include <gnomon/silhouette/light_sides.h>
#include <gnomon/volume/layers.h>

namespace gnomon::gl {
namespace {

constexpr int kFewLayers = 63;  // fits every way of counting
constexpr int kCoarsestLayerCells = 32, kFinestLayerCells = 1024;

SideForm form_of(Primitives p) {
  return p == Primitives::quads    ? SideForm::triangles
         : p == Primitives::strips ? SideForm::strips
                                   : SideForm::fans;
}

struct Builder {
  CasterVolumes& v;
  const GpuMesh& m;
  bool one_point;
  SideForm form;
  std::vector<std::uint8_t> beyond_receivers{};  // per vertex
  LoopScratch scratch{};
  Silhouette silhouette{};

  void note(bool polygon, std::uint32_t layers) {
    v.polygon.push_back(polygon ? 1 : 0);
    v.layers_of.push_back(layers);
  }

  std::uint32_t count_casting(std::span<const std::uint32_t> triangles, Casting casting) const {
    std::uint32_t n = 0;
    for (const std::uint32_t t : triangles) n += casts(casting, v.light_side[t]) ? 1 : 0;
    return n;
  }

  // What z-pass never draws is not made.
  std::span<const std::uint32_t> caps_of(std::span<const std::uint32_t> triangles,
                                         bool z_fail) const {
    return z_fail || v.all_caps ? triangles : std::span<const std::uint32_t>();
  }

  // Precondition: `silhouette` is theirs.
  void append_triangles(std::uint32_t p, std::span<const std::uint32_t> triangles, bool z_fail,
                        std::uint32_t layers) {
    append_volume(v.lists, m.mesh, silhouette, caps_of(triangles, z_fail), v.light_side, one_point,
                  v.plan[p].casting, form, p, beyond_receivers, scratch, v.grazed_edges);
    note(false, layers);
  }

  void append_part(std::uint32_t p) {
    const PartPlan& plan = v.plan[p];
    if (plan.left_out) return;
    const Part& part = m.parts.parts[p];
    if (plan.by_polygon) {
      for (const std::uint32_t t : part.triangles) {
        if (!casts(plan.casting, v.light_side[t])) continue;
        append_prism(v.lists, m.mesh, t, v.light_side[t], one_point, p, beyond_receivers,
                     v.grazed_edges);
        note(true, 1);
      }
      return;
    }
    const std::uint32_t layers = part.convex && plan.casting != Casting::all_triangles
                                     ? 1
                                     : count_casting(part.triangles, plan.casting);
    if (v.most_layers == 0 || layers <= v.most_layers) {
      const EdgesOfParts& edges = m.part_edges;
      silhouette.clear();
      find_part_silhouette(
          silhouette, m.edges,
          std::span(edges.edge).subspan(edges.first[p], edges.first[p + 1] - edges.first[p]),
          m.parts.part_of, p, v.light_side, plan.casting);
      append_triangles(p, part.triangles, plan.z_fail, layers);
      return;
    }
    append_chunks(p, part.triangles, plan.z_fail);
  }

  // Casting triangles of a part in volumes of at most most_layers of them.
  void append_chunks(std::uint32_t p, std::span<const std::uint32_t> triangles, bool z_fail) {
    std::vector<std::uint32_t> chunk;
    const auto flush = [&] {
      if (chunk.empty()) return;
      silhouette.clear();
      find_silhouette_of_few(silhouette, m.mesh, chunk, v.light_side, v.plan[p].casting);
      append_triangles(p, chunk, z_fail, static_cast<std::uint32_t>(chunk.size()));
      chunk.clear();
    };
    for (const std::uint32_t t : triangles) {
      if (!casts(v.plan[p].casting, v.light_side[t])) continue;
      chunk.push_back(t);
      if (chunk.size() == v.most_layers) flush();
    }
    flush();
  }

  void append_regions(bool z_fail) {
    for (std::uint32_t r = 0; r < v.regions.size(); ++r) {
      if ((v.region_z_fail[r] != 0) != z_fail) continue;
      const auto triangles = v.regions.triangles_of(r);
      if (v.most_layers != 0 && triangles.size() > v.most_layers) {
        append_chunks(m.parts.part_of[triangles[0]], triangles, z_fail);
        continue;
      }
      append_volume(v.lists, m.mesh, v.regions.silhouette_of(r), caps_of(triangles, z_fail),
                    v.light_side, one_point, Casting::all_triangles, form,
                    m.parts.part_of[triangles[0]], beyond_receivers, scratch, v.grazed_edges);
      note(false, static_cast<std::uint32_t>(triangles.size()));
    }
  }
};

// The doubled vertices, extruded on the CPU as the shader does it: columns are added in their order
// (glm adds them in pairs), so that no bit differs from what a shader without fused operations
// computes. To infinity there is one rounding, whatever the order.
std::vector<glm::vec4> extrude(const TriMesh& mesh, const glm::mat4& project) {
  std::vector<glm::vec4> out;
  out.reserve(mesh.positions.size() * 2);
  for (const Vec3& position : mesh.positions) {
    const glm::vec3 p(position);
    out.emplace_back(p, 1.0f);
    glm::vec4 behind = project[0] * p.x;
    behind += project[1] * p.y;
    behind += project[2] * p.z;
    behind += project[3];
    out.push_back(behind);
  }
  return out;
}

double farthest_squared(const GpuMesh& m, const Light& light) {
  const Vec3 l(light);
  if (light.w == 0) return glm::dot(l, l);
  double out = 0;
  for (const Vec3& corner :
       corners_of({glm::min(m.lo, m.caster_lo), glm::max(m.hi, m.caster_hi)})) {
    const Vec3 d = l - corner * light.w;
    out = std::max(out, glm::dot(d, d));
  }
  return out;
}

// The sine of the angle between the triangle's plane and the light, seen from the corner where it
// is least.
// Above kNearlyGrazing it may be anything above it. `farthest`: no corner of the mesh is farther
// from the light, squared (of a directional light: its length).
double sine_to_light(const TriMesh& mesh, std::uint32_t triangle, const Light& light,
                     double farthest) {
  const Triangle& t = mesh.triangles[triangle];
  const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
  const Vec3 l(light), n = glm::cross(b - a, c - a);
  // Most triangles are far from it, which needs neither root nor all corners.
  const double height = glm::dot(n, l - a * light.w);
  if (height * height > 2 * kNearlyGrazing * kNearlyGrazing * glm::dot(n, n) * farthest) return 1;
  double longest = 0;
  for (const Vec3* p : {&a, &b, &c}) {
    const Vec3 d = l - *p * light.w;
    longest = std::max(longest, glm::dot(d, d));
  }
  const double below = std::sqrt(glm::dot(n, n) * longest);
  return below > 0 ? std::fabs(glm::dot(n, l - a * light.w)) / below : 0;
}

}  // namespace

bool update_sides(CasterVolumes& v, const GpuMesh& m, std::uint64_t mesh_version,
                  const Light& light, const std::vector<PartPlan>& plan) {
  const bool same_light = v.array && v.light == light && v.mesh_version == mesh_version;
  if (same_light && v.plan == plan) return false;
  if (!same_light) {
    v.light_side = light_sides(m.mesh, light);
    v.grazed = false;
    v.grazed_edges.clear();
    v.nearly_grazed.clear();
    const double farthest = farthest_squared(m, light);
    for (std::uint32_t t = 0; t < m.mesh.triangles.size(); ++t) {
      const double sine = sine_to_light(m.mesh, t, light, farthest);
      if (sine <= kNearlyGrazing && m.casts[t] != 0 && m.receives[t] != 0)
        v.nearly_grazed.push_back(t);
      if (sine > kGrazing) continue;
      v.grazed |= m.receives[t] != 0;
      const Triangle& corners = m.mesh.triangles[t];
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = corners[k], b = corners[(k + 1) % 3];
        v.grazed_edges.push_back({std::min(a, b), std::max(a, b)});
      }
    }
    std::sort(v.grazed_edges.begin(), v.grazed_edges.end());
  }
  v.light = light;
  v.mesh_version = mesh_version;
  v.plan = plan;
  std::vector<std::uint8_t> casting(m.mesh.triangles.size(), 0);
  std::vector<std::uint8_t> in_region(m.mesh.triangles.size(), 0);
  bool regions = false;
  for (std::size_t p = 0; p < plan.size(); ++p) {
    regions |= plan[p].by_region;
    for (const std::uint32_t t : m.parts.parts[p].triangles) {
      casting[t] = !plan[p].left_out && casts(plan[p].casting, v.light_side[t]) ? 1 : 0;
      if (plan[p].by_region) in_region[t] = casting[t];
    }
  }
  v.regions = regions ? find_lit_regions(m.edges, v.light_side, in_region) : LitRegions{};
  if (same_light && v.casting == casting) return true;
  v.casting = std::move(casting);
  v.layers = 0;
  for (std::size_t p = 0; p < plan.size(); ++p) {
    const Part& part = m.parts.parts[p];
    if (plan[p].left_out) continue;
    if (part.convex && plan[p].casting != Casting::all_triangles) {
      ++v.layers;
    } else {
      for (const std::uint32_t t : part.triangles) v.layers += v.casting[t];
    }
  }
  // The sum holds for sure; where it is too much for a stencil, grids say better, finer ones best.
  const LayerItems items =
      v.layers > kFewLayers ? layer_items(m.parts, v.light_side, v.casting) : LayerItems{};
  for (int cells = kCoarsestLayerCells; v.layers > kFewLayers && cells <= kFinestLayerCells;
       cells *= 2) {
    v.layers = std::min(v.layers, layer_bound(m.mesh, items, light, cells));
    if (v.layers <= kWrapLayers) break;
  }
  return true;
}

bool update_lists(CasterVolumes& v, const GpuMesh& m, const Method& method, const NearClip& near,
                  const glm::mat4& project, const Vec4& receivers, bool all_caps,
                  std::uint32_t most_layers, bool sides_changed) {
  // Not so of a bounding plane across x, which leaves [0][0] at 0 too.
  const glm::vec4 none(0.0f);
  const bool one_point =
      v.light.w == 0 && project[0] == none && project[1] == none && project[2] == none;
  std::vector<std::uint8_t> region_z_fail(v.regions.size());
  for (std::uint32_t r = 0; r < v.regions.size(); ++r)
    region_z_fail[r] = may_any_shade_near(near, m.mesh, v.regions.triangles_of(r)) ? 1 : 0;
  if (!sides_changed && v.region_z_fail == region_z_fail && v.extrusion == method.extrusion &&
      v.primitives == method.primitives && v.most_layers == most_layers &&
      v.one_point == one_point && v.receivers == receivers && v.all_caps == all_caps &&
      (method.extrusion != Extrusion::cpu || v.project == project)) {
    return false;
  }
  v.region_z_fail = std::move(region_z_fail);
  v.extrusion = method.extrusion;
  v.primitives = method.primitives;
  v.most_layers = most_layers;
  v.one_point = one_point;
  v.project = project;
  v.receivers = receivers;
  v.all_caps = all_caps;

  v.lists = {};
  v.polygon.clear();
  v.layers_of.clear();
  Builder builder{v, m, v.one_point, form_of(method.primitives)};
  if (receivers != Vec4(0, 0, 0, 1)) {
    for (const Vec3& p : m.mesh.positions)
      builder.beyond_receivers.push_back(glm::dot(receivers, point(p)) <= 0 ? 1 : 0);
  }
  for (const bool z_fail : {true, false}) {
    for (std::uint32_t p = 0; p < v.plan.size(); ++p) {
      if (!v.plan[p].by_region && v.plan[p].z_fail == z_fail) builder.append_part(p);
    }
    builder.append_regions(z_fail);
    if (z_fail) v.z_fail_volumes = v.lists.volumes.size();
  }
  std::vector<std::uint32_t> indices;
  for (int k = 0; k < kListKinds; ++k) {
    const std::vector<std::uint32_t>& list = v.lists.lists[k];
    v.list_begin[k] = static_cast<std::uint32_t>(indices.size());
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
    const std::vector<glm::vec4> vertices = extrude(m.mesh, project);
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

std::array<IndexRange, kListKinds> ranges_of(const CasterVolumes& v, std::size_t first,
                                             std::size_t last) {
  std::array<IndexRange, kListKinds> out{};
  if (first == last) return out;
  for (int k = 0; k < kListKinds; ++k) {
    const IndexRange &a = v.lists.volumes[first].lists[k], &b = v.lists.volumes[last - 1].lists[k];
    out[k] = {v.list_begin[k] + a.first, b.first + b.count - a.first};
  }
  return out;
}

}  // namespace gnomon::gl
