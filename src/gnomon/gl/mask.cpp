// The shadow mask of one light, in the stencil, the alpha channel or the screen.
// Based on: Everitt and Kilgard 2002, section 3.3; Roettger, Irion and Ertl 2002, sections 4.2-4.4.
#include <array>

#include <glm/matrix.hpp>

#include <gnomon/core/exact.h>
#include <gnomon/gl/renderer_state.h>

namespace gnomon::gl {
namespace {

constexpr float kLarge = 16777216.0f;  // "Accelerated Stencil Shadow Extrusion": LARGE

struct InstanceVolumes {
  const InstanceSlot* instance;
  CasterVolumes* volumes;
  const LightPlan::OfInstance* plan;
};

// Uniforms and vertices of one instance's volumes.
void use_volumes(const Frame& frame, const LightPlan& plan, const InstanceVolumes& v) {
  const auto form = static_cast<std::size_t>(plan.method.extrusion);
  const GLuint program = frame.state->programs.volume[form].id();
  glUseProgram(program);
  const glm::vec4 light(v.plan->light);
  set(program, "u_clip", frame.clip_of(*v.instance));
  set(program, "u_light", light);
  if (plan.method.extrusion == Extrusion::blend ||
      plan.method.extrusion == Extrusion::blend_large) {
    // Points behind: x Lw - L, w = 0; finite: the same times LARGE, w = 1.
    const float k = plan.method.extrusion == Extrusion::blend ? 1.0f : kLarge;
    glm::mat4 project(0.0f);
    for (int i = 0; i < 3; ++i) {
      project[i][i] = light.w * k;
      project[3][i] = -light[i] * k;
    }
    project[3][3] = plan.method.extrusion == Extrusion::blend ? 0.0f : 1.0f;
    set(program, "u_keep", glm::mat4(1.0f));
    set(program, "u_project", project);
  }
  set(program, "u_colour", glm::vec4(1));
  glBindVertexArray(v.volumes->array.id());
}

void draw_range(const Frame& frame, const IndexRange& range) {
  if (range.count == 0) return;
  glDrawElements(
      GL_TRIANGLES, static_cast<GLsizei>(range.count), GL_UNSIGNED_INT,
      reinterpret_cast<const void*>(std::uintptr_t(range.first) * sizeof(std::uint32_t)));
  ++frame.stats->volume_draws;
  frame.stats->volume_triangles += range.count / 3;
}

// Which lists a way of counting draws: z-fail the whole surface of the volume, z-pass its sides,
// and the light caps of casters that are not seen themselves.
void draw_lists(const Frame& frame, const std::array<IndexRange, kListKinds>& ranges, bool z_fail,
                bool caps, bool turned) {
  const int first = turned ? kSidesTurned : kSides;
  draw_range(frame, ranges[first]);
  if (z_fail || caps) draw_range(frame, ranges[first + kLightCap]);
  if (z_fail) draw_range(frame, ranges[first + kDarkCap]);
}

bool any(const std::array<IndexRange, kListKinds>& ranges, bool turned) {
  const int first = turned ? kSidesTurned : kSides;
  return ranges[first].count + ranges[first + kLightCap].count + ranges[first + kDarkCap].count > 0;
}

std::vector<InstanceVolumes> prepare(const Frame& frame, const LightPlan& plan) {
  std::vector<InstanceVolumes> out;
  for (std::size_t i = 0; i < plan.instances.size(); ++i) {
    const LightPlan::OfInstance& of = plan.instances[i];
    if (of.parts.empty()) continue;
    InstanceSlot& instance = frame.state->instances[i];
    const MeshSlot& mesh = frame.state->meshes[instance.mesh];
    if (instance.volumes.size() <= plan.number) instance.volumes.resize(plan.number + 1);
    CasterVolumes& v = instance.volumes[plan.number];
    if (update_volumes(v, mesh.gpu, mesh.version, of.light, of.parts, plan.method))
      ++frame.stats->rebuilt;
    frame.stats->z_fail_volumes += static_cast<int>(v.z_fail_volumes);
    frame.stats->z_pass_volumes += static_cast<int>(v.lists.volumes.size() - v.z_fail_volumes);
    for (const std::uint8_t p : v.polygon) frame.stats->polygon_volumes += p;
    out.push_back({&instance, &v, &of});
  }
  return out;
}

// --- stencil ---------------------------------------------------------------------------------

// Face operations of one step: which faces count up and which down, where.
Pass stencil_pass(const Method& m, bool z_fail, bool turned, int phase) {
  Pass p;
  p.depth_func = GL_LESS;
  p.depth_clamp = m.far_plane == FarPlane::clamp;
  p.stencil_test = true;
  const GLenum up = m.ops == StencilOps::wrap ? GL_INCR_WRAP : GL_INCR;
  const GLenum down = m.ops == StencilOps::wrap ? GL_DECR_WRAP : GL_DECR;
  // z-pass: entering faces in front count up, leaving ones down. z-fail: entering faces behind
  // count down, leaving ones up.
  StencilFace& enter = turned ? p.back : p.front;
  StencilFace& leave = turned ? p.front : p.back;
  (z_fail ? enter.depth_fail : enter.depth_pass) = z_fail ? down : up;
  (z_fail ? leave.depth_fail : leave.depth_pass) = z_fail ? up : down;
  if (m.passes == StencilPasses::culled) {
    // Phase 0 draws what counts up, phase 1 what counts down: saturation at 0 loses nothing.
    const bool draw_enter = (phase == 0) != z_fail;
    p.cull = draw_enter != turned ? GL_BACK : GL_FRONT;
  }
  return p;
}

void count_in_stencil(const Frame& frame, const LightPlan& plan,
                      const std::vector<InstanceVolumes>& all) {
  const Method& m = plan.method;
  const int phases = m.passes == StencilPasses::culled ? 2 : 1;
  for (int phase = 0; phase < phases; ++phase) {
    for (const bool z_fail : {true, false}) {
      for (const bool turned : {false, true}) {
        bool applied = false;
        for (const InstanceVolumes& v : all) {
          const auto& ranges = z_fail ? v.volumes->z_fail : v.volumes->z_pass;
          if (!any(ranges, turned)) continue;
          if (!applied) apply(stencil_pass(m, z_fail, turned, phase), frame.state->support);
          applied = true;
          use_volumes(frame, plan, v);
          draw_lists(frame, ranges, z_fail, v.plan->caps_in_front, turned);
        }
      }
    }
  }
}

// --- alpha and screen ------------------------------------------------------------------------

struct Blend {
  GLenum source, destination;
  float brightness;
};
constexpr Blend kDouble{GL_DST_COLOR, GL_ONE, 1.0f};
constexpr Blend kHalve{GL_DST_COLOR, GL_ZERO, 0.5f};

std::array<bool, 4> mask_channels(const Method& m) {
  if (m.mask == MaskIn::alpha) return {false, false, false, true};
  return {true, true, true, true};
}

void set_brightness(const Frame& frame, const LightPlan& plan, float brightness) {
  const auto form = static_cast<std::size_t>(plan.method.extrusion);
  set(frame.state->programs.volume[form].id(), "u_colour", glm::vec4(brightness));
}

// One volume after the other: what enters first, then what leaves, so that the clamp at 1 (maximum:
// the eight bits) loses nothing (Roettger et al., 4.2; docs/methods.md).
void count_by_blending(const Frame& frame, const LightPlan& plan,
                       const std::vector<InstanceVolumes>& all) {
  const Method& m = plan.method;
  const bool doubling = m.arithmetic == Arithmetic::doubling;
  for (const InstanceVolumes& v : all) {
    use_volumes(frame, plan, v);
    for (std::size_t k = 0; k < v.volumes->lists.volumes.size(); ++k) {
      const bool z_fail = k < v.volumes->z_fail_volumes;
      const Volume& volume = v.volumes->lists.volumes[k];
      std::array<IndexRange, kListKinds> ranges = volume.lists;
      for (int i = 0; i < kListKinds; ++i) ranges[i].first += v.volumes->list_begin[i];
      for (const bool first : {true, false}) {
        const Blend& blend = first == doubling ? kDouble : kHalve;
        set_brightness(frame, plan, blend.brightness);
        for (const bool turned : {false, true}) {
          if (!any(ranges, turned)) continue;
          Pass p;
          p.depth_func = z_fail ? GL_GEQUAL : GL_LESS;
          p.depth_clamp = m.far_plane == FarPlane::clamp;
          p.blend = true;
          p.source = blend.source;
          p.destination = blend.destination;
          p.colour = mask_channels(m);
          // z-pass: entering faces first. z-fail: leaving faces first.
          const bool draw_enter = first != z_fail;
          p.cull = draw_enter != turned ? GL_BACK : GL_FRONT;
          apply(p, frame.state->support);
          draw_lists(frame, ranges, z_fail, v.plan->caps_in_front, turned);
        }
      }
    }
  }
}

void rectangle_blend(const Frame& frame, const Method& m, GLenum source, GLenum destination,
                     float brightness, GLenum equation = GL_FUNC_ADD) {
  Pass p;
  p.depth_test = false;
  p.blend = true;
  p.blend_equation = equation;
  p.source = source;
  p.destination = destination;
  p.colour = mask_channels(m);
  draw_rectangle(frame, p, glm::vec4(brightness));
  ++frame.stats->rectangles;
}

// Three states to two (Roettger et al., 4.3 and 4.4; TECHNIQUES 6).
void normalise(const Frame& frame, const Method& m) {
  const bool attenuated = m.shadows == Shadows::attenuated;
  if (m.arithmetic == Arithmetic::maximum) {
    rectangle_blend(frame, m, GL_ONE, GL_ONE, 0.5f, GL_MAX);  // 1/2 in shadow, 1 where lit
    if (!attenuated) {  // beyond the paper: 0 and 1, to add a light
      rectangle_blend(frame, m, GL_ONE, GL_ONE, 0.5f, GL_FUNC_REVERSE_SUBTRACT);
      rectangle_blend(frame, m, kDouble.source, kDouble.destination, 1.0f);
    }
    return;
  }
  rectangle_blend(frame, m, kDouble.source, kDouble.destination, 1.0f);
  rectangle_blend(frame, m, GL_ONE_MINUS_DST_COLOR, GL_ZERO, 1.0f);
  if (attenuated) {
    rectangle_blend(frame, m, GL_ONE, GL_ONE, 0.5f);
  } else {
    rectangle_blend(frame, m, kDouble.source, kDouble.destination, 1.0f);
  }
}

// --- receivers that do not cast --------------------------------------------------------------

// Their unlit side is in shadow though nothing of theirs counts (DEFINITIONS, "The prism and the
// count"): drawn again where they are seen, they add one.
void count_unlit_receivers(const Frame& frame, const LightPlan& plan) {
  const Method& m = plan.method;
  for (std::size_t i = 0; i < plan.instances.size(); ++i) {
    const InstanceSlot& instance = frame.state->instances[i];
    if (!instance.alive) continue;
    const GpuMesh& mesh = frame.state->meshes[instance.mesh].gpu;
    if (mesh.only_receive.empty()) continue;
    for (const bool positive : {false, true}) {
      std::vector<std::uint32_t> indices;
      ExactStats stats;
      for (const std::uint32_t t : mesh.only_receive) {
        const Triangle& v = mesh.mesh.triangles[t];
        const int side = light_side(mesh.mesh.positions[v[0]], mesh.mesh.positions[v[1]],
                                    mesh.mesh.positions[v[2]], plan.instances[i].light, stats);
        if ((side > 0) == positive) indices.insert(indices.end(), {2 * v[0], 2 * v[1], 2 * v[2]});
      }
      if (indices.empty()) continue;
      Pass p;
      p.depth_func = GL_EQUAL;
      p.depth_clamp = m.far_plane == FarPlane::clamp;
      // The light sees the counterclockwise side of those of side -1: their clockwise one is dark.
      p.cull = positive ? GL_BACK : GL_FRONT;
      float brightness = 1;
      if (m.mask == MaskIn::stencil) {
        p.stencil_test = true;
        p.front.depth_pass = p.back.depth_pass = GL_INCR;
      } else {
        const Blend& blend = m.arithmetic == Arithmetic::doubling ? kDouble : kHalve;
        p.blend = true;
        p.source = blend.source;
        p.destination = blend.destination;
        p.colour = mask_channels(m);
        brightness = blend.brightness;
      }
      apply(p, frame.state->support);
      const GLuint program = frame.state->programs.flat.id();
      glUseProgram(program);
      set(program, "u_clip", frame.clip_of(instance));
      set(program, "u_colour", glm::vec4(brightness));
      VertexArray array = VertexArray::make();
      Buffer buffer = Buffer::make();
      glBindVertexArray(array.id());
      glBindBuffer(GL_ARRAY_BUFFER, mesh.doubled.id());
      glEnableVertexAttribArray(kVertex);
      glVertexAttribPointer(kVertex, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
      glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer.id());
      glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                   static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(),
                   GL_STREAM_DRAW);
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(indices.size()), GL_UNSIGNED_INT, nullptr);
      glBindVertexArray(0);
    }
  }
}

void clear_mask(const Frame& frame, const Method& m) {
  Pass p;
  p.depth_test = false;
  if (m.mask == MaskIn::stencil) {
    apply(p, frame.state->support);
    glClearStencil(0);
    glClear(GL_STENCIL_BUFFER_BIT);
    return;
  }
  const float start = m.arithmetic == Arithmetic::maximum ? 1.0f : 0.25f;
  p.colour = mask_channels(m);
  apply(p, frame.state->support);
  glClearColor(start, start, start, start);
  glClear(GL_COLOR_BUFFER_BIT);
}

}  // namespace

void draw_light_mask(const Frame& frame, const LightPlan& plan) {
  const std::vector<InstanceVolumes> volumes = prepare(frame, plan);
  clear_mask(frame, plan.method);
  if (plan.method.mask == MaskIn::stencil) {
    frame.stats->stencil_groups = 1;
    count_in_stencil(frame, plan, volumes);
    count_unlit_receivers(frame, plan);
    return;
  }
  count_by_blending(frame, plan, volumes);
  count_unlit_receivers(frame, plan);
  normalise(frame, plan.method);
}

void draw_volume_faces(const Frame& frame, const LightPlan& plan, const Pass& pass,
                       const glm::vec4& colour) {
  const std::vector<InstanceVolumes> volumes = prepare(frame, plan);
  apply(pass, frame.state->support);
  for (const InstanceVolumes& v : volumes) {
    use_volumes(frame, plan, v);
    set(frame.state->programs.volume[static_cast<std::size_t>(plan.method.extrusion)].id(),
        "u_colour", colour);
    for (const auto* ranges : {&v.volumes->z_fail, &v.volumes->z_pass}) {
      draw_range(frame, (*ranges)[kSides]);
      draw_range(frame, (*ranges)[kSidesTurned]);
    }
  }
}

}  // namespace gnomon::gl
