// A triangle of homogeneous corners, ready to be drawn tile by tile: a side of a shadow volume as a
// camera or a lamp needs it, or a caster. Four linear functions of the pixel; the bounds of what
// floating point knows of them. Based on: Olano, Greer, Triangle scan conversion using 2D
// homogeneous coordinates, 1997 (no clipping, corners at infinity allowed).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include <gnomon/mesh/tri_mesh.h>
#include <gnomon/raster/polygon.h>
#include <gnomon/raster/screen_space.h>
#include <gnomon/silhouette/silhouette.h>

namespace gnomon {

// What a side's linear functions a x + b y + c say, by index; the last two are 0 and fill vectors.
// kEdge and the two after it: the edge functions, positive inside, in about a pixel's unit (|a| +
// |b| = 1 unless the edge is far from all pixels). kNearness: of the side's plane; NaN where
// nothing is known of it. kUpper and kLower: bounds of nearness inside the side, which vary less
// than it does: nearness and a multiple of the edge function across which it varies most, so that a
// side seen nearly edge-on is known well in large squares too.
enum SideFunction { kEdge = 0, kNearness = 3, kUpper = 4, kLower = 5, kSideFunctions = 8 };

struct alignas(64) Side {
  double a[kSideFunctions], b[kSideFunctions], c[kSideFunctions];
  // How far the computed functions are off anywhere in the picture, without rounding to float;
  // those of nearness by `relative` of their value more, and compared with a sample's.
  float slack[kSideFunctions];
  float relative;
  std::int32_t add;    // what a sample behind it adds to its count
  std::uint32_t id;    // the silhouette edge's index, or the triangle's
  std::int8_t facing;  // exact sign of |c0; c1; c2; e|, scene coordinates
  bool caster;
};
static_assert(sizeof(Side) == 256);

// What sides of one kind share.
struct SideSetup {
  const ScreenSpace* space = nullptr;
  const ScreenPoint<double>* points = nullptr;  // of the vertices
  EquationErrors errors;                        // of the sides' equations
  double least_nearness = 0;  // of all samples: what lies behind it everywhere is left out
  double nearness_floor = 0;  // of the samples
  // The exact facing of what floating point cannot tell, by id; 0: in front of no sample, left out.
  std::function<int(std::uint32_t)> facing;
};

// Makes the sides over edges [begin, end): corners a, b and minus_light. Leaves out those that no
// sample of the picture can lie behind. Returns how many were made; out holds end - begin. In the
// edges' order.
std::size_t make_sides(const SideSetup& setup, const SilhouetteEdge* edges, std::size_t begin,
                       std::size_t end, const ScreenPoint<double>& minus_light, Side* out);

// The same of the triangles ids[0 .. n); add: light_sides[id] times facing.
std::size_t make_caster_sides(const SideSetup& setup, const Triangle* triangles,
                              const std::uint32_t* ids, std::size_t n,
                              const std::int8_t* light_sides, Side* out);

}  // namespace gnomon
