#include <gnomon/gl/pass.h>

#include <iterator>

namespace gnomon::gl {
namespace {

void enable(GLenum what, bool on) { on ? glEnable(what) : glDisable(what); }

GLint integer(GLenum what) {
  GLint value = 0;
  glGetIntegerv(what, &value);
  return value;
}

bool desktop() { return epoxy_is_desktop_gl(); }

// What is on or off for every pass of ours.
enum class In { every, desktop };
struct Switch {
  GLenum what;
  bool on;
  In api;
};
constexpr Switch kSwitchTable[] = {{GL_DITHER, false, In::every},
                                   {GL_SAMPLE_ALPHA_TO_COVERAGE, false, In::every},
                                   {GL_SAMPLE_COVERAGE, false, In::every},
                                   {GL_POLYGON_OFFSET_FILL, false, In::every},
                                   {GL_RASTERIZER_DISCARD, false, In::every},
                                   {GL_SAMPLE_ALPHA_TO_ONE, false, In::desktop},
                                   {GL_SAMPLE_MASK, false, In::desktop},
                                   {GL_MULTISAMPLE, true, In::desktop},
                                   {GL_POLYGON_OFFSET_LINE, false, In::desktop},
                                   {GL_POLYGON_OFFSET_POINT, false, In::desktop},
                                   {GL_COLOR_LOGIC_OP, false, In::desktop},
                                   {GL_POLYGON_SMOOTH, false, In::desktop},
                                   {GL_LINE_SMOOTH, false, In::desktop},
                                   {GL_FRAMEBUFFER_SRGB, false, In::desktop},
                                   {GL_CLIP_DISTANCE0, false, In::desktop},
                                   {GL_CLIP_DISTANCE1, false, In::desktop},
                                   {GL_CLIP_DISTANCE2, false, In::desktop},
                                   {GL_CLIP_DISTANCE3, false, In::desktop},
                                   {GL_CLIP_DISTANCE4, false, In::desktop},
                                   {GL_CLIP_DISTANCE5, false, In::desktop},
                                   {GL_CLIP_DISTANCE6, false, In::desktop},
                                   {GL_CLIP_DISTANCE7, false, In::desktop}};

struct PixelStore {
  GLenum what;
  GLint value;
  In api;
};
constexpr PixelStore kPixelStoreTable[] = {
    {GL_PACK_ALIGNMENT, 4, In::every},           {GL_PACK_ROW_LENGTH, 0, In::every},
    {GL_PACK_SKIP_PIXELS, 0, In::every},         {GL_PACK_SKIP_ROWS, 0, In::every},
    {GL_UNPACK_ALIGNMENT, 4, In::every},         {GL_UNPACK_ROW_LENGTH, 0, In::every},
    {GL_UNPACK_SKIP_PIXELS, 0, In::every},       {GL_UNPACK_SKIP_ROWS, 0, In::every},
    {GL_PACK_SWAP_BYTES, GL_FALSE, In::desktop}, {GL_UNPACK_SWAP_BYTES, GL_FALSE, In::desktop}};

bool there(In api) { return api == In::every || desktop(); }

bool has_clip_control() {
  return desktop() && (epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_ARB_clip_control"));
}
bool has_offset_clamp() {
  return (desktop() && epoxy_gl_version() >= 46) ||
         epoxy_has_gl_extension("GL_ARB_polygon_offset_clamp");
}
// Colour masks and blending of each draw buffer; functions and equations since 4.0.
bool has_buffer_masks() { return desktop(); }
bool has_buffer_functions() { return desktop() && epoxy_gl_version() >= 40; }

}  // namespace

void apply(const Pass& p, const PassSupport& support) {
  enable(GL_DEPTH_TEST, p.depth_test);
  glDepthFunc(p.depth_func);
  glDepthMask(p.depth_write ? GL_TRUE : GL_FALSE);
  if (support.depth_clamp) enable(GL_DEPTH_CLAMP, p.depth_clamp);

  enable(GL_STENCIL_TEST, p.stencil_test);
  glStencilFunc(p.stencil_func, p.stencil_ref, p.stencil_read);
  glStencilMask(p.stencil_write);
  glStencilOpSeparate(GL_FRONT, p.stencil_fail, p.front.depth_fail, p.front.depth_pass);
  glStencilOpSeparate(GL_BACK, p.stencil_fail, p.back.depth_fail, p.back.depth_pass);

  enable(GL_BLEND, p.blend);
  glBlendEquation(p.blend_equation);
  glBlendFunc(p.source, p.destination);

  enable(GL_CULL_FACE, p.cull != GL_NONE);
  if (p.cull != GL_NONE) glCullFace(p.cull);
  glColorMask(p.colour[0], p.colour[1], p.colour[2], p.colour[3]);
  enable(GL_SCISSOR_TEST, p.scissor.has_value());
  if (p.scissor) glScissor(p.scissor->x, p.scissor->y, p.scissor->width, p.scissor->height);
  if (support.depth_bounds) {
    enable(GL_DEPTH_BOUNDS_TEST_EXT, p.depth_bounds.has_value());
    if (p.depth_bounds) glDepthBoundsEXT((*p.depth_bounds)[0], (*p.depth_bounds)[1]);
  }
}

void offset_depth(float factor, float units) {
  enable(GL_POLYGON_OFFSET_FILL, factor != 0 || units != 0);
  glPolygonOffset(factor, units);
}

StateGuard::Face StateGuard::take_face(bool front) {
  Face f;
  f.func = integer(front ? GL_STENCIL_FUNC : GL_STENCIL_BACK_FUNC);
  f.ref = integer(front ? GL_STENCIL_REF : GL_STENCIL_BACK_REF);
  f.read = integer(front ? GL_STENCIL_VALUE_MASK : GL_STENCIL_BACK_VALUE_MASK);
  f.write = integer(front ? GL_STENCIL_WRITEMASK : GL_STENCIL_BACK_WRITEMASK);
  f.fail = integer(front ? GL_STENCIL_FAIL : GL_STENCIL_BACK_FAIL);
  f.depth_fail = integer(front ? GL_STENCIL_PASS_DEPTH_FAIL : GL_STENCIL_BACK_PASS_DEPTH_FAIL);
  f.depth_pass = integer(front ? GL_STENCIL_PASS_DEPTH_PASS : GL_STENCIL_BACK_PASS_DEPTH_PASS);
  return f;
}

void StateGuard::put_face(GLenum face, const Face& f) {
  glStencilFuncSeparate(face, f.func, f.ref, f.read);
  glStencilMaskSeparate(face, f.write);
  glStencilOpSeparate(face, f.fail, f.depth_fail, f.depth_pass);
}

StateGuard::DrawBuffer StateGuard::take_buffer(GLuint k) {
  DrawBuffer b;
  if (has_buffer_masks()) {
    b.blend = glIsEnabledi(GL_BLEND, k);
    glGetBooleani_v(GL_COLOR_WRITEMASK, k, b.colour.data());
  } else {
    b.blend = glIsEnabled(GL_BLEND);
    glGetBooleanv(GL_COLOR_WRITEMASK, b.colour.data());
  }
  const auto get = [&](GLenum what) {
    GLint value = 0;
    has_buffer_functions() ? glGetIntegeri_v(what, k, &value) : glGetIntegerv(what, &value);
    return value;
  };
  b.src_rgb = get(GL_BLEND_SRC_RGB);
  b.dst_rgb = get(GL_BLEND_DST_RGB);
  b.src_alpha = get(GL_BLEND_SRC_ALPHA);
  b.dst_alpha = get(GL_BLEND_DST_ALPHA);
  b.rgb = get(GL_BLEND_EQUATION_RGB);
  b.alpha = get(GL_BLEND_EQUATION_ALPHA);
  return b;
}

void StateGuard::put_buffer(GLuint k, const DrawBuffer& b) {
  if (has_buffer_masks()) {
    b.blend ? glEnablei(GL_BLEND, k) : glDisablei(GL_BLEND, k);
    glColorMaski(k, b.colour[0], b.colour[1], b.colour[2], b.colour[3]);
  } else if (k == 0) {
    enable(GL_BLEND, b.blend);
    glColorMask(b.colour[0], b.colour[1], b.colour[2], b.colour[3]);
  }
  if (has_buffer_functions()) {
    glBlendFuncSeparatei(k, b.src_rgb, b.dst_rgb, b.src_alpha, b.dst_alpha);
    glBlendEquationSeparatei(k, b.rgb, b.alpha);
  } else if (k == 0) {
    glBlendFuncSeparate(b.src_rgb, b.dst_rgb, b.src_alpha, b.dst_alpha);
    glBlendEquationSeparate(b.rgb, b.alpha);
  }
}

bool has_usual_clip_space() {
  std::array<GLfloat, 2> range{};
  glGetFloatv(GL_DEPTH_RANGE, range.data());
  if (!(range[0] < range[1])) return false;
  return !has_clip_control() || (integer(GL_CLIP_ORIGIN) == GL_LOWER_LEFT &&
                                 integer(GL_CLIP_DEPTH_MODE) == GL_NEGATIVE_ONE_TO_ONE);
}

StateGuard::StateGuard(const PassSupport& support, DepthsOf depths) : support_(support) {
  static_assert(std::size(kSwitchTable) == kSwitches);
  static_assert(std::size(kPixelStoreTable) == kPixelStores);
  glGetIntegerv(GL_VIEWPORT, viewport_.data());
  glGetIntegerv(GL_SCISSOR_BOX, scissor_.data());
  glGetFloatv(GL_DEPTH_RANGE, depth_range_.data());
  glGetFloatv(GL_COLOR_CLEAR_VALUE, clear_colour_.data());
  glGetBooleanv(GL_DEPTH_WRITEMASK, &depth_write_);
  if (desktop()) {
    glGetDoublev(GL_DEPTH_CLEAR_VALUE, &clear_depth_);
  } else {
    GLfloat value = 1;
    glGetFloatv(GL_DEPTH_CLEAR_VALUE, &value);
    clear_depth_ = value;
  }
  clear_stencil_ = integer(GL_STENCIL_CLEAR_VALUE);
  depth_test_ = glIsEnabled(GL_DEPTH_TEST);
  stencil_test_ = glIsEnabled(GL_STENCIL_TEST);
  cull_ = glIsEnabled(GL_CULL_FACE);
  scissor_test_ = glIsEnabled(GL_SCISSOR_TEST);
  glGetFloatv(GL_POLYGON_OFFSET_FACTOR, &offset_factor_);
  glGetFloatv(GL_POLYGON_OFFSET_UNITS, &offset_units_);
  if (has_offset_clamp()) glGetFloatv(GL_POLYGON_OFFSET_CLAMP, &offset_clamp_);
  restart_ = glIsEnabled(desktop() ? GL_PRIMITIVE_RESTART : GL_PRIMITIVE_RESTART_FIXED_INDEX);
  if (desktop()) {
    restart_index_ = integer(GL_PRIMITIVE_RESTART_INDEX);
    provoking_vertex_ = integer(GL_PROVOKING_VERTEX);
    glGetIntegerv(GL_POLYGON_MODE, polygon_mode_.data());
  }
  if (support_.depth_clamp) clamp_ = glIsEnabled(GL_DEPTH_CLAMP);
  if (support_.depth_bounds) {
    bounds_test_ = glIsEnabled(GL_DEPTH_BOUNDS_TEST_EXT);
    glGetFloatv(GL_DEPTH_BOUNDS_EXT, bounds_.data());
  }
  depth_func_ = integer(GL_DEPTH_FUNC);
  cull_face_ = integer(GL_CULL_FACE_MODE);
  front_face_ = integer(GL_FRONT_FACE);
  program_ = integer(GL_CURRENT_PROGRAM);
  vertex_array_ = integer(GL_VERTEX_ARRAY_BINDING);
  array_buffer_ = integer(GL_ARRAY_BUFFER_BINDING);
  draw_framebuffer_ = integer(GL_DRAW_FRAMEBUFFER_BINDING);
  read_framebuffer_ = integer(GL_READ_FRAMEBUFFER_BINDING);
  renderbuffer_ = integer(GL_RENDERBUFFER_BINDING);
  pack_buffer_ = integer(GL_PIXEL_PACK_BUFFER_BINDING);
  unpack_buffer_ = integer(GL_PIXEL_UNPACK_BUFFER_BINDING);
  active_texture_ = integer(GL_ACTIVE_TEXTURE);
  for (int unit = 0; unit < kTextureUnits; ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    textures_[unit] = integer(GL_TEXTURE_BINDING_2D);
    samplers_[unit] = integer(GL_SAMPLER_BINDING);
    glBindSampler(unit, 0);
  }
  for (std::size_t k = 0; k < kSwitches; ++k) {
    if (there(kSwitchTable[k].api)) switches_[k] = glIsEnabled(kSwitchTable[k].what);
  }
  for (std::size_t k = 0; k < kPixelStores; ++k) {
    if (there(kPixelStoreTable[k].api)) pixel_stores_[k] = integer(kPixelStoreTable[k].what);
  }
  for (GLuint k = 0; k < (has_buffer_masks() ? kDrawBuffers : 1); ++k) buffers_[k] = take_buffer(k);
  glGetFloatv(GL_LINE_WIDTH, &line_width_);
  if (has_clip_control()) {
    clip_origin_ = integer(GL_CLIP_ORIGIN);
    clip_depth_ = integer(GL_CLIP_DEPTH_MODE);
  }
  front_ = take_face(true);
  back_ = take_face(false);

  // What every pass here relies on.
  glFrontFace(GL_CCW);
  for (const Switch& w : kSwitchTable) {
    const bool depths_depend = w.what == GL_MULTISAMPLE && depths == DepthsOf::caller;
    if (there(w.api) && !depths_depend) enable(w.what, w.on);
  }
  for (const PixelStore& p : kPixelStoreTable) {
    if (there(p.api)) glPixelStorei(p.what, p.value);
  }
  glLineWidth(1);
  if (depths == DepthsOf::ours) {
    glDepthRangef(0, 1);
    if (desktop()) glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
    if (has_clip_control()) glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  }
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  if (desktop()) {
    glEnable(GL_PRIMITIVE_RESTART);
    glPrimitiveRestartIndex(0xffffffffu);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  } else {
    glEnable(GL_PRIMITIVE_RESTART_FIXED_INDEX);
  }
}

StateGuard::~StateGuard() {
  glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
  glScissor(scissor_[0], scissor_[1], scissor_[2], scissor_[3]);
  glDepthRangef(depth_range_[0], depth_range_[1]);
  if (has_clip_control()) glClipControl(clip_origin_, clip_depth_);
  for (std::size_t k = 0; k < kSwitches; ++k) {
    if (there(kSwitchTable[k].api)) enable(kSwitchTable[k].what, switches_[k]);
  }
  for (std::size_t k = 0; k < kPixelStores; ++k) {
    if (there(kPixelStoreTable[k].api)) glPixelStorei(kPixelStoreTable[k].what, pixel_stores_[k]);
  }
  for (GLuint k = 0; k < (has_buffer_masks() ? kDrawBuffers : 1); ++k) put_buffer(k, buffers_[k]);
  glLineWidth(line_width_);
  glClearColor(clear_colour_[0], clear_colour_[1], clear_colour_[2], clear_colour_[3]);
  glDepthMask(depth_write_);
  desktop() ? glClearDepth(clear_depth_) : glClearDepthf(static_cast<GLfloat>(clear_depth_));
  glClearStencil(clear_stencil_);
  enable(GL_DEPTH_TEST, depth_test_);
  enable(GL_STENCIL_TEST, stencil_test_);
  enable(GL_CULL_FACE, cull_);
  enable(GL_SCISSOR_TEST, scissor_test_);
  if (has_offset_clamp()) {
    glPolygonOffsetClamp(offset_factor_, offset_units_, offset_clamp_);
  } else {
    glPolygonOffset(offset_factor_, offset_units_);
  }
  enable(desktop() ? GL_PRIMITIVE_RESTART : GL_PRIMITIVE_RESTART_FIXED_INDEX, restart_);
  if (desktop()) {
    glPrimitiveRestartIndex(static_cast<GLuint>(restart_index_));
    glProvokingVertex(static_cast<GLenum>(provoking_vertex_));
    glPolygonMode(GL_FRONT_AND_BACK, static_cast<GLenum>(polygon_mode_[0]));
  }
  if (support_.depth_clamp) enable(GL_DEPTH_CLAMP, clamp_);
  if (support_.depth_bounds) {
    enable(GL_DEPTH_BOUNDS_TEST_EXT, bounds_test_);
    glDepthBoundsEXT(bounds_[0], bounds_[1]);
  }
  glDepthFunc(depth_func_);
  glCullFace(cull_face_);
  glFrontFace(front_face_);
  glUseProgram(program_);
  glBindVertexArray(vertex_array_);
  glBindBuffer(GL_ARRAY_BUFFER, array_buffer_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, draw_framebuffer_);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, read_framebuffer_);
  glBindRenderbuffer(GL_RENDERBUFFER, renderbuffer_);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, pack_buffer_);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, unpack_buffer_);
  for (int unit = 0; unit < kTextureUnits; ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, textures_[unit]);
    glBindSampler(unit, samplers_[unit]);
  }
  glActiveTexture(active_texture_);
  put_face(GL_FRONT, front_);
  put_face(GL_BACK, back_);
}

}  // namespace gnomon::gl
