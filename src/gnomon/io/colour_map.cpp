#include <gnomon/io/colour_map.h>

#include <algorithm>
#include <cmath>

#include <gnomon/core/place.h>

namespace gnomon {
namespace {

constexpr double kLightest = 96, kDarkest = 14;  // L*

// Chroma and hue (degrees) at equal steps of lightness; chosen by eye inside the sRGB gamut.
struct Point {
  double chroma, hue;
};
constexpr std::array<Point, 8> kPoints{
    {{9, 98}, {44, 88}, {62, 72}, {64, 51}, {57, 24}, {47, -12}, {40, -42}, {31, -64}}};

// Catmull-Rom spline through the points, the ends doubled.
template <class Member>
double along(double t, Member member) {
  const int last = static_cast<int>(kPoints.size()) - 1;
  const double x = t * last;
  const int k = std::min(static_cast<int>(x), last - 1);
  const double u = x - k;
  const auto value = [&](int i) {
    return member(kPoints[static_cast<std::size_t>(std::clamp(i, 0, last))]);
  };
  const double a = value(k - 1), b = value(k), c = value(k + 1), d = value(k + 2);
  return b + 0.5 * u * (c - a + u * (2 * a - 5 * b + 4 * c - d + u * (3 * (b - c) + d - a)));
}

std::uint8_t srgb_byte(double linear) {
  const double v = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0, 1.0)));
}

// CIELAB (D65) to sRGB, IEC 61966-2-1.
Rgb from_lab(double l, double a, double b) {
  const auto inverse = [](double f) {
    return f > 6.0 / 29 ? f * f * f : 3 * 36.0 / 841 * (f - 4.0 / 29);
  };
  const double fy = (l + 16) / 116;
  const double x = 0.95047 * inverse(fy + a / 500), y = inverse(fy),
               z = 1.08883 * inverse(fy - b / 200);
  return {srgb_byte(3.2404542 * x - 1.5371385 * y - 0.4985314 * z),
          srgb_byte(-0.9692660 * x + 1.8760108 * y + 0.0415560 * z),
          srgb_byte(0.0556434 * x - 0.2040259 * y + 1.0572252 * z)};
}

std::array<Rgb, 256> make_table() {
  std::array<Rgb, 256> table;
  for (std::size_t k = 0; k < table.size(); ++k) {
    const double t = static_cast<double>(k) / 255;
    const double chroma = along(t, [](const Point& p) { return p.chroma; });
    const double hue = along(t, [](const Point& p) { return p.hue; }) * kDegree;
    table[k] = from_lab(kLightest + t * (kDarkest - kLightest), chroma * std::cos(hue),
                        chroma * std::sin(hue));
  }
  return table;
}

}  // namespace

const std::array<Rgb, 256>& hours_colours() {
  static const std::array<Rgb, 256> table = make_table();
  return table;
}

Rgb hours_colour(double share) {
  return hours_colours()[static_cast<std::size_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)))];
}

}  // namespace gnomon
