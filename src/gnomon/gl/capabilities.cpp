#include <gnomon/gl/capabilities.h>

#include <epoxy/egl.h>
#include <epoxy/gl.h>

namespace gnomon::gl {

Result<Capabilities> find_capabilities() {
  const auto* version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
  if (version == nullptr) return Error{"No OpenGL context is current on this thread."};
  Capabilities c;
  c.es = !epoxy_is_desktop_gl();
  const int v = epoxy_gl_version();
  c.major = v / 10;
  c.minor = v % 10;
  c.renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  for (const char* name : {"llvmpipe", "softpipe", "SwiftShader"})
    c.software |= c.renderer.find(name) != std::string::npos;
  if (v < (c.es ? 30 : 33)) {
    return Error{"The OpenGL context is " + std::string(version) +
                 "; Gnomon's renderer needs OpenGL 3.3 or OpenGL ES 3.0."};
  }
  const auto has = [](const char* name) { return epoxy_has_gl_extension(name); };
  c.depth_clamp = !c.es || has("GL_EXT_depth_clamp");
  c.depth_bounds = has("GL_EXT_depth_bounds_test");
  c.float_colour =
      !c.es || v >= 32 || has("GL_EXT_color_buffer_float") || has("GL_EXT_color_buffer_half_float");
  c.float_blend = !c.es || (has("GL_EXT_color_buffer_float") && has("GL_EXT_float_blend"));
  glGetIntegerv(GL_MAX_SAMPLES, &c.max_samples);
  return c;
}

Result<Capabilities> without(Capabilities c, const std::string& name) {
  if (name == "depth-clamp") {
    c.depth_clamp = false;
  } else if (name == "depth-bounds") {
    c.depth_bounds = false;
  } else if (name == "float-colour") {
    c.float_colour = c.float_blend = false;
  } else if (name == "float-blend") {
    c.float_blend = false;
  } else if (name == "multisampling") {
    c.max_samples = 0;
  } else {
    return Error{"There is no capability '" + name +
                 "': depth-clamp, depth-bounds, float-blend, float-colour, multisampling."};
  }
  return c;
}

std::string describe(const Capabilities& c) {
  std::string text = (c.es ? "OpenGL ES " : "OpenGL ") + std::to_string(c.major) + "." +
                     std::to_string(c.minor) + " (" + c.renderer + ")";
  const auto add = [&](bool there, const char* name) {
    text += std::string(there ? ", " : ", no ") + name;
  };
  add(c.depth_clamp, "depth clamp");
  add(c.depth_bounds, "depth bounds");
  add(c.float_colour, "half-float colour");
  add(c.float_blend, "blending of 32-bit floats");
  return text + ", at most " + std::to_string(c.max_samples) + " samples a pixel";
}

}  // namespace gnomon::gl
