// A triangle of homogeneous corners, set up for rasterization: edges, plane of nearness, and what
// floating point can vouch for. Based on: Olano, Greer, Triangle scan conversion using 2D
// homogeneous coordinates, 1997 (no clipping, corners at infinity allowed).
//
// Notation: E(x,y) edge function, positive inside; N(x,y) / F nearness of the polygon's plane over
// pixel point (x,y).
#pragma once

#include <cstdint>
#include <limits>

#include <gnomon/raster/screen_space.h>
#include <gnomon/view/predicates.h>

namespace gnomon {

// a x + b y + c
template <class T>
struct Linear {
  T a, b, c;
};

// Line through p and r as seen from the eye.
template <class T>
Linear<T> line_through(const ScreenPoint<T>& p, const ScreenPoint<T>& r) {
  return {p.y * r.w - p.w * r.y, p.w * r.x - p.x * r.w, p.x * r.y - p.y * r.x};
}

template <class T>
struct PolygonEquations {
  Linear<T> edges[3];  // edge k from corner k to corner k+1
  Linear<T> n;
  T f;
};

template <class T>
PolygonEquations<T> polygon_equations(const ScreenPoint<T>& p0, const ScreenPoint<T>& p1,
                                      const ScreenPoint<T>& p2) {
  PolygonEquations<T> q;
  q.edges[0] = line_through(p0, p1);
  q.edges[1] = line_through(p1, p2);
  q.edges[2] = line_through(p2, p0);
  q.f = (p2.x * q.edges[0].a + p2.y * q.edges[0].b) + p2.w * q.edges[0].c;
  q.n.a = (p0.z * q.edges[1].a + p1.z * q.edges[2].a) + p2.z * q.edges[0].a;
  q.n.b = (p0.z * q.edges[1].b + p1.z * q.edges[2].b) + p2.z * q.edges[0].b;
  q.n.c = (p0.z * q.edges[1].c + p1.z * q.edges[2].c) + p2.z * q.edges[0].c;
  return q;
}

// Error bounds of polygon_equations() for all polygons whose corners obey the given bounds.
struct EquationErrors {
  Linear<double> edges[3];
  double n = 0;  // of N(x,y) anywhere in the picture
  double f = 0;
};
EquationErrors equation_errors(const ScreenPoint<Bound>& p0, const ScreenPoint<Bound>& p1,
                               const ScreenPoint<Bound>& p2, int width, int height);

// Where an edge crosses a row: at x0 + k y (y = row + 1/2), right within +-slack.
struct RowEdge {
  double x0 = 0, k = 0, slack = 0;
};
enum class EdgeKind : std::uint8_t {
  kLower,  // inside to the right of the crossing
  kUpper,  // inside to the left
  kFlat,   // no crossing: inside where x0 + k y > slack, outside where < -slack, undecided between
};

struct Polygon {
  RowEdge edges[3];
  EdgeKind kinds[3] = {EdgeKind::kFlat, EdgeKind::kFlat, EdgeKind::kFlat};
  std::int8_t facing = 0;  // exact sign of |c0; c1; c2; e|, scene coordinates
  // Nearness g.a x + g.b y + g.c; NaN where floating point knows nothing of it.
  Linear<double> g;
  double inverse_ga = 0;  // 1 / g.a where rows may be cut by nearness; 0 where not
  double least = -std::numeric_limits<double>::infinity();  // no sample under it is less near
  // |nearness - exact| <= error_absolute + error_relative |nearness|; rounded up to float.
  float error_absolute = 0;
  float error_relative = 0;
  std::int32_t add = 0;  // what a sample behind it adds to its count
  std::int32_t first_row = 0, end_row = 0;
  std::uint32_t id = 0;  // whose it is: index into the silhouette or the triangles
  bool caster = false;   // a triangle's, not a side's
};

// Fills edges, nearness and facing from the equations. `corners` are read only if the filter cannot
// tell the facing.
void set_up(Polygon& p, const PolygonEquations<double>& q, const EquationErrors& errors,
            const ScreenSpace& space, const View& view, const Corners& corners, const Light& light,
            ExactStats& stats);

// Replaces the polygon's nearness by one with a bound of its own, valid inside the polygon:
// computed in pixel coordinates around its first corner, where little cancels. For polygons whose
// nearness is kept (receivers). Vertices only; `errors`: of the points.
void refine_nearness(Polygon& p, const ScreenPoint<double> (&corners)[3],
                     const ScreenPoint<Bound>& errors, const ScreenSpace& space);

struct Span {
  int begin = 0, end = 0;  // pixels of a row: [begin, end)
};

// Rows of the picture that the polygon may touch where its nearness exceeds `least`; clips the
// picture by its edges in floating point, one row wider than found. Sets first_row, end_row (empty:
// first_row >= end_row) and least. Returns the columns, as wide.
Span set_rows(Polygon& p, const PolygonEquations<double>& q, const EquationErrors& errors,
              const ScreenSpace& space, double least);

// The pixels of a row that the polygon may cover, by floating point; `undecided`: exact_span() has
// to be asked.
Span widest_span(const Polygon& p, int row, int width, bool& undecided);

// What exact decisions on a polygon need.
struct ExactPolygon {
  const View& view;
  Corners corners;
  int facing;
  Light light;
};

// The exact pixels of a row that the polygon covers.
Span exact_span(const Polygon& p, const ExactPolygon& exact, int row, ExactStats& stats);

// Pixel i is to the right of a crossing x if i + 1/2 > x, i.e. i >= floor(x + 1/2) (unless tied,
// which slack sees).
inline constexpr double kPixelCentre = 0.5;

}  // namespace gnomon
