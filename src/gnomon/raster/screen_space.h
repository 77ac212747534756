// Scene points in the basis of a view, in floating point with known error bounds.
//
// Notation: P = x right + y down + w origin + z eye (the view's four vectors, view.h). In this
// basis the eye is (0,0,0,1) and the pixel point at (x,y) pixels is (x,y,1,0), so that a
// determinant with e, or with q and e, is one of (x,y,w) alone. Any determinant in scene
// coordinates is `orientation` times a positive number times the one in this basis. Nearness of a
// point is z / w.
#pragma once

#include <span>
#include <vector>

#include <gnomon/core/approx.h>
#include <gnomon/core/vec.h>
#include <gnomon/view/view.h>

namespace gnomon {

template <class T>
struct ScreenPoint {
  T x, y, w, z;
};

struct ScreenSpace {
  Approx rows[4][4];    // x, y, w, z as linear functions of the scene's (x,y,z,w)
  int orientation = 1;  // sign of |right; down; origin; eye|
  int width = 0, height = 0;
};

// Precondition: the view's four vectors are linearly independent.
ScreenSpace screen_space(const View& view);

ScreenPoint<double> project(const ScreenSpace& s, const Vec4& p);

// Bounds on the result and error of project() for all points with components up to `largest` in
// magnitude.
ScreenPoint<Bound> project_bound(const ScreenSpace& s, const Vec4& largest);

struct ScreenPoints {
  std::vector<ScreenPoint<double>> points;
  ScreenPoint<Bound> bound;
};
ScreenPoints project_all(const ScreenSpace& s, std::span<const Vec3> positions, int threads);

}  // namespace gnomon
