// Exact decisions on the samples of a view. One predicate each; see core/exact.h for the tie rule
// and docs/exactness.md for the derivations.
//
// A flat polygon is given by three homogeneous corners: vertices of the scene, or minus the light
// (the far corner of a shadow volume's side). All signs are of determinants in scene coordinates.
#pragma once

#include <array>

#include <gnomon/core/exact.h>
#include <gnomon/view/view.h>

namespace gnomon {

struct Corner {
  Vec4 at;
  bool light = false;  // the corner is -L: `at` is ignored
};

using Corners = std::array<Corner, 3>;

inline Corners triangle_corners(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {Corner{point(a)}, Corner{point(b)}, Corner{point(c)}};
}
inline Corners side_corners(const Vec3& a, const Vec3& b) {
  return {Corner{point(a)}, Corner{point(b)}, Corner{Vec4(0.0), true}};
}

// Sign of |c0; c1; c2; e|: which side of the polygon the eye sees. 0 only if the corners are
// collinear.
int facing(const View& view, const Corners& c, const Light& light, ExactStats& stats);

// Sign of |q; e; p; r| for the pixel's point q: on which side of the line p r (as seen from the
// eye) the pixel's centre lies.
int edge_side(const View& view, int column, int row, const Corner& p, const Corner& r,
              const Light& light, ExactStats& stats);

// True if the ray meets the polygon `c` in front of the sample on the plane of the triangle `r`
// (three vertices). Facings are those of facing(). Precondition: the ray meets both. False where
// the planes coincide.
bool in_front(const View& view, int column, int row, const Corners& c, int facing_c,
              const Corners& r, int facing_r, const Light& light, ExactStats& stats);

// True if the polygon `c` lies in the plane of the triangle `r` (three vertices), exactly, before
// any tie rule. Then in_front() says the same for all pixels that both cover.
bool in_one_plane(const Corners& c, const Corners& r, const Light& light);

// True if the pixel's centre is inside the polygon as seen from the eye: all three edge sides agree
// with the facing.
bool covers(const View& view, int column, int row, const Corners& c, int facing_c,
            const Light& light, ExactStats& stats);

// True if a triangle (three vertices) crosses the segment from the eye to the light. Part of C(e),
// DEFINITIONS "The prism and the count".
bool between_eye_and_light(const View& view, const Corners& c, const Light& light,
                           ExactStats& stats);

// True if corners p and r lie on one line through the eye, on the same side of it: as seen from the
// eye the edge is a point. For vertices only. Then a side over this edge covers no pixel.
bool seen_end_on(const View& view, const Vec3& p, const Vec3& r);

// True if the triangle (three vertices) lies in a plane through the eye, exactly, before any tie
// rule. In a parallel view it then covers no pixel: its corners are collinear as seen from the eye,
// all on one side of infinity.
bool seen_edge_on(const View& view, const Vec3& a, const Vec3& b, const Vec3& c);

// True if a parallel view looks exactly the way that the light's rays run: what the eye sees first,
// the light meets first, and no side of a shadow volume is in front of any sample
// (docs/exactness.md).
bool looks_with_light(const View& view, const Light& light);

}  // namespace gnomon
