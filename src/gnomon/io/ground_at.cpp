// A uniform grid over the triangles' boxes; the triangles of one cell are tested one by one.
#include <gnomon/io/ground_at.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

#include <gnomon/io/footprints.h>

namespace gnomon {
namespace {

using Points = std::array<Vec3, 3>;

// A grid as fine as this many cells a triangle finds about as many triangles in a cell as there are
// around a place of a terrain.
constexpr double kCellsPerTriangle = 1.0;
// Entries a triangle, at most: where large triangles lie among small ones the grid is made coarser.
constexpr std::uint64_t kEntriesPerTriangle = 16, kFreeEntries = 1 << 20;

struct Grid {
  std::vector<Points> triangles;
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // the box of all
  double cells_per_x = 0, cells_per_y = 0;
  std::uint32_t columns = 1, rows = 1;
  std::vector<std::uint64_t> first;    // of cell k: entries first[k] .. first[k + 1]
  std::vector<std::uint32_t> entries;  // indices into triangles

  // Rounded, but never falling with x: a triangle's cells hold those of all places in it.
  std::uint32_t column(double x) const { return cell((x - x0) * cells_per_x, columns); }
  std::uint32_t row(double y) const { return cell((y - y0) * cells_per_y, rows); }

  static std::uint32_t cell(double at, std::uint32_t n) {
    return at >= n ? n - 1 : at > 0 ? static_cast<std::uint32_t>(at) : 0;
  }
};

struct Cells {
  std::uint32_t column0, column1, row0, row1;  // both ends included
};

Cells cells_of(const Grid& grid, const Points& t) {
  const auto [left, right] = std::minmax({t[0].x, t[1].x, t[2].x});
  const auto [low, high] = std::minmax({t[0].y, t[1].y, t[2].y});
  return {grid.column(left), grid.column(right), grid.row(low), grid.row(high)};
}

void set_cells(Grid& grid, double size) {
  const auto split = [&](double extent, std::uint32_t& n, double& per_unit) {
    n = static_cast<std::uint32_t>(std::clamp(std::ceil(extent / size), 1.0, 65536.0));
    per_unit = n / extent;
  };
  split(grid.x1 - grid.x0, grid.columns, grid.cells_per_x);
  split(grid.y1 - grid.y0, grid.rows, grid.cells_per_y);
}

std::uint64_t entries_of(const Grid& grid) {
  std::uint64_t n = 0;
  for (const Points& t : grid.triangles) {
    const Cells c = cells_of(grid, t);
    n += std::uint64_t{c.column1 - c.column0 + 1} * (c.row1 - c.row0 + 1);
  }
  return n;
}

void fill(Grid& grid) {
  const auto each_cell = [&](const Points& t, const auto& visit) {
    const Cells c = cells_of(grid, t);
    for (std::uint32_t row = c.row0; row <= c.row1; ++row) {
      for (std::uint32_t column = c.column0; column <= c.column1; ++column) {
        visit(std::size_t{row} * grid.columns + column);
      }
    }
  };
  grid.first.assign(std::size_t{grid.columns} * grid.rows + 1, 0);
  for (const Points& t : grid.triangles) {
    each_cell(t, [&](std::size_t k) { ++grid.first[k + 1]; });
  }
  for (std::size_t k = 1; k < grid.first.size(); ++k) grid.first[k] += grid.first[k - 1];
  grid.entries.resize(grid.first.back());
  std::vector<std::uint64_t> at(grid.first.begin(), grid.first.end() - 1);
  for (std::size_t t = 0; t < grid.triangles.size(); ++t) {
    each_cell(grid.triangles[t],
              [&](std::size_t k) { grid.entries[at[k]++] = static_cast<std::uint32_t>(t); });
  }
}

bool inside(const Points& t, const Vec3& p) {
  const int a = turn(t[0], t[1], p), b = turn(t[1], t[2], p);
  if (a * b < 0) return false;
  const int c = turn(t[2], t[0], p);
  return a * c >= 0 && b * c >= 0;
}

double cross(double ax, double ay, double bx, double by) { return ax * by - ay * bx; }

// Precondition: p is inside.
double height(const Points& t, const Vec3& p) {
  for (const Vec3& v : t) {
    if (v.x == p.x && v.y == p.y) return v.z;
  }
  const Vec3 b = t[1] - t[0], c = t[2] - t[0], q = p - t[0];
  const auto [low, high] = std::minmax({t[0].z, t[1].z, t[2].z});
  const double area = cross(b.x, b.y, c.x, c.y);
  if (area == 0) return high;  // a sliver thinner than double resolves
  const double z =
      t[0].z + (b.z * cross(q.x, q.y, c.x, c.y) + c.z * cross(b.x, b.y, q.x, q.y)) / area;
  return std::clamp(z, low, high);
}

std::optional<double> highest(const Grid& grid, double x, double y) {
  if (!(x >= grid.x0 && x <= grid.x1 && y >= grid.y0 && y <= grid.y1)) return {};
  const Vec3 p(x, y, 0);
  const std::size_t cell = std::size_t{grid.row(y)} * grid.columns + grid.column(x);
  std::optional<double> found;
  for (std::uint64_t k = grid.first[cell]; k < grid.first[cell + 1]; ++k) {
    const Points& t = grid.triangles[grid.entries[k]];
    if (found && std::max({t[0].z, t[1].z, t[2].z}) <= *found) continue;
    if (!inside(t, p)) continue;
    const double z = height(t, p);
    if (!found || z > *found) found = z;
  }
  return found;
}

}  // namespace

GroundAt ground_at(std::vector<std::array<Vec3, 3>> triangles) {
  auto grid = std::make_shared<Grid>();
  std::erase_if(triangles, [](const Points& t) { return turn(t[0], t[1], t[2]) == 0; });
  grid->triangles = std::move(triangles);
  if (grid->triangles.empty()) {
    return [](double, double) { return std::optional<double>(); };
  }
  grid->x0 = grid->y0 = std::numeric_limits<double>::infinity();
  grid->x1 = grid->y1 = -grid->x0;
  for (const Points& t : grid->triangles) {
    for (const Vec3& p : t) {
      grid->x0 = std::min(grid->x0, p.x), grid->x1 = std::max(grid->x1, p.x);
      grid->y0 = std::min(grid->y0, p.y), grid->y1 = std::max(grid->y1, p.y);
    }
  }
  const double count = static_cast<double>(grid->triangles.size());
  const double width = grid->x1 - grid->x0, depth = grid->y1 - grid->y0;
  // Not finer than one strip would need, where the surface is long and narrow.
  double size = std::max(std::sqrt(width / (kCellsPerTriangle * count) * depth),
                         std::max(width, depth) / (kCellsPerTriangle * count));
  const std::uint64_t most = kEntriesPerTriangle * grid->triangles.size() + kFreeEntries;
  set_cells(*grid, size);
  while (entries_of(*grid) > most && (grid->columns > 1 || grid->rows > 1)) {
    size *= 2;
    set_cells(*grid, size);
  }
  fill(*grid);
  return [grid = std::shared_ptr<const Grid>(std::move(grid))](double x, double y) {
    return highest(*grid, x, y);
  };
}

}  // namespace gnomon
