#include <gnomon/gl/caster_volumes.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include <gnomon/gl/program.h>
#include <gnomon/gl/screen_rectangle.h>
#include <gnomon/silhouette/light_sides.h>
#include <gnomon/volume/layers.h>

namespace gnomon::gl {
namespace {

constexpr int kFewLayers = 63;  // fits every way of counting
// Grids of layers, the cheapest first. A sun's bound holds for suns whose rays it moves by so many
// cells, about: with 32 cells 3.6 degrees about this one, a quarter of an hour and more.
struct LayerGrid {
  int cells;
  double spread;
};
constexpr LayerGrid kLayerGrids[] = {{32, 2},    {64, 2},     {128, 1},     {256, 0.5},
                                     {512, 0.5}, {1024, 0.5}, {1024, 0.25}, {1024, 0}};
// Light sides are found one by one up to this share of the mesh, else all together, which is so
// many times faster a triangle.
constexpr std::size_t kFewSides = 8;

SideForm form_of(Primitives p) {
  return p == Primitives::quads    ? SideForm::triangles
         : p == Primitives::strips ? SideForm::strips
                                   : SideForm::fans;
}

// No ray crosses more of a part's triangles that cast.
std::uint32_t layers_of(const Part& part, CastingSides sides) {
  if (sides == CastingSides::none) return 0;
  const auto both = part.convex ? 2 : static_cast<std::uint32_t>(part.triangles.size());
  return sides == CastingSides::one ? both / 2 : both;
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

  // What z-pass never draws is not made.
  std::span<const std::uint32_t> caps_of(std::span<const std::uint32_t> triangles,
                                         bool z_fail) const {
    return z_fail || v.all_caps ? triangles : std::span<const std::uint32_t>();
  }

  void append_triangles(std::uint32_t p, std::span<const SilhouetteEdge> edges,
                        std::span<const std::uint32_t> triangles, bool z_fail,
                        std::uint32_t layers) {
    append_volume(v.lists, m.mesh, edges, caps_of(triangles, z_fail), v.light_side, one_point,
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
    const std::uint32_t layers = layers_of(part, v.casting[p]);
    if (v.most_layers == 0 || layers <= v.most_layers) {
      append_triangles(p, v.silhouettes.of(p), part.triangles, plan.z_fail, layers);
    } else {
      append_chunks(p, part.triangles, plan.z_fail);
    }
  }

  // Casting triangles of a part in volumes of at most most_layers of them.
  void append_chunks(std::uint32_t p, std::span<const std::uint32_t> triangles, bool z_fail) {
    std::vector<std::uint32_t> chunk;
    const auto flush = [&] {
      if (chunk.empty()) return;
      silhouette.clear();
      find_silhouette_of_few(silhouette, m.mesh, chunk, v.light_side, v.plan[p].casting);
      append_triangles(p, silhouette, chunk, z_fail, static_cast<std::uint32_t>(chunk.size()));
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

// What the light grazes: of casting triangles by the tree, if there is one.
void find_grazed(CasterVolumes& v, GpuMesh& m, const Light& light) {
  v.grazed = false;
  v.grazed_edges.clear();
  v.nearly_grazed.clear();
  const double farthest = farthest_squared(m, light);
  ExactStats exact;
  const auto look = [&](std::uint32_t t) {
    const double sine = sine_to_light(m.mesh, t, light, farthest);
    const Triangle& corners = m.mesh.triangles[t];
    if (sine <= kNearlyGrazing && m.casts[t] != 0 && m.receives[t] != 0) {
      const std::vector<Vec3>& p = m.mesh.positions;
      const int side = light_side(p[corners[0]], p[corners[1]], p[corners[2]], light, exact);
      v.nearly_grazed.push_back({t, static_cast<std::int8_t>(side)});
    }
    if (sine > kGrazing) return;
    v.grazed |= m.receives[t] != 0;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k], b = corners[(k + 1) % 3];
      v.grazed_edges.push_back({std::min(a, b), std::max(a, b)});
    }
  };
  SilhouetteFinder& finder = m.silhouettes;
  if (finder.edge_tree && finder.current) {
    std::vector<std::uint32_t> triangles;
    find_near_planes(triangles, *finder.edge_tree, light,
                     kNearlyGrazing * std::sqrt(farthest) * (1 + 0x1p-40), finder.scratch);
    for (const std::uint32_t t : triangles) look(t);
    for (const std::uint32_t t : m.only_receive) look(t);
  } else {
    for (std::uint32_t t = 0; t < m.mesh.triangles.size(); ++t) look(t);
  }
  std::sort(v.grazed_edges.begin(), v.grazed_edges.end());
}

// Finds light sides of the parts for which `needed(p)`, where they are not known yet.
template <class Needed>
void require_sides(CasterVolumes& v, const GpuMesh& m, const Needed& needed) {
  std::vector<std::uint32_t> parts;
  std::size_t triangles = 0;
  for (std::uint32_t p = 0; p < v.plan.size(); ++p) {
    if (v.sides_known[p] != 0 || !needed(p)) continue;
    parts.push_back(p);
    triangles += m.parts.parts[p].triangles.size();
  }
  if (parts.empty()) return;
  if (triangles * kFewSides > m.mesh.triangles.size()) {
    v.light_side = light_sides(m.mesh, v.light);
    v.sides_known.assign(v.sides_known.size(), 1);
    return;
  }
  v.light_side.resize(m.mesh.triangles.size());
  ExactStats exact;
  for (const std::uint32_t p : parts) {
    for (const std::uint32_t t : m.parts.parts[p].triangles) {
      const Triangle& c = m.mesh.triangles[t];
      v.light_side[t] = static_cast<std::int8_t>(light_side(
          m.mesh.positions[c[0]], m.mesh.positions[c[1]], m.mesh.positions[c[2]], v.light, exact));
    }
    v.sides_known[p] = 1;
  }
}

// The sum of parts' layers holds for sure; where it is too much for a stencil, grids say better,
// finer ones best. The search begins at the grid that sufficed last.
void bound_layers(LayersKept& kept, const CasterVolumes& v, const GpuMesh& m) {
  const LayerItems items = layer_items(m.parts, v.casting);
  kept.light = v.light;
  kept.layers = std::numeric_limits<int>::max();
  for (;; ++kept.grid) {
    const LayerGrid& grid = kLayerGrids[kept.grid];
    kept.spread = v.light.w == 0 ? grid.spread / grid.cells : 0;
    kept.layers = std::min(
        kept.layers, layer_bound(m.mesh, items, v.light, grid.cells, kept.spread, &v.silhouettes));
    if (kept.layers <= kWrapLayers || kept.grid + 1 == std::size(kLayerGrids)) break;
  }
  // With room to spare, a coarser one is tried the next time.
  if (kept.layers <= kWrapLayers / 2 && kept.grid > 0) --kept.grid;
}

void update_regions(CasterVolumes& v, const GpuMesh& m) {
  v.regions = {};
  const auto by_region = [&](std::uint32_t p) {
    return v.plan[p].by_region && !v.plan[p].left_out;
  };
  std::vector<std::uint8_t> in_region;
  for (std::uint32_t p = 0; p < v.plan.size(); ++p) {
    if (!by_region(p)) continue;
    if (in_region.empty()) {
      require_sides(v, m, by_region);
      in_region.assign(m.mesh.triangles.size(), 0);
    }
    for (const std::uint32_t t : m.parts.parts[p].triangles)
      in_region[t] = casts(v.plan[p].casting, v.light_side[t]) ? 1 : 0;
  }
  if (!in_region.empty()) v.regions = find_lit_regions(m.edges, v.light_side, in_region);
}

}  // namespace

bool update_silhouettes(CasterVolumes& v, GpuMesh& m, std::uint64_t mesh_version,
                        const Light& light, const std::vector<PartPlan>& plan, SilhouetteBy by) {
  const bool same_mesh = v.array && v.mesh_version == mesh_version;
  const bool same_light = same_mesh && v.light == light;
  if (same_light && v.plan == plan) return false;
  v.light = light;
  v.mesh_version = mesh_version;
  v.plan = plan;
  if (!same_light) {
    find_silhouette(v.whole, v.light_side, m.silhouettes, by, m.mesh, m.edges, light);
    v.sides_known.assign(plan.size(), v.light_side.empty() ? 0 : 1);
    find_grazed(v, m, light);
  }
  std::vector<CastingSides> casting;
  for (const PartPlan& p : plan) {
    casting.push_back(p.left_out                            ? CastingSides::none
                      : p.casting == Casting::all_triangles ? CastingSides::both
                                                            : CastingSides::one);
  }
  if (!same_mesh || v.casting != casting) v.kept = {};
  if (!same_light || v.casting != casting)
    v.silhouettes = split_by_part(v.whole, m.part_edges, casting);
  v.casting = std::move(casting);
  update_regions(v, m);
  v.layers = 0;
  for (std::size_t p = 0; p < plan.size(); ++p)
    v.layers += static_cast<int>(layers_of(m.parts.parts[p], v.casting[p]));
  if (v.layers > kFewLayers) {
    if (!near(v.kept.light, light, v.kept.spread)) bound_layers(v.kept, v, m);
    v.layers = std::min(v.layers, v.kept.layers);
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

  require_sides(v, m, [&](std::uint32_t p) {
    const PartPlan& plan = v.plan[p];
    return !plan.left_out &&
           (plan.z_fail || all_caps || plan.by_polygon || plan.by_region ||
            (most_layers != 0 && layers_of(m.parts.parts[p], v.casting[p]) > most_layers));
  });
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
