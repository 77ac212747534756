// Counts in the alpha channel or the screen.
// Based on: Roettger, Irion and Ertl 2002, sections 4.2-4.4.
#include <gnomon/gl/mask_counts.h>

namespace gnomon::gl {
namespace {

// Doubles by brightness 1.
constexpr GLenum kDoubleSource = GL_DST_COLOR, kDoubleDestination = GL_ONE;

// The maximum variant in eight bits begins so many doublings below the clamp: where rounding of
// depths counts a pixel below 0, it must not be lost there before a shadow brings it back to 0.
constexpr int kRoomSteps = 2;
static_assert(0.25f * (1 << kRoomSteps) == 1.0f);

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

}  // namespace

std::array<bool, 4> mask_channels(const Method& m) {
  if (m.mask == MaskIn::alpha) return {false, false, false, true};
  return {true, true, true, true};
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
      const GLuint program = use_volumes(frame, plan, v, z_fail);
      apply(p, frame);
      for (const bool turned : {false, true}) {
        if (!any(b.ranges, turned)) continue;
        // z-fail counts behind: what is left counts up there.
        const bool front_enters = z_fail == turned;
        const FaceColours colours{front_enters ? enters : leaves, front_enters ? leaves : enters};
        set_colours(program, colours);
        draw_faces(frame, plan, b, p, turned, colours);
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

}  // namespace gnomon::gl
