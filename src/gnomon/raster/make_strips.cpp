#include <algorithm>
#include <cmath>
#include <limits>

#include <gnomon/raster/polygon.h>
#include <gnomon/raster/strip.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gnomon/raster/make_strips.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gnomon {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kStripLanes = 8;
using D = hn::CappedTag<double, kStripLanes>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

constexpr double kMostSlack = 0.25;  // pixels; beyond it the polygon knows better
constexpr double kMostColumns = 32767;
constexpr std::int32_t kMostMultiplicity = 32767;
// Nearness, pixels and their products have to stay far below float's end.
constexpr double kLargestMagnitude = 1e30;
// Rounding of sums of few terms in double, as a share of their magnitudes.
constexpr double kRoundoff = 16 * kUnitRoundoff;

HWY_INLINE V Set(double x) { return hn::Set(D(), x); }
HWY_INLINE V Clamp(V x, double least, double most) {
  return hn::Min(hn::Max(x, Set(least)), Set(most));
}
HWY_INLINE V Take(M mask, V yes, V no) { return hn::IfThenElse(mask, yes, no); }

// Where strips lie, as far as they are not deeper than `least`.
struct Boxes {
  V low_x, high_x;
  V first, last;  // rows; whole numbers
  M some;         // touches the picture, and is not all below `least`
};

// Arrays for one value of each lane.
template <class T>
struct Lanes {
  HWY_ALIGN T at[kStripLanes];
};
HWY_INLINE void Keep(V x, Lanes<double>& out) { hn::Store(x, D(), out.at); }
HWY_INLINE void Keep(V x, Lanes<float>& out) {
  const hn::Rebind<float, D> f;
  hn::Store(hn::DemoteTo(f, x), f, out.at);
}
HWY_INLINE void Keep(V x, Lanes<std::int32_t>& out) {
  const hn::Rebind<std::int32_t, D> i;
  hn::Store(hn::DemoteTo(i, x), i, out.at);
}
// Not below x >= 0: rounding to nearest takes away at most 2^-24 of it.
HWY_INLINE V NotBelow(V x) { return hn::Add(hn::Mul(x, Set(1 + 0x1p-22)), Set(1e-30)); }

struct Ends {
  V ax, ay, az, bx, by, bz;
};

HWY_INLINE Boxes FindBoxes(const Ends& e, const StripLight& light, V least) {
  const V zero = hn::Zero(D());
  const V margin =
      hn::Add(hn::Mul(Set(kRoundoff), hn::Add(hn::Abs(least), Set(light.point.z.magnitude))),
              Set(2 * light.point.z.error + light.nearness_floor));
  const V inverse = Set(light.inverse_sinks), deepest = hn::Sub(least, margin);
  const V to_a = hn::Mul(hn::Sub(e.az, deepest), inverse),
          to_b = hn::Mul(hn::Sub(e.bz, deepest), inverse);
  const V run_a = hn::Max(to_a, zero), run_b = hn::Max(to_b, zero);
  const V lx = Set(light.l.x), ly = Set(light.l.y);
  const V ax = hn::Add(e.ax, hn::Mul(run_a, lx)), bx = hn::Add(e.bx, hn::Mul(run_b, lx));
  const V ay = hn::Add(e.ay, hn::Mul(run_a, ly)), by = hn::Add(e.by, hn::Mul(run_b, ly));
  Boxes b;
  b.low_x = hn::Min(hn::Min(e.ax, e.bx), hn::Min(ax, bx));
  b.high_x = hn::Max(hn::Max(e.ax, e.bx), hn::Max(ax, bx));
  const V top = hn::Sub(hn::Min(hn::Min(e.ay, e.by), hn::Min(ay, by)), Set(kStripMargin)),
          bottom = hn::Add(hn::Max(hn::Max(e.ay, e.by), hn::Max(ay, by)), Set(kStripMargin));
  // Whether a row whose middle is just there counts does not matter: the margin is in it.
  b.first = hn::Floor(hn::Add(Clamp(top, 0, light.height), Set(kPixelCentre)));
  b.last = hn::Sub(hn::Floor(hn::Add(Clamp(bottom, 0, light.height), Set(kPixelCentre))), Set(1));
  b.some = hn::And(hn::And(hn::Ge(hn::Max(to_a, to_b), zero), hn::Ge(b.last, b.first)),
                   hn::And(hn::Gt(b.high_x, Set(-1)), hn::Lt(b.low_x, Set(light.width + 1))));
  return b;
}

// The lowest samples below each box; below some only.
HWY_INLINE V LeastUnder(const Boxes& b, const StripLight& light, const LeastCells& cells, V least) {
  Lanes<std::int32_t> x0, x1, y0, y1;
  Lanes<double> out, some;
  Keep(Clamp(hn::Sub(b.low_x, Set(1)), 0, light.width), x0);
  Keep(Clamp(hn::Add(b.high_x, Set(1)), 0, light.width), x1);
  Keep(b.first, y0);
  Keep(b.last, y1);
  Keep(least, out);
  Keep(hn::IfThenElseZero(b.some, Set(1)), some);
  for (std::size_t k = 0; k < hn::Lanes(D()); ++k) {
    if (some.at[k] != 0) out.at[k] = least_under(cells, x0.at[k], x1.at[k], y0.at[k], y1.at[k]);
  }
  return hn::Load(D(), out.at);
}

std::size_t MakeStrips(const SilhouetteEdge* edges, const std::uint32_t* ids, std::size_t n,
                       const ScreenPoint<double>* points, const StripLight& light,
                       const LeastCells& cells, int orientation, Strip* out,
                       std::vector<UnsureStrip>& unsure) {
  const D d;
  const V zero = hn::Zero(d), one = Set(1), half = Set(kPixelCentre);
  const bool down = light.l.y > 0;
  const double least_of_all = static_cast<double>(cells.levels.back().least[0]);
  if (least_of_all == std::numeric_limits<double>::infinity()) return 0;  // there are no samples
  const V lx = Set(light.l.x), ly = Set(light.l.y), lz = Set(light.l.z), k = Set(light.k);
  const V of_points = Set(light.point.x.error + light.point.y.error);
  const std::size_t lanes = hn::Lanes(d);
  std::size_t made = 0;
  for (std::size_t begin = 0; begin < n; begin += lanes) {
    const std::size_t count = std::min(lanes, n - begin);
    Lanes<double> at[6];
    for (std::size_t i = 0; i < lanes; ++i) {
      const SilhouetteEdge& e = edges[ids[begin + std::min(i, count - 1)]];
      const ScreenPoint<double>&a = points[e.a], &b = points[e.b];
      at[0].at[i] = a.x;
      at[1].at[i] = a.y;
      at[2].at[i] = a.z;
      at[3].at[i] = b.x;
      at[4].at[i] = b.y;
      at[5].at[i] = b.z;
    }
    const Ends e{hn::Load(d, at[0].at), hn::Load(d, at[1].at), hn::Load(d, at[2].at),
                 hn::Load(d, at[3].at), hn::Load(d, at[4].at), hn::Load(d, at[5].at)};
    const V x = hn::Sub(e.bx, e.ax), y = hn::Sub(e.by, e.ay), z = hn::Sub(e.bz, e.az);
    const V f = hn::Sub(hn::Mul(x, ly), hn::Mul(y, lx));

    // Where it lies, as far as the samples below it are deep.
    Boxes box = FindBoxes(e, light, Set(least_of_all));
    if (hn::AllFalse(d, box.some)) continue;
    const V least = LeastUnder(box, light, cells, Set(least_of_all));
    const M samples = hn::Lt(least, Set(std::numeric_limits<double>::infinity()));
    const M before = box.some;
    box = FindBoxes(e, light, Take(samples, least, Set(least_of_all)));
    const M some = hn::And(hn::And(before, box.some), samples);
    if (hn::AllFalse(d, some)) continue;
    const V rows = hn::Add(hn::Sub(box.last, box.first), one);
    const V column = hn::Floor(Clamp(e.ax, 0, light.width));
    const V from_column = hn::Sub(hn::Sub(hn::Floor(hn::Max(box.low_x, Set(2))), Set(2)), column);
    const V to_column = hn::Sub(
        hn::Min(hn::Add(hn::Floor(Clamp(box.high_x, 0, light.width)), Set(3)), Set(light.width)),
        column);
    const V column_x = hn::Add(column, half), row_y = hn::Add(down ? box.first : box.last, half);
    M sure = hn::And(
        hn::Gt(hn::Abs(f), Set(4 * light.f_error)),
        hn::And(hn::Ge(from_column, Set(-kMostColumns)), hn::Le(to_column, Set(kMostColumns))));

    // Crossings.
    const V to_row_a = hn::Sub(row_y, e.ay), to_row_b = hn::Sub(row_y, e.by);
    const V at_a = hn::Sub(hn::Add(e.ax, hn::Mul(to_row_a, k)), column_x),
            at_b = hn::Sub(hn::Add(e.bx, hn::Mul(to_row_b, k)), column_x);
    const M a_left = hn::Gt(hn::Mul(f, Set(light.inverse_y)), zero);
    const V left = Take(a_left, at_a, at_b), right = Take(a_left, at_b, at_a);
    V slack = hn::Add(Set(light.sweep_error),
                      hn::Mul(Set(kCrossingInFloat),
                              hn::Add(hn::Max(hn::Abs(left), hn::Abs(right)),
                                      hn::Add(hn::Mul(Set(std::fabs(light.k)), rows), one))));
    // The edge's own rows; beyond them left and right bound the strip alone.
    const V first_of_edge = hn::Max(
        box.first,
        hn::Floor(hn::Add(
            Clamp(hn::Sub(hn::Min(e.ay, e.by), Set(kStripMargin)), 0, light.height + 1.0), half)));
    const V last_of_edge = hn::Min(
        box.last, hn::Sub(hn::Floor(hn::Add(Clamp(hn::Add(hn::Max(e.ay, e.by), Set(kStripMargin)),
                                                  0, light.height + 1.0),
                                            half)),
                          one));
    const M has_edge = hn::Le(first_of_edge, last_of_edge);
    const V least_y = hn::Sub(hn::Abs(y), Set(2 * light.point.y.error));
    const M knows_edge = hn::Gt(least_y, hn::Mul(Set(16), of_points));
    sure = hn::And(sure, hn::Or(hn::Not(has_edge), knows_edge));
    const M edge = hn::And(has_edge, knows_edge);
    const V edge_step = hn::IfThenElseZero(edge, hn::Div(x, Take(edge, y, one)));
    const V edge_at =
        hn::IfThenElseZero(edge, hn::Sub(hn::Add(e.ax, hn::Mul(to_row_a, edge_step)), column_x));
    // A flat line is far outside beyond the edge's own rows.
    const V steepness = hn::Abs(edge_step);
    const M flat = hn::Gt(steepness, Set(4 * (std::fabs(light.k) + 1)));
    const V reach = Take(
        flat,
        hn::Add(down ? hn::Sub(last_of_edge, box.first) : hn::Sub(box.last, first_of_edge), one),
        rows);
    // Slope and distance are wrong by what the points are.
    const V distance = hn::Add(hn::Add(hn::Abs(to_row_a), reach), one);
    const V edge_slack = hn::Add(
        hn::Add(
            hn::Mul(hn::Mul(hn::Add(one, steepness), of_points),
                    hn::Add(one, hn::Div(hn::Add(distance, distance), Take(edge, least_y, one)))),
            hn::Mul(Set(kRoundoff), hn::Add(hn::Add(hn::Abs(e.ax), Set(light.width)),
                                            hn::Mul(steepness, distance)))),
        hn::Mul(Set(kCrossingInFloat),
                hn::Add(hn::Add(hn::Abs(edge_at), hn::Mul(steepness, reach)), one)));
    slack = hn::Max(slack, hn::IfThenElseZero(edge, edge_slack));
    sure = hn::And(sure, hn::Lt(slack, Set(kMostSlack)));

    // Nearness.
    const V inverse = hn::Div(one, Take(hn::Eq(f, zero), one, f));
    const V ga = hn::Mul(hn::Sub(hn::Mul(z, ly), hn::Mul(y, lz)), inverse),
            gb = hn::Mul(hn::Sub(hn::Mul(x, lz), hn::Mul(z, lx)), inverse);
    const V to_column_a = hn::Sub(column_x, e.ax);
    const V g = hn::Add(e.az, hn::Add(hn::Mul(ga, to_column_a), hn::Mul(gb, to_row_a)));
    const V slope_x = hn::Abs(ga), slope_y = hn::Abs(gb);
    const V far_x = hn::Add(hn::Add(hn::Sub(box.high_x, box.low_x), hn::Abs(to_column_a)), Set(8)),
            far_y = hn::Add(hn::Add(hn::Abs(y), hn::Abs(to_row_a)), hn::Add(rows, Set(8)));
    // |f| is at least four times its error.
    const V of_slopes = hn::Mul(
        hn::Add(hn::Mul(hn::Add(Set(light.ga_error), hn::Mul(slope_x, Set(light.f_error))), far_x),
                hn::Mul(hn::Add(Set(light.gb_error), hn::Mul(slope_y, Set(light.f_error))), far_y)),
        hn::Mul(Set(1.5), hn::Abs(inverse)));
    const V of_corner = hn::Add(hn::Mul(slope_x, Set(light.point.x.error)),
                                hn::Mul(slope_y, Set(light.point.y.error)));
    const V of_rounding =
        hn::Mul(Set(kRoundoff),
                hn::Add(hn::Abs(e.az), hn::Add(hn::Mul(slope_x, far_x), hn::Mul(slope_y, far_y))));
    const V columns = hn::Add(hn::Max(hn::Neg(from_column), to_column), Set(8));
    const V magnitude = hn::Add(
        hn::Abs(g), hn::Add(hn::Mul(slope_x, columns), hn::Mul(slope_y, hn::Add(rows, Set(8)))));
    const V error = hn::Mul(hn::Add(hn::Add(hn::Add(of_slopes, of_corner), of_rounding),
                                    hn::Add(Set(light.point.z.error + light.nearness_floor),
                                            hn::Mul(Set(kNearnessInFloat), magnitude))),
                            Set(1 + 0x1p-20));
    sure = hn::And(sure, hn::Lt(magnitude, Set(kLargestMagnitude)));

    // The cut by nearness, with all that may be wrong with it to the safe side.
    const M steep = hn::Gt(hn::Mul(slope_x, Set(kMostSlack)), hn::Add(error, error));
    const V inverse_ga = hn::Div(one, Take(steep, ga, one));
    const V cut_step = hn::Mul(hn::Neg(gb), inverse_ga),
            cut_at = hn::Mul(hn::Sub(least, g), inverse_ga);
    const V cut_slack =
        hn::Add(hn::Mul(hn::Add(error, error), hn::Abs(inverse_ga)),
                hn::Mul(Set(2 * kCrossingInFloat),
                        hn::Add(hn::Add(hn::Abs(cut_at), hn::Mul(hn::Abs(cut_step), rows)), one)));
    const M cut = hn::And(steep, hn::Lt(cut_slack, Set(kMostSlack)));
    const M rising = hn::Gt(ga, zero);
    const V safe_cut = Take(rising, hn::Sub(cut_at, cut_slack), hn::Add(cut_at, cut_slack));

    V kinds = Set(down ? 0 : Strip::kFromLast);
    kinds = hn::Add(
        kinds, hn::IfThenElseZero(edge, Take(hn::Lt(hn::Mul(y, f), zero), Set(Strip::kEdgeLower),
                                             Set(Strip::kEdgeUpper))));
    kinds = hn::Add(
        kinds, hn::IfThenElseZero(cut, Take(rising, Set(Strip::kCutLower), Set(Strip::kCutUpper))));

    Lanes<float> o_left, o_right, o_edge, o_edge_step, o_cut, o_cut_step, o_slack, o_g, o_ga, o_gb,
        o_error;
    Lanes<std::int32_t> o_column, o_begin, o_end, o_first, o_rows, o_kinds, o_state, o_side;
    // Nothing out of float's range is converted.
    const M fine = hn::And(some, sure);
    const auto keep = [&](V v, Lanes<float>& to)
                          HWY_ATTR { Keep(hn::IfThenElseZero(fine, v), to); };
    keep(left, o_left);
    keep(right, o_right);
    keep(edge_at, o_edge);
    keep(edge_step, o_edge_step);
    keep(hn::IfThenElseZero(cut, safe_cut), o_cut);
    keep(hn::IfThenElseZero(cut, cut_step), o_cut_step);
    keep(NotBelow(slack), o_slack);
    keep(g, o_g);
    keep(ga, o_ga);
    keep(gb, o_gb);
    keep(NotBelow(error), o_error);
    Keep(column, o_column);
    Keep(hn::IfThenElseZero(fine, from_column), o_begin);
    Keep(hn::IfThenElseZero(fine, to_column), o_end);
    Keep(box.first, o_first);
    Keep(rows, o_rows);
    Keep(kinds, o_kinds);
    Keep(hn::IfThenElseZero(some, Take(sure, one, Set(2))), o_state);
    Keep(Take(hn::Gt(f, zero), one, Set(-1)), o_side);
    for (std::size_t i = 0; i < count; ++i) {
      if (o_state.at[i] == 0) continue;
      const std::uint32_t id = ids[begin + i];
      const std::int32_t m = edges[id].multiplicity;
      if (o_state.at[i] == 2 || m > kMostMultiplicity || m < -kMostMultiplicity) {
        unsure.push_back({id, o_first.at[i], o_first.at[i] + o_rows.at[i]});
        continue;
      }
      if (o_begin.at[i] >= o_end.at[i]) continue;
      Strip& s = out[made++];
      s.left = o_left.at[i];
      s.right = o_right.at[i];
      s.edge = o_edge.at[i];
      s.edge_step = o_edge_step.at[i];
      s.cut = o_cut.at[i];
      s.cut_step = o_cut_step.at[i];
      s.slack = o_slack.at[i];
      s.g = o_g.at[i];
      s.ga = o_ga.at[i];
      s.gb = o_gb.at[i];
      s.error = o_error.at[i];
      s.column = o_column.at[i];
      s.begin = static_cast<std::int16_t>(o_begin.at[i]);
      s.end = static_cast<std::int16_t>(o_end.at[i]);
      s.first_row = static_cast<std::uint16_t>(o_first.at[i]);
      s.rows = static_cast<std::uint16_t>(o_rows.at[i]);
      s.add = static_cast<std::int16_t>(-m * orientation * o_side.at[i]);
      s.kinds = static_cast<std::uint8_t>(o_kinds.at[i]);
      s.id = id;
    }
  }
  return made;
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon {

HWY_EXPORT(MakeStrips);

std::size_t make_strips(const SilhouetteEdge* edges, const std::uint32_t* ids, std::size_t n,
                        const ScreenPoint<double>* points, const StripLight& light,
                        const LeastCells& cells, int orientation, Strip* out,
                        std::vector<UnsureStrip>& unsure) {
  return HWY_DYNAMIC_DISPATCH(MakeStrips)(edges, ids, n, points, light, cells, orientation, out,
                                          unsure);
}

}  // namespace gnomon
#endif
