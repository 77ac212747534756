// Framebuffers of our own: colour with alpha, depth with or without stencil, multisampled or not.
#pragma once

#include <gnomon/core/result.h>
#include <gnomon/gl/handles.h>
#include <gnomon/gl/renderer.h>

namespace gnomon::gl {

struct TargetFormat {
  int width = 0, height = 0;
  int samples = 1;
  int float_bits = 0;   // 16 or 32: floats instead of 8-bit colours
  bool stencil = true;  // 24-bit depth with 8-bit stencil; without: 24-bit depth alone
  bool operator==(const TargetFormat&) const = default;
};

struct Target {
  TargetFormat format;
  Framebuffer framebuffer;
  Texture2D colour;            // of one sample a pixel
  Renderbuffer colour_buffer;  // of several
  Renderbuffer depth;
};

// Errors: the framebuffer is incomplete (names size and format). `depth_of`: shares its depth and
// stencil instead of having its own.
Result<Target> make_target(const TargetFormat& format, const Target* depth_of = nullptr);

// The colours in the same format with one sample a pixel; bound for drawing, the target for
// reading.
struct Resolved {
  Framebuffer framebuffer;
  Renderbuffer colour_buffer;
};
Resolved resolve(const Target& target);

// The colours of one sample a pixel.
Image read_colours(const Target& target);

}  // namespace gnomon::gl
