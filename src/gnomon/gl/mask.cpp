// The shadow mask of one light, in the stencil, the alpha channel or the screen.
// Based on: Everitt and Kilgard 2002, section 3.3; Roettger, Irion and Ertl 2002, sections 4.2-4.4.
#include <array>
#include <utility>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <gnomon/core/exact.h>
#include <gnomon/gl/renderer_state.h>
#include <gnomon/volume/near_cap.h>

namespace gnomon::gl {
namespace {

struct InstanceVolumes {
  const InstanceSlot* instance;
  const GpuMesh* mesh;
  CasterVolumes* volumes;
  const LightPlan::OfInstance* plan;
  // Per volume, the vertices of its near caps in State::near_caps: first[k] .. first[k + 1].
  std::vector<std::uint32_t> near_caps;
  bool offset = false;  // sides are moved away: the light grazes something of the scene
  // Per part, where its volume matters; nothing: perhaps everywhere. Empty: no part is known.
  std::vector<std::optional<Rect>> rectangles{};
};

// Volumes drawn together.
struct Batch {
  const InstanceVolumes* of = nullptr;
  bool z_fail = false;
  std::array<IndexRange, kListKinds> ranges{};
  IndexRange near_caps{};
  std::optional<Rect> scissor{};  // the frame's, where there is none
};

// Counts that fit. One that wraps, up to kWrapLayers, which the grid of layer_bound() proves; one
// that saturates counts from 0 up to 255 faces, and is looked through for that. Where neither fits,
// groups of volumes are counted one after the other in seven bits from 32. Between groups a count
// that reaches 64 goes to the eighth bit and starts anew; smaller ones go on, so that a side that
// volumes of two groups share, counted to rounding on the wrong side of a sample, still cancels.
constexpr int kGroupMiddle = 32, kGroupFull = 64, kGroupLayers = 63;
constexpr GLuint kGroupBits = 0x7f, kShadedBit = 0x80;
static_assert(kGroupFull - 1 + kGroupLayers <= int(kGroupBits));

bool starts_at_near_plane(const Method& m) {
  return m.count == Count::near_cap || m.count == Count::zp_plus;
}

// With depth clamp no side is cut by the near or far plane, however it is counted: a cut one has
// other corners, and z-pass and z-fail would differ where these are rounded. z-pass then leaves out
// what lies before the near plane, where it starts to count, and z-fail does where it counts dark
// caps without a depth test: a bounding plane may lie on the eye's side.
bool leaves_out_before_near(const Method& m, bool z_fail) {
  return m.far_plane == FarPlane::clamp && (!z_fail || m.reach == Reach::bounded);
}

GLuint volume_program(const Frame& frame, const LightPlan& plan, bool z_fail) {
  const Programs& programs = frame.state->programs;
  const auto form = static_cast<std::size_t>(plan.method.extrusion);
  return leaves_out_before_near(plan.method, z_fail) ? programs.volume_from_near[form].id()
                                                     : programs.volume[form].id();
}

// Uniforms and vertices of one instance's volumes.
void use_volumes(const Frame& frame, const InstanceVolumes& v, GLuint program) {
  glUseProgram(program);
  set(program, "u_clip", frame.clip_of(*v.instance));
  set(program, "u_project", v.plan->project);
  glBindVertexArray(v.volumes->array.id());
}

void draw_range(const Frame& frame, const IndexRange& range, GLenum primitive = GL_TRIANGLES) {
  if (range.count == 0) return;
  glDrawElements(
      primitive, static_cast<GLsizei>(range.count), GL_UNSIGNED_INT,
      reinterpret_cast<const void*>(std::uintptr_t(range.first) * sizeof(std::uint32_t)));
  ++frame.stats->volume_draws;
  frame.stats->volume_triangles += range.count / 3;
}

// Sides that start at an edge of a triangle whose plane holds the light lie in that plane. Exactly,
// they are just behind whatever lies there and is seen from its lit side, and just before what is
// seen from its unlit one, which count_unlit_receivers() shades; so where such triangles receive,
// these sides (no others: their shadows' edges would move) are drawn a little farther away than
// they are: by the rounding of depths, and that of corners to a 256th of a pixel.
constexpr float kOffsetSlope = 1.0f / 256, kOffsetSteps = 2;

void draw_sides(const Frame& frame, const Method& m,
                const std::array<IndexRange, kListKinds>& ranges, bool turned, bool offset) {
  const GLenum primitive = m.primitives == Primitives::strips ? GL_TRIANGLE_STRIP
                           : m.primitives == Primitives::fans ? GL_TRIANGLE_FAN
                                                              : GL_TRIANGLES;
  draw_range(frame, ranges[turned ? kSidesTurned : kSides], primitive);
  const IndexRange& grazing = ranges[turned ? kGrazingSidesTurned : kGrazingSides];
  if (grazing.count == 0) return;
  if (offset) offset_depth(kOffsetSlope, kOffsetSteps);
  draw_range(frame, grazing, primitive);
  if (offset) offset_depth(0, 0);
}

void draw_caps(const Frame& frame, const std::array<IndexRange, kListKinds>& ranges, bool turned) {
  draw_range(frame, ranges[turned ? kLightCapTurned : kLightCap]);
  draw_range(frame, ranges[turned ? kDarkCapTurned : kDarkCap]);
}

// What a way of counting draws of a batch, in a pass that is applied: z-fail the whole surface of
// the volumes, z-pass their sides, and light caps where they may be in front of the picture.
void draw_faces(const Frame& frame, const Method& m, const Batch& b, const Pass& pass,
                bool turned) {
  draw_sides(frame, m, b.ranges, turned, b.of->offset);
  const IndexRange& caps = b.ranges[turned ? kLightCapTurned : kLightCap];
  if (b.z_fail) {
    draw_range(frame, caps);
    const IndexRange& dark = b.ranges[turned ? kDarkCapTurned : kDarkCap];
    if (dark.count == 0) return;
    // From the near plane on it lies behind everything, whatever the rounding of depths.
    Pass behind = pass;
    behind.depth_func = pass.stencil_test ? GL_NEVER : GL_ALWAYS;
    apply(behind, frame);
    draw_range(frame, dark);
    return apply(pass, frame);
  }
  if (b.of->plan->caps_in_front == CapsInFront::all) return draw_range(frame, caps);
  if (b.of->plan->caps_in_front == CapsInFront::none || caps.count == 0) return;
  if (pass.cull == GL_BACK) return;
  Pass back = pass;
  back.cull = GL_FRONT;
  if (pass.cull == GL_NONE) apply(back, frame);
  draw_range(frame, caps);
  if (pass.cull == GL_NONE) apply(pass, frame);
}

bool any(const std::array<IndexRange, kListKinds>& ranges, bool turned) {
  const int first = turned ? kSidesTurned : kSides;
  return ranges[first].count + ranges[first + kGrazingSides].count +
             ranges[first + kLightCap].count + ranges[first + kDarkCap].count >
         0;
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

struct Prepared {
  std::vector<InstanceVolumes> all;
  std::vector<bool> changed;  // of each, its sides
  long long layers = 0;       // no ray from the light crosses more casting triangles
  bool grouped = false;
  bool offset = false;  // sides are moved away
};

void update_all_lists(const Frame& frame, const LightPlan& plan, Prepared& prepared) {
  for (std::size_t i = 0; i < prepared.all.size(); ++i) {
    InstanceVolumes& v = prepared.all[i];
    if (update_lists(*v.volumes, *v.mesh, plan.method, v.plan->near, v.plan->project,
                     v.plan->receivers, prepared.grouped ? kGroupLayers : 0, prepared.changed[i])) {
      ++frame.stats->rebuilt;
    }
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

Prepared prepare(const Frame& frame, const LightPlan& plan) {
  Prepared out;
  for (std::size_t i = 0; i < plan.instances.size(); ++i) {
    const LightPlan::OfInstance& of = plan.instances[i];
    if (of.parts.empty()) continue;
    InstanceSlot& instance = frame.state->instances[i];
    const MeshSlot& mesh = frame.state->meshes[instance.mesh];
    if (instance.volumes.size() <= plan.number) instance.volumes.resize(plan.number + 1);
    CasterVolumes& v = instance.volumes[plan.number];
    out.changed.push_back(update_sides(v, mesh.gpu, mesh.version, of.light, of.parts));
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
  return out;
}

Batch batch_of(const InstanceVolumes& v, std::size_t first, std::size_t last, bool z_fail) {
  Batch b{&v, z_fail, ranges_of(*v.volumes, first, last), {}};
  if (!v.near_caps.empty())
    b.near_caps = {v.near_caps[first], v.near_caps[last] - v.near_caps[first]};
  return b;
}

// Where one volume matters, in the frame's scissor.
std::optional<Rect> scissor_of(const Frame& frame, const InstanceVolumes& v, std::size_t volume) {
  if (v.rectangles.empty()) return {};
  const std::optional<Rect>& own = v.rectangles[v.volumes->lists.volumes[volume].caster];
  if (!own || !frame.scissor) return own;
  return common(*frame.scissor, *own);
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

// All volumes, each instance's z-fail and z-pass ones at once; or in groups of few layers.
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

// What z-pass starts with: the count at the near plane. The pass says how it is counted.
void draw_near_start(const Frame& frame, const LightPlan& plan, const Batch& b, Pass pass,
                     float brightness) {
  pass.depth_test = false;
  const Programs& programs = frame.state->programs;
  if (plan.method.count == Count::near_cap) {
    if (b.near_caps.count == 0) return;
    apply(pass, frame);
    glUseProgram(programs.plain.id());
    set(programs.plain.id(), "u_colour", glm::vec4(brightness));
    glBindVertexArray(frame.state->near_cap_array.id());
    glDrawArrays(GL_TRIANGLES, static_cast<GLint>(b.near_caps.first),
                 static_cast<GLsizei>(b.near_caps.count));
    ++frame.stats->volume_draws;
    return;
  }
  // ZP+: the casters between near plane and light, thrown onto the near plane.
  const glm::dmat4 rows = glm::transpose(frame.camera->clip * b.of->instance->to_scene);
  Vec4 plane = rows[3] + rows[2];
  double side = glm::dot(plane, b.of->plan->light);
  if (side == 0) return;  // seen from the light the plane is a line
  if (side < 0) {
    plane = -plane;
    side = -side;
  }
  pass.cull = GL_NONE;
  apply(pass, frame);
  const GLuint program = programs.near_light.id();
  glUseProgram(program);
  set(program, "u_colour", glm::vec4(brightness));
  set(program, "u_clip", frame.clip_of(*b.of->instance));
  set(program, "u_light", glm::vec4(b.of->plan->light));
  set(program, "u_plane", glm::vec4(plane));
  set(program, "u_light_side", static_cast<float>(side));
  glBindVertexArray(b.of->volumes->array.id());
  draw_range(frame, b.ranges[kLightCap]);
  draw_range(frame, b.ranges[kLightCapTurned]);
}

// --- stencil ---------------------------------------------------------------------------------

// Face operations of one step: which faces count up and which down, where.
Pass stencil_pass(const Method& m, bool grouped, bool z_fail, bool turned, int phase) {
  Pass p;
  p.depth_func = GL_LESS;
  p.depth_clamp = m.far_plane == FarPlane::clamp;
  p.stencil_test = true;
  if (grouped) p.stencil_write = kGroupBits;
  const GLenum up = m.ops == StencilOps::wrap ? GL_INCR_WRAP : GL_INCR;
  const GLenum down = m.ops == StencilOps::wrap ? GL_DECR_WRAP : GL_DECR;
  // z-pass: entering faces in front count up, leaving ones down. z-fail: entering faces behind
  // count down, leaving ones up.
  StencilFace& enter = turned ? p.back : p.front;
  StencilFace& leave = turned ? p.front : p.back;
  (z_fail ? enter.depth_fail : enter.depth_pass) = z_fail ? down : up;
  (z_fail ? leave.depth_fail : leave.depth_pass) = z_fail ? up : down;
  if (m.passes == StencilPasses::culled) {
    // Phase 0 counts up, phase 1 counts down: saturation at 0 loses nothing. The other faces are
    // left alone, not culled: drivers cull what they clip before its corners are rounded to pixels
    // (llvmpipe), and a sliver that these turn round would be in neither phase.
    const bool enters = (phase == 0) != z_fail;
    (enters ? leave : enter) = {};
  }
  return p;
}

// Of culled passes, phase 0 draws what counts up and phase 1 what counts down.
void count_phase(const Frame& frame, const LightPlan& plan, const Method& m,
                 const std::vector<Batch>& batches, bool grouped, int phase) {
  if (starts_at_near_plane(m) && (m.count == Count::near_cap || phase == 0)) {
    for (const Batch& b : batches) {
      // Seen from the light every face counts up; a near cap's clockwise slivers count down.
      Pass p = stencil_pass(m, grouped, false, false, phase);
      if (m.count == Count::zp_plus) p.back.depth_pass = p.front.depth_pass;
      draw_near_start(frame, plan, b, p, 1);
    }
  }
  for (const bool z_fail : {true, false}) {
    for (const bool turned : {false, true}) {
      Pass p = stencil_pass(m, grouped, z_fail, turned, phase);
      bool applied = false;
      const InstanceVolumes* used = nullptr;
      for (const Batch& b : batches) {
        if (b.z_fail != z_fail || !any(b.ranges, turned)) continue;
        if (!applied || b.scissor || p.scissor) {
          p.scissor = b.scissor;
          apply(p, frame);
        }
        applied = true;
        if (used != b.of) use_volumes(frame, *b.of, volume_program(frame, plan, z_fail));
        used = b.of;
        draw_faces(frame, m, b, p, turned);
      }
    }
  }
}

void count_group(const Frame& frame, const LightPlan& plan, const Method& m,
                 const std::vector<Batch>& batches, bool grouped) {
  const int phases = m.passes == StencilPasses::culled ? 2 : 1;
  for (int phase = 0; phase < phases; ++phase) count_phase(frame, plan, m, batches, grouped, phase);
}

void clear_stencil(const Frame& frame, int value) {
  if (std::exchange(frame.state->stencil, std::nullopt) == value) return;
  Pass p;
  p.depth_test = false;
  apply(p, frame);
  glClearStencil(value);
  glClear(GL_STENCIL_BUFFER_BIT);
}

// Counts up, looks whether anything reached 255, and counts down. False: something did.
bool count_saturating(const Frame& frame, const LightPlan& plan,
                      const std::vector<Batch>& batches) {
  Method m = plan.method;
  m.passes = StencilPasses::culled;
  m.ops = StencilOps::saturate;
  clear_stencil(frame, 0);
  count_phase(frame, plan, m, batches, false, 0);
  Pass look;
  look.depth_test = false;
  look.stencil_test = true;
  look.stencil_func = GL_EQUAL;
  look.stencil_ref = 255;
  Renderer::State& state = *frame.state;
  if (!state.query) state.query = Query::make();
  glBeginQuery(GL_ANY_SAMPLES_PASSED, state.query.id());
  draw_rectangle(frame, look, glm::vec4(0));
  glEndQuery(GL_ANY_SAMPLES_PASSED);
  ++frame.stats->other_rectangles;
  GLuint full = 0;
  glGetQueryObjectuiv(state.query.id(), GL_QUERY_RESULT, &full);
  if (full != 0) return false;
  count_phase(frame, plan, m, batches, false, 1);
  return true;
}

LitTest count_in_stencil(const Frame& frame, const LightPlan& plan, Prepared& prepared) {
  const FrameStats before = *frame.stats;
  auto groups = batches_of(frame, prepared);
  frame.stats->stencil_groups = 1;
  const bool wraps = prepared.layers <= kWrapLayers;
  if ((plan.method.ops == StencilOps::saturate || !wraps) &&
      count_saturating(frame, plan, groups.front())) {
    return {GL_GEQUAL, 0, 0xff, GL_INCR, 0xff};
  }
  // Faces that count up may be too many though layers are few. Groups would be worse: neighbours in
  // two of them do not cancel where they are rounded.
  if (wraps) {
    clear_stencil(frame, kWrapMiddle);
    Method m = plan.method;
    m.ops = StencilOps::wrap;
    count_group(frame, plan, m, groups.front(), false);
    return {GL_GEQUAL, kWrapMiddle, 0xff, GL_INCR, 0xff};
  }
  prepared.grouped = true;
  frame.stats->scissored_volumes = before.scissored_volumes;
  frame.stats->culled_volumes = before.culled_volumes;
  update_all_lists(frame, plan, prepared);
  groups = batches_of(frame, prepared);
  frame.stats->stencil_groups = static_cast<int>(groups.size());
  clear_stencil(frame, kGroupMiddle);
  for (std::size_t k = 0; k < groups.size(); ++k) {
    count_group(frame, plan, plan.method, groups[k], true);
    const bool last = k + 1 == groups.size();
    Pass keep;  // where the count is far above the middle (at the end: above it), the shaded bit
    keep.depth_test = false;
    keep.stencil_test = true;
    keep.stencil_func = last ? GL_LESS : GL_EQUAL;
    keep.stencil_ref = (last ? kGroupMiddle : kGroupFull) | static_cast<GLint>(kShadedBit);
    keep.stencil_read = last ? kGroupBits : kGroupFull;
    keep.stencil_write = kShadedBit;
    keep.front.depth_pass = keep.back.depth_pass = GL_REPLACE;
    draw_rectangle(frame, keep, glm::vec4(0));
    ++frame.stats->other_rectangles;
    if (last) break;
    Pass restart = keep;  // and only there the count starts anew
    restart.stencil_func = GL_NOTEQUAL;
    restart.stencil_ref = kGroupMiddle;
    restart.stencil_write = kGroupBits;
    draw_rectangle(frame, restart, glm::vec4(0));
    ++frame.stats->other_rectangles;
  }
  return {GL_GEQUAL, 0, kShadedBit, GL_INVERT, kShadedBit};
}

// --- alpha and screen ------------------------------------------------------------------------

// Doubles by brightness 1. The volumes' faces double and halve at once: 2 x brightness x what is
// there.
constexpr GLenum kDoubleSource = GL_DST_COLOR, kDoubleDestination = GL_ONE;
constexpr GLenum kFaceSource = GL_DST_COLOR, kFaceDestination = GL_SRC_COLOR;
constexpr float kDoubles = 1.0f, kHalves = 0.25f;

// The maximum variant in eight bits begins so many doublings below the clamp: where rounding of
// depths counts a pixel below 0, it must not be lost there before a shadow brings it back to 0.
constexpr int kRoomSteps = 2;
static_assert(0.25f * (1 << kRoomSteps) == 1.0f);

std::array<bool, 4> mask_channels(const Method& m) {
  if (m.mask == MaskIn::alpha) return {false, false, false, true};
  return {true, true, true, true};
}

// One volume after the other (Roettger et al., 4.2), but entering and leaving faces in one pass: a
// ray crosses at most one of each where eight bits are counted in, and there, from 1/4, 1/2 or 1,
// halving and doubling in either order are exact, but for what the clamp at 1 loses when what
// enters comes first, which stays a shadow.
void count_by_blending(const Frame& frame, const LightPlan& plan, const Prepared& prepared) {
  const Method& m = plan.method;
  const bool doubling = m.arithmetic == Arithmetic::doubling;
  const float enters = doubling ? kDoubles : kHalves, leaves = doubling ? kHalves : kDoubles;
  for (const InstanceVolumes& v : prepared.all) {
    for (std::size_t k = 0; k < v.volumes->lists.volumes.size(); ++k) {
      const bool z_fail = k < v.volumes->z_fail_volumes;
      const Batch b = batch_of(v, k, k + 1, z_fail);
      const std::optional<Rect> scissor = scissor_of(frame, v, k);
      if (scissor)
        ++(scissor->width == 0 ? frame.stats->culled_volumes : frame.stats->scissored_volumes);
      if (scissor && scissor->width == 0) continue;
      Pass p;
      p.depth_func = z_fail ? GL_GEQUAL : GL_LESS;
      p.depth_clamp = m.far_plane == FarPlane::clamp;
      p.blend = true;
      p.source = kFaceSource;
      p.destination = kFaceDestination;
      p.colour = mask_channels(m);
      p.scissor = scissor;
      if (starts_at_near_plane(m)) {
        p.cull = GL_BACK;
        draw_near_start(frame, plan, b, p, enters);
        p.cull = GL_FRONT;  // slivers of a near cap that are turned leave
        if (m.count == Count::near_cap) draw_near_start(frame, plan, b, p, leaves);
        p.cull = GL_NONE;
      }
      const GLuint program = volume_program(frame, plan, z_fail);
      use_volumes(frame, v, program);
      apply(p, frame);
      for (const bool turned : {false, true}) {
        if (!any(b.ranges, turned)) continue;
        // z-fail counts behind: what is left counts up there.
        const bool front_enters = z_fail == turned;
        set(program, "u_front_colour", glm::vec4(front_enters ? enters : leaves));
        set(program, "u_back_colour", glm::vec4(front_enters ? leaves : enters));
        draw_faces(frame, m, b, p, turned);
      }
    }
  }
}

// Half floats count without a clamp, from 2^-14 to 2^15 and to infinity, where a count would be
// lost: the mask is looked through for such values. Zero is what underflow leaves.
Result<bool> check_floats(const Frame& frame, const Method& m, const Target& target) {
  Renderer::State& state = *frame.state;
  Texture2D copy = Texture2D::make();
  glActiveTexture(GL_TEXTURE3);
  glBindTexture(GL_TEXTURE_2D, copy.id());
  glTexImage2D(GL_TEXTURE_2D, 0, m.float_bits == 32 ? GL_RGBA32F : GL_RGBA16F, target.format.width,
               target.format.height, 0, GL_RGBA, GL_FLOAT, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, target.format.width, target.format.height);
  Pass p;
  p.depth_test = false;
  apply(p, frame);
  const GLuint program = state.programs.overflow.id();
  glUseProgram(program);
  set(program, "u_image", 3);
  set(program, "u_channel",
      m.mask == MaskIn::alpha ? glm::vec4(0, 0, 0, 1) : glm::vec4(1, 0, 0, 0));
  // Powers of two that have one more step to go: of half floats, normal ones.
  set(program, "u_least", m.float_bits == 32 ? 0x1p-124f : 0x1p-13f);
  set(program, "u_most", m.float_bits == 32 ? 0x1p126f : 0x1p14f);
  set(program, "u_depth", -1.0f);
  glBindVertexArray(state.empty.id());
  if (!state.query) state.query = Query::make();
  glBeginQuery(GL_ANY_SAMPLES_PASSED, state.query.id());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glEndQuery(GL_ANY_SAMPLES_PASSED);
  GLuint lost = 0;
  glGetQueryObjectuiv(state.query.id(), GL_QUERY_RESULT, &lost);
  ++frame.stats->other_rectangles;
  if (lost == 0) return true;
  return Error{
      "More shadows lie over each other in a pixel than a mask in floats can count (about 14 in 16 "
      "bits, 120 in 32): take --method stencil, which counts any number."};
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
  if (m.float_bits > 0) {
    // Powers of two without a clamp: bounded from both sides first.
    const bool maximum = m.arithmetic == Arithmetic::maximum;
    if (!maximum) rectangle_blend(frame, m, GL_ONE, GL_ONE, 0.25f, GL_MAX);
    rectangle_blend(frame, m, GL_ONE, GL_ONE, maximum ? 1.0f : 0.5f, GL_MIN);
  }
  if (m.arithmetic == Arithmetic::maximum) {
    if (m.float_bits == 0) {  // beyond the paper, whose lit is the clamp from the beginning
      for (int k = 0; k < kRoomSteps; ++k)
        rectangle_blend(frame, m, kDoubleSource, kDoubleDestination, kDoubles);
      frame.stats->rectangles -= kRoomSteps;
      frame.stats->other_rectangles += kRoomSteps;
    }
    rectangle_blend(frame, m, GL_ONE, GL_ONE, 0.5f, GL_MAX);  // 1/2 in shadow, 1 where lit
    if (!attenuated) {  // beyond the paper: 0 and 1, to add a light
      rectangle_blend(frame, m, GL_ONE, GL_ONE, 0.5f, GL_FUNC_REVERSE_SUBTRACT);
      rectangle_blend(frame, m, kDoubleSource, kDoubleDestination, kDoubles);
    }
    return;
  }
  rectangle_blend(frame, m, kDoubleSource, kDoubleDestination, kDoubles);
  rectangle_blend(frame, m, GL_ONE_MINUS_DST_COLOR, GL_ZERO, 1.0f);
  if (attenuated) {
    rectangle_blend(frame, m, GL_ONE, GL_ONE, 0.5f);
  } else {
    rectangle_blend(frame, m, kDoubleSource, kDoubleDestination, kDoubles);
  }
}

// --- receivers whose volumes do not shade them ------------------------------------------------

// The unlit side of a receiver that does not cast is in shadow though nothing of its own counts
// (docs/exactness.md). Of one that casts and lies nearly in a plane with the light, the side that
// belongs before the unlit side may have come behind it: by rounding, or because it is moved away.
// Such receivers, drawn again where they are seen, add one.
void count_unlit_receivers(const Frame& frame, const LightPlan& plan, const Prepared& prepared) {
  const Method& m = plan.method;
  for (std::size_t i = 0; i < plan.instances.size(); ++i) {
    const InstanceSlot& instance = frame.state->instances[i];
    if (!instance.alive) continue;
    const GpuMesh& mesh = frame.state->meshes[instance.mesh].gpu;
    // By light side: of -1 the light sees the counterclockwise side, and the other one is unlit.
    std::array<std::vector<std::uint32_t>, 2> indices;
    const auto add = [&](std::uint32_t t, int side) {
      const Triangle& v = mesh.mesh.triangles[t];
      std::vector<std::uint32_t>& to = indices[side > 0 ? 1 : 0];
      to.insert(to.end(), {2 * v[0], 2 * v[1], 2 * v[2]});
    };
    ExactStats exact;
    for (const std::uint32_t t : mesh.only_receive) {
      const Triangle& v = mesh.mesh.triangles[t];
      add(t, light_side(mesh.mesh.positions[v[0]], mesh.mesh.positions[v[1]],
                        mesh.mesh.positions[v[2]], plan.instances[i].light, exact));
    }
    if (!plan.instances[i].parts.empty()) {
      const CasterVolumes& v = instance.volumes[plan.number];
      for (const std::uint32_t t : v.nearly_grazed) add(t, v.light_side[t]);
    }
    for (const bool positive : {false, true}) {
      const std::vector<std::uint32_t>& drawn = indices[positive ? 1 : 0];
      if (drawn.empty()) continue;
      Pass p;
      p.depth_func = GL_EQUAL;
      p.depth_clamp = m.far_plane == FarPlane::clamp;
      p.cull = positive ? GL_BACK : GL_FRONT;
      float brightness = 1;
      if (m.mask == MaskIn::stencil) {
        p.stencil_test = true;
        if (prepared.grouped) {  // the shaded bit says it all
          p.stencil_ref = static_cast<GLint>(kShadedBit);
          p.stencil_write = kShadedBit;
        }
        p.front.depth_pass = p.back.depth_pass = prepared.grouped ? GL_REPLACE : GL_INCR;
      } else {
        p.blend = true;
        p.source = kFaceSource;
        p.destination = kFaceDestination;
        p.colour = mask_channels(m);
        brightness = m.arithmetic == Arithmetic::doubling ? kDoubles : kHalves;
      }
      apply(p, frame);
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
                   static_cast<GLsizeiptr>(drawn.size() * sizeof(std::uint32_t)), drawn.data(),
                   GL_STREAM_DRAW);
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(drawn.size()), GL_UNSIGNED_INT, nullptr);
      glBindVertexArray(0);
    }
  }
}

void clear_colours(const Frame& frame, const Method& m) {
  Pass p;
  p.depth_test = false;
  const float start = m.arithmetic == Arithmetic::maximum && m.float_bits > 0 ? 1.0f : 0.25f;
  p.colour = mask_channels(m);
  apply(p, frame);
  glClearColor(start, start, start, start);
  glClear(GL_COLOR_BUFFER_BIT);
}

}  // namespace

void draw_lines(const VertexArray& array, const Buffer& buffer, const Buffer& vertices,
                const std::vector<std::uint32_t>& indices) {
  glBindVertexArray(array.id());
  glBindBuffer(GL_ARRAY_BUFFER, vertices.id());
  glEnableVertexAttribArray(kVertex);
  glVertexAttribPointer(kVertex, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer.id());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(),
               GL_STREAM_DRAW);
  glDrawElements(GL_LINES, static_cast<GLsizei>(indices.size()), GL_UNSIGNED_INT, nullptr);
  glBindVertexArray(0);
}

void draw_where_lit(Pass& p, const LitTest& lit, bool once) {
  p.stencil_test = true;
  p.stencil_func = lit.func;
  p.stencil_ref = lit.ref;
  p.stencil_read = lit.read;
  p.stencil_write = lit.write;
  p.front.depth_pass = p.back.depth_pass = once ? lit.once : GL_KEEP;
}

void draw_where_shadowed(Pass& p, const LitTest& lit) {
  draw_where_lit(p, lit, false);
  p.stencil_func = GL_LESS;  // the opposite of GL_GEQUAL
}

Result<LitTest> draw_light_mask(const Frame& frame, const LightPlan& plan, const Target* target) {
  const Method& m = plan.method;
  Prepared prepared = prepare(frame, plan);
  for (const InstanceVolumes& v : prepared.all) {
    frame.stats->z_fail_volumes += static_cast<int>(v.volumes->z_fail_volumes);
    frame.stats->z_pass_volumes +=
        static_cast<int>(v.volumes->lists.volumes.size() - v.volumes->z_fail_volumes);
    for (const std::uint8_t p : v.volumes->polygon) frame.stats->polygon_volumes += p;
  }
  if (m.mask == MaskIn::stencil) {
    const LitTest lit = count_in_stencil(frame, plan, prepared);
    count_unlit_receivers(frame, plan, prepared);
    return lit;
  }
  clear_colours(frame, m);
  count_by_blending(frame, plan, prepared);
  count_unlit_receivers(frame, plan, prepared);
  if (m.float_bits > 0) {
    Result<bool> good = check_floats(frame, m, *target);
    if (!good) return good.error();
  }
  normalise(frame, m);
  return LitTest{};
}

void draw_volume_faces(const Frame& frame, const LightPlan& plan, const Pass& pass,
                       const glm::vec4& colour) {
  Prepared prepared = prepare(frame, plan);
  for (InstanceVolumes& v : prepared.all) v.rectangles.clear();  // they are looked at as a whole
  apply(pass, frame);
  for (const std::vector<Batch>& batches : batches_of(frame, prepared)) {
    for (const Batch& b : batches) {
      GLuint program =
          frame.state->programs.volume[static_cast<std::size_t>(plan.method.extrusion)].id();
      use_volumes(frame, *b.of, program);
      if (const auto& inside = frame.camera->keep_inside) {
        program = frame.state->programs.volume_inside.id();
        glUseProgram(program);
        set(program, "u_clip", frame.clip_of(*b.of->instance));
        set(program, "u_project", b.of->plan->project);
        set(program, "u_inside", glm::mat4(*inside * b.of->instance->to_scene));
      }
      set(program, "u_front_colour", colour);
      set(program, "u_back_colour", colour);
      for (const bool turned : {false, true}) {
        draw_sides(frame, plan.method, b.ranges, turned, false);
        draw_caps(frame, b.ranges, turned);
      }
    }
  }
}

void draw_silhouettes(const Frame& frame, const LightPlan& plan, const Pass& pass,
                      const glm::vec4& colour) {
  const Prepared prepared = prepare(frame, plan);
  apply(pass, frame);
  const std::optional<glm::dmat4>& inside = frame.camera->keep_inside;
  const GLuint program =
      inside ? frame.state->programs.flat_inside.id() : frame.state->programs.flat.id();
  glUseProgram(program);
  set(program, "u_colour", colour);
  const VertexArray array = VertexArray::make();
  const Buffer buffer = Buffer::make();
  for (const InstanceVolumes& v : prepared.all) {
    Silhouette edges;
    for (std::uint32_t p = 0; p < v.plan->parts.size(); ++p) {
      const EdgesOfParts& of = v.mesh->part_edges;
      find_part_silhouette(edges, v.mesh->edges,
                           std::span(of.edge).subspan(of.first[p], of.first[p + 1] - of.first[p]),
                           v.mesh->parts.part_of, p, v.volumes->light_side,
                           v.plan->parts[p].casting);
    }
    std::vector<std::uint32_t> indices;
    for (const SilhouetteEdge& e : edges) indices.insert(indices.end(), {2 * e.a, 2 * e.b});
    set(program, "u_clip", frame.clip_of(*v.instance));
    if (inside) set(program, "u_inside", glm::mat4(*inside * v.instance->to_scene));
    draw_lines(array, buffer, v.mesh->doubled, indices);
  }
}

}  // namespace gnomon::gl
