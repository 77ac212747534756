#include <gnomon/raster/fill_band.h>

#include <algorithm>
#include <cmath>

#include <gnomon/raster/add_where_positive.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gnomon/raster/fill_band.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gnomon {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using DI = hn::Rebind<std::int32_t, D>;
using DF = hn::Rebind<float, D>;
using F = hn::ScalableTag<float>;
using FI = hn::Rebind<std::int32_t, F>;

// The widest reading of each row's span, the polygon's nearness at its first pixel and the error
// bound of the float comparison.
constexpr std::size_t kRowSlots = kBandRowsMax + HWY_MAX_BYTES / sizeof(double);
struct RowSpans {
  HWY_ALIGN std::int32_t begin[kRowSlots];
  HWY_ALIGN std::int32_t end[kRowSlots];
  HWY_ALIGN float start[kRowSlots];
  HWY_ALIGN float error[kRowSlots];
  HWY_ALIGN double
      undecided[kRowSlots];  // not 0: a narrower reading is possible; valid if any_undecided
  bool any_undecided = false;
};

// The error bound of comparing nearness that runs from `start` to `stop` over a span. The factor
// makes up for rounding to float.
double comparison_error(const Polygon& p, const BandJob& job, double start, double stop) {
  return (p.error_absolute + job.nearness_floor +
          (p.error_relative + kFloatCompare) * std::max(std::fabs(start), std::fabs(stop))) *
         (1 + 0x1p-20);
}

void FindSpans(const Polygon& p, const BandJob& job, int first, int rows, RowSpans& out) {
  const D d;
  const DI di;
  const DF df;
  const auto half = hn::Set(d, kPixelCentre), zero = hn::Zero(d),
             width = hn::Set(d, static_cast<double>(job.width));
  // The cut by nearness is an optimisation, one pixel wider than computed; no exactness needed.
  const bool cut = p.inverse_ga != 0 && std::isfinite(job.least_nearness);
  const double cut_slack =
      1 +
      std::fabs(p.inverse_ga) * 2 *
          (p.error_absolute + (p.error_relative + kFloatCompare) * std::fabs(job.least_nearness) +
           job.nearness_floor);
  const auto ga = hn::Set(d, p.g.a), gb = hn::Set(d, p.g.b), gc = hn::Set(d, p.g.c);
  const auto error_absolute = hn::Set(d, (p.error_absolute + job.nearness_floor) * (1 + 0x1p-20));
  const auto error_relative = hn::Set(d, (p.error_relative + kFloatCompare) * (1 + 0x1p-20));
  out.any_undecided = false;
  for (int i = 0; i < rows; i += static_cast<int>(hn::Lanes(d))) {
    const auto y = hn::Add(hn::Set(d, first + i + kPixelCentre), hn::Iota(d, 0.0));
    auto begin = zero, end = width;
    auto undecided = hn::Lt(zero, zero);
    for (int edge = 0; edge < 3; ++edge) {
      const RowEdge& e = p.edges[edge];
      const auto x = hn::Add(hn::Set(d, e.x0), hn::Mul(hn::Set(d, e.k), y));
      const auto slack = hn::Set(d, e.slack);
      if (p.kinds[edge] == EdgeKind::kFlat) {
        end = hn::IfThenElse(hn::Lt(x, hn::Neg(slack)), zero, end);
        undecided = hn::Or(undecided, hn::Not(hn::Gt(x, slack)));
        continue;
      }
      const auto middle = hn::Add(x, half);
      const auto low = hn::Floor(hn::Sub(middle, slack)), high = hn::Floor(hn::Add(middle, slack));
      undecided = hn::Or(undecided, hn::Lt(low, high));
      if (p.kinds[edge] == EdgeKind::kLower) {
        begin = hn::Max(begin, low);
      } else {
        end = hn::Min(end, high);
      }
    }
    const auto base = hn::Add(gc, hn::Mul(gb, y));
    if (cut) {
      const auto above = hn::Sub(base, hn::Set(d, job.least_nearness));
      const auto x = hn::Sub(half, hn::Mul(above, hn::Set(d, p.inverse_ga)));
      if (p.inverse_ga > 0) {
        begin = hn::Max(begin, hn::Floor(hn::Sub(x, hn::Set(d, cut_slack))));
      } else {
        end = hn::Min(end, hn::Floor(hn::Add(x, hn::Set(d, cut_slack))));
      }
    }
    begin = hn::Min(begin, width);
    end = hn::Max(end, zero);
    const auto start = hn::Add(base, hn::Mul(ga, hn::Add(begin, half)));
    const auto stop = hn::Add(start, hn::Mul(ga, hn::Sub(end, begin)));
    const auto error =
        hn::Add(error_absolute, hn::Mul(error_relative, hn::Max(hn::Abs(start), hn::Abs(stop))));
    hn::StoreU(hn::DemoteTo(di, begin), di, out.begin + i);
    hn::StoreU(hn::DemoteTo(di, end), di, out.end + i);
    hn::StoreU(hn::DemoteTo(df, start), df, out.start + i);
    hn::StoreU(hn::DemoteTo(df, error), df, out.error + i);
    undecided = hn::And(undecided, hn::Lt(begin, end));
    if (HWY_UNLIKELY(!hn::AllFalse(d, undecided))) {
      if (!out.any_undecided) std::fill(out.undecided, out.undecided + kRowSlots, 0.0);
      out.any_undecided = true;
      hn::StoreU(hn::IfThenElseZero(undecided, hn::Set(d, 1.0)), d, out.undecided + i);
    }
  }
}

// Corrects the samples of a vector that are too close to the polygon for float: bits of `close`,
// and of `front` what float said.
template <class M>
HWY_NOINLINE void DecideClose(const Polygon& p, const BandJob& job, M close, M front, int column,
                              int row, std::int32_t* counts) {
  const F f;
  HWY_ALIGN float is_close[HWY_MAX_BYTES / sizeof(float)], is_front[HWY_MAX_BYTES / sizeof(float)];
  hn::StoreU(hn::IfThenElseZero(close, hn::Set(f, 1.0f)), f, is_close);
  hn::StoreU(hn::IfThenElseZero(front, hn::Set(f, 1.0f)), f, is_front);
  for (int lane = 0; lane < static_cast<int>(hn::Lanes(f)); ++lane) {
    if (is_close[lane] == 0) continue;
    const bool exact = job.exact->in_front(p, column + lane, row), guess = is_front[lane] != 0;
    if (exact != guess) counts[lane] += exact ? p.add : -p.add;
  }
}

// Adds p.add to the samples that the polygon is in front of.
void FillPolygon(const Polygon& p, const BandJob& job, RowSpans& spans, int first, int rows) {
  const F f;
  const FI fi;
  const int lanes = static_cast<int>(hn::Lanes(f));
  const auto step = hn::Set(f, static_cast<float>(p.g.a)), iota = hn::Iota(f, 0.0f),
             zero = hn::Zero(f);
  const auto add = hn::Set(fi, p.add);
  for (int i = 0; i < rows; ++i) {
    int begin = spans.begin[i], end = spans.end[i];
    if (begin >= end) continue;
    const int row = first + i;
    if (HWY_UNLIKELY(spans.any_undecided) && spans.undecided[i] != 0) {
      const Span exact = job.exact->span(p, row);
      begin = std::max(begin, exact.begin);
      end = std::min(end, exact.end);
      if (begin >= end) continue;
      const double start = (p.g.c + p.g.b * (row + kPixelCentre)) + p.g.a * (begin + kPixelCentre);
      spans.start[i] = static_cast<float>(start);
      spans.error[i] =
          static_cast<float>(comparison_error(p, job, start, start + p.g.a * (end - begin)));
    }
    const std::ptrdiff_t y = row - job.first_row;
    const float* nearness = job.nearness + y * job.nearness_stride + begin;
    std::int32_t* counts = job.counts + y * job.stride + begin;
    const auto start = hn::Set(f, spans.start[i]), error = hn::Set(f, spans.error[i]);
    const auto n = hn::Set(f, static_cast<float>(end - begin));
    for (int x = 0; x < end - begin; x += lanes) {
      const auto k = hn::Add(hn::Set(f, static_cast<float>(x)), iota);
      const auto valid = hn::Lt(k, n);
      const auto difference = hn::Sub(hn::Add(start, hn::Mul(k, step)), hn::LoadU(f, nearness + x));
      const auto front = hn::And(valid, hn::Gt(difference, zero));
      const auto added = hn::IfThenElseZero(hn::RebindMask(fi, front), add);
      hn::StoreU(hn::Add(hn::LoadU(fi, counts + x), added), fi, counts + x);
      const auto close =
          hn::AndNot(hn::Gt(hn::Abs(difference), error), valid);  // NaN counts as close
      if (HWY_UNLIKELY(!hn::AllFalse(f, close)))
        DecideClose(p, job, close, front, begin + x, row, counts + x);
    }
  }
}

void FillBand(const BandJob& job) {
  RowSpans spans;
  for (std::size_t s = 0; s < job.count; ++s) {
    const Polygon& p = job.polygons[job.selected[s]];
    const int first = std::max(job.first_row, p.first_row);
    const int rows = std::min(job.first_row + job.rows, p.end_row) - first;
    if (rows <= 0) continue;
    FindSpans(p, job, first, rows, spans);
    FillPolygon(p, job, spans, first, rows);
  }
}

void AddWherePositive(const std::int32_t* counts, int n, std::uint32_t weight,
                      std::uint32_t* sums) {
  const hn::ScalableTag<std::int32_t> d;
  const auto w = hn::Set(d, static_cast<std::int32_t>(weight)), zero = hn::Zero(d);
  const int lanes = static_cast<int>(hn::Lanes(d));
  int i = 0;
  for (; i + lanes <= n; i += lanes) {
    auto* s =
        reinterpret_cast<std::int32_t*>(sums + i);  // same size; wrapping addition is the same
    const auto add = hn::IfThenElseZero(hn::Gt(hn::LoadU(d, counts + i), zero), w);
    hn::StoreU(hn::Add(hn::LoadU(d, s), add), d, s);
  }
  for (; i < n; ++i) sums[i] += counts[i] > 0 ? weight : 0;
}

const char* Name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace gnomon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon {

HWY_EXPORT(FillBand);
HWY_EXPORT(AddWherePositive);
HWY_EXPORT(Name);

void fill_band(const BandJob& job) { HWY_DYNAMIC_DISPATCH(FillBand)(job); }

void add_where_positive(const std::int32_t* counts, int n, std::uint32_t weight,
                        std::uint32_t* sums) {
  HWY_DYNAMIC_DISPATCH(AddWherePositive)(counts, n, weight, sums);
}

const char* instruction_set() { return HWY_DYNAMIC_DISPATCH(Name)(); }

}  // namespace gnomon
#endif
