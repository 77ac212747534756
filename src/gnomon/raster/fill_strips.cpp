#include <gnomon/raster/fill_strips.h>

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gnomon/raster/fill_strips.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <gnomon/raster/fill_quads-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gnomon {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kAhead = 8;  // strips are fetched before they are filled

// Rows [first, first + rows) of which `skip` are of other strips; first is a multiple of four.
HWY_INLINE void FindStripSpans(const Strip& s, const StripJob& job, int first, int skip, int rows,
                               RowSpans& out) {
  const F f;
  const FI fi;
  const int lanes = static_cast<int>(hn::Lanes(f));
  const auto one = hn::Set(f, 1.0f), slack = hn::Set(f, s.slack);
  const auto below = hn::Set(f, -0x1p30f), above = hn::Set(f, 0x1p30f);
  const auto left = hn::Set(f, s.left), right = hn::Set(f, s.right), slope = hn::Set(f, job.slope);
  const auto edge = hn::Set(f, s.edge), edge_step = hn::Set(f, s.edge_step);
  const auto cut = hn::Set(f, s.cut), cut_step = hn::Set(f, s.cut_step);
  const auto kinds = hn::Set(fi, s.kinds);
  const auto is = [&](Strip::Kinds k)
                      HWY_ATTR { return hn::RebindMask(f, hn::TestBit(kinds, hn::Set(fi, k))); };
  const auto edge_lower = is(Strip::kEdgeLower), edge_upper = is(Strip::kEdgeUpper);
  const auto cut_lower = is(Strip::kCutLower), cut_upper = is(Strip::kCutUpper);
  const auto least = hn::Set(f, s.begin), most = hn::Set(f, s.end);
  const auto column = hn::Set(fi, s.column), none = hn::Zero(fi), lane = hn::Iota(fi, 0);
  const int reference = reference_row(s);
  for (int i = 0; i < rows; i += lanes) {
    const auto row = hn::Add(lane, hn::Set(fi, i));
    const auto y = hn::ConvertTo(f, hn::Add(row, hn::Set(fi, first - reference)));
    const auto sweep = hn::Mul(slope, y);
    const auto line = hn::Add(edge, hn::Mul(edge_step, y));
    const auto deepest = hn::Floor(hn::Add(hn::Add(cut, hn::Mul(cut_step, y)), one));
    const auto lower =
        hn::Add(hn::Max(hn::Add(left, sweep), hn::IfThenElse(edge_lower, line, below)), one);
    const auto upper =
        hn::Add(hn::Min(hn::Add(right, sweep), hn::IfThenElse(edge_upper, line, above)), one);
    auto begin = hn::Floor(hn::Sub(lower, slack)), end = hn::Floor(hn::Add(upper, slack));
    const auto begin_high = hn::Floor(hn::Add(lower, slack)),
               end_low = hn::Floor(hn::Sub(upper, slack));
    begin = hn::Max(begin, hn::IfThenElse(cut_lower, deepest, least));
    end = hn::Min(end, hn::IfThenElse(cut_upper, deepest, most));
    begin = hn::Max(begin, least);
    end = hn::Min(end, most);
    const auto here =
        hn::And(hn::And(hn::Gt(row, hn::Set(fi, skip - 1)), hn::Lt(row, hn::Set(fi, rows))),
                hn::RebindMask(fi, hn::Lt(begin, end)));
    const auto unsure =
        hn::And(hn::RebindMask(f, here), hn::Or(hn::Gt(begin_high, begin), hn::Lt(end_low, end)));
    // Of rows that are empty only differences matter, which overflow in no case.
    const auto b =
        hn::IfThenElse(here, hn::Add(hn::ConvertTo(fi, begin), column), hn::Set(fi, kNoBegin));
    const auto e = hn::IfThenElse(here, hn::Add(hn::ConvertTo(fi, end), column), none);
    hn::Store(b, fi, out.begin + i);
    hn::Store(e, fi, out.end + i);
    hn::Store(hn::IfThenElse(here, hn::Sub(e, b), none), fi, out.width + i);
    if (HWY_UNLIKELY(!hn::AllFalse(f, unsure))) {
      HWY_ALIGN float flag[kLanesMax];
      hn::Store(hn::IfThenElseZero(unsure, one), f, flag);
      for (int k = 0; k < lanes; ++k) {
        if (flag[k] == 0) continue;
        Narrow(out, i + k, job.exact->span(s, first + i + k));
      }
    }
  }
}

#if HWY_TARGET == HWY_SCALAR

void FillStrips(const StripJob& job) {
  RowSpans spans;
  for (std::size_t n = 0; n < job.count; ++n) {
    const Strip& s = job.strips[job.selected[n]];
    if (n + kAhead < job.count) hwy::Prefetch(&job.strips[job.selected[n + kAhead]]);
    const int from = std::max<int>(job.first_row, s.first_row),
              to = std::min<int>(job.first_row + job.rows, s.first_row + s.rows);
    if (from >= to) continue;
    FindStripSpans(s, job, from, 0, to - from, spans);
    for (int row = from; row < to; ++row) {
      const int i = row - job.first_row;
      const std::size_t base = static_cast<std::size_t>(i / kQuadRows) * job.stride +
                               static_cast<std::size_t>(i % kQuadRows);
      const float at_row = s.g + s.gb * static_cast<float>(row - reference_row(s));
      for (int x = spans.begin[row - from]; x < spans.end[row - from]; ++x) {
        const std::size_t k = base + static_cast<std::size_t>(x) * kQuadRows;
        const float difference = at_row + s.ga * static_cast<float>(x - s.column) - job.nearness[k];
        const bool close = !(std::fabs(difference) > s.error);
        if (close ? job.exact->in_front(s, x, row) : difference > 0) job.counts[k] += s.add;
      }
    }
  }
}

#else

// Adds s.add to the samples that the strip is in front of.
HWY_INLINE void FillStrip(const Strip& s, const StripJob& job, const RowSpans& spans, int first,
                          int rows) {
  const F f;
  const FI fi;
  const auto lane = hn::Iota(fi, 0);
  const auto lane_column = hn::ShiftRight<2>(lane), lane_row = hn::And(lane, hn::Set(fi, 3));
  const auto offset = hn::Add(hn::Mul(hn::Set(f, s.ga), hn::ConvertTo(f, lane_column)),
                              hn::Mul(hn::Set(f, s.gb), hn::ConvertTo(f, lane_row)));
  const auto step = hn::Set(f, s.ga * static_cast<float>(ColumnsOfVector())),
             error = hn::Set(f, s.error);
  const int reference = reference_row(s);
  for (int i = 0; i < rows; i += kQuadRows) {
    const ColumnRange range = RangeOfRows(spans, i);
    if (range.begin >= range.end) continue;
    const std::size_t base =
        static_cast<std::size_t>((first + i - job.first_row) / kQuadRows) * job.stride;
    const auto at = hn::Add(hn::Set(f, (s.g + s.gb * static_cast<float>(first + i - reference)) +
                                           s.ga * static_cast<float>(range.begin - s.column)),
                            offset);
    FillRows(spans, i, first + i, range, job.nearness + base, job.counts + base, at, step, error,
             s.add, [&](int column, int row) { return job.exact->in_front(s, column, row); });
  }
}

void FillStrips(const StripJob& job) {
  RowSpans spans;
  for (std::size_t n = 0; n < job.count; ++n) {
    const Strip& s = job.strips[job.selected[n]];
    if (n + kAhead < job.count) hwy::Prefetch(&job.strips[job.selected[n + kAhead]]);
    const int from = std::max<int>(job.first_row, s.first_row),
              to = std::min<int>(job.first_row + job.rows, s.first_row + s.rows);
    if (from >= to) continue;
    const int skip = (from - job.first_row) % kQuadRows;
    FindStripSpans(s, job, from - skip, skip, to - (from - skip), spans);
    FillStrip(s, job, spans, from - skip, to - (from - skip));
  }
}

#endif

void InterleaveRows(const float* from, int width, int rows, float* to, std::size_t stride) {
  const F f;
  const int lanes = static_cast<int>(hn::Lanes(f));
  const auto none = hn::Set(f, std::numeric_limits<float>::infinity());
  for (int row = 0; row < rows; row += kQuadRows, to += stride) {
    const float* r = from + static_cast<std::ptrdiff_t>(row) * width;
    const int n = std::min(kQuadRows, rows - row);
    int x = 0;
    for (; x + lanes <= width; x += lanes) {
      hn::StoreInterleaved4(
          hn::LoadU(f, r + x), n > 1 ? hn::LoadU(f, r + width + x) : none,
          n > 2 ? hn::LoadU(f, r + 2 * static_cast<std::ptrdiff_t>(width) + x) : none,
          n > 3 ? hn::LoadU(f, r + 3 * static_cast<std::ptrdiff_t>(width) + x) : none, f,
          to + static_cast<std::ptrdiff_t>(x) * kQuadRows);
    }
    for (; x < width; ++x) {
      for (int k = 0; k < kQuadRows; ++k) {
        to[static_cast<std::ptrdiff_t>(x) * kQuadRows + k] =
            k < n ? r[static_cast<std::ptrdiff_t>(k) * width + x]
                  : std::numeric_limits<float>::infinity();
      }
    }
  }
}

template <class Take>
HWY_INLINE void TakeRows(std::int32_t* counts, std::size_t stride, int width, int rows, Take take) {
  const FI fi;
  const int lanes = static_cast<int>(hn::Lanes(fi));
  for (int row = 0; row < rows; row += kQuadRows, counts += stride) {
    for (int x = 0; x < width; x += lanes) {
      std::int32_t* c = counts + static_cast<std::ptrdiff_t>(x) * kQuadRows;
      hn::Vec<FI> v0, v1, v2, v3;
      hn::LoadInterleaved4(fi, c, v0, v1, v2, v3);
      for (int k = 0; k < kQuadRows; ++k) hn::StoreU(hn::Zero(fi), fi, c + k * lanes);
      take(v0, row, x);
      if (row + 1 < rows) take(v1, row + 1, x);
      if (row + 2 < rows) take(v2, row + 2, x);
      if (row + 3 < rows) take(v3, row + 3, x);
    }
  }
}

void TakeMask(std::int32_t* counts, std::size_t stride, int width, int rows, std::uint8_t* to,
              std::ptrdiff_t to_stride) {
  const hn::Rebind<std::uint8_t, FI> bytes;
  const int lanes = static_cast<int>(hn::Lanes(bytes));
  TakeRows(counts, stride, width, rows, [&](auto v, int row, int x) HWY_ATTR {
    const auto shadow = hn::Min(hn::DemoteTo(bytes, v), hn::Set(bytes, 1));
    std::uint8_t* t = to + row * to_stride + x;
    if (HWY_LIKELY(x + lanes <= width)) {
      hn::StoreU(shadow, bytes, t);
    } else {
      HWY_ALIGN std::uint8_t last[kLanesMax];
      hn::Store(shadow, bytes, last);
      std::copy_n(last, width - x, t);
    }
  });
}

void TakeCounts(std::int32_t* counts, std::size_t stride, int width, int rows, std::int32_t* to,
                std::ptrdiff_t to_stride) {
  const FI fi;
  TakeRows(counts, stride, width, rows, [&](auto v, int row, int x) HWY_ATTR {
    std::int32_t* t = to + row * to_stride + x;
    hn::StoreU(hn::Add(hn::LoadU(fi, t), v), fi, t);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon {

HWY_EXPORT(FillStrips);
HWY_EXPORT(InterleaveRows);
HWY_EXPORT(TakeMask);
HWY_EXPORT(TakeCounts);

void fill_strips(const StripJob& job) { HWY_DYNAMIC_DISPATCH(FillStrips)(job); }

void interleave_rows(const float* from, int width, int rows, float* to, std::size_t stride) {
  HWY_DYNAMIC_DISPATCH(InterleaveRows)(from, width, rows, to, stride);
}

void take_mask(std::int32_t* counts, std::size_t stride, int width, int rows, std::uint8_t* to,
               std::ptrdiff_t to_stride) {
  HWY_DYNAMIC_DISPATCH(TakeMask)(counts, stride, width, rows, to, to_stride);
}

void take_counts(std::int32_t* counts, std::size_t stride, int width, int rows, std::int32_t* to,
                 std::ptrdiff_t to_stride) {
  HWY_DYNAMIC_DISPATCH(TakeCounts)(counts, stride, width, rows, to, to_stride);
}

}  // namespace gnomon
#endif
