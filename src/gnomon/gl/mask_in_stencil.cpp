// Counts in the stencil.
// Based on: Everitt and Kilgard 2002, section 3.3.
#include <utility>

#include <gnomon/gl/mask_counts.h>

namespace gnomon::gl {
namespace {

// Counts that fit. One that wraps, up to kWrapLayers, which the grid of layer_bound() proves; one
// that saturates counts from 0 up to 255 faces, and is looked through for that. Where neither fits,
// groups of volumes are counted one after the other in seven bits from 32. Between groups a count
// that reaches 64 goes to the eighth bit and starts anew; smaller ones go on, so that a side that
// volumes of two groups share, counted to rounding on the wrong side of a sample, still cancels.
constexpr int kGroupMiddle = 32, kGroupFull = 64;
constexpr GLuint kGroupBits = 0x7f;
static_assert(kGroupFull - 1 + kGroupLayers <= int(kGroupBits));

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
        if (used != b.of) use_volumes(frame, plan, *b.of, z_fail);
        used = b.of;
        draw_faces(frame, plan, b, p, turned);
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

}  // namespace

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
  frame.stats->scissored_volumes = before.scissored_volumes;
  frame.stats->culled_volumes = before.culled_volumes;
  regroup(frame, plan, prepared);
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

}  // namespace gnomon::gl
