// Rectangles of the picture outside which nothing that is drawn matters (scissor).
#pragma once

#include <optional>
#include <span>

#include <gnomon/core/place.h>
#include <gnomon/gl/camera.h>
#include <gnomon/gl/pass.h>

namespace gnomon::gl {

// A box in the scene's coordinates. One that holds nothing: lo > hi.
struct SceneBox {
  Vec3 lo{0, 0, 0}, hi{0, 0, 0};
};
std::array<Vec3, 8> corners_of(const SceneBox& box);

// Pixels that see a point of the convex hull of at most kMostPoints `points` (scene coordinates; w
// = 0: at infinity), and one more on each side; {0, 0, 0, 0}: none does.
inline constexpr int kMostPoints = 16;
Rect rectangle_round(const Camera& camera, std::span<const Vec4> points);
Rect rectangle_round(const Camera& camera, const SceneBox& box);

// Pixels that see a point of `receivers` in the shadow of `caster`, likewise. Nothing: the light is
// in the caster's box, and no bound is known.
//
// Proof: a point X = L + u (C - L), u >= 1, C in the caster's box, is outside of the receivers' box
// once u |C - L| is more than the farthest of its corners is from L, so for all u > s = that over
// the least |C - L|. For u in [1, s], X is in the convex hull of the box's corners and of their
// images at u = s. A directional light: X = C + u d, d of length 1, s the diagonal of the box round
// both.
std::optional<Rect> shadow_rectangle(const Camera& camera, const Light& light,
                                     const SceneBox& caster, const SceneBox& receivers);

// Pixels that see a point of the shadow of `caster`, however far away.
Rect endless_rectangle(const Camera& camera, const Light& light, const SceneBox& caster);

// What both cover.
Rect common(const Rect& a, const Rect& b);

// A rectangle of the camera's picture in one of another size, and two pixels more on each side,
// from which bilinear filtering reads.
Rect scaled(const Rect& rectangle, const Camera& camera, int width, int height);

}  // namespace gnomon::gl
