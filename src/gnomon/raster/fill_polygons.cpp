#include <gnomon/raster/fill_polygons.h>

#include <algorithm>
#include <cmath>

#include <gnomon/raster/fill_strips.h>
#include <gnomon/raster/strip.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gnomon/raster/fill_polygons.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <gnomon/raster/fill_quads-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gnomon {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
using DI = hn::Rebind<std::int32_t, D>;

// Rows [first, first + rows) of which `skip` are of other polygons, and those of the last group of
// four.
void FindSpans(const Polygon& p, const PolygonJob& job, int first, int skip, int rows,
               RowSpans& out) {
  const D d;
  const DI di;
  const auto half = hn::Set(d, kPixelCentre), zero = hn::Zero(d),
             width = hn::Set(d, static_cast<double>(job.width));
  // The cut by nearness is an optimisation, one pixel wider than computed; no exactness needed.
  const bool cut = p.inverse_ga != 0 && std::isfinite(p.least);
  const double cut_slack =
      1 + std::fabs(p.inverse_ga) * 2 *
              (p.error_absolute + (p.error_relative + kNearnessInFloat) * std::fabs(p.least) +
               job.nearness_floor);
  const int all = (rows + kQuadRows - 1) / kQuadRows * kQuadRows;
  for (int i = 0; i < all; i += static_cast<int>(hn::Lanes(d))) {
    const auto row = hn::Add(hn::Set(d, i), hn::Iota(d, 0.0));
    const auto y = hn::Add(row, hn::Set(d, first + kPixelCentre));
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
    if (cut) {
      const auto above =
          hn::Sub(hn::Add(hn::Set(d, p.g.c), hn::Mul(hn::Set(d, p.g.b), y)), hn::Set(d, p.least));
      const auto x = hn::Sub(half, hn::Mul(above, hn::Set(d, p.inverse_ga)));
      if (p.inverse_ga > 0) {
        begin = hn::Max(begin, hn::Floor(hn::Sub(x, hn::Set(d, cut_slack))));
      } else {
        end = hn::Min(end, hn::Floor(hn::Add(x, hn::Set(d, cut_slack))));
      }
    }
    const auto here = hn::And(hn::And(hn::Ge(row, hn::Set(d, skip)), hn::Lt(row, hn::Set(d, rows))),
                              hn::Lt(begin, end));
    begin = hn::IfThenElse(here, begin, hn::Set(d, kNoBegin));
    end = hn::IfThenElseZero(here, end);
    hn::StoreU(hn::DemoteTo(di, begin), di, out.begin + i);
    hn::StoreU(hn::DemoteTo(di, end), di, out.end + i);
    hn::StoreU(hn::DemoteTo(di, hn::IfThenElseZero(here, hn::Sub(end, begin))), di, out.width + i);
    undecided = hn::And(undecided, here);
    if (HWY_UNLIKELY(!hn::AllFalse(d, undecided))) {
      HWY_ALIGN double flag[8];
      hn::Store(hn::IfThenElseZero(undecided, hn::Set(d, 1.0)), d, flag);
      for (int k = 0; k < static_cast<int>(hn::Lanes(d)); ++k) {
        if (flag[k] == 0) continue;
        Narrow(out, i + k, job.exact->span(p, first + i + k));
      }
    }
  }
}

// Bound of the float comparison where nearness in double runs up to `most` in magnitude. The factor
// makes up for rounding to float.
double comparison_error(const Polygon& p, const PolygonJob& job, double most) {
  return (static_cast<double>(p.error_absolute) + job.nearness_floor +
          (static_cast<double>(p.error_relative) + kNearnessInFloat) * most) *
         (1 + 0x1p-20);
}

std::int32_t addition(const Polygon& p, const PolygonJob& job) {
  return job.signs == nullptr ? p.add : p.add * job.signs[p.id];
}

#if HWY_TARGET == HWY_SCALAR

void FillPolygon(const Polygon& p, const PolygonJob& job, const RowSpans& spans, int first,
                 int rows) {
  for (int i = 0; i < rows; ++i) {
    const int row = first + i;
    const double at_row = p.g.c + p.g.b * (row + kPixelCentre);
    const std::size_t base =
        static_cast<std::size_t>((row - job.first_row) / kQuadRows) * job.stride +
        static_cast<std::size_t>((row - job.first_row) % kQuadRows);
    for (int x = spans.begin[i]; x < spans.end[i]; ++x) {
      const std::size_t k = base + static_cast<std::size_t>(x) * kQuadRows;
      const double nearness = at_row + p.g.a * (x + kPixelCentre);
      const double difference = nearness - static_cast<double>(job.nearness[k]);
      const bool sure = std::fabs(difference) > comparison_error(p, job, std::fabs(nearness));
      if (sure ? difference > 0 : job.exact->in_front(p, x, row)) job.counts[k] += addition(p, job);
    }
  }
}

#else

// Adds to the samples that the polygon is in front of.
void FillPolygon(const Polygon& p, const PolygonJob& job, const RowSpans& spans, int first,
                 int rows) {
  const F f;
  const FI fi;
  const int columns = ColumnsOfVector();
  const auto ga = static_cast<float>(p.g.a);
  const auto offset = hn::Mul(hn::Set(f, ga), hn::ConvertTo(f, hn::ShiftRight<2>(hn::Iota(fi, 0)))),
             step = hn::Set(f, ga * static_cast<float>(columns));
  const std::int32_t add = addition(p, job);
  for (int i = 0; i < rows; i += kQuadRows) {
    const ColumnRange range = RangeOfRows(spans, i);
    if (range.begin >= range.end) continue;
    HWY_ALIGN float start[kQuadRows];
    double most = 0;
    for (int k = 0; k < kQuadRows; ++k) {
      const double at =
          (p.g.c + p.g.b * (first + i + k + kPixelCentre)) + p.g.a * (range.begin + kPixelCentre);
      const double end = at + p.g.a * (range.end + columns - range.begin);
      most = std::max(most, std::max(std::fabs(at), std::fabs(end)));
      start[k] = static_cast<float>(at);
    }
    const auto error = hn::Set(f, static_cast<float>(comparison_error(p, job, most)));
    const std::size_t base =
        static_cast<std::size_t>((first + i - job.first_row) / kQuadRows) * job.stride;
    FillRows(spans, i, first + i, range, job.nearness + base, job.counts + base,
             hn::Add(hn::LoadDup128(f, start), offset), step, error, add,
             [&](int column, int row) { return job.exact->in_front(p, column, row); });
  }
}

#endif

void FillPolygons(const PolygonJob& job) {
  RowSpans spans;
  for (std::size_t n = 0; n < job.count; ++n) {
    const Polygon& p = job.polygons[job.selected[n]];
    const int from = std::max(job.first_row, p.first_row),
              to = std::min(job.first_row + job.rows, p.end_row);
    if (from >= to) continue;
    const int skip = (from - job.first_row) % kQuadRows;
    FindSpans(p, job, from - skip, skip, to - (from - skip), spans);
    FillPolygon(p, job, spans, from - skip, to - (from - skip));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon {

HWY_EXPORT(FillPolygons);

void fill_polygons(const PolygonJob& job) { HWY_DYNAMIC_DISPATCH(FillPolygons)(job); }

}  // namespace gnomon
#endif
