// The inner loop of the counter in a parallel view for what is no strip: sides of lamps, casters in
// front of receivers, sides that strips are not trusted with. Rows lie interleaved as for strips
// (fill_strips.h). Per polygon the spans of its rows are found in double, then each block of four
// rows by some columns is tested in float; whatever lies within the error bounds is handed to the
// exact predicates. docs/counting.md.
#pragma once

#include <cstddef>
#include <cstdint>

#include <gnomon/raster/polygon.h>

namespace gnomon {

// The exact decisions that the loop asks for.
class ExactPolygonDecisions {
 public:
  virtual ~ExactPolygonDecisions() = default;
  virtual Span span(const Polygon& p, int row) = 0;
  // True if the polygon is in front of the sample; false where there is no sample.
  virtual bool in_front(const Polygon& p, int column, int row) = 0;
};

struct PolygonJob {
  const Polygon* polygons = nullptr;
  const std::uint32_t* selected = nullptr;  // indices into polygons
  std::size_t count = 0;
  const std::int8_t* signs = nullptr;  // by id: what the polygon adds is multiplied by it, if given
  int first_row = 0, rows = 0, width = 0;
  const float* nearness = nullptr;  // interleaved, `stride` apart, aligned as Highway's memory is
  std::int32_t* counts = nullptr;   // the same; added to
  std::size_t stride = 0;
  double nearness_floor = 0;  // absolute error of nearness
  ExactPolygonDecisions* exact = nullptr;
};

// Precondition: rows <= kStripRowsMax.
void fill_polygons(const PolygonJob& job);

}  // namespace gnomon
