// The oracle's own decisions on a sample, straight from DEFINITIONS. Nothing here knows of
// silhouettes, sides or spans.
//
// Notation: r a receiving triangle, t = (A,B,C) a caster, e the eye, q the pixel's point, L the
// light; |a;b;c;d| = det4, |r;x| = |r0;r1;r2;x|; capital signs are +1 or -1.
//
// The sample. Every point of the pixel's ray is alpha e + beta q with beta > 0. It lies on r's
// plane if alpha |r;e| + beta |r;q| = 0, so
//   p = S (|r;e| q - |r;q| e),  S = sign |r;e|,
// where S makes the factor of q positive. Its weight is positive for samples in front of the eye:
// for a parallel view (e.w = 0, q.w = 1) it is S |r;e|, for a camera (e.w = 1, q.w = 0) it is -S
// |r;q|, positive exactly if alpha is.
//
// The crossing. The points between p and L are k p + l L, k, l > 0. One of them lies on t's plane
// if F = sign |t;p| and sign |t;L| differ; call it x = a A + b B + c C. Since p = (x - l L) / k,
//   |L;p;A;B| = |L;x;A;B| / k = c |L;C;A;B| / k = -c |t;L| / k,  so sign |L;p;A;B| = F sign c,
// and likewise for |L;p;B;C| with a, |L;p;C;A| with b. The weight of x is positive, so x is inside
// t exactly if all three equal F.
//
// Just in front. p' = p + (infinitesimal) e. It matters only where |t;p| vanishes identically, i.e.
// where t lies in r's plane; then sign |t;p'| = sign |t;e|.
//
// Ties. p is linear in e and in q, and each polynomial below is linear in p and in L, so
// core/exact.h's rule applies to them with e and q replaced in both factors of each product.
#pragma once

#include <array>
#include <optional>
#include <type_traits>

#include <gnomon/core/exact.h>
#include <gnomon/mesh/tri_mesh.h>
#include <gnomon/view/view.h>

namespace gnomon::oracle {

using Points = std::array<Vec3, 3>;

inline Points points_of(const TriMesh& mesh, std::uint32_t t) {
  const Triangle& v = mesh.triangles[t];
  return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
}

struct Pixel {
  int column, row;
};

template <class T>
H4<T> eye(const View& view, int order) {
  return lift<T>(order_of(view.eye, order));
}

// The pixel's point, exact in T; order 1 and 2: its step to the right and down.
template <class T>
H4<T> pixel(const View& view, const Pixel& at, int order) {
  if (order == 1) return lift<T>(view.right);
  if (order == 2) return lift<T>(view.down);
  const T i(at.column + 0.5), j(at.row + 0.5);
  const auto along = [&](int k) {
    return T(view.origin[k]) + i * T(view.right[k]) + j * T(view.down[k]);
  };
  return {along(0), along(1), along(2), T(view.origin.w)};
}

template <class T>
T plane(const Points& t, const H4<T>& x) {
  return det4<T>(lift<T>(t[0]), lift<T>(t[1]), lift<T>(t[2]), x);
}

// sign |t;e|, the side that the eye sees; of a triangle with area never 0.
inline int eye_side(const View& view, const Points& t, ExactStats& stats) {
  const auto polynomial = [&]<class T>(int e, int, int) { return plane<T>(t, eye<T>(view, e)); };
  return tie_sign({.eye = true, .light = false, .pixel = false}, stats, polynomial);
}

// sign |t;L|; of a triangle with area never 0.
inline int light_side_of(const Points& t, const Light& light, ExactStats& stats) {
  const auto polynomial = [&]<class T>(int, int l, int) {
    return plane<T>(t, lift<T>(order_of(light, l)));
  };
  return tie_sign({.eye = false, .light = true, .pixel = false}, stats, polynomial);
}

// The sample p / S of a pixel on the plane of r, for every order of infinitesimals. Exact
// coordinates are long to compute and asked for again by each caster, so they are kept. Not to be
// shared between threads.
class SamplePoint {
 public:
  SamplePoint(const View& view, const Pixel& at, const Points& r) : view_(view), at_(at), r_(r) {}

  const View& view() const { return view_; }
  const Points& r() const { return r_; }

  // |r;e| q - |r;q| e with e and q replaced by the coefficients of their infinitesimals.
  template <class T>
  H4<T> at(int e, int q) const {
    if constexpr (std::is_same_v<T, Dyadic>) {
      std::optional<H4<Dyadic>>& kept = kept_[static_cast<std::size_t>(3 * e + q)];
      if (!kept) kept = compute<Dyadic>(e, q);
      return *kept;
    } else {
      return compute<T>(e, q);
    }
  }

 private:
  template <class T>
  H4<T> compute(int e, int q) const {
    const H4<T> x = eye<T>(view_, e), y = pixel<T>(view_, at_, q);
    const T rx = plane<T>(r_, x), ry = plane<T>(r_, y);
    return {rx * y.x - ry * x.x, rx * y.y - ry * x.y, rx * y.z - ry * x.z, rx * y.w - ry * x.w};
  }

  const View& view_;
  Pixel at_;
  Points r_;
  mutable std::array<std::optional<H4<Dyadic>>, 12> kept_;  // 4 orders of e, 3 of q
};

// True if both triangles lie in one plane: |t;x| vanishes at three points of r's plane that are not
// on one line, so on all of it.
inline bool coplanar(const Points& r, const Points& t) {
  for (const Vec3& x : r) {
    if (x == t[0] || x == t[1] || x == t[2]) continue;
    if (plane<Approx>(t, lift<Approx>(x)).certain()) return false;
    if (plane<Dyadic>(t, lift<Dyadic>(x)).sign() != 0) return false;
  }
  return true;
}

// sign |t;p| S: the side of t's plane on which the sample lies, up to S; 0 exactly if t lies in r's
// plane.
inline int sample_side(const SamplePoint& sample, const Points& t, ExactStats& stats) {
  const auto polynomial = [&]<class T>(int e, int, int q) {
    return plane<T>(t, sample.at<T>(e, q));
  };
  const Approx approx = polynomial.template operator()<Approx>(0, 0, 0);
  if (approx.certain()) return approx.sign();
  if (coplanar(sample.r(), t)) {  // saves finding all twelve coefficients to be zero
    ++stats.exact;
    ++stats.ties;
    return 0;
  }
  return tie_sign({.eye = true, .light = false, .pixel = true}, stats, polynomial);
}

// sign |L;p;A;B| S: on which side of the line from the light to the sample the edge passes. Never 0
// for A != B.
inline int edge_side_of(const SamplePoint& sample, const Light& light, const Vec3& a, const Vec3& b,
                        ExactStats& stats) {
  const bool at_vertex =
      light == point(a) || light == point(b);  // two equal rows: zero unless the light moves
  const auto polynomial = [&]<class T>(int e, int l, int q) {
    if (l == 0 && at_vertex) return T(0.0);
    return det4<T>(lift<T>(order_of(light, l)), sample.at<T>(e, q), lift<T>(a), lift<T>(b));
  };
  return tie_sign({.eye = true, .light = true, .pixel = true}, stats, polynomial);
}

// sign |q;e;A;B|: on which side of the pixel's ray the edge passes. Never 0 for A != B. With x = a
// A + b B + c C the ray's point on t, |q;e;A;B| beta = |x;e;A;B| = c |t;e|: the ray meets t in
// front of the eye exactly if all three edges have the sign of |t;e|.
inline int ray_side(const View& view, const Pixel& at, const Vec3& a, const Vec3& b,
                    ExactStats& stats) {
  const auto polynomial = [&]<class T>(int e, int, int q) {
    return det4<T>(pixel<T>(view, at, q), eye<T>(view, e), lift<T>(a), lift<T>(b));
  };
  return tie_sign({.eye = true, .light = false, .pixel = true}, stats, polynomial);
}

// True if the segment from just in front of the sample to the light crosses t. `seen`: sign |r;e|;
// `lit`: sign |t;L|. The slow clear version: every sign by the predicates above, none left out.
inline bool crosses(const SamplePoint& sample, int seen, const Points& t, int lit,
                    const Light& light, ExactStats& stats) {
  int front = seen * sample_side(sample, t, stats);
  if (front == 0) front = eye_side(sample.view(), t, stats);
  if (lit == front) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    if (seen * edge_side_of(sample, light, t[k], t[(k + 1) % 3], stats) != front) return false;
  }
  return true;
}

// True if the segment from the eye to the light crosses t: the crossing above with e in place of p.
inline bool before_eye(const View& view, const Points& t, const Light& light, ExactStats& stats) {
  const int front = eye_side(view, t, stats);
  if (light_side_of(t, light, stats) == front) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = t[k], &b = t[(k + 1) % 3];
    const auto polynomial = [&]<class T>(int e, int l, int) {
      return det4<T>(lift<T>(order_of(light, l)), eye<T>(view, e), lift<T>(a), lift<T>(b));
    };
    if (tie_sign({.eye = true, .light = true, .pixel = false}, stats, polynomial) != front)
      return false;
  }
  return true;
}

}  // namespace gnomon::oracle
