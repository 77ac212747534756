// Where the near plane cuts a shadow volume: the cut of each caster's prism, to be drawn as a front
// face of the volume, so that z-pass counts rightly with the near plane inside volumes ("Shadow
// Volumes Revisited", Roettger, Irion, Ertl 2002, section 3.1; Everitt and Kilgard 2002, section
// 2.2.2, on why it is fragile).
//
// Cuts of prisms that share a side share the corners on it, bit for bit. So the cuts of a caster
// set add up to a figure whose border is the cut of its silhouette's sides, for any soup: nothing
// is left open or covered twice between neighbours, whatever was rounded. What this cannot give is
// that a GPU clips the sides themselves at the near plane in the same bits.
#pragma once

#include <array>

#include <gnomon/core/vec.h>

namespace gnomon {

// A plane with coordinates, as four linear functions (rows) of homogeneous points X: X is in the
// plane where h.X = 0, and there at (u.X / w.X, v.X / w.X). w.X > 0 for points of space in the
// plane.
struct CapPlane {
  Vec4 u, v, w, h;
  int orientation =
      0;  // exact sign of the determinant |u; v; w; h|; 0: not a plane with coordinates
};

// The plane through `origin` along two axes that are not parallel; the point origin + s u_axis + t
// v_axis has the coordinates (s, t). The near rectangle, if origin is its middle and the axes lead
// to the middles of its sides, is [-1,1] x [-1,1].
CapPlane cap_plane(const Vec3& origin, const Vec3& u_axis, const Vec3& v_axis);

// The same of a projection: rows x, y and w of its matrix, and h = w + z (the near plane of
// OpenGL's clip space). Coordinates are then those of normalised devices.
CapPlane cap_plane(const Vec4& u, const Vec4& v, const Vec4& w, const Vec4& h);

// A convex polygon in the plane's coordinates. A plane cuts a prism, a part of the simplex (A, B,
// C, -L), in three or four corners; each side of the square adds one at most.
struct NearCap {
  static constexpr int kMaxCorners = 4 + 4;
  std::array<Vec2, kMaxCorners> at;
  int size = 0;  // 0: the plane misses the prism within the square
};

// The part in [-1,1] x [-1,1] of the cut of the plane with the prism behind the triangle (a, b, c),
// of all points whose segment to the light crosses it. Corners run counterclockwise (from u to v)
// as the prism counts +1, whatever the triangle's winding; only a sliver whose corners were rounded
// past each other runs clockwise, and must then count -1: draw both faces. `side`: light_sides() of
// the triangle. Preconditions: snapped inputs, light.w >= 0. Points on the plane count as on its
// side h > 0. A light exactly at a vertex has no rays there; the cut is then empty or rubbish, but
// neighbours still fit.
NearCap near_cap(const Vec3& a, const Vec3& b, const Vec3& c, int side, const Light& light,
                 const CapPlane& plane);

}  // namespace gnomon
