// The near clip volume: all points between the near rectangle of a view and the light. Only casters
// that reach into it can cast a shadow onto the near rectangle; volumes of all others may be
// counted with z-pass and no caps. "Geometry of shadows in real time", section 5 (figure 3);
// Everitt and Kilgard 2002, section 3.4.
//
// The answer "no" is a proof: it is given only if a plane strictly separates the box or points from
// the volume, its rounding errors included, so that no movement by the infinitesimals of the tie
// rule (core/exact.h) changes it. "May" can be said too often, but for boxes the planes tried are
// all that ever separate a box from this volume, so only rounding makes it so.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <gnomon/core/vec.h>
#include <gnomon/mesh/tri_mesh.h>

namespace gnomon {

// The computed dot product n.p of two triples differs from the exact one by less than
// kDotSlack * (|n.x p.x| + |n.y p.y| + |n.z p.z|), that sum computed in double as well: each term
// goes through at most three roundings of 2^-53, and the fourth pays for the sum of magnitudes.
inline constexpr double kDotSlack = 0x1p-51;

struct NearClip {
  // The volume lies where normal . x <= most (exactly, for these numbers as stored).
  struct HalfSpace {
    Vec3 normal;
    double most;
  };
  // Both sides of the near plane, the planes through the light and a side of the rectangle, and the
  // planes along an edge of the volume and an axis, both ways (2 + 4 + 2 * 18).
  static constexpr int kMaxHalfSpaces = 42;
  std::array<HalfSpace, kMaxHalfSpaces> half_spaces;
  int size = 0;           // half spaces in use; those that would not hold for certain are left out
  Vec3 lo{0.0}, hi{0.0};  // bounds of the volume; infinite where a directional light's prism is
  // As given; for planes that come with the casters.
  std::array<Vec3, 4> near_rectangle;
  Light light;
};

// `near_rectangle`: its corners in order around it (either way), scene coordinates. They are taken
// as exact: a caller whose picture is made from rounded numbers (a float matrix) passes a rectangle
// that is larger by that rounding. Light: w > 0 a point (x/w, y/w, z/w), w = 0 the direction
// towards it; a light in the near plane is allowed, the volume is then flat. Precondition:
// coordinates and light snapped (core/exact.h), light not zero.
NearClip near_clip_volume(const std::array<Vec3, 4>& near_rectangle, const Light& light);

// False: no caster within the box lo..hi meets a segment from the near rectangle to the light.
bool may_shade_near(const NearClip& near, const Vec3& lo, const Vec3& hi);

// False: no caster within the convex hull of the points does. Tries the box of the points, then
// each half space on the points themselves: planes of the hull of the points are not tried, so this
// says "may" somewhat more often than it must. No points: false.
bool may_shade_near(const NearClip& near, std::span<const Vec3> points);

// The same for the convex hull of some triangles of a mesh.
bool may_shade_near(const NearClip& near, const TriMesh& mesh,
                    std::span<const std::uint32_t> triangles);

// False: none of these triangles of a mesh does. Tighter than their hull (a terrain's holds every
// street), as tight as rounding allows, and linear in the triangles; most are ruled out by their
// box.
bool may_any_shade_near(const NearClip& near, const TriMesh& mesh,
                        std::span<const std::uint32_t> triangles);

}  // namespace gnomon
