#include <gnomon/gl/volume_batches.h>

#include <chrono>
#include <utility>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <gnomon/volume/near_cap.h>

namespace gnomon::gl {
namespace {

double milliseconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

// The cut of every volume with the near plane, in clip space, z-pass's start ("Shadow Volumes
// Revisited", 3.1).
void make_near_caps(const Frame& frame, std::vector<InstanceVolumes>& all) {
  std::vector<glm::vec4> vertices;
  for (InstanceVolumes& v : all) {
    const glm::dmat4 rows = glm::transpose(frame.camera->clip * v.instance->to_scene);
    const CapPlane plane = cap_plane(rows[0], rows[1], rows[3], rows[3] + rows[2]);
    v.near_caps = {static_cast<std::uint32_t>(vertices.size())};
    for (const Volume& volume : v.volumes->lists.volumes) {
      for (const int kind : {kLightCap, kLightCapTurned}) {
        const IndexRange& range = volume.lists[kind];
        const std::uint32_t* at = v.volumes->lists.lists[kind].data() + range.first;
        for (std::uint32_t i = 0; i < range.count; i += 3) {
          const auto p = [&](int k) { return v.mesh->mesh.positions[at[i + k] / 2]; };
          const NearCap cap =
              near_cap(p(0), p(1), p(2), kind == kLightCap ? -1 : 1, v.plan->light, plane);
          for (int k = 2; k < cap.size; ++k) {
            for (const Vec2& c : {cap.at[0], cap.at[k - 1], cap.at[k]})
              vertices.emplace_back(glm::vec2(c), 0.0f, 1.0f);
          }
        }
      }
      v.near_caps.push_back(static_cast<std::uint32_t>(vertices.size()));
    }
  }
  Renderer::State& state = *frame.state;
  if (!state.near_cap_array) {
    state.near_cap_array = VertexArray::make();
    state.near_caps = Buffer::make();
  }
  glBindVertexArray(state.near_cap_array.id());
  glBindBuffer(GL_ARRAY_BUFFER, state.near_caps.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(glm::vec4)),
               vertices.data(), GL_STREAM_DRAW);
  glEnableVertexAttribArray(kVertex);
  glVertexAttribPointer(kVertex, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void update_all_lists(const Frame& frame, const LightPlan& plan, Prepared& prepared) {
  for (std::size_t i = 0; i < prepared.all.size(); ++i) {
    InstanceVolumes& v = prepared.all[i];
    const bool all_caps = frame.whole_volumes || starts_at_near_plane(plan.method) ||
                          v.plan->caps_in_front != CapsInFront::none;
    const bool made = update_lists(*v.volumes, *v.mesh, plan.method, v.plan->near, v.plan->project,
                                   v.plan->receivers, all_caps, prepared.grouped ? kGroupLayers : 0,
                                   prepared.changed[i]);
    // Groups make the same volumes a second time.
    if (!prepared.grouped) ++(made ? frame.stats->rebuilt : frame.stats->kept);
  }
  if (plan.method.count == Count::near_cap) make_near_caps(frame, prepared.all);
}

// A volume has a scissor of its own where that saves so much of the picture: a sixteenth, above
// what a draw of its own costs (with none, frames of many small bodies took 5 % longer).
constexpr double kScissorSaves = 1.0 / 16;

void find_rectangles(const Frame& frame, const LightPlan& plan, InstanceVolumes& v) {
  const Camera& camera = *frame.camera;
  const auto [width, height] = mask_size(camera, plan.method.mask_scale);
  const Rect whole{0, 0, camera.width, camera.height};
  const auto area = [&](const Rect& r) {
    const Rect seen = common(whole, r);
    return double(seen.width) * seen.height;
  };
  v.rectangles.clear();
  for (const Part& part : v.mesh->parts.parts) {
    std::array<Vec3, 8> corners = corners_of({part.lo, part.hi});
    for (Vec3& p : corners) p = Vec3(v.instance->to_scene * point(p));
    SceneBox box{corners[0], corners[0]};
    for (const Vec3& p : corners) box = {glm::min(box.lo, p), glm::max(box.hi, p)};
    std::optional<Rect> r = shadow_rectangle(camera, plan.light, box, *plan.receivers);
    if (r && r->width > 0 &&
        area(endless_rectangle(camera, plan.light, box)) - area(*r) <= kScissorSaves * area(whole))
      r.reset();
    if (r) r = scaled(*r, camera, width, height);
    v.rectangles.push_back(r);
  }
}

// Appends batches of the volumes first .. last - 1: at once, but for those that matter in a small
// part of the picture. Those that matter nowhere are left out.
void append_batches(const Frame& frame, std::vector<Batch>& to, const InstanceVolumes& v,
                    std::size_t first, std::size_t last, bool z_fail) {
  for (std::size_t k = first; k < last && !v.rectangles.empty(); ++k) {
    const std::optional<Rect> scissor = scissor_of(frame, v, k);
    if (!scissor) continue;
    if (first < k) to.push_back(batch_of(v, first, k, z_fail));
    first = k + 1;
    if (scissor->width == 0) {
      ++frame.stats->culled_volumes;
      continue;
    }
    to.push_back(batch_of(v, k, k + 1, z_fail));
    to.back().scissor = scissor;
    ++frame.stats->scissored_volumes;
  }
  if (first < last) to.push_back(batch_of(v, first, last, z_fail));
}

}  // namespace

Prepared prepare(const Frame& frame, const LightPlan& plan) {
  const auto begin = std::chrono::steady_clock::now();
  Prepared out;
  for (std::size_t i = 0; i < plan.instances.size(); ++i) {
    const LightPlan::OfInstance& of = plan.instances[i];
    if (of.parts.empty()) continue;
    InstanceSlot& instance = frame.state->instances[i];
    MeshSlot& mesh = frame.state->meshes[instance.mesh];
    if (instance.volumes.size() <= plan.number) instance.volumes.resize(plan.number + 1);
    CasterVolumes& v = instance.volumes[plan.number];
    out.changed.push_back(
        update_silhouettes(v, mesh.gpu, mesh.version, of.light, of.parts, plan.method.silhouettes));
    if (mesh.gpu.silhouettes.last > SilhouetteBy::brute_force) ++frame.stats->by_tree;
    out.layers += v.layers;
    out.all.push_back({&instance, &mesh.gpu, &v, &of, {}});
    out.offset |= v.grazed;
  }
  for (InstanceVolumes& v : out.all) v.offset = out.offset;
  // Volumes that end at a plane cover little that does not matter, and one draw is better. The
  // start at the near plane would have to be cut as well.
  if (plan.receivers && plan.method.reach == Reach::infinite &&
      !starts_at_near_plane(plan.method)) {
    for (InstanceVolumes& v : out.all) find_rectangles(frame, plan, v);
  }
  update_all_lists(frame, plan, out);
  frame.stats->volumes_ms += milliseconds_since(begin);
  return out;
}

void regroup(const Frame& frame, const LightPlan& plan, Prepared& prepared) {
  const auto begin = std::chrono::steady_clock::now();
  prepared.grouped = true;
  update_all_lists(frame, plan, prepared);
  frame.stats->volumes_ms += milliseconds_since(begin);
}

Batch batch_of(const InstanceVolumes& v, std::size_t first, std::size_t last, bool z_fail) {
  Batch b{&v, z_fail, ranges_of(*v.volumes, first, last), {}};
  if (!v.near_caps.empty())
    b.near_caps = {v.near_caps[first], v.near_caps[last] - v.near_caps[first]};
  return b;
}

std::optional<Rect> scissor_of(const Frame& frame, const InstanceVolumes& v, std::size_t volume) {
  if (v.rectangles.empty()) return {};
  const std::optional<Rect>& own = v.rectangles[v.volumes->lists.volumes[volume].caster];
  if (!own || !frame.scissor) return own;
  return common(*frame.scissor, *own);
}

std::vector<std::vector<Batch>> batches_of(const Frame& frame, const Prepared& prepared) {
  std::vector<std::vector<Batch>> groups(1);
  std::uint32_t layers = 0;
  for (const InstanceVolumes& v : prepared.all) {
    const std::size_t split = v.volumes->z_fail_volumes, end = v.volumes->lists.volumes.size();
    for (const bool z_fail : {true, false}) {
      std::size_t first = z_fail ? 0 : split;
      const std::size_t last = z_fail ? split : end;
      for (std::size_t k = first; prepared.grouped && k < last; ++k) {
        if (layers + v.volumes->layers_of[k] > kGroupLayers) {
          append_batches(frame, groups.back(), v, first, k, z_fail);
          groups.emplace_back();
          first = k;
          layers = 0;
        }
        layers += v.volumes->layers_of[k];
      }
      append_batches(frame, groups.back(), v, first, last, z_fail);
    }
  }
  return groups;
}

}  // namespace gnomon::gl
