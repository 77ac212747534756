// The box nearest to a point, of many, seen from above.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <gnomon/view/view.h>

namespace gnomon {

// Boxes are numbered in the order given; they may overlap, and be empty of area, but x0 <= x1,
// y0 <= y1 and all are finite. A grid with about a box in each cell: a question takes about as long
// whatever the number of boxes is, where they are spread as buildings are.
class BoxFinder {
 public:
  explicit BoxFinder(std::vector<Bounds2> boxes);

  // The box that is nearest to (x, y), distance 0 inside of it; of equally near ones the lowest
  // number. Only those that `accepts` count; without it all. Nothing where there is none.
  std::optional<std::size_t> nearest(double x, double y,
                                     const std::function<bool(std::size_t)>& accepts = {}) const;

 private:
  std::vector<std::uint32_t>& cell(int column, int row) {
    return cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(column)];
  }
  int column_of(double x) const;
  int row_of(double y) const;

  std::vector<Bounds2> boxes_;
  std::vector<std::vector<std::uint32_t>> cells_;
  std::vector<std::uint32_t> large_;  // these lie in too many cells
  Bounds2 all_{0, 0, 0, 0};
  double size_ = 1;  // of a cell
  int columns_ = 1, rows_ = 1;
};

}  // namespace gnomon
