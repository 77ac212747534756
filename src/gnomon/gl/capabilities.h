// What the OpenGL at hand can do, found at run time, and what of it is not to be used.
#pragma once

#include <string>
#include <vector>

#include <gnomon/core/result.h>

namespace gnomon::gl {

// The common subset, OpenGL 3.3 core and OpenGL ES 3.0 (WebGL 2), has no entry here: two-sided
// stencil state, wrapping stencil operations, primitive restart, framebuffer objects are in both.
struct Capabilities {
  bool es = false;            // OpenGL ES
  int major = 0, minor = 0;   // of the context
  std::string renderer;       // GL_RENDERER
  bool software = false;      // it draws with the processor: llvmpipe, softpipe, SwiftShader
  bool depth_clamp = false;   // core since 3.2; ES: EXT_depth_clamp
  bool depth_bounds = false;  // EXT_depth_bounds_test
  bool float_blend = false;   // 32-bit floats as a target of blending; ES: EXT_float_blend
  bool float_colour =
      false;            // half floats as a target of drawing; ES: EXT_color_buffer_(half_)float
  int max_samples = 0;  // of a multisampled renderbuffer
};

// Of the current context. Errors: no context is current, or it is older than OpenGL 3.3 / ES 3.0.
Result<Capabilities> find_capabilities();

// Makes one of them look absent: "depth-clamp", "depth-bounds", "float-blend", "float-colour"
// (both), "multisampling". Error: no such name (lists them).
Result<Capabilities> without(Capabilities capabilities, const std::string& name);

// One line for people: "OpenGL 4.5 (llvmpipe ...): depth clamp, half-float colour; no depth
// bounds".
std::string describe(const Capabilities& capabilities);

}  // namespace gnomon::gl
