#include <gnomon/gl/target.h>

#include <algorithm>
#include <string>

namespace gnomon::gl {
namespace {

GLenum colour_format(const TargetFormat& f) {
  return f.float_bits == 32 ? GL_RGBA32F : f.float_bits == 16 ? GL_RGBA16F : GL_RGBA8;
}

}  // namespace

Result<Target> make_target(const TargetFormat& f, const Target* depth_of) {
  Target t;
  t.format = f;
  GLint largest = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
  const std::string size = std::to_string(f.width) + " x " + std::to_string(f.height);
  if (f.width > largest || f.height > largest) {
    return Error{"A picture of " + size + " pixels is larger than this OpenGL draws (" +
                 std::to_string(largest) + " pixels a side)."};
  }
  t.framebuffer = Framebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, t.framebuffer.id());
  if (f.samples > 1) {
    t.colour_buffer = Renderbuffer::make();
    glBindRenderbuffer(GL_RENDERBUFFER, t.colour_buffer.id());
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, f.samples, colour_format(f), f.width,
                                     f.height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                              t.colour_buffer.id());
  } else {
    t.colour = Texture2D::make();
    glBindTexture(GL_TEXTURE_2D, t.colour.id());
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(colour_format(f)), f.width, f.height, 0,
                 GL_RGBA, f.float_bits > 0 ? GL_FLOAT : GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, t.colour.id(), 0);
  }
  GLuint depth = depth_of != nullptr ? depth_of->depth.id() : 0;
  if (depth_of == nullptr) {
    t.depth = Renderbuffer::make();
    depth = t.depth.id();
    glBindRenderbuffer(GL_RENDERBUFFER, depth);
    const GLenum format = f.stencil ? GL_DEPTH24_STENCIL8 : GL_DEPTH_COMPONENT24;
    if (f.samples > 1) {
      glRenderbufferStorageMultisample(GL_RENDERBUFFER, f.samples, format, f.width, f.height);
    } else {
      glRenderbufferStorage(GL_RENDERBUFFER, format, f.width, f.height);
    }
  }
  glFramebufferRenderbuffer(GL_FRAMEBUFFER,
                            f.stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT,
                            GL_RENDERBUFFER, depth);
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    return Error{"OpenGL makes no framebuffer of " + size + " pixels, " +
                 std::to_string(f.samples) + " samples a pixel, " +
                 (f.stencil ? "with" : "without") + " stencil (status " + std::to_string(status) +
                 ")."};
  }
  return t;
}

Resolved resolve(const Target& target) {
  const TargetFormat& f = target.format;
  Resolved out;
  out.framebuffer = Framebuffer::make();
  out.colour_buffer = Renderbuffer::make();
  glBindRenderbuffer(GL_RENDERBUFFER, out.colour_buffer.id());
  glRenderbufferStorage(GL_RENDERBUFFER, colour_format(f), f.width, f.height);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, out.framebuffer.id());
  glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                            out.colour_buffer.id());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer.id());
  glDisable(GL_SCISSOR_TEST);
  glBlitFramebuffer(0, 0, f.width, f.height, 0, 0, f.width, f.height, GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
  return out;
}

Image read_colours(const Target& target) {
  const TargetFormat& f = target.format;
  Image image{f.width, f.height, {}};
  image.rgba.resize(std::size_t(f.width) * f.height * 4);
  Resolved resolved;
  if (f.samples > 1) resolved = resolve(target);
  glBindFramebuffer(GL_READ_FRAMEBUFFER,
                    f.samples > 1 ? resolved.framebuffer.id() : target.framebuffer.id());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  if (f.float_bits > 0) {
    std::vector<float> values(image.rgba.size());
    glReadPixels(0, 0, f.width, f.height, GL_RGBA, GL_FLOAT, values.data());
    std::transform(values.begin(), values.end(), image.rgba.begin(), [](float v) {
      return static_cast<std::uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255.0f + 0.5f);
    });
  } else {
    glReadPixels(0, 0, f.width, f.height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
  }
  const std::size_t row = std::size_t(f.width) * 4;
  for (int y = 0; y < f.height / 2; ++y) {
    std::swap_ranges(image.rgba.begin() + y * row, image.rgba.begin() + (y + 1) * row,
                     image.rgba.begin() + (f.height - 1 - y) * row);
  }
  return image;
}

}  // namespace gnomon::gl
