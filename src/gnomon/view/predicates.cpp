#include <gnomon/view/predicates.h>

namespace gnomon {
namespace {

template <class T>
H4<T> eye_of(const View& v, int order) {
  return lift<T>(order_of(v.eye, order));
}

// The pixel's point q, or the coefficient of its infinitesimal step. Exact in T: nothing is rounded
// before.
template <class T>
H4<T> pixel_of(const View& v, int column, int row, int order) {
  if (order == 1) return lift<T>(v.right);
  if (order == 2) return lift<T>(v.down);
  const T x(column + 0.5), y(row + 0.5);
  const H4<T> o = lift<T>(v.origin), r = lift<T>(v.right), d = lift<T>(v.down);
  return {o.x + x * r.x + y * d.x, o.y + x * r.y + y * d.y, o.z + x * r.z + y * d.z, o.w};
}

template <class T>
H4<T> corner_of(const Corner& c, const Light& light, int order) {
  return lift<T>(c.light ? -order_of(light, order) : c.at);
}

bool has_light(const Corners& c) { return c[0].light || c[1].light || c[2].light; }

struct Facing {
  const View& view;
  const Corners& c;
  const Light& light;
  template <class T>
  T operator()(int e, int l, int) const {
    return det4<T>(corner_of<T>(c[0], light, l), corner_of<T>(c[1], light, l),
                   corner_of<T>(c[2], light, l), eye_of<T>(view, e));
  }
};

struct EdgeSide {
  const View& view;
  int column, row;
  const Corner &p, &r;
  const Light& light;
  template <class T>
  T operator()(int e, int l, int q) const {
    return det4<T>(pixel_of<T>(view, column, row, q), eye_of<T>(view, e), corner_of<T>(p, light, l),
                   corner_of<T>(r, light, l));
  }
};

// |r; e| |c; q| - |r; q| |c; e|
struct DepthOrder {
  const View& view;
  int column, row;
  const Corners &c, &r;
  const Light& light;
  template <class T>
  T operator()(int e, int l, int q) const {
    const H4<T> c0 = corner_of<T>(c[0], light, l), c1 = corner_of<T>(c[1], light, l),
                c2 = corner_of<T>(c[2], light, l);
    const H4<T> r0 = lift<T>(r[0].at), r1 = lift<T>(r[1].at), r2 = lift<T>(r[2].at);
    const H4<T> eye = eye_of<T>(view, e), pix = pixel_of<T>(view, column, row, q);
    return det4<T>(r0, r1, r2, eye) * det4<T>(c0, c1, c2, pix) -
           det4<T>(r0, r1, r2, pix) * det4<T>(c0, c1, c2, eye);
  }
};

struct LightEdgeSide {  // |L; e; p; r|
  const View& view;
  const Corner &p, &r;
  const Light& light;
  template <class T>
  T operator()(int e, int l, int) const {
    return det4<T>(lift<T>(order_of(light, l)), eye_of<T>(view, e), lift<T>(p.at), lift<T>(r.at));
  }
};

struct LightSide {  // |c0; c1; c2; L|
  const Corners& c;
  const Light& light;
  template <class T>
  T operator()(int, int l, int) const {
    return det4<T>(lift<T>(c[0].at), lift<T>(c[1].at), lift<T>(c[2].at),
                   lift<T>(order_of(light, l)));
  }
};

}  // namespace

int facing(const View& view, const Corners& c, const Light& light, ExactStats& stats) {
  return tie_sign({.eye = true, .light = has_light(c), .pixel = false}, stats,
                  Facing{view, c, light});
}

int edge_side(const View& view, int column, int row, const Corner& p, const Corner& r,
              const Light& light, ExactStats& stats) {
  return tie_sign({.eye = true, .light = p.light || r.light, .pixel = true}, stats,
                  EdgeSide{view, column, row, p, r, light});
}

bool in_front(const View& view, int column, int row, const Corners& c, int facing_c,
              const Corners& r, int facing_r, const Light& light, ExactStats& stats) {
  const int s = tie_sign({.eye = true, .light = has_light(c), .pixel = true}, stats,
                         DepthOrder{view, column, row, c, r, light});
  return s * facing_c * facing_r < 0;
}

bool in_one_plane(const Corners& c, const Corners& r, const Light& light) {
  const auto in_plane = [&]<class T>(const Corner& corner, T) {
    return det4<T>(lift<T>(r[0].at), lift<T>(r[1].at), lift<T>(r[2].at),
                   corner_of<T>(corner, light, 0));
  };
  for (const Corner& corner : c) {
    if (in_plane(corner, Approx(0.0)).certain()) return false;
    if (in_plane(corner, Dyadic()).sign() != 0) return false;
  }
  return true;
}

bool covers(const View& view, int column, int row, const Corners& c, int facing_c,
            const Light& light, ExactStats& stats) {
  for (int k = 0; k < 3; ++k) {
    if (edge_side(view, column, row, c[k], c[(k + 1) % 3], light, stats) != facing_c) return false;
  }
  return true;
}

bool between_eye_and_light(const View& view, const Corners& c, const Light& light,
                           ExactStats& stats) {
  const int eye = facing(view, c, light, stats);
  if (tie_sign({.eye = false, .light = true, .pixel = false}, stats, LightSide{c, light}) == eye)
    return false;
  for (int k = 0; k < 3; ++k) {
    const int side = tie_sign({.eye = true, .light = true, .pixel = false}, stats,
                              LightEdgeSide{view, c[k], c[(k + 1) % 3], light});
    if (side != eye) return false;
  }
  return true;
}

bool seen_edge_on(const View& view, const Vec3& a, const Vec3& b, const Vec3& c) {
  if (is_parallel(view) &&
      (seen_end_on(view, a, b) || seen_end_on(view, b, c) || seen_end_on(view, c, a)))
    return true;
  const Corners corners = triangle_corners(a, b, c);
  const Facing f{view, corners, Light(0.0)};
  return !f.operator()<Approx>(0, 0, 0).certain() && f.operator()<Dyadic>(0, 0, 0).sign() == 0;
}

bool looks_with_light(const View& view, const Light& light) {
  if (!is_parallel(view) || light.w != 0) return false;
  using D = Dyadic;
  const Vec3 e(view.eye), l(light);
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    if ((D(e[i]) * D(l[j]) - D(e[j]) * D(l[i])).sign() != 0) return false;
  }
  return (D(e.x) * D(l.x) + D(e.y) * D(l.y) + D(e.z) * D(l.z)).sign() > 0;
}

bool seen_end_on(const View& view, const Vec3& p, const Vec3& r) {
  // Seen from above every vertical wall edge is one: no arithmetic needed.
  if (is_parallel(view) && view.eye.x == 0 && view.eye.y == 0) return p.x == r.x && p.y == r.y;
  // Collinear with the eye: p, r and e span a plane with no point of the view outside it; exactly
  // when the three components of (p - e w) x (r - e w) vanish. For a parallel view: (r - p) x e.
  using D = Dyadic;
  const auto cross_is_zero = [](const D(&u)[3], const D(&v)[3]) {
    return (u[1] * v[2] - u[2] * v[1]).sign() == 0 && (u[2] * v[0] - u[0] * v[2]).sign() == 0 &&
           (u[0] * v[1] - u[1] * v[0]).sign() == 0;
  };
  const auto minus = [](const Vec3& a, const Vec3& b, D(&out)[3]) {
    for (int k = 0; k < 3; ++k) out[k] = D(a[k]) - D(b[k]);
  };
  const Vec3 e(view.eye);
  D u[3], v[3];
  if (is_parallel(view)) {
    minus(r, p, u);
    for (int k = 0; k < 3; ++k) v[k] = D(e[k]);
    return cross_is_zero(u, v);
  }
  minus(p, e, u);
  minus(r, e, v);
  if (!cross_is_zero(u, v)) return false;
  return (u[0] * v[0] + u[1] * v[1] + u[2] * v[2]).sign() > 0;
}

}  // namespace gnomon
