#include <gnomon/volume/near_cap.h>

#include <algorithm>
#include <cassert>

#include <gnomon/core/exact.h>

// A corner is made from the two ends of one edge of the simplex, or of one segment of the cut, by a
// formula in which each end has a role that it has by itself: positive or negative side, inside or
// outside. So it is the same bits in whatever order, and for whichever neighbour, the edge is met.

namespace gnomon {
namespace {

double dot(const Vec4& f, const Vec4& x) {
  return (f.x * x.x + f.y * x.y) + (f.z * x.z + f.w * x.w);
}

// A point of the plane, (u, v) homogeneous.
struct PlanePoint {
  double u, v, w;
};

// Distances (up to scale) from the sides of the square, inwards.
double inside_by(const PlanePoint& p, int square_side) {
  switch (square_side) {
    case 0:
      return p.w + p.u;
    case 1:
      return p.w - p.u;
    case 2:
      return p.w + p.v;
    default:
      return p.w - p.v;
  }
}

// Where the segment leaves the square: f_in >= 0 > f_out. Put exactly on that side of it, where
// clipping by the others keeps it, as all interpolate u (or v) and w alike.
PlanePoint between(const PlanePoint& in, double f_in, const PlanePoint& out, double f_out,
                   int square_side) {
  const double t = f_in / (f_in - f_out);
  PlanePoint p = {in.u + t * (out.u - in.u), in.v + t * (out.v - in.v), in.w + t * (out.w - in.w)};
  (square_side < 2 ? p.u : p.v) = square_side % 2 == 0 ? -p.w : p.w;
  return p;
}

struct Cut {
  std::array<PlanePoint, NearCap::kMaxCorners> at;
  int size = 0;
  void put(const PlanePoint& p) { at[static_cast<std::size_t>(size++)] = p; }
};

Cut clipped(const Cut& cut, int square_side) {
  Cut kept;
  for (int k = 0; k < cut.size; ++k) {
    const PlanePoint &p = cut.at[static_cast<std::size_t>(k)],
                     &q = cut.at[static_cast<std::size_t>(k + 1 == cut.size ? 0 : k + 1)];
    const double fp = inside_by(p, square_side), fq = inside_by(q, square_side);
    if (fp >= 0) kept.put(p);
    if ((fp >= 0) != (fq >= 0)) {
      kept.put(fp >= 0 ? between(p, fp, q, fq, square_side) : between(q, fq, p, fp, square_side));
    }
  }
  return kept;
}

}  // namespace

CapPlane cap_plane(const Vec4& u, const Vec4& v, const Vec4& w, const Vec4& h) {
  ExactStats ignored;
  const int orientation = tie_sign({}, ignored, [&]<class T>(int, int, int) {
    return det4<T>(lift<T>(u), lift<T>(v), lift<T>(w), lift<T>(h));
  });
  return {u, v, w, h, orientation};
}

CapPlane cap_plane(const Vec3& origin, const Vec3& u_axis, const Vec3& v_axis) {
  const auto dot3 = [](const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
  // The vectors in the plane that give 1 along one axis and 0 along the other.
  const double uu = dot3(u_axis, u_axis), uv = dot3(u_axis, v_axis), vv = dot3(v_axis, v_axis);
  const double area2 = uu * vv - uv * uv;
  const Vec3 to_u = (u_axis * vv - v_axis * uv) / area2, to_v = (v_axis * uu - u_axis * uv) / area2;
  const Vec3 n(u_axis.y * v_axis.z - u_axis.z * v_axis.y, u_axis.z * v_axis.x - u_axis.x * v_axis.z,
               u_axis.x * v_axis.y - u_axis.y * v_axis.x);
  return cap_plane(Vec4(to_u, -dot3(to_u, origin)), Vec4(to_v, -dot3(to_v, origin)),
                   Vec4(0, 0, 0, 1), Vec4(n, -dot3(n, origin)));
}

NearCap near_cap(const Vec3& a, const Vec3& b, const Vec3& c, int side, const Light& light,
                 const CapPlane& plane) {
  assert(side == 1 || side == -1);
  const Vec4 corners[4] = {point(a), point(b), point(c), -light};
  // Corners on the positive side first, each side in order; the permutation's sign.
  int order[4], positive = 0, filled = 0;
  double h[4];
  for (int k = 0; k < 4; ++k) {
    h[k] = dot(plane.h, corners[k]);
    if (h[k] >= 0) order[filled++] = k, ++positive;
  }
  NearCap cap;
  if (positive == 0 || positive == 4) return cap;
  for (int k = 0; k < 4; ++k) {
    if (!(h[k] >= 0)) order[filled++] = k;
  }
  int permutation = 1;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) permutation = order[i] > order[j] ? -permutation : permutation;
  }

  PlanePoint seen[4];
  for (int k = 0; k < 4; ++k) {
    seen[k] = {dot(plane.u, corners[k]), dot(plane.v, corners[k]), dot(plane.w, corners[k])};
  }
  // The point of the edge from order[p] (positive) to order[q] (negative) in the plane: both
  // weights are >= 0, so it is a point of the simplex itself, not of its opposite.
  const auto crossing = [&](int p, int q) -> PlanePoint {
    const PlanePoint &x = seen[order[p]], &y = seen[order[q]];
    const double hx = h[order[p]], hy = h[order[q]];
    return {hx * y.u - hy * x.u, hx * y.v - hy * x.v, hx * y.w - hy * x.w};
  };
  Cut cut;
  if (positive == 1) {
    for (const int q : {1, 2, 3}) cut.put(crossing(0, q));
  } else if (positive == 3) {
    for (const int p : {0, 1, 2}) cut.put(crossing(p, 3));
  } else {
    cut.put(crossing(0, 2));
    cut.put(crossing(0, 3));
    cut.put(crossing(1, 3));
    cut.put(crossing(1, 2));
  }
  // In each of these orders the first three corners have a determinant (u, v, w) of the sign
  // orientation * permutation * side (docs/volumes.md).
  if (plane.orientation * permutation * side < 0) {
    std::reverse(cut.at.begin(), cut.at.begin() + cut.size);
  }
  for (int k = 0; k < 4 && cut.size > 0; ++k) cut = clipped(cut, k);
  for (int k = 0; k < cut.size; ++k) {
    // Within the square w >= |u|, |v|, but for rounding; where w is 0, so are they.
    const PlanePoint& p = cut.at[static_cast<std::size_t>(k)];
    const Vec2 at = p.w > 0 ? Vec2(p.u / p.w, p.v / p.w) : Vec2(0.0);
    cap.at[static_cast<std::size_t>(k)] = {std::clamp(at.x, -1.0, 1.0),
                                           std::clamp(at.y, -1.0, 1.0)};
  }
  cap.size = cut.size;
  return cap;
}

}  // namespace gnomon
