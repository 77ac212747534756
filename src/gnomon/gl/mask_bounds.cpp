#include <gnomon/gl/mask_bounds.h>

#include <cmath>

namespace gnomon::gl {
namespace {

// Of a depth buffer of 24 bits: a surface's depth and a side's are rounded to a step each, and
// before that to floats of 24 bits when corners are put on the screen and when they are
// interpolated over polygons that reach far out of it.
// Two more and slopes over 1/256 pixel are what the renderer moves sides away by where the light
// grazes surfaces (volume_draws.cpp).
constexpr double kSteps = 8 + 2;
// Corners are rounded to 1/256 pixel (OpenGL asks for 1/16 at least), of surface and side.
constexpr double kCorner = (1.0 + 2.0) / 256;
constexpr double kShare = 0.001;
constexpr double kLowShare = 0.1;
// An answer from another place is right half of the time where both states are as frequent.
constexpr double kLowNearEdges = 0.5;

}  // namespace

MaskBound bound_of(const Method& m) {
  MaskBound b;
  b.share = kShare;
  b.steps = kSteps;
  b.pixels = kCorner;
  if (m.mask_scale < 1) {
    b.of = m.mask_scale >= 0.5 ? "half size" : "quarter size";
    // One answer stands for a square of pixels, and bilinear filtering reaches half a square more.
    b.edge = static_cast<int>(std::ceil(1.5 / m.mask_scale));
    b.steps = b.pixels = 0;
    b.share = kLowShare;
    b.near_edges = kLowNearEdges;
    b.unexplained = true;
    b.why =
        "one answer stands for a square of pixels, and near the rim of a surface for another "
        "surface's";
  } else if (m.extrusion == Extrusion::blend_large) {
    b.of = "finite extrusion";
    b.unexplained = true;
    b.why =
        "points behind are 16777216 times as far from the light: in floats they lie beside the "
        "points at infinity";
  } else if (m.count == Count::zp_plus) {
    b.of = "ZP+";
    b.unexplained = true;
    b.why =
        "casters are thrown on the near plane in another order of operations than sides are cut "
        "by it: cracks at its edges";
  } else if (m.count == Count::near_cap) {
    b.of = "near caps";
    b.unexplained = true;
    b.why = "the cut with the near plane is rounded apart from the sides that it closes";
  } else {
    b.of = "full resolution";
    b.same_as_stencil = true;
    b.why =
        "the same sides with the same depths are counted, only kept elsewhere or counted from the "
        "other end";
  }
  return b;
}

std::vector<MaskBound> mask_bounds() {
  Method usual, caps, plus, large, half, quarter;
  caps.count = Count::near_cap;
  plus.count = Count::zp_plus;
  large.extrusion = Extrusion::blend_large;
  half.mask_scale = 0.5;
  quarter.mask_scale = 0.25;
  std::vector<MaskBound> out;
  for (const Method& m : {usual, caps, plus, large, half, quarter}) out.push_back(bound_of(m));
  return out;
}

}  // namespace gnomon::gl
