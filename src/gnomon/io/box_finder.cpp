#include <gnomon/io/box_finder.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gnomon {
namespace {

// A box in more cells than this is looked at for every question instead.
constexpr int kMostCells = 64;
constexpr int kLongestSide = 4096;  // cells of the grid along a side

double distance2(const Bounds2& b, double x, double y) {
  const double dx = std::max({b.x0 - x, 0.0, x - b.x1}), dy = std::max({b.y0 - y, 0.0, y - b.y1});
  return dx * dx + dy * dy;
}

}  // namespace

int BoxFinder::column_of(double x) const {
  return static_cast<int>(std::clamp(std::floor((x - all_.x0) / size_), 0.0, columns_ - 1.0));
}
int BoxFinder::row_of(double y) const {
  return static_cast<int>(std::clamp(std::floor((y - all_.y0) / size_), 0.0, rows_ - 1.0));
}

BoxFinder::BoxFinder(std::vector<Bounds2> boxes) : boxes_(std::move(boxes)) {
  if (boxes_.empty()) return;
  all_ = boxes_[0];
  for (const Bounds2& b : boxes_) {
    all_ = {std::min(all_.x0, b.x0), std::min(all_.y0, b.y0), std::max(all_.x1, b.x1),
            std::max(all_.y1, b.y1)};
  }
  const double width = all_.x1 - all_.x0, height = all_.y1 - all_.y0;
  size_ = std::max({std::sqrt(width * height / static_cast<double>(boxes_.size())),
                    width / kLongestSide, height / kLongestSide});
  if (!(size_ > 0)) size_ = 1;
  columns_ = static_cast<int>(width / size_) + 1;
  rows_ = static_cast<int>(height / size_) + 1;
  cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::uint32_t k = 0; k < boxes_.size(); ++k) {
    const Bounds2& b = boxes_[k];
    const int i0 = column_of(b.x0), i1 = column_of(b.x1), j0 = row_of(b.y0), j1 = row_of(b.y1);
    if ((i1 - i0 + 1.0) * (j1 - j0 + 1.0) > kMostCells) {
      large_.push_back(k);
      continue;
    }
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i) cell(i, j).push_back(k);
    }
  }
}

std::optional<std::size_t> BoxFinder::nearest(
    double x, double y, const std::function<bool(std::size_t)>& accepts) const {
  std::optional<std::size_t> found;
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](std::uint32_t k) {
    const double d = distance2(boxes_[k], x, y);
    if (d > least || (d == least && found && *found <= k)) return;
    if (accepts && !accepts(k)) return;
    least = d;
    found = k;
  };
  for (const std::uint32_t k : large_) look(k);
  // Rings of cells around that of the point, or the one nearest to it, until all of a ring is
  // farther away than what was found: r rings on, at least (r - 1) cells.
  const int column = column_of(x), row = row_of(y);
  for (int r = 0; r <= std::max(columns_, rows_); ++r) {
    const double reach = (r - 1) * size_;
    if (reach > 0 && reach * reach > least) break;
    for (int j = std::max(0, row - r); j <= std::min(rows_ - 1, row + r); ++j) {
      const bool whole = j == row - r || j == row + r;
      for (int i = column - r; i <= column + r; i += whole || r == 0 ? 1 : 2 * r) {
        if (i < 0 || i >= columns_ || cells_.empty()) continue;
        for (const std::uint32_t k :
             cells_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(i)]) {
          look(k);
        }
      }
    }
  }
  return found;
}

}  // namespace gnomon
