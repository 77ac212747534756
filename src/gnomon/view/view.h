// A view: the eye and the grid of pixel rays. See docs/conventions.md and docs/exactness.md.
//
// Notation: e the eye, q the pixel's point, both homogeneous. The ray of pixel (column i, row j),
// row 0 at the top, is
//   q = origin + (i + 1/2) right + (j + 1/2) down,   ray = { alpha e + beta q : alpha, beta >= 0 }.
// A parallel view has e.w = 0 (direction *towards* the eye) and origin.w = 1 (a plane of points); a
// camera has e.w = 1 and origin.w = 0 (a fan of directions). right.w = down.w = 0 always. Nearness
// of a point p = alpha e + beta q on the ray is alpha / beta: for a parallel view the signed
// distance above the plane of pixel points in units of |e|, for a camera the reciprocal of the
// distance in units of |q|. Larger is nearer.
#pragma once

#include <gnomon/core/vec.h>

namespace gnomon {

struct View {
  Vec4 eye;
  Vec4 origin;     // upper left corner of the upper left pixel
  Vec4 right;      // one pixel to the right
  Vec4 down;       // one pixel down
  int width = 0;   // pixels
  int height = 0;  // pixels
};

// Horizontal rectangle in scene coordinates, metres.
struct Bounds2 {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

// Seen from straight above, north (+y) up: width = ceil((x1-x0)/pixel) and so on; the upper left
// corner is (x0, y1). Heights are measured from `z` (nearness = z coordinate - z), any value near
// the scene's heights.
View plan_view(const Bounds2& bounds, double pixel, double z);

// Camera at `eye` looking at `target`, `up` roughly up; vertical field of view in radians.
// Precondition: eye != target, 0 < vertical_fov < pi, `up` not along the view.
View perspective_view(const Vec3& eye, const Vec3& target, const Vec3& up, double vertical_fov,
                      int width, int height);

// Parallel camera: looks from `eye` to `target`; the picture is `height_m` metres high at the
// target.
View orthographic_view(const Vec3& eye, const Vec3& target, const Vec3& up, double height_m,
                       int width, int height);

inline bool is_parallel(const View& v) { return v.eye.w == 0.0; }

// The pixel's point q in floating point (rounded); exact code uses the definition above.
inline Vec4 pixel_point(const View& v, int column, int row) {
  return v.origin + (column + 0.5) * v.right + (row + 0.5) * v.down;
}

}  // namespace gnomon
