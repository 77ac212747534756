// The inner loop of the counter: polygons of one light over some rows of the picture.
//
// Per polygon and row the span of covered pixels is found in double, then each sample is tested
// against the polygon's nearness in float; whatever lies within the error bounds is handed to the
// exact predicates. So the result is the exact one whatever the instruction set; see
// docs/counting.md for the bounds.
#pragma once

#include <cstdint>

#include <gnomon/raster/polygon.h>

namespace gnomon {

// Relative error of the float comparison: nearness stored as float (2^-23), the polygon's as start
// + k * step in float (5 roundings of values up to twice the larger end, 2^-21), the subtraction
// (2^-24). Rounded up.
inline constexpr double kFloatCompare = 0x1p-20;

// The exact decisions that the loop asks for.
class ExactDecisions {
 public:
  virtual ~ExactDecisions() = default;
  virtual Span span(const Polygon& p, int row) = 0;
  // True if the polygon is in front of the sample; false where there is no sample.
  virtual bool in_front(const Polygon& p, int column, int row) = 0;
};

struct BandJob {
  const Polygon* polygons = nullptr;
  const std::uint32_t* selected = nullptr;  // indices into polygons
  std::size_t count = 0;
  int first_row = 0, rows = 0, width = 0;
  const float* nearness =
      nullptr;  // of the rows; kPadding more may be read at the end (their values do not matter)
  int nearness_stride = 0;
  std::int32_t* counts = nullptr;  // of the rows, added to; kPadding more after each row
  int stride = 0;                  // of counts; at least width + kPadding
  double least_nearness = 0;       // of the band's samples; infinity: there are none
  double nearness_floor = 0;       // absolute error of nearness
  ExactDecisions* exact = nullptr;
};

inline constexpr int kBandRowsMax = 64;
inline constexpr int kPadding =
    64;  // samples that may be read and rewritten beyond the end of a row

void fill_band(const BandJob& job);

}  // namespace gnomon
