// The window's picture as a file.
#pragma once

#include <epoxy/gl.h>

#include <fstream>
#include <string>

// As PPM, before the window shows it. False: it cannot be written.
inline bool save_window(int width, int height, const char* path) {
  std::string pixels(std::size_t(width) * std::size_t(height) * 3, '\0');
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
  std::ofstream out(path, std::ios::binary);
  out << "P6\n" << width << ' ' << height << "\n255\n";
  for (std::size_t row = std::size_t(height); row-- > 0;)
    out.write(&pixels[row * std::size_t(width) * 3], width * 3);
  return bool(out.flush());
}
