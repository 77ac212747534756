#include <algorithm>
#include <cmath>
#include <limits>

#include <gnomon/raster/side.h>
#include <gnomon/view/receivers.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gnomon/raster/make_sides.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gnomon {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kSideLanes = 8;
using D = hn::CappedTag<double, kSideLanes>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

// Rounding of scaling a linear function and of evaluating it in double: fewer roundings.
constexpr double kRoundoff = 16 * kUnitRoundoff;
// An edge function below it is taken for that of a point.
constexpr double kLeastSize = 1e-200;

HWY_INLINE V Set(double x) { return hn::Set(D(), x); }

struct Corners3 {
  V x, y, w, z;
};
struct Line {
  V a, b, c;
};
// In the order of operations of line_through(), whose error bounds hold.
HWY_INLINE Line LineThrough(const Corners3& p, const Corners3& r) {
  return {hn::Sub(hn::Mul(p.y, r.w), hn::Mul(p.w, r.y)),
          hn::Sub(hn::Mul(p.w, r.x), hn::Mul(p.x, r.w)),
          hn::Sub(hn::Mul(p.x, r.y), hn::Mul(p.y, r.x))};
}
HWY_INLINE V Weighted(V p, V a, V q, V b, V r, V c) {
  return hn::Add(hn::Add(hn::Mul(p, a), hn::Mul(q, b)), hn::Mul(r, c));
}

// Bound of the terms' magnitudes in the picture; the highest value in it.
HWY_INLINE V Reach(const Line& l, V w, V h) {
  return hn::Add(hn::Add(hn::Mul(hn::Abs(l.a), w), hn::Mul(hn::Abs(l.b), h)), hn::Abs(l.c));
}
HWY_INLINE V Highest(const Line& l, V w, V h) {
  const V zero = hn::Zero(D());
  return hn::Add(l.c, hn::Add(hn::Mul(hn::Max(l.a, zero), w), hn::Mul(hn::Max(l.b, zero), h)));
}
// More than any bound that can decide anything: edge functions reach a few times the picture's
// sides, bounds of nearness 2^22 times kLargestNearness. Infinite bounds would turn into NaN.
constexpr double kLargestSlack = 1e37;
// As floats, not below x >= 0: rounding to nearest takes away at most 2^-24 of it.
HWY_INLINE void StoreNotBelow(V x, float* out) {
  const hn::Rebind<float, D> f;
  const V more = hn::Add(hn::Mul(x, Set(1 + 0x1p-20)), Set(1e-30));
  hn::Store(hn::DemoteTo(f, hn::Min(more, Set(kLargestSlack))), f, out);
}

// source.take(i, corners): pointers to its three points; source.id(i); source.weight(i).
template <class Source>
std::size_t Make(const SideSetup& s, const Source& source, std::size_t n, bool caster, Side* out) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  const double width = s.space->width, height = s.space->height;
  const V zero = hn::Zero(d), one = Set(1), w = Set(width), h = Set(height);
  std::size_t made = 0;
  HWY_ALIGN double at[12][kSideLanes];
  HWY_ALIGN double a[6][kSideLanes], b[6][kSideLanes], c[6][kSideLanes], keep[kSideLanes];
  HWY_ALIGN float slack[6][kSideLanes], relative[kSideLanes];
  HWY_ALIGN double inside[kSideLanes];
  for (std::size_t begin = 0; begin < n; begin += lanes) {
    const std::size_t count = std::min(lanes, n - begin);
    for (std::size_t i = 0; i < lanes; ++i) {
      const ScreenPoint<double>* p[3];
      source.take(begin + std::min(i, count - 1), p);
      for (std::size_t k = 0; k < 3; ++k) {
        at[4 * k][i] = p[k]->x;
        at[4 * k + 1][i] = p[k]->y;
        at[4 * k + 2][i] = p[k]->w;
        at[4 * k + 3][i] = p[k]->z;
      }
    }
    Corners3 p[3];
    for (int k = 0; k < 3; ++k) {
      p[k] = {hn::Load(d, at[4 * k]), hn::Load(d, at[4 * k + 1]), hn::Load(d, at[4 * k + 2]),
              hn::Load(d, at[4 * k + 3])};
    }
    const Line e[3] = {LineThrough(p[0], p[1]), LineThrough(p[1], p[2]), LineThrough(p[2], p[0])};
    const V f = Weighted(p[2].x, e[0].a, p[2].y, e[0].b, p[2].w, e[0].c);
    const V na = Weighted(p[0].z, e[1].a, p[1].z, e[2].a, p[2].z, e[0].a),
            nb = Weighted(p[0].z, e[1].b, p[1].z, e[2].b, p[2].z, e[0].b),
            nc = Weighted(p[0].z, e[1].c, p[1].z, e[2].c, p[2].z, e[0].c);

    const M certain = hn::Gt(hn::Abs(f), Set(s.errors.f));
    hn::Store(hn::IfThenElse(hn::Gt(f, zero), one, Set(-1)), d, inside);
    if (HWY_UNLIKELY(!hn::AllTrue(d, certain))) {
      HWY_ALIGN double sure[kSideLanes];
      hn::Store(hn::IfThenElseZero(certain, one), d, sure);
      for (std::size_t i = 0; i < count; ++i) {
        if (sure[i] == 0) inside[i] = s.facing(source.id(begin + i)) * s.space->orientation;
      }
    }
    const V sign = hn::Load(d, inside);
    M kept = hn::Ne(sign, zero);
    Line edges[3];  // positive inside, scaled
    V bounds[3];
    for (int k = 0; k < 3; ++k) {
      const Linear<double>& error = s.errors.edges[k];
      const double total = (error.a * width + error.b * height + error.c) * kInflate;
      const V size = hn::Max(hn::Add(hn::Abs(e[k].a), hn::Abs(e[k].b)),
                             hn::Mul(hn::Abs(e[k].c), Set(1 / (width + height))));
      // Where the edge is a point nothing is known: 0 with a bound.
      const V scale = hn::IfThenElseZero(hn::Gt(size, Set(kLeastSize)),
                                         hn::Div(one, hn::Max(size, Set(kLeastSize))));
      const V scaled = hn::Mul(scale, sign);
      const Line l{hn::Mul(e[k].a, scaled), hn::Mul(e[k].b, scaled), hn::Mul(e[k].c, scaled)};
      bounds[k] = hn::Add(hn::Mul(Set(total), scale),
                          hn::Mul(Set(kRoundoff), hn::Add(one, Reach(l, w, h))));
      kept = hn::And(kept, hn::Not(hn::Lt(Highest(l, w, h), hn::Neg(bounds[k]))));
      edges[k] = l;
    }
    const M resolved = hn::Gt(hn::Abs(f), Set(4 * s.errors.f));  // else its nearness is a guess
    const V inverse = hn::Div(one, hn::IfThenElse(resolved, f, one));
    const Line quotient{hn::Mul(na, inverse), hn::Mul(nb, inverse), hn::Mul(nc, inverse)};
    const V of_f =
        hn::Div(one, hn::IfThenElse(resolved, hn::Sub(hn::Abs(f), Set(s.errors.f)), one));
    const V absolute = hn::Add(hn::Mul(Set(s.errors.n * kInflate), of_f),
                               hn::Mul(Set(kRoundoff), Reach(quotient, w, h)));
    const M known =
        hn::And(resolved, hn::Lt(hn::Add(Reach(quotient, w, h), absolute), Set(kLargestNearness)));
    const V share = hn::IfThenElseZero(known, hn::Mul(Set(s.errors.f * kInflate), of_f));
    const V unknown = Set(std::numeric_limits<double>::quiet_NaN());
    const Line g{hn::IfThenElseZero(known, quotient.a), hn::IfThenElseZero(known, quotient.b),
                 hn::IfThenElse(known, quotient.c, unknown)};
    // nearness + t edge >= nearness inside for t >= 0; and - t edge <= nearness.
    Line upper = g, lower = g;
    V upper_bound = absolute, lower_bound = absolute;
    V least_upper = hn::Add(hn::Abs(g.a), hn::Abs(g.b)), least_lower = least_upper;
    for (int k = 0; k < 3; ++k) {
      const Line& l = edges[k];
      const V square = hn::Add(hn::Mul(l.a, l.a), hn::Mul(l.b, l.b));
      const M steep = hn::Gt(square, Set(0x1p-10));
      const V along =
          hn::IfThenElseZero(steep, hn::Div(hn::Add(hn::Mul(g.a, l.a), hn::Mul(g.b, l.b)),
                                            hn::IfThenElse(steep, square, one)));
      const auto try_bound = [&](Line& best, V& bound, V& least, V t, V factor) HWY_ATTR {
        const Line tilted{hn::Add(g.a, hn::Mul(factor, l.a)), hn::Add(g.b, hn::Mul(factor, l.b)),
                          hn::Add(g.c, hn::Mul(factor, l.c))};
        const V steepness = hn::Add(hn::Abs(tilted.a), hn::Abs(tilted.b));
        const M better = hn::And(hn::Gt(t, zero), hn::Lt(steepness, least));
        least = hn::IfThenElse(better, steepness, least);
        best = {hn::IfThenElse(better, tilted.a, best.a), hn::IfThenElse(better, tilted.b, best.b),
                hn::IfThenElse(better, tilted.c, best.c)};
        // The share that nearness may be wrong by is also one of what lies beyond the edge.
        const V more = hn::Add(
            hn::Mul(hn::Mul(t, bounds[k]), hn::Add(one, share)),
            hn::Mul(Set(kRoundoff), hn::Add(hn::Mul(t, Reach(l, w, h)), Reach(tilted, w, h))));
        bound = hn::IfThenElse(better, hn::Add(absolute, more), bound);
      };
      try_bound(upper, upper_bound, least_upper, hn::Neg(along), hn::Neg(along));
      try_bound(lower, lower_bound, least_lower, along, hn::Neg(along));
    }
    const V nearest = Highest(upper, w, h);
    const V error = hn::Add(upper_bound, hn::Mul(share, hn::Abs(nearest)));
    kept = hn::And(kept, hn::Not(hn::Lt(hn::Add(nearest, error), Set(s.least_nearness))));
    if (hn::AllFalse(d, kept)) continue;
    hn::Store(hn::IfThenElseZero(kept, one), d, keep);
    const auto store = [&](int k, const Line& l, V bound) HWY_ATTR {
      hn::Store(l.a, d, a[k]);
      hn::Store(l.b, d, b[k]);
      hn::Store(l.c, d, c[k]);
      StoreNotBelow(bound, slack[k]);
    };
    for (int k = 0; k < 3; ++k) store(kEdge + k, edges[k], bounds[k]);
    const V floor = Set(s.nearness_floor);
    store(kNearness, g, hn::Add(absolute, floor));
    store(kUpper, upper, upper_bound);  // squares' bounds of nearness hold exactly
    store(kLower, lower, lower_bound);
    StoreNotBelow(share, relative);
    for (std::size_t i = 0; i < count; ++i) {
      if (keep[i] == 0) continue;
      Side& side = out[made++];
      for (int k = 0; k < 6; ++k) {
        side.a[k] = a[k][i];
        side.b[k] = b[k][i];
        side.c[k] = c[k][i];
        side.slack[k] = slack[k][i];
      }
      for (int k = 6; k < kSideFunctions; ++k) {
        side.a[k] = side.b[k] = side.c[k] = 0;
        side.slack[k] = 0;
      }
      side.relative = relative[i];
      side.facing = static_cast<std::int8_t>(inside[i] * s.space->orientation);
      side.id = source.id(begin + i);
      side.add = source.weight(begin + i) * side.facing;
      side.caster = caster;
    }
  }
  return made;
}

struct EdgeSource {
  const ScreenPoint<double>* points;
  const SilhouetteEdge* edges;
  std::size_t begin;
  const ScreenPoint<double>& minus_light;
  void take(std::size_t i, const ScreenPoint<double>* (&p)[3]) const {
    p[0] = &points[edges[begin + i].a];
    p[1] = &points[edges[begin + i].b];
    p[2] = &minus_light;
  }
  std::uint32_t id(std::size_t i) const { return static_cast<std::uint32_t>(begin + i); }
  std::int32_t weight(std::size_t i) const { return -edges[begin + i].multiplicity; }
};

struct CasterSource {
  const ScreenPoint<double>* points;
  const Triangle* triangles;
  const std::uint32_t* ids;
  const std::int8_t* sides;
  void take(std::size_t i, const ScreenPoint<double>* (&p)[3]) const {
    for (std::size_t k = 0; k < 3; ++k) p[k] = &points[triangles[ids[i]][k]];
  }
  std::uint32_t id(std::size_t i) const { return ids[i]; }
  std::int32_t weight(std::size_t i) const { return sides[ids[i]]; }
};

std::size_t MakeSides(const SideSetup& setup, const SilhouetteEdge* edges, std::size_t begin,
                      std::size_t end, const ScreenPoint<double>& minus_light, Side* out) {
  return Make(setup, EdgeSource{setup.points, edges, begin, minus_light}, end - begin, false, out);
}

std::size_t MakeCasterSides(const SideSetup& setup, const Triangle* triangles,
                            const std::uint32_t* ids, std::size_t n, const std::int8_t* light_sides,
                            Side* out) {
  return Make(setup, CasterSource{setup.points, triangles, ids, light_sides}, n, true, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon {

HWY_EXPORT(MakeSides);
HWY_EXPORT(MakeCasterSides);

std::size_t make_sides(const SideSetup& setup, const SilhouetteEdge* edges, std::size_t begin,
                       std::size_t end, const ScreenPoint<double>& minus_light, Side* out) {
  return HWY_DYNAMIC_DISPATCH(MakeSides)(setup, edges, begin, end, minus_light, out);
}

std::size_t make_caster_sides(const SideSetup& setup, const Triangle* triangles,
                              const std::uint32_t* ids, std::size_t n,
                              const std::int8_t* light_sides, Side* out) {
  return HWY_DYNAMIC_DISPATCH(MakeCasterSides)(setup, triangles, ids, n, light_sides, out);
}

}  // namespace gnomon
#endif
