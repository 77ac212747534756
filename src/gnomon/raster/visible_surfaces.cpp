#include <gnomon/raster/visible_surfaces.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <gnomon/core/parallel.h>
#include <gnomon/raster/least_cells.h>
#include <gnomon/raster/nearness_tiles.h>
#include <gnomon/raster/polygon.h>

namespace gnomon {
namespace {

constexpr int kBandRows = 16;
// Receivers::nearness: what a float may be off by, relative, beyond its own rounding; and the floor
// under it, as a share of the nearest sample's nearness. Pixel coordinates cancel in the plane of a
// small triangle, which leaves errors of double near 2^-30 of the largest nearness; a tenth of a
// micrometre in a plan of a city. What is worse is decided exactly.
constexpr double kFloatShare = 0x1p-26;
constexpr double kFloorShare = 0x1p-28;
constexpr double kSmallestFloat = std::numeric_limits<float>::min();  // below it rounding is more

struct Prepared {
  std::vector<Polygon> polygons;  // nearest first, so that hidden surfaces are refused early
  std::vector<std::vector<std::uint32_t>> bands;
};

Corners corners_of(const Scene& scene, std::uint32_t triangle) {
  const Triangle& t = scene.mesh.triangles[triangle];
  return triangle_corners(scene.mesh.positions[t[0]], scene.mesh.positions[t[1]],
                          scene.mesh.positions[t[2]]);
}

Prepared prepare(const Scene& scene, const View& view, const ScreenSpace& space, int threads,
                 ExactStats& stats) {
  const ScreenPoints screen = project_all(space, scene.mesh.positions, threads);
  const EquationErrors errors =
      equation_errors(screen.bound, screen.bound, screen.bound, view.width, view.height);
  struct Ordered {
    double nearest;
    Polygon polygon;
  };
  std::vector<Ordered> ordered;
  ordered.reserve(scene.mesh.triangles.size());
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (!receives(scene, t)) continue;
    const Triangle& v = scene.mesh.triangles[t];
    const ScreenPoint<double> p[3] = {screen.points[v[0]], screen.points[v[1]],
                                      screen.points[v[2]]};
    const PolygonEquations<double> q = polygon_equations(p[0], p[1], p[2]);
    if (is_parallel(view) && std::fabs(q.f) <= errors.f &&
        seen_edge_on(view, scene.mesh.positions[v[0]], scene.mesh.positions[v[1]],
                     scene.mesh.positions[v[2]])) {
      continue;  // a wall seen from above
    }
    Polygon polygon;
    set_up(polygon, q, errors, space, view, corners_of(scene, t), Light(0.0), stats);
    set_rows(polygon, q, errors, space, -std::numeric_limits<double>::infinity());
    if (polygon.first_row >= polygon.end_row) continue;
    refine_nearness(polygon, p, screen.bound, space);
    polygon.id = t;
    double nearest = -std::numeric_limits<double>::infinity();
    for (const ScreenPoint<double>& c : p) {
      nearest = std::max(nearest, c.w > 0 ? c.z / c.w : std::numeric_limits<double>::infinity());
    }
    ordered.push_back({nearest, polygon});
  }
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const Ordered& a, const Ordered& b) { return a.nearest > b.nearest; });
  Prepared out;
  out.bands.resize(static_cast<std::size_t>((view.height + kBandRows - 1) / kBandRows));
  out.polygons.reserve(ordered.size());
  for (const Ordered& o : ordered) {
    const auto index = static_cast<std::uint32_t>(out.polygons.size());
    for (int b = o.polygon.first_row / kBandRows; b <= (o.polygon.end_row - 1) / kBandRows; ++b) {
      out.bands[static_cast<std::size_t>(b)].push_back(index);
    }
    out.polygons.push_back(o.polygon);
  }
  return out;
}

// One band of the z-buffer, in double, with exact decisions where two surfaces are too close to
// call.
class Band {
 public:
  Band(const Scene& scene, const View& view, const Prepared& prepared, int first_row, int rows)
      : scene_(scene),
        view_(view),
        prepared_(prepared),
        first_row_(first_row),
        nearness_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(view.width),
                  -std::numeric_limits<double>::infinity()),
        error_(nearness_.size(), 0.0F),
        polygon_(nearness_.size(), kNoTriangle) {}

  void draw(std::uint32_t index, int row) {
    const Polygon& p = prepared_.polygons[index];
    bool undecided = false;
    Span span = widest_span(p, row, view_.width, undecided);
    if (span.begin >= span.end) return;
    if (undecided) {
      const ExactPolygon exact{view_, corners_of(scene_, p.id), p.facing, Light(0.0)};
      span = exact_span(p, exact, row, spans);
    }
    const double y = row + kPixelCentre;
    const double start = p.g.c + p.g.b * y;
    const std::size_t base =
        static_cast<std::size_t>(row - first_row_) * static_cast<std::size_t>(view_.width);
    for (int x = span.begin; x < span.end; ++x) {
      const std::size_t k = base + static_cast<std::size_t>(x);
      const double g = start + p.g.a * (x + kPixelCentre);
      const std::uint32_t before = polygon_[k];
      const double error = p.error_absolute + (p.error_relative + kNearness) * std::fabs(g);
      if (before != kNoTriangle) {
        const double difference = g - nearness_[k];
        if (std::fabs(difference) > error + static_cast<double>(error_[k])) {  // false for NaN
          if (difference < 0) continue;
        } else if (!nearer(p, prepared_.polygons[before], x, row)) {
          continue;
        }
      }
      error_[k] = rounded_up(error);
      nearness_[k] = g;
      polygon_[k] = index;
    }
  }

  void store(Receivers& out, double floor) const {
    const std::size_t base =
        static_cast<std::size_t>(first_row_) * static_cast<std::size_t>(view_.width);
    for (std::size_t k = 0; k < polygon_.size(); ++k) {
      if (polygon_[k] == kNoTriangle) {
        out.triangle[base + k] = kNoTriangle;
        out.nearness[base + k] = std::numeric_limits<float>::infinity();
        continue;
      }
      const double g = nearness_[k], error = static_cast<double>(error_[k]);
      out.triangle[base + k] = prepared_.polygons[polygon_[k]].id;
      const bool known =
          error <= std::max(std::fabs(g) * kFloatShare, floor) && std::fabs(g) <= kLargestNearness;
      out.nearness[base + k] =
          known ? static_cast<float>(g) : std::numeric_limits<float>::quiet_NaN();
    }
  }

  double largest() const {
    double m = 0;
    for (std::size_t k = 0; k < polygon_.size(); ++k) {
      if (polygon_[k] != kNoTriangle && std::isfinite(nearness_[k]))
        m = std::max(m, std::fabs(nearness_[k]));
    }
    return m;
  }

  ExactStats spans, depths;

 private:
  static constexpr double kNearness = 4 * kUnitRoundoff;  // rounding of the sum of three terms

  bool nearer(const Polygon& p, const Polygon& other, int column, int row) {
    const Corners a = corners_of(scene_, p.id), b = corners_of(scene_, other.id);
    if (last_pair_[0] != p.id || last_pair_[1] != other.id) {
      last_pair_ = {p.id, other.id};
      last_coplanar_ = true;
      for (const Corner& c : a) {
        ExactStats ignored;
        last_coplanar_ = last_coplanar_ && tie_sign({}, ignored, OnPlane{b, c}) == 0;
      }
    }
    if (last_coplanar_) {
      ++depths.exact;
      ++depths.ties;
      return p.id < other.id;
    }
    return in_front(view_, column, row, a, p.facing, b, other.facing, Light(0.0), depths);
  }

  struct OnPlane {
    const Corners& plane;
    const Corner& c;
    template <class T>
    T operator()(int, int, int) const {
      return det4<T>(lift<T>(plane[0].at), lift<T>(plane[1].at), lift<T>(plane[2].at),
                     lift<T>(c.at));
    }
  };

  const Scene& scene_;
  const View& view_;
  const Prepared& prepared_;
  int first_row_;
  std::vector<double> nearness_;
  std::vector<float> error_;            // of nearness_
  std::vector<std::uint32_t> polygon_;  // index into prepared_.polygons
  std::array<std::uint32_t, 2> last_pair_{kNoTriangle, kNoTriangle};
  bool last_coplanar_ = false;
};

}  // namespace

Receivers visible_surfaces(const Scene& scene, const View& view, int threads, ExactStats* stats) {
  Receivers out;
  out.view = view;
  const std::size_t samples =
      static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
  out.triangle.resize(samples);
  out.nearness.resize(samples);
  for (const Surface& s : scene.surfaces) {
    out.casters_in_front |= s.casts && !s.receives;
    out.receivers_not_casting |= s.receives && !s.casts;
  }
  ExactStats local;
  const ScreenSpace space = screen_space(view);
  const Prepared prepared = prepare(scene, view, space, threads, local);
  const int bands = static_cast<int>(prepared.bands.size());

  // The floor under a float's error depends on the nearest sample, so bands are drawn first and
  // stored afterwards.
  std::vector<std::unique_ptr<Band>> drawn(static_cast<std::size_t>(bands));
  parallel_for(bands, threads, [&](int b) {
    const int first = b * kBandRows, end = std::min(view.height, first + kBandRows);
    auto band = std::make_unique<Band>(scene, view, prepared, first, end - first);
    for (const std::uint32_t index : prepared.bands[static_cast<std::size_t>(b)]) {
      const Polygon& p = prepared.polygons[index];
      for (int row = std::max(first, p.first_row); row < std::min(end, p.end_row); ++row)
        band->draw(index, row);
    }
    drawn[static_cast<std::size_t>(b)] = std::move(band);
  });
  double nearest = 0;
  for (const auto& band : drawn) {
    nearest = std::max(nearest, band->largest());
    local += band->spans;
    local += band->depths;
  }
  out.nearness_floor = std::max(nearest * kFloorShare, kSmallestFloat);
  parallel_for(bands, threads,
               [&](int b) { drawn[static_cast<std::size_t>(b)]->store(out, out.nearness_floor); });
  if (is_parallel(view)) {
    out.cells = least_cells(scene, out, threads);
  } else {
    out.tiles = nearness_tiles(out, threads);
  }
  if (stats != nullptr) *stats += local;
  return out;
}

}  // namespace gnomon
