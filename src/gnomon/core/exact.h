// Exact signs of determinants of homogeneous points, with one tie rule. See DEFINITIONS
// (docs/exactness.md).
//
// Every geometric decision is the sign of a polynomial that is linear in each of the eye e, the
// pixel point q and the light L. It is evaluated in Approx first and, where that cannot decide, in
// Dyadic. If it is exactly zero, the inputs count as moved by infinitesimals in one fixed order:
// the pixel centre by (d, d^2) pixels, the light by (t, t^2, t^3) along x, y, z, the eye by (s,
// s^2, s^3) along x, y, z, with s << t << d. Because of the linearity, the coefficient of each
// infinitesimal is the same polynomial with e, q or L replaced by an axis vector; the first that is
// not zero decides.
#pragma once

#include <cmath>
#include <cstdint>

#include <gnomon/core/approx.h>
#include <gnomon/core/dyadic.h>
#include <gnomon/core/vec.h>

namespace gnomon {

// Coordinates that exact arithmetic takes: 0, or between these in magnitude. Storing code snaps
// smaller ones to 0 and refuses larger.
inline constexpr double kSmallestCoordinate = 0x1p-100;  // metres; far below an atom
inline constexpr double kLargestCoordinate = 1e12;       // metres; beyond Saturn

inline double snapped(double c) { return std::fabs(c) < kSmallestCoordinate ? 0.0 : c; }
inline Vec4 snapped(const Vec4& v) {
  return {snapped(v.x), snapped(v.y), snapped(v.z), snapped(v.w)};
}

// How often a filter was not enough, and how often the exact value was zero.
struct ExactStats {
  std::uint64_t exact = 0;  // decisions that needed exact arithmetic
  std::uint64_t ties = 0;   // of these, exactly zero before the tie rule
  ExactStats& operator+=(const ExactStats& o) {
    exact += o.exact;
    ties += o.ties;
    return *this;
  }
};

// A homogeneous point over the number type T.
template <class T>
struct H4 {
  T x, y, z, w;
};

template <class T>
H4<T> lift(const Vec4& v) {
  return {T(v.x), T(v.y), T(v.z), T(v.w)};
}
template <class T>
H4<T> lift(const Vec3& v) {
  return {T(v.x), T(v.y), T(v.z), T(1.0)};
}

// Row determinant |a; b; c; d|, by 2x2 minors of (a,b) and (c,d).
template <class T>
T det4(const H4<T>& a, const H4<T>& b, const H4<T>& c, const H4<T>& d) {
  const T s0 = a.x * b.y - a.y * b.x, s1 = a.x * b.z - a.z * b.x, s2 = a.x * b.w - a.w * b.x;
  const T s3 = a.y * b.z - a.z * b.y, s4 = a.y * b.w - a.w * b.y, s5 = a.z * b.w - a.w * b.z;
  const T c0 = c.x * d.y - c.y * d.x, c1 = c.x * d.z - c.z * d.x, c2 = c.x * d.w - c.w * d.x;
  const T c3 = c.y * d.z - c.z * d.y, c4 = c.y * d.w - c.w * d.y, c5 = c.z * d.w - c.w * d.z;
  return ((s0 * c5 - s1 * c4) + (s2 * c3 + s3 * c2)) - (s4 * c1 - s5 * c0);
}

// Which of the three inputs a polynomial depends on (and ties may move).
struct Depends {
  bool eye = false, light = false, pixel = false;
};

// Replaces eye or light by its k-th infinitesimal's coefficient: k = 0 the value itself, 1..3 the
// axes x, y, z.
inline Vec4 order_of(const Vec4& value, int k) {
  if (k == 0) return value;
  Vec4 axis(0, 0, 0, 0);
  axis[k - 1] = 1.0;
  return axis;
}

// Sign of a polynomial under the tie rule. f.operator()<T>(eye_order, light_order, pixel_order)
// returns its value in T with the inputs replaced as above (pixel_order 1: the step to the right,
// 2: the step down). Returns 0 only if it vanishes identically.
template <class F>
int tie_sign(const Depends& on, ExactStats& stats, const F& f) {
  for (int e = 0; e <= (on.eye ? 3 : 0); ++e) {
    for (int l = 0; l <= (on.light ? 3 : 0); ++l) {
      for (int p = 0; p <= (on.pixel ? 2 : 0); ++p) {
        const Approx approx = f.template operator()<Approx>(e, l, p);
        if (approx.certain()) return approx.sign();
        if (e + l + p == 0) ++stats.exact;
        const int s = f.template operator()<Dyadic>(e, l, p).sign();
        if (s != 0) return s;
        if (e + l + p == 0) ++stats.ties;
      }
    }
  }
  return 0;
}

// Sign of |a; b; c; light|: on which side of the plane through a, b, c the light is. Of a triangle
// without area -1: its prism is empty, so that any sign is right, as long as all ask for the same.
int light_side(const Vec3& a, const Vec3& b, const Vec3& c, const Light& light, ExactStats& stats);

// True if the triangle has no area (exactly).
bool zero_area(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace gnomon
