#include <gnomon/gl/pass.h>

namespace gnomon::gl {
namespace {

void enable(GLenum what, bool on) { on ? glEnable(what) : glDisable(what); }

GLint integer(GLenum what) {
  GLint value = 0;
  glGetIntegerv(what, &value);
  return value;
}

bool desktop() { return epoxy_is_desktop_gl(); }

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

StateGuard::StateGuard(const PassSupport& support) : support_(support) {
  glGetIntegerv(GL_VIEWPORT, viewport_.data());
  glGetIntegerv(GL_SCISSOR_BOX, scissor_.data());
  glGetBooleanv(GL_COLOR_WRITEMASK, colour_.data());
  glGetFloatv(GL_COLOR_CLEAR_VALUE, clear_colour_.data());
  glGetBooleanv(GL_DEPTH_WRITEMASK, &depth_write_);
  glGetFloatv(GL_DEPTH_CLEAR_VALUE, &clear_depth_);
  clear_stencil_ = integer(GL_STENCIL_CLEAR_VALUE);
  depth_test_ = glIsEnabled(GL_DEPTH_TEST);
  stencil_test_ = glIsEnabled(GL_STENCIL_TEST);
  blend_ = glIsEnabled(GL_BLEND);
  cull_ = glIsEnabled(GL_CULL_FACE);
  scissor_test_ = glIsEnabled(GL_SCISSOR_TEST);
  dither_ = glIsEnabled(GL_DITHER);
  alpha_to_coverage_ = glIsEnabled(GL_SAMPLE_ALPHA_TO_COVERAGE);
  offset_fill_ = glIsEnabled(GL_POLYGON_OFFSET_FILL);
  glGetFloatv(GL_POLYGON_OFFSET_FACTOR, &offset_factor_);
  glGetFloatv(GL_POLYGON_OFFSET_UNITS, &offset_units_);
  discard_ = glIsEnabled(GL_RASTERIZER_DISCARD);
  restart_ = glIsEnabled(desktop() ? GL_PRIMITIVE_RESTART : GL_PRIMITIVE_RESTART_FIXED_INDEX);
  if (desktop()) {
    restart_index_ = integer(GL_PRIMITIVE_RESTART_INDEX);
    glGetIntegerv(GL_POLYGON_MODE, polygon_mode_.data());
    srgb_ = glIsEnabled(GL_FRAMEBUFFER_SRGB);
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
  pack_alignment_ = integer(GL_PACK_ALIGNMENT);
  unpack_alignment_ = integer(GL_UNPACK_ALIGNMENT);
  active_texture_ = integer(GL_ACTIVE_TEXTURE);
  for (int unit = 0; unit < kTextureUnits; ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    textures_[unit] = integer(GL_TEXTURE_BINDING_2D);
    samplers_[unit] = integer(GL_SAMPLER_BINDING);
    glBindSampler(unit, 0);
  }
  blend_src_rgb_ = integer(GL_BLEND_SRC_RGB);
  blend_dst_rgb_ = integer(GL_BLEND_DST_RGB);
  blend_src_alpha_ = integer(GL_BLEND_SRC_ALPHA);
  blend_dst_alpha_ = integer(GL_BLEND_DST_ALPHA);
  blend_rgb_ = integer(GL_BLEND_EQUATION_RGB);
  blend_alpha_ = integer(GL_BLEND_EQUATION_ALPHA);
  front_ = take_face(true);
  back_ = take_face(false);

  // What every pass here relies on.
  glFrontFace(GL_CCW);
  glDisable(GL_DITHER);
  glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_RASTERIZER_DISCARD);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  if (desktop()) {
    glEnable(GL_PRIMITIVE_RESTART);
    glPrimitiveRestartIndex(0xffffffffu);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDisable(GL_FRAMEBUFFER_SRGB);
  } else {
    glEnable(GL_PRIMITIVE_RESTART_FIXED_INDEX);
  }
}

StateGuard::~StateGuard() {
  glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
  glScissor(scissor_[0], scissor_[1], scissor_[2], scissor_[3]);
  glColorMask(colour_[0], colour_[1], colour_[2], colour_[3]);
  glClearColor(clear_colour_[0], clear_colour_[1], clear_colour_[2], clear_colour_[3]);
  glDepthMask(depth_write_);
  glClearDepthf(clear_depth_);
  glClearStencil(clear_stencil_);
  enable(GL_DEPTH_TEST, depth_test_);
  enable(GL_STENCIL_TEST, stencil_test_);
  enable(GL_BLEND, blend_);
  enable(GL_CULL_FACE, cull_);
  enable(GL_SCISSOR_TEST, scissor_test_);
  enable(GL_DITHER, dither_);
  enable(GL_SAMPLE_ALPHA_TO_COVERAGE, alpha_to_coverage_);
  enable(GL_POLYGON_OFFSET_FILL, offset_fill_);
  glPolygonOffset(offset_factor_, offset_units_);
  enable(GL_RASTERIZER_DISCARD, discard_);
  enable(desktop() ? GL_PRIMITIVE_RESTART : GL_PRIMITIVE_RESTART_FIXED_INDEX, restart_);
  if (desktop()) {
    glPrimitiveRestartIndex(static_cast<GLuint>(restart_index_));
    glPolygonMode(GL_FRONT_AND_BACK, static_cast<GLenum>(polygon_mode_[0]));
    enable(GL_FRAMEBUFFER_SRGB, srgb_);
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
  glPixelStorei(GL_PACK_ALIGNMENT, pack_alignment_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, unpack_alignment_);
  for (int unit = 0; unit < kTextureUnits; ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, textures_[unit]);
    glBindSampler(unit, samplers_[unit]);
  }
  glActiveTexture(active_texture_);
  glBlendFuncSeparate(blend_src_rgb_, blend_dst_rgb_, blend_src_alpha_, blend_dst_alpha_);
  glBlendEquationSeparate(blend_rgb_, blend_alpha_);
  put_face(GL_FRONT, front_);
  put_face(GL_BACK, back_);
}

}  // namespace gnomon::gl
