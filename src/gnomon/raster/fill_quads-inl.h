// What strips and polygons share when they are filled (fill_strips.cpp, fill_polygons.cpp): blocks
// of four rows by some columns, and the samples in them that float cannot decide. Compiled once for
// each instruction set, so it is included after foreach_target.h and has no include guard but
// Highway's.
#if defined(GNOMON_RASTER_FILL_QUADS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_FILL_QUADS_INL_H_
#undef GNOMON_RASTER_FILL_QUADS_INL_H_
#else
#define GNOMON_RASTER_FILL_QUADS_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <gnomon/raster/fill_strips.h>

HWY_BEFORE_NAMESPACE();
namespace gnomon {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kLanesMax = 16;
using F = hn::CappedTag<float, kLanesMax>;
using FI = hn::Rebind<std::int32_t, F>;
using FU = hn::Rebind<std::uint32_t, F>;

// The widest reading of each row's span, in columns of the picture; empty rows begin at kNoBegin,
// end at 0 and have no width.
constexpr std::int32_t kNoBegin = 0x3fffffff;
struct RowSpans {
  HWY_ALIGN std::int32_t begin[kStripRowsMax + kLanesMax];
  HWY_ALIGN std::int32_t end[kStripRowsMax + kLanesMax];
  HWY_ALIGN std::int32_t width[kStripRowsMax + kLanesMax];
};

// Row i of the spans is no wider than `exact`, which was asked for.
HWY_INLINE void Narrow(RowSpans& spans, int i, const Span& exact) {
  const std::int32_t from = std::max(spans.begin[i], exact.begin),
                     to = std::min(spans.end[i], exact.end);
  const bool empty = from >= to;
  spans.begin[i] = empty ? kNoBegin : from;
  spans.end[i] = empty ? 0 : to;
  spans.width[i] = empty ? 0 : to - from;
}

#if HWY_TARGET != HWY_SCALAR

// Columns of a vector, which holds four rows of each.
HWY_INLINE int ColumnsOfVector() { return static_cast<int>(hn::Lanes(F())) / kQuadRows; }

struct ColumnRange {
  int begin, end;  // begin: a multiple of a vector's columns
};
// What four rows from row i reach over; empty: begin >= end.
HWY_INLINE ColumnRange RangeOfRows(const RowSpans& spans, int i) {
  const std::int32_t *b = spans.begin + i, *e = spans.end + i;
  return {std::min(std::min(b[0], b[1]), std::min(b[2], b[3])) & -ColumnsOfVector(),
          std::max(std::max(e[0], e[1]), std::max(e[2], e[3]))};
}

// Corrects the samples of a vector that are too close for float: of `close`, where `front` is what
// float said. in_front(column, row): the exact answer.
template <class M, class InFront>
HWY_NOINLINE void DecideClose(M close, M front, int column, int row, std::int32_t add,
                              std::int32_t* counts, const InFront& in_front) {
  const F f;
  HWY_ALIGN float is_close[kLanesMax], is_front[kLanesMax];
  hn::StoreU(hn::IfThenElseZero(close, hn::Set(f, 1.0f)), f, is_close);
  hn::StoreU(hn::IfThenElseZero(front, hn::Set(f, 1.0f)), f, is_front);
  for (int lane = 0; lane < static_cast<int>(hn::Lanes(f)); ++lane) {
    if (is_close[lane] == 0) continue;
    const bool exact = in_front(column + lane / kQuadRows, row + lane % kQuadRows),
               guess = is_front[lane] != 0;
    if (exact != guess) counts[lane] += exact ? add : -add;
  }
}

// Four rows, the first of which is row i of the spans and `row` of the picture. `nearness` and
// `counts`: of their columns from 0. `at`: nearness of the face at the vector's samples that begins
// at range.begin; `step`: from one vector to the next; `error`: of the comparison.
template <class V, class InFront>
HWY_INLINE void FillRows(const RowSpans& spans, int i, int row, ColumnRange range,
                         const float* nearness, std::int32_t* counts, V at, V step, V error,
                         std::int32_t add, const InFront& in_front) {
  const F f;
  const FI fi;
  const FU fu;
  const int columns = ColumnsOfVector();
  const auto lane_column = hn::ShiftRight<2>(hn::Iota(fi, 0));
  const auto added = hn::Set(fi, add);
  const auto width = hn::BitCast(fu, hn::LoadDup128(fi, spans.width + i));
  auto within =
      hn::Sub(hn::Add(hn::Set(fi, range.begin), lane_column), hn::LoadDup128(fi, spans.begin + i));
  auto vectors = hn::Zero(f);
  for (int x = range.begin; x < range.end; x += columns) {
    const std::size_t k = static_cast<std::size_t>(x) * kQuadRows;
    const auto valid = hn::RebindMask(f, hn::Lt(hn::BitCast(fu, within), width));
    const auto difference = hn::Sub(hn::Add(at, hn::Mul(vectors, step)), hn::Load(f, nearness + k));
    const auto front = hn::And(valid, hn::Gt(difference, error));
    const auto close = hn::AndNot(hn::Gt(hn::Abs(difference), error), valid);  // NaN: close
    hn::Store(
        hn::Add(hn::Load(fi, counts + k), hn::IfThenElseZero(hn::RebindMask(fi, front), added)), fi,
        counts + k);
    if (HWY_UNLIKELY(!hn::AllFalse(f, close)))
      DecideClose(close, front, x, row, add, counts + k, in_front);
    within = hn::Add(within, hn::Set(fi, columns));
    vectors = hn::Add(vectors, hn::Set(f, 1.0f));
  }
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace gnomon
HWY_AFTER_NAMESPACE();

#endif  // toggle
