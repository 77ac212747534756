// What the scenes of buildings are put together from: closed bodies, wound outwards, and open
// sheets. See second_paper_scenes.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gnomon/scene/scene.h>

namespace gnomon::scenes {

// Metres, z up. Coordinates are rounded to whole multiples of 2^-10 m, which floats hold exactly.
// Bodies share no vertices with each other: what touches overlaps or keeps a distance.
class BodyBuilder {
 public:
  // What is added from here on belongs to this surface, a new one or one of these names. The colour
  // (sRGB, 0 to 1) is the material's; the first one stays.
  void begin(const std::string& object, const std::string& material, const Vec3& colour,
             bool casts = true);

  // Open: one triangle, two triangles. Corners counterclockwise as seen from the front.
  void plate(const Vec3& a, const Vec3& b, const Vec3& c);
  void sheet(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
  // A level grid of across * deep cells, two triangles each.
  void grid(const Vec3& corner, double cell_x, double cell_y, int across, int deep);

  // Closed; the faces, indices into points, are wound alike, and are turned if that is inwards.
  void body(const std::vector<Vec3>& points, std::vector<Triangle> faces);
  // From ring to ring, which have n points each, and a cap at either end: 2 n (rings - 1) + 2 (n -
  // 2) triangles. The ends are convex and plane and have no three points in a line.
  void loft(const std::vector<std::vector<Vec3>>& rings);
  // Over an outline that may be concave, as seen along `axis` (0 x, 1 y, 2 z) a simple polygon.
  void concave_prism(const std::vector<Vec3>& outline, const Vec3& along, int axis);
  // The last ring leads to the first one: 2 n rings triangles.
  void closed_loft(const std::vector<std::vector<Vec3>>& rings);

  // 12 triangles each. `beam`: `side` is across it, and `width` along `side`.
  void box(const Vec3& lo, const Vec3& hi);
  void parallelepiped(const Vec3& at, const Vec3& u, const Vec3& v, const Vec3& w);
  void beam(const Vec3& a, const Vec3& b, double width, double depth, const Vec3& side);
  // Of `sides` sides: 4 sides - 4 triangles. With three sides a light lattice bar.
  void bar(const Vec3& a, const Vec3& b, double radius, int sides);
  // An L profile, legs `width` wide and a fifth of that thick: 20 triangles.
  void angle_profile(const Vec3& a, const Vec3& b, double width, const Vec3& side);
  // Turned about the vertical through `at`. The outline, (radius, height), begins and ends on the
  // axis, or nowhere touches it and is closed.
  void turned(const Vec3& at, const std::vector<Vec2>& outline, int around);

  std::size_t triangles() const { return scene_.mesh.triangles.size(); }
  std::size_t casting() const;
  // Those of the object.
  std::size_t triangles_of(const std::string& object) const;
  // Welded, at the place, degrees. Precondition: no triangle has zero area.
  Scene finished(double latitude, double longitude);

 private:
  std::uint32_t vertex(const Vec3& p);
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  Scene scene_;
  std::uint32_t surface_ = 0;
  std::vector<std::uint32_t> material_of_;  // per surface
};

// Points of a circle in the plane of u and v, from u towards v.
std::vector<Vec3> circle(const Vec3& middle, const Vec3& u, const Vec3& v, int n);

}  // namespace gnomon::scenes
