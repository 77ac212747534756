// The draws of volume_batches.h.
#include <gnomon/gl/volume_batches.h>

#include <cstdint>
#include <utility>

#include <glm/matrix.hpp>

namespace gnomon::gl {
namespace {

// With depth clamp no side is cut by the near or far plane, however it is counted: a cut one has
// other corners, and z-pass and z-fail would differ where these are rounded. z-pass then leaves out
// what lies before the near plane, where it starts to count, and z-fail does where it counts dark
// caps without a depth test: a bounding plane may lie on the eye's side.
bool leaves_out_before_near(const Method& m, bool z_fail) {
  return m.far_plane == FarPlane::clamp && (!z_fail || m.reach == Reach::bounded);
}

void draw_range(const Frame& frame, const IndexRange& range, GLenum primitive = GL_TRIANGLES) {
  if (range.count == 0) return;
  glDrawElements(
      primitive, static_cast<GLsizei>(range.count), GL_UNSIGNED_INT,
      reinterpret_cast<const void*>(std::uintptr_t(range.first) * sizeof(std::uint32_t)));
  ++frame.stats->volume_draws;
  frame.stats->volume_triangles += range.count / 3;
}

enum class Kept { all, from_near, beyond_far, near_clip };

// The program that is used is left used.
GLuint volume_program(const Frame& frame, const LightPlan& plan, Kept kept) {
  const Programs& programs = frame.state->programs;
  const auto form = static_cast<std::size_t>(plan.method.extrusion);
  if (kept == Kept::all) return programs.volume[form].id();
  if (kept == Kept::near_clip) return programs.volume_near_clip[form].id();
  const GLuint program = programs.volume_cut[form].id();
  glUseProgram(program);
  set(program, "u_keep", kept == Kept::from_near ? glm::vec4(0, 0, 1, 1) : glm::vec4(0, 0, 1, -1));
  return program;
}

// Sides that start at an edge of a triangle whose plane holds the light lie in that plane. Exactly,
// they are just behind whatever lies there and is seen from its lit side, and just before what is
// seen from its unlit one, which count_unlit_receivers() shades; so where such triangles receive,
// these sides (no others: their shadows' edges would move) are drawn a little farther away than
// they are: by the rounding of depths, and that of corners to a 256th of a pixel. So are light caps
// that near or far plane cuts.
constexpr float kOffsetSlope = 1.0f / 256, kOffsetSteps = 2;

}  // namespace

void set_colours(GLuint program, const FaceColours& colours) {
  set(program, "u_front_colour", glm::vec4(colours.front));
  set(program, "u_back_colour", glm::vec4(colours.back));
}

bool starts_at_near_plane(const Method& m) {
  return m.count == Count::near_cap || m.count == Count::zp_plus;
}

GLuint use_volumes(const Frame& frame, const LightPlan& plan, const InstanceVolumes& v,
                   bool z_fail) {
  const Kept kept = leaves_out_before_near(plan.method, z_fail) ? Kept::from_near : Kept::all;
  const GLuint program = volume_program(frame, plan, kept);
  use_volumes(frame, v, program);
  return program;
}

void use_volumes(const Frame& frame, const InstanceVolumes& v, GLuint program) {
  glUseProgram(program);
  set(program, "u_clip", frame.clip_of(*v.instance));
  set(program, "u_project", v.plan->project);
  glBindVertexArray(v.volumes->array.id());
}

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

namespace {

// Draws with another program than use_volumes() took, and goes back to that.
void draw_with(const Frame& frame, const LightPlan& plan, const Batch& b, Kept kept,
               const IndexRange& range, const FaceColours& colours) {
  const GLuint program = volume_program(frame, plan, kept);
  use_volumes(frame, *b.of, program);
  set_colours(program, colours);
  draw_range(frame, range);
  use_volumes(frame, plan, *b.of, b.z_fail);
}

// Light caps must be as deep as their surfaces, though they are clamped where surfaces are clipped.
// What lies before the near plane is clipped alike: neither way of counting counts a cap there, and
// its corners may be so far off that no depth of the whole polygon is right. What lies beyond the
// far plane is behind the picture, and z-fail counts it: so nothing may be clipped there, also not
// at a seam. Cut by another unit, or reaching beyond, a polygon is as deep as its surface to few
// steps only, and is moved away by as many.
void draw_light_caps(const Frame& frame, const LightPlan& plan, const Batch& b, const Pass& pass,
                     const IndexRange& caps, const FaceColours& colours) {
  const auto& [before_near, beyond_far] =
      std::pair(b.of->plan->before_near, b.of->plan->beyond_far);
  if (!pass.depth_clamp || caps.count == 0 || !(before_near || beyond_far))
    return draw_range(frame, caps);
  if (before_near && !epoxy_is_desktop_gl()) {
    // There are no clip distances: all is clipped, and what lies beyond is drawn once more. Single
    // pixels along the far plane may be counted twice or never.
    Pass clipped = pass;
    clipped.depth_clamp = false;
    apply(clipped, frame);
    draw_with(frame, plan, b, Kept::all, caps, colours);
    apply(pass, frame);
    if (b.z_fail && beyond_far) draw_with(frame, plan, b, Kept::beyond_far, caps, colours);
    return;
  }
  offset_depth(kOffsetSlope, kOffsetSteps);
  if (before_near) {
    glEnable(GL_CLIP_DISTANCE0);
    draw_with(frame, plan, b, Kept::near_clip, caps, colours);
    glDisable(GL_CLIP_DISTANCE0);
  } else {
    draw_range(frame, caps);
  }
  offset_depth(0, 0);
}

}  // namespace

void draw_faces(const Frame& frame, const LightPlan& plan, const Batch& b, const Pass& pass,
                bool turned, const FaceColours& colours) {
  draw_sides(frame, plan.method, b.ranges, turned, b.of->offset);
  const IndexRange& caps = b.ranges[turned ? kLightCapTurned : kLightCap];
  if (b.z_fail) {
    draw_light_caps(frame, plan, b, pass, caps, colours);
    const IndexRange& dark = b.ranges[turned ? kDarkCapTurned : kDarkCap];
    if (dark.count == 0) return;
    // From the near plane on it lies behind everything, whatever the rounding of depths.
    Pass behind = pass;
    behind.depth_func = pass.stencil_test ? GL_NEVER : GL_ALWAYS;
    apply(behind, frame);
    draw_range(frame, dark);
    return apply(pass, frame);
  }
  if (b.of->plan->caps_in_front == CapsInFront::all)
    return draw_light_caps(frame, plan, b, pass, caps, colours);
  if (b.of->plan->caps_in_front == CapsInFront::none || caps.count == 0) return;
  if (pass.cull == GL_BACK) return;
  Pass back = pass;
  back.cull = GL_FRONT;
  if (pass.cull == GL_NONE) apply(back, frame);
  draw_light_caps(frame, plan, b, back, caps, colours);
  if (pass.cull == GL_NONE) apply(pass, frame);
}

bool any(const std::array<IndexRange, kListKinds>& ranges, bool turned) {
  const int first = turned ? kSidesTurned : kSides;
  return ranges[first].count + ranges[first + kGrazingSides].count +
             ranges[first + kLightCap].count + ranges[first + kDarkCap].count >
         0;
}

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

}  // namespace gnomon::gl
