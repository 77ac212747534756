// How far a drawn mask may be from the exact one: every bound that verification holds methods to,
// and why it is what it is.
#pragma once

#include <string_view>

#include <gnomon/gl/method.h>

namespace gnomon::gl {

// A sample that differs is explained if its answer is exact within `edge` pixels of it (rounding of
// edges on the screen), or if sides of shadow volumes lie within `steps` of the depth buffer of it,
// plus what their slopes make of `pixels` (rounding of depths), which can have been counted on
// the wrong side of it.
struct MaskBound {
  std::string_view of;    // the methods that it is for
  double share = 0;       // of the picture's samples, may differ, those on an edge to a 256th of a
                          // pixel aside
  double near_edges = 0;  // if more: of the samples with an edge within `edge` pixels, may differ
  int edge = 1;           // pixels
  double steps = 0;       // of a depth buffer of 24 bits
  double pixels = 0;
  bool unexplained = false;      // differences without such a reason are allowed, within the share
  bool same_as_stencil = false;  // not one pixel may differ from the stencil's mask
  std::string_view why;
};

MaskBound bound_of(const Method& method);
// One of each kind.
std::vector<MaskBound> mask_bounds();

}  // namespace gnomon::gl
