// Pictures in memory, and a canvas to draw lines, areas and text on them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gnomon/core/vec.h>

namespace gnomon {

struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;  // sRGB
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

// Row-major, row 0 at the top.
struct Picture {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;
};

// Of four bytes a pixel: red, green, blue, and one that is left out.
inline Picture picture_of_rgba(int width, int height, std::span<const std::uint8_t> rgba) {
  Picture out{width, height, {}};
  out.pixels.reserve(rgba.size() / 4);
  for (std::size_t i = 0; i + 3 < rgba.size(); i += 4)
    out.pixels.push_back({rgba[i], rgba[i + 1], rgba[i + 2]});
  return out;
}

inline Rgb& at(Picture& p, int x, int y) {
  return p.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(p.width) +
                  static_cast<std::size_t>(x)];
}
inline const Rgb& at(const Picture& p, int x, int y) {
  return p.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(p.width) +
                  static_cast<std::size_t>(x)];
}

enum class Align { left, centre, right };

struct TextStyle {
  double size = 16;  // pixels per em
  Rgb colour{0, 0, 0};
  bool bold = false;
  Align align =
      Align::left;  // of the text to the x given; of the lines inside the box where it wraps
  double wrap = 0;  // pixels; lines break there; 0: never
};

struct TextSize {
  double width = 0, height = 0;  // pixels
};

// Pixels, x to the right, y down, pixel centres at halves. Draws anti-aliased in sans-serif type
// (any UTF-8 text).
class Canvas {
 public:
  // Precondition: 0 < width, height <= 32767 (Cairo's limit).
  Canvas(int width, int height, Rgb background);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  void rectangle(double x, double y, double width, double height, Rgb fill);
  void frame(double x, double y, double width, double height, Rgb stroke, double line);  // inside
  void polygon(std::span<const Vec2> corners, Rgb fill);
  void line(Vec2 from, Vec2 to, Rgb stroke, double width);
  void circle(Vec2 centre, double radius, Rgb stroke, double line);
  // Upper left corner of the picture at whole pixels; what reaches outside is cut off.
  void image(int x, int y, const Picture& picture);
  // y is the top of the text's box; returns the size of the box.
  TextSize text(double x, double y, const std::string& words, const TextStyle& style);
  TextSize measure(const std::string& words, const TextStyle& style) const;

  Picture picture() const;

 private:
  struct Cairo;
  std::unique_ptr<Cairo> cairo_;
};

}  // namespace gnomon
