// A View as OpenGL sees it: one matrix from scene coordinates to clip space whose pixels are the
// View's, and what the choice between z-pass and z-fail needs of it.
// Based on: Everitt and Kilgard 2002, sections 3.2.1 (far plane at infinity) and 4.2.
#pragma once

#include <array>
#include <limits>
#include <optional>

#include <glm/mat4x4.hpp>

#include <gnomon/core/result.h>
#include <gnomon/core/vec.h>
#include <gnomon/scene/scene.h>
#include <gnomon/view/view.h>

namespace gnomon::gl {

struct Camera {
  glm::dmat4 clip{1.0};  // scene coordinates, homogeneous, to clip space; x right, y up, z away
  Vec4 eye;              // homogeneous; w = 0: direction towards the eye of a parallel view
  std::array<Vec3, 4> near_rectangle{};  // lower left, lower right, upper
                                         // right, upper left; a pixel beyond the picture
  bool infinite = false;      // the far plane is at infinity; otherwise volumes need depth clamp
  int width = 0, height = 0;  // pixels
  // To be looked at: nothing outside the frustum of another camera, whose matrix this is, is drawn.
  std::optional<glm::dmat4> keep_inside{};
};

// Distances along the view axis, metres. Of a parallel view: coordinates along the direction of
// view, from the plane of the view's pixel points (may be negative).
struct DepthRange {
  double near_plane = 0.1;
  double far_plane = std::numeric_limits<double>::infinity();
};

// Preconditions: a camera has 0 < near_plane < far_plane; a parallel view has a finite far_plane.
Camera camera_of(const View& view, const DepthRange& range);

// From an engine's own matrix (row 4 of a perspective one must not be that of a parallel one),
// scene coordinates to clip space, depth -1..1. Errors: the matrix is singular; a perspective
// one has reversed depths.
Result<Camera> camera_of(const glm::dmat4& clip, int width, int height);

// A look into the clip space of another camera, as in Everitt and Kilgard's Figures 2, 3 and 5:
// surfaces stand where its matrix puts them, x to the right, y up, z (depth -1..1) away from it,
// and `view` looks at them in these coordinates (x, y, -z: right-handed). What is outside its
// frustum is left out. Shadows are right where the picture is seen from in front of the far plane
// (z < 1) and counted from the near plane: Count::near_cap, Reach::infinite.
Camera clip_space_camera(const Camera& first, const View& view, const DepthRange& range);

// The largest near plane and the smallest far plane that cut nothing of the scene's receivers that
// the view can see, with a margin of kRangeMargin of the distance for rounding to float.
// `infinite`: leaves the far plane at infinity (not for a parallel view).
DepthRange depth_range(const Scene& scene, const View& view, bool infinite);
inline constexpr double kRangeMargin = 1.0 / 64;

}  // namespace gnomon::gl
