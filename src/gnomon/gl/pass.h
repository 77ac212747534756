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

// Of Capabilities.
struct PassSupport {
  bool depth_clamp = false, depth_bounds = false;
};
void apply(const Pass& pass, const PassSupport& support);

// Moves what is drawn from here on away from the eye: `factor` of its depth's slope per pixel and
// `units` of the smallest depth step. 0, 0: no more. Passes do not change it.
void offset_depth(float factor, float units);

// Whose framebuffer is drawn to. Depths in the caller's were drawn in the caller's depth range,
// with the caller's provoking vertex, on which their rounding depends (llvmpipe), and per sample or
// pixel as the caller has it.
enum class DepthsOf { ours, caller };

// The caller's state: everything that this room touches, taken when made, put back when destroyed.
// In between, what could spoil a pass is at its default.
class StateGuard {
 public:
  explicit StateGuard(const PassSupport& support, DepthsOf depths = DepthsOf::ours);
  ~StateGuard();
  StateGuard(const StateGuard&) = delete;
  StateGuard& operator=(const StateGuard&) = delete;

 private:
  struct Face {
    GLint func, ref, read, write, fail, depth_fail, depth_pass;
  };
  // As many as the tables in pass.cpp have.
  static constexpr std::size_t kSwitches = 22, kPixelStores = 10;
  static constexpr std::size_t kDrawBuffers = 8;  // OpenGL has no fewer
  static Face take_face(bool front);
  static void put_face(GLenum face, const Face& f);
  struct DrawBuffer {
    GLboolean blend = GL_FALSE;
    std::array<GLboolean, 4> colour{};
    GLint src_rgb = 0, dst_rgb = 0, src_alpha = 0, dst_alpha = 0, rgb = 0, alpha = 0;
  };
  static DrawBuffer take_buffer(GLuint k);
  static void put_buffer(GLuint k, const DrawBuffer& b);
  PassSupport support_;
  std::array<GLint, 4> viewport_{}, scissor_{};
  std::array<GLfloat, 4> clear_colour_{};
  std::array<GLfloat, 2> depth_range_{};
  std::array<GLboolean, kSwitches> switches_{};
  std::array<GLint, kPixelStores> pixel_stores_{};
  std::array<DrawBuffer, kDrawBuffers> buffers_{};
  GLboolean depth_write_ = GL_TRUE, depth_test_, stencil_test_, cull_, scissor_test_, restart_,
            clamp_ = GL_FALSE, bounds_test_ = GL_FALSE;
  std::array<GLfloat, 2> bounds_{};
  GLfloat line_width_ = 1;
  GLfloat offset_factor_ = 0, offset_units_ = 0;
  GLfloat offset_clamp_ = 0;
  GLdouble clear_depth_ = 1;
  GLint clear_stencil_ = 0, depth_func_, cull_face_, front_face_, program_, vertex_array_,
        array_buffer_, draw_framebuffer_, read_framebuffer_, renderbuffer_, active_texture_,
        restart_index_ = 0, pack_buffer_, unpack_buffer_, clip_origin_ = 0, clip_depth_ = 0,
        provoking_vertex_ = 0;
  std::array<GLint, 2> polygon_mode_{};
  std::array<GLint, 4> textures_{}, samplers_{};  // of the units that this room uses
  Face front_, back_;
};

// False where the depths of the bound framebuffer cannot have been drawn with our matrices: the
// near half of clip space cut off (glClipControl), depths or picture upside down.
bool has_usual_clip_space();

// Units that this room binds textures to: base colour, normal, mask, and one to copy.
inline constexpr int kTextureUnits = 4;

}  // namespace gnomon::gl
