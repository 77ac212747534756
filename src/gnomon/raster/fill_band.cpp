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
using F = hn::ScalableTag<float>;
using FI = hn::Rebind<std::int32_t, F>;

// The widest reading of each row's span, and whether a narrower one is possible.
struct RowSpans {
  HWY_ALIGN std::int32_t begin[kBandRowsMax + HWY_MAX_BYTES / sizeof(double)];
  HWY_ALIGN std::int32_t end[kBandRowsMax + HWY_MAX_BYTES / sizeof(double)];
  HWY_ALIGN double undecided[kBandRowsMax + HWY_MAX_BYTES / sizeof(double)];
  bool any_undecided = false;
};

void FindSpans(const Polygon& p, const BandJob& job, int first, int rows, RowSpans& out) {
  const D d;
  const DI di;
  const auto half = hn::Set(d, kPixelCentre), zero = hn::Zero(d),
             width = hn::Set(d, static_cast<double>(job.width));
  // The cut by nearness is an optimisation, one pixel wider than computed; no exactness needed.
  const bool cut = p.inverse_ga != 0 && std::isfinite(job.least_nearness);
  const double cut_slack =
      1 +
      std::fabs(p.inverse_ga) * 2 *
          (p.error_absolute + (p.error_relative + kFloatCompare) * std::fabs(job.least_nearness) +
           job.nearness_floor);
  out.any_undecided = false;
  for (int i = 0; i < rows; i += static_cast<int>(hn::Lanes(d))) {
    const auto y = hn::Add(hn::Set(d, first + i + kPixelCentre), hn::Iota(d, 0.0));
    auto begin = zero, end = width;
    auto undecided = hn::Lt(zero, zero);
    for (const RowEdge& e : p.edges) {
      const auto x = hn::Add(hn::Set(d, e.x0), hn::Mul(hn::Set(d, e.k), y));
      const auto slack = hn::Set(d, e.slack);
      if (e.kind == RowEdge::kFlat) {
        end = hn::IfThenElse(hn::Lt(x, hn::Neg(slack)), zero, end);
        undecided = hn::Or(undecided, hn::Not(hn::Gt(x, slack)));
        continue;
      }
      const auto middle = hn::Add(x, half);
      const auto low = hn::Floor(hn::Sub(middle, slack)), high = hn::Floor(hn::Add(middle, slack));
      undecided = hn::Or(undecided, hn::Lt(low, high));
      if (e.kind == RowEdge::kLower) {
        begin = hn::Max(begin, low);
      } else {
        end = hn::Min(end, high);
      }
    }
    if (cut) {
      const auto above =
          hn::Add(hn::Set(d, p.g.c - job.least_nearness), hn::Mul(hn::Set(d, p.g.b), y));
      const auto x = hn::Sub(half, hn::Mul(above, hn::Set(d, p.inverse_ga)));
      if (p.inverse_ga > 0) {
        begin = hn::Max(begin, hn::Floor(hn::Sub(x, hn::Set(d, cut_slack))));
      } else {
        end = hn::Min(end, hn::Floor(hn::Add(x, hn::Set(d, cut_slack))));
      }
    }
    begin = hn::Min(begin, width);
    end = hn::Max(end, zero);
    hn::StoreU(hn::DemoteTo(di, begin), di, out.begin + i);
    hn::StoreU(hn::DemoteTo(di, end), di, out.end + i);
    undecided = hn::And(undecided, hn::Lt(begin, end));
    if (!hn::AllFalse(d, undecided)) {
      if (!out.any_undecided) std::fill(out.undecided, out.undecided + kBandRowsMax, 0.0);
      out.any_undecided = true;
      hn::StoreU(hn::IfThenElseZero(undecided, hn::Set(d, 1.0)), d, out.undecided + i);
    }
  }
}

// Adds p.add to the samples of the span that the polygon is in front of.
void FillSpan(const Polygon& p, const BandJob& job, int row, int begin, int end) {
  const F f;
  const FI fi;
  const double y = row + kPixelCentre;
  const double start = (p.g.c + p.g.b * y) + p.g.a * (begin + kPixelCentre);
  const double stop = start + p.g.a * (end - begin);
  const double error =
      p.error_absolute + job.nearness_floor +
      (p.error_relative + kFloatCompare) * std::max(std::fabs(start), std::fabs(stop));
  const auto v_start = hn::Set(f, static_cast<float>(start)),
             v_step = hn::Set(f, static_cast<float>(p.g.a));
  const auto v_error =
      hn::Set(f, static_cast<float>(error * (1 + 0x1p-20)));  // not below `error` after rounding
  const auto v_add = hn::Set(fi, p.add);
  const std::size_t base =
      static_cast<std::size_t>(row - job.first_row) * static_cast<std::size_t>(job.stride) +
      static_cast<std::size_t>(begin);
  const float* nearness = job.nearness + base;
  std::int32_t* counts = job.counts + base;
  const int lanes = static_cast<int>(hn::Lanes(f)), n = end - begin;
  for (int i = 0; i < n; i += lanes) {
    const auto k = hn::Add(hn::Set(f, static_cast<float>(i)), hn::Iota(f, 0.0f));
    const auto valid = hn::Lt(k, hn::Set(f, static_cast<float>(n)));
    const auto difference =
        hn::Sub(hn::Add(v_start, hn::Mul(k, v_step)), hn::LoadU(f, nearness + i));
    const auto front = hn::And(valid, hn::Gt(difference, hn::Zero(f)));
    const auto added = hn::IfThenElseZero(hn::RebindMask(fi, front), v_add);
    hn::StoreU(hn::Add(hn::LoadU(fi, counts + i), added), fi, counts + i);
    const auto close =
        hn::AndNot(hn::Gt(hn::Abs(difference), v_error), valid);  // NaN counts as close
    if (HWY_UNLIKELY(!hn::AllFalse(f, close))) {
      HWY_ALIGN float is_close[HWY_MAX_BYTES / sizeof(float)],
          is_front[HWY_MAX_BYTES / sizeof(float)];
      hn::StoreU(hn::IfThenElseZero(close, hn::Set(f, 1.0f)), f, is_close);
      hn::StoreU(hn::IfThenElseZero(front, hn::Set(f, 1.0f)), f, is_front);
      for (int lane = 0; lane < lanes; ++lane) {
        if (is_close[lane] == 0) continue;
        const bool exact = job.exact->in_front(p, begin + i + lane, row),
                   guess = is_front[lane] != 0;
        if (exact != guess) counts[i + lane] += exact ? p.add : -p.add;
      }
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
    for (int i = 0; i < rows; ++i) {
      int begin = spans.begin[i], end = spans.end[i];
      if (begin >= end) continue;
      if (HWY_UNLIKELY(spans.any_undecided) && spans.undecided[i] != 0) {
        const Span exact = job.exact->span(p, first + i);
        begin = std::max(begin, exact.begin);
        end = std::min(end, exact.end);
        if (begin >= end) continue;
      }
      FillSpan(p, job, first + i, begin, end);
    }
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
