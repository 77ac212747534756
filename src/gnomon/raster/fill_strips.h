// The inner loop of the counter in a parallel view under a sun: strips of one light over some rows
// of the picture. Samples and counts of four rows lie interleaved: column 0 of rows 0, 1, 2, 3,
// then column 1, so that a vector is a block of some columns by four rows and thin strips fill it.
//
// Per strip the spans of all rows are found in float, then each block is tested in float; whatever
// lies within the error bounds is handed to the exact predicates. So the result is the exact one
// whatever the instruction set. docs/counting.md.
#pragma once

#include <cstddef>
#include <cstdint>

#include <gnomon/raster/polygon.h>
#include <gnomon/raster/strip.h>

namespace gnomon {

inline constexpr int kQuadRows = 4;  // interleaved

// Columns that may be read and rewritten beyond the end of a row.
inline constexpr int kQuadPadding = 64;

// From one group of four rows to the next, in values: whole lines of memory.
inline std::size_t quad_stride(int width) {
  return static_cast<std::size_t>((width + kQuadPadding + 15) & ~15) * kQuadRows;
}

// The exact decisions that the loop asks for.
class ExactStripDecisions {
 public:
  virtual ~ExactStripDecisions() = default;
  virtual Span span(const Strip& s, int row) = 0;
  // True if the strip is in front of the sample; false where there is no sample.
  virtual bool in_front(const Strip& s, int column, int row) = 0;
};

struct StripJob {
  const Strip* strips = nullptr;
  const std::uint32_t* selected = nullptr;  // indices into strips
  std::size_t count = 0;
  float slope = 0;  // of all strips' left and right ends, columns per row
  int first_row = 0, rows = 0;
  const float* nearness = nullptr;  // interleaved, `stride` apart, aligned as Highway's memory is
  std::int32_t* counts = nullptr;   // the same; added to
  std::size_t stride = 0;
  ExactStripDecisions* exact = nullptr;
};

inline constexpr int kStripRowsMax = 64;  // of a job

// Precondition: rows <= kStripRowsMax.
void fill_strips(const StripJob& job);

// Rows of nearness to groups of four; rows that are missing in the last group are set to infinity.
// `from` may be read to the end of its last row only.
void interleave_rows(const float* from, int width, int rows, float* to, std::size_t stride);

// Interleaved counts to rows of 0 and 1 (count > 0), `to_stride` apart, and to zero. Nothing is
// written behind the rows.
void take_mask(std::int32_t* counts, std::size_t stride, int width, int rows, std::uint8_t* to,
               std::ptrdiff_t to_stride);

// Adds interleaved counts to rows of counts, `to_stride` apart, and sets them to zero. Up to
// kQuadPadding values more are read and written behind each row.
void take_counts(std::int32_t* counts, std::size_t stride, int width, int rows, std::int32_t* to,
                 std::ptrdiff_t to_stride);

}  // namespace gnomon
