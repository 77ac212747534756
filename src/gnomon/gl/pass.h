// All state of a pass in one struct, applied in one place. Nothing else in this room sets depth,
// stencil, blend, cull, colour-mask, scissor or polygon-mode state.
#pragma once

#include <array>
#include <optional>

#include <epoxy/gl.h>

namespace gnomon::gl {

struct StencilFace {
  GLenum depth_fail = GL_KEEP;
  GLenum depth_pass = GL_KEEP;
};

struct Rect {
  int x = 0, y = 0, width = 0, height = 0;  // pixels, y upwards (OpenGL's)
};

struct Pass {
  bool depth_test = true;
  GLenum depth_func = GL_LESS;
  bool depth_write = false;
  bool depth_clamp = false;  // only where Capabilities has it

  bool stencil_test = false;
  GLenum stencil_func = GL_ALWAYS;
  GLint stencil_ref = 0;
  GLuint stencil_read = 0xff;
  GLuint stencil_write = 0xff;
  StencilFace front, back;  // two-sided: both are core in OpenGL 2.0 and OpenGL ES 2.0
  GLenum stencil_fail = GL_KEEP;

  bool blend = false;
  GLenum blend_equation = GL_FUNC_ADD;
  GLenum source = GL_ONE, destination = GL_ZERO;

  GLenum cull = GL_NONE;  // GL_NONE, GL_FRONT, GL_BACK
  std::array<bool, 4> colour{false, false, false, false};
  std::optional<Rect> scissor{};
  std::optional<std::array<double, 2>> depth_bounds{};  // only where Capabilities has it
};

// `depth_bounds_there`: Capabilities::depth_bounds; `depth_clamp_there` likewise.
struct PassSupport {
  bool depth_clamp = false, depth_bounds = false;
};
void apply(const Pass& pass, const PassSupport& support);

// Moves what is drawn from here on away from the eye: `factor` of its depth's slope per pixel and
// `units` of the smallest depth step. 0, 0: no more. Passes do not change it.
void offset_depth(float factor, float units);

// The caller's state: everything that this room touches, taken when made, put back when destroyed.
class StateGuard {
 public:
  explicit StateGuard(const PassSupport& support);
  ~StateGuard();
  StateGuard(const StateGuard&) = delete;
  StateGuard& operator=(const StateGuard&) = delete;

 private:
  struct Face {
    GLint func, ref, read, write, fail, depth_fail, depth_pass;
  };
  static Face take_face(bool front);
  static void put_face(GLenum face, const Face& f);
  PassSupport support_;
  std::array<GLint, 4> viewport_{}, scissor_{};
  std::array<GLboolean, 4> colour_{};
  std::array<GLfloat, 4> clear_colour_{};
  GLboolean depth_write_ = GL_TRUE, depth_test_, stencil_test_, blend_, cull_, scissor_test_,
            restart_, clamp_ = GL_FALSE, bounds_test_ = GL_FALSE, dither_, alpha_to_coverage_,
            offset_fill_, discard_, srgb_ = GL_FALSE;
  std::array<GLfloat, 2> bounds_{};
  GLfloat offset_factor_ = 0, offset_units_ = 0;
  GLfloat clear_depth_ = 1;
  GLint clear_stencil_ = 0, depth_func_, cull_face_, front_face_, program_, vertex_array_,
        array_buffer_, draw_framebuffer_, read_framebuffer_, renderbuffer_, active_texture_,
        blend_src_rgb_, blend_dst_rgb_, blend_src_alpha_, blend_dst_alpha_, blend_rgb_,
        blend_alpha_, restart_index_ = 0, unpack_alignment_, pack_alignment_, pack_buffer_,
        unpack_buffer_;
  std::array<GLint, 2> polygon_mode_{};
  std::array<GLint, 4> textures_{}, samplers_{};  // of the units that this room uses
  Face front_, back_;
};

// Units that this room binds textures to: base colour, normal, mask, and one to copy.
inline constexpr int kTextureUnits = 4;

}  // namespace gnomon::gl
