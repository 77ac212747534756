#include <gnomon/raster/least_cells.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gnomon/core/approx.h>
#include <gnomon/core/parallel.h>
#include <gnomon/raster/screen_space.h>

namespace gnomon {
namespace {

constexpr int kSide = 1 << kCellShift;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Of a vertex in a parallel view.
double error_of_nearness(const Scene& scene, const ScreenSpace& space) {
  Vec4 largest(0, 0, 0, 1);
  for (const Vec3& p : scene.mesh.positions) {
    for (int k = 0; k < 3; ++k) largest[k] = std::max(largest[k], std::fabs(p[k]));
  }
  return project_bound(space, largest).z.error;
}

}  // namespace

LeastCells least_cells(const Scene& scene, const Receivers& r, int threads) {
  LeastCells out;
  out.width = r.view.width;
  out.height = r.view.height;
  const bool parallel = is_parallel(r.view);
  const ScreenSpace space = screen_space(r.view);
  const double error = parallel ? error_of_nearness(scene, space) : 0;
  const auto least_of = [&](std::uint32_t triangle) {
    if (!parallel) return 0.0;
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t v : scene.mesh.triangles[triangle])
      least = std::min(least, project(space, point(scene.mesh.positions[v])).z - error);
    return least;
  };
  LeastCells::Level first{
      (out.width + kSide - 1) >> kCellShift, (out.height + kSide - 1) >> kCellShift, {}};
  first.least.resize(static_cast<std::size_t>(first.width) *
                     static_cast<std::size_t>(first.height));
  const std::size_t width = static_cast<std::size_t>(out.width);
  parallel_for(first.height, threads, [&](int row) {
    const int y0 = row << kCellShift, y1 = std::min(out.height, y0 + kSide);
    for (int cell = 0; cell < first.width; ++cell) {
      const int x0 = cell << kCellShift, n = std::min(out.width - x0, kSide);
      std::array<float, kSide> least;
      std::array<std::uint32_t, kSide> unknown{};
      least.fill(kInfinity);
      const auto see = [&](int y, int columns) {
        const float* from = r.nearness.data() + static_cast<std::size_t>(y) * width + x0;
        for (int x = 0; x < columns; ++x) {
          least[x] = from[x] < least[x] ? from[x] : least[x];  // false for NaN
          unknown[x] |= from[x] != from[x] ? 1U : 0U;
        }
      };
      for (int y = y0; y < y1; ++y) {
        if (n == kSide) {
          see(y, kSide);
        } else {
          see(y, n);
        }
      }
      const double stored = static_cast<double>(*std::min_element(least.begin(), least.end()));
      double bound = stored - std::fabs(stored) * kNearnessRounding - r.nearness_floor;
      if (std::isinf(stored)) bound = stored;
      if (std::find(unknown.begin(), unknown.end(), 1U) != unknown.end()) {
        for (int y = y0; y < y1; ++y) {
          for (int x = x0; x < x0 + n; ++x) {
            const std::size_t k = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
            if (std::isnan(r.nearness[k])) bound = std::min(bound, least_of(r.triangle[k]));
          }
        }
      }
      first.least[static_cast<std::size_t>(row) * static_cast<std::size_t>(first.width) +
                  static_cast<std::size_t>(cell)] = rounded_down(bound);
    }
  });
  out.levels.push_back(std::move(first));
  while (out.levels.back().width > 1 || out.levels.back().height > 1) {
    const LeastCells::Level& below = out.levels.back();
    LeastCells::Level above{(below.width + 1) / 2, (below.height + 1) / 2, {}};
    above.least.assign(
        static_cast<std::size_t>(above.width) * static_cast<std::size_t>(above.height), kInfinity);
    for (int y = 0; y < below.height; ++y) {
      for (int x = 0; x < below.width; ++x) {
        float& least =
            above.least[static_cast<std::size_t>(y / 2) * static_cast<std::size_t>(above.width) +
                        static_cast<std::size_t>(x / 2)];
        least = std::min(
            least, below.least[static_cast<std::size_t>(y) * static_cast<std::size_t>(below.width) +
                               static_cast<std::size_t>(x)]);
      }
    }
    out.levels.push_back(std::move(above));
  }
  return out;
}

double least_under(const LeastCells& cells, int x0, int x1, int y0, int y1) {
  x0 = std::clamp(x0, 0, cells.width - 1) >> kCellShift;
  x1 = std::clamp(x1, 0, cells.width - 1) >> kCellShift;
  y0 = std::clamp(y0, 0, cells.height - 1) >> kCellShift;
  y1 = std::clamp(y1, 0, cells.height - 1) >> kCellShift;
  std::size_t level = 0;
  while (x1 - x0 > 3 || y1 - y0 > 3) {
    x0 >>= 1;
    x1 >>= 1;
    y0 >>= 1;
    y1 >>= 1;
    ++level;
  }
  const LeastCells::Level& l = cells.levels[level];
  float least = kInfinity;
  for (int y = y0; y <= y1; ++y) {
    const float* row = l.least.data() + static_cast<std::ptrdiff_t>(y) * l.width;
    for (int x = x0; x <= x1; ++x) least = std::min(least, row[x]);
  }
  return static_cast<double>(least);
}

}  // namespace gnomon
