#include <gnomon/gl/mask_bounds.h>

#include <cmath>

namespace gnomon::gl {
namespace {

// Depths are rounded to 24 bits, a surface's and a side's, and interpolated in floats of 24 bits.
constexpr double kSteps = 8;
// Corners of polygons are rounded to 1/256 pixel.
constexpr double kCorner = 1.0 / 128;
constexpr double kShare = 0.001;

}  // namespace

MaskBound bound_of(const Method& m) {
  MaskBound b;
  b.share = kShare;
  b.steps = kSteps;
  b.pixels = kCorner;
  if (m.mask_scale < 1) {
    b.of = m.mask_scale >= 0.5 ? "half size" : "quarter size";
    b.edge = static_cast<int>(std::ceil(1 / m.mask_scale)) + 1;
    b.share = 0.05;
    b.steps = b.pixels = 0;
    b.unexplained = true;
  } else if (m.extrusion == Extrusion::blend_large) {
    b.of = "finite extrusion";
    b.unexplained = true;
  } else if (m.count == Count::zp_plus) {
    b.of = "ZP+";
    b.unexplained = true;
  } else if (m.count == Count::near_cap) {
    b.of = "near caps";
  } else {
    b.of = "full resolution";
    b.same_as_stencil = true;
  }
  return b;
}

}  // namespace gnomon::gl
