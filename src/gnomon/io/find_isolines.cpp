#include <gdal_alg.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

#include <gnomon/core/parallel.h>
#include <gnomon/io/gdal_support.h>
#include <gnomon/io/isolines.h>
#include <gnomon/io/write_geotiff.h>
#include <gnomon/profile/hour_classes.h>

namespace gnomon {
namespace {

constexpr double kKept = 0.75;    // samples: how far points left out may be from the line
constexpr double kNoMean = -1.0;  // where there is no sample

double squared_distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 ab = b - a, ap = p - a;
  const double length2 = ab.x * ab.x + ab.y * ab.y;
  const double t = length2 > 0 ? std::clamp((ap.x * ab.x + ap.y * ab.y) / length2, 0.0, 1.0) : 0.0;
  const double x = ap.x - t * ab.x, y = ap.y - t * ab.y;
  return x * x + y * y;
}

// Douglas and Peucker 1973.
std::vector<Vec2> simplified(const std::vector<Vec2>& line) {
  std::vector<std::uint8_t> keep(line.size(), 0);
  keep.front() = keep.back() = 1;
  std::vector<std::pair<std::size_t, std::size_t>> parts{{0, line.size() - 1}};
  while (!parts.empty()) {
    const auto [first, last] = parts.back();
    parts.pop_back();
    double farthest = kKept * kKept;
    std::size_t at = first;
    for (std::size_t k = first + 1; k < last; ++k) {
      const double d = squared_distance_to_segment(line[k], line[first], line[last]);
      if (d > farthest) {
        farthest = d;
        at = k;
      }
    }
    if (at == first) continue;
    keep[at] = 1;
    parts.emplace_back(first, at);
    parts.emplace_back(at, last);
  }
  std::vector<Vec2> out;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (keep[k] != 0) out.push_back(line[k]);
  }
  return out;
}

// Weighted sums along a row of samples: of those there are, and of those that reach the level.
struct RowSums {
  std::vector<std::uint8_t> is_there, is_reached;  // with a sample that is not on either side
  std::vector<int> there, reached;

  explicit RowSums(int width)
      : is_there(static_cast<std::size_t>(width) + 2, 0),
        is_reached(static_cast<std::size_t>(width) + 2, 0),
        there(static_cast<std::size_t>(width), 0),
        reached(static_cast<std::size_t>(width), 0) {}
};

void sum_row(const Profile& p, int row, std::uint32_t least_ticks, RowSums& out) {
  const std::size_t width = static_cast<std::size_t>(p.width);
  const bool inside = row >= 0 && row < p.height;
  const std::size_t begin = inside ? static_cast<std::size_t>(row) * width : 0;
  for (std::size_t x = 0; x < width; ++x) {
    const bool there = inside && p.valid[begin + x] != 0;
    out.is_there[x + 1] = there ? 1 : 0;
    out.is_reached[x + 1] = there && p.shadow_ticks[begin + x] >= least_ticks ? 1 : 0;
  }
  for (std::size_t x = 0; x < width; ++x) {
    out.there[x] = out.is_there[x] + 2 * out.is_there[x + 1] + out.is_there[x + 2];
    out.reached[x] = out.is_reached[x] + 2 * out.is_reached[x + 1] + out.is_reached[x + 2];
  }
}

struct Collector {
  std::vector<Isoline>* lines;
  const View* view;
  std::uint64_t level_ms;
};

CPLErr collect(double, int n, double* x, double* y, void* data) {
  const auto& to = *static_cast<Collector*>(data);
  std::vector<Vec2> line;
  for (int k = 0; k < n; ++k) line.emplace_back(x[k], y[k]);
  if (line.size() < 2) return CE_None;
  line = simplified(line);
  for (Vec2& p : line) {
    const Vec4 q = to.view->origin + p.x * to.view->right + p.y * to.view->down;
    p = {q.x, q.y};
  }
  to.lines->push_back({to.level_ms, std::move(line)});
  return CE_None;
}

struct DestroyGenerator {
  void operator()(void* generator) const { GDAL_CG_Destroy(generator); }
};

std::vector<Isoline> lines_at(const Profile& p, const View& view, std::uint64_t level_ms) {
  std::vector<Isoline> lines;
  Collector collector{&lines, &view, level_ms};
  // Means lie between 0 and 1: of the levels 1/2, 3/2, ... there is one.
  const std::unique_ptr<void, DestroyGenerator> generator(
      GDAL_CG_Create(p.width, p.height, TRUE, kNoMean, 1.0, 0.5, collect, &collector));
  RowSums above(p.width), here(p.width), below(p.width);
  const std::uint32_t least = least_ticks(p, level_ms);
  sum_row(p, -1, least, above);
  sum_row(p, 0, least, here);
  std::vector<double> means(static_cast<std::size_t>(p.width));
  for (int row = 0; row < p.height; ++row) {
    sum_row(p, row + 1, least, below);
    for (std::size_t x = 0; x < means.size(); ++x) {
      const std::size_t k = static_cast<std::size_t>(row) * means.size() + x;
      const int there = above.there[x] + 2 * here.there[x] + below.there[x];
      const int reached = above.reached[x] + 2 * here.reached[x] + below.reached[x];
      means[x] = p.valid[k] == 0 ? kNoMean : static_cast<double>(reached) / there;
    }
    GDAL_CG_FeedLine(generator.get(), means.data());
    std::swap(above, here);
    std::swap(here, below);
  }
  return lines;
}

}  // namespace

std::vector<Isoline> find_isolines(const Profile& profile, const View& plan, std::uint64_t step_ms,
                                   int threads) {
  assert(is_plan(plan) && profile.width == plan.width && profile.height == plan.height);
  assert(step_ms > 0);
  std::vector<std::vector<Isoline>> found(static_cast<std::size_t>(levels(profile, step_ms)));
  parallel_for(static_cast<int>(found.size()), threads, [&](int k) {
    const std::uint64_t level = step_ms * (static_cast<std::uint64_t>(k) + 1);
    found[static_cast<std::size_t>(k)] = lines_at(profile, plan, level);
  });
  std::vector<Isoline> lines;
  for (std::vector<Isoline>& level : found) {
    std::move(level.begin(), level.end(), std::back_inserter(lines));
  }
  return lines;
}

}  // namespace gnomon
