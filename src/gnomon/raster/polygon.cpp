#include <gnomon/raster/polygon.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include <glm/common.hpp>

#include <gnomon/core/exact.h>

namespace gnomon {
namespace {

// Rounding of x0 + k y in double, and of adding 1/2: at most this share of |x0| + |k| y.
constexpr double kCrossingRoundoff = 8 * kUnitRoundoff;
// Rounding of g.a x + g.b y + g.c in double, of the coefficients' division, and again of starting a
// span elsewhere.
constexpr double kNearnessRoundoff = 8 * kUnitRoundoff;

std::pair<RowEdge, EdgeKind> row_edge(const Linear<double>& line, const Linear<double>& error,
                                      double inside, int width, int height) {
  const double a = line.a * inside, b = line.b * inside, c = line.c * inside;
  const double total = error.a * width + error.b * height + error.c;
  RowEdge e;
  if (std::fabs(a) > 2 * error.a) {
    const double inverse = 1 / a;
    e.x0 = -c * inverse;
    e.k = -b * inverse;
    e.slack = total / (std::fabs(a) - error.a) * kInflate +
              kCrossingRoundoff * (std::fabs(e.x0) + std::fabs(e.k) * height + 1);
    if (e.slack < width) return {e, a > 0 ? EdgeKind::kLower : EdgeKind::kUpper};
  }
  // (Nearly) parallel to the rows: the whole row is inside, outside or undecided.
  e.x0 = c;
  e.k = b;
  e.slack = (std::fabs(a) * width + total) * kInflate +
            kCrossingRoundoff * (std::fabs(c) + std::fabs(b) * height) + kUnderflowGuard;
  return {e, EdgeKind::kFlat};
}

}  // namespace

EquationErrors equation_errors(const ScreenPoint<Bound>& p0, const ScreenPoint<Bound>& p1,
                               const ScreenPoint<Bound>& p2, int width, int height) {
  const PolygonEquations<Bound> q = polygon_equations(p0, p1, p2);
  EquationErrors e;
  for (int k = 0; k < 3; ++k)
    e.edges[k] = {q.edges[k].a.error, q.edges[k].b.error, q.edges[k].c.error};
  e.n = ((q.n.a.error * width + q.n.b.error * height) + q.n.c.error) * kInflate;
  e.f = q.f.error;
  return e;
}

void set_up(Polygon& p, const PolygonEquations<double>& q, const EquationErrors& errors,
            const ScreenSpace& space, const View& view, const Corners& corners, const Light& light,
            ExactStats& stats) {
  const bool certain = std::fabs(q.f) > errors.f;
  p.facing = static_cast<std::int8_t>(certain ? (q.f > 0 ? space.orientation : -space.orientation)
                                              : facing(view, corners, light, stats));
  const double inside = p.facing * space.orientation;
  p.inverse_ga = 0;
  p.error_absolute = p.error_relative = 0;
  for (int k = 0; k < 3; ++k)
    std::tie(p.edges[k], p.kinds[k]) =
        row_edge(q.edges[k], errors.edges[k], inside, space.width, space.height);
  if (std::fabs(q.f) <= 4 * errors.f) {  // seen (nearly) edge-on: its nearness is anybody's guess
    p.g = {0, 0, std::numeric_limits<double>::quiet_NaN()};
    return;
  }
  const double inverse = 1 / q.f;
  p.g = {q.n.a * inverse, q.n.b * inverse, q.n.c * inverse};
  const double least = std::fabs(q.f) - errors.f;
  const double reach =
      std::fabs(p.g.a) * space.width + std::fabs(p.g.b) * space.height + std::fabs(p.g.c);
  p.error_absolute = rounded_up(errors.n / least * kInflate + kNearnessRoundoff * reach);
  p.error_relative = rounded_up(errors.f / least * kInflate);
  // A cut by nearness is an optimisation: only where it is sharper than the picture is wide.
  if (std::fabs(p.g.a) * space.width > 4 * p.error_absolute) p.inverse_ga = 1 / p.g.a;
}

void refine_nearness(Polygon& p, const ScreenPoint<double> (&corners)[3],
                     const ScreenPoint<Bound>& errors, const ScreenSpace& space) {
  // Moving the picture's origin by whole pixels is a shear, x' = x - dx w.
  const auto whole = [&](double v, double w) {
    const double pixel = std::round(v / w);
    return w > 0 && std::fabs(pixel) < kLargestCoordinate ? pixel : 0.0;
  };
  const double dx = whole(corners[0].x, corners[0].w), dy = whole(corners[0].y, corners[0].w);
  ScreenPoint<Approx> local[3];
  double reach_x = 0, reach_y = 0;
  for (int k = 0; k < 3; ++k) {
    const Approx w(corners[k].w, errors.w.error);
    local[k] = {Approx(corners[k].x, errors.x.error) - Approx(dx) * w,
                Approx(corners[k].y, errors.y.error) - Approx(dy) * w, w,
                Approx(corners[k].z, errors.z.error)};
    if (w.value > w.error) {
      reach_x = std::max(reach_x, std::fabs(local[k].x.value / w.value) + 1);
      reach_y = std::max(reach_y, std::fabs(local[k].y.value / w.value) + 1);
    } else {  // reaches behind the eye: may cover any pixel
      reach_x = space.width + std::fabs(dx);
      reach_y = space.height + std::fabs(dy);
    }
  }
  const PolygonEquations<Approx> q = polygon_equations(local[0], local[1], local[2]);
  if (!q.f.certain()) {
    p.g = {0, 0, std::numeric_limits<double>::quiet_NaN()};
    return;
  }
  const Approx a = q.n.a / q.f, b = q.n.b / q.f, c = q.n.c / q.f;
  p.g = {a.value, b.value, c.value - (a.value * dx + b.value * dy)};
  const double moved = std::fabs(p.g.a) * (space.width + std::fabs(dx)) +
                       std::fabs(p.g.b) * (space.height + std::fabs(dy)) + std::fabs(c.value);
  p.error_absolute = rounded_up((a.error * reach_x + b.error * reach_y + c.error) * kInflate +
                                kNearnessRoundoff * moved);
  p.error_relative = 0;
}

Span set_rows(Polygon& p, const PolygonEquations<double>& q, const EquationErrors& errors,
              const ScreenSpace& space, double least) {
  const double w = space.width, h = space.height;
  std::array<Vec2, 12> corners{Vec2{0, 0}, Vec2{w, 0}, Vec2{w, h}, Vec2{0, h}}, next;
  std::size_t n = 4;
  const auto clip = [&](double a, double b, double c) {  // keeps a x + b y + c >= 0
    std::size_t m = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2 s = corners[i], t = corners[(i + 1) % n];
      const double ds = a * s.x + b * s.y + c, dt = a * t.x + b * t.y + c;
      if (ds >= 0) next[m++] = s;
      if ((ds < 0) != (dt < 0)) next[m++] = s + (t - s) * (ds / (ds - dt));
    }
    n = m;
    corners = next;
  };
  const double inside = p.facing * space.orientation;
  for (int k = 0; k < 3 && n > 0; ++k) {
    const Linear<double>&l = q.edges[k], &e = errors.edges[k];
    clip(l.a * inside, l.b * inside, l.c * inside + (e.a * w + e.b * h + e.c) * 2);
  }
  if (n > 0 && !std::isnan(p.g.c) && std::isfinite(least)) {
    const double margin =
        p.error_absolute * 2 + (p.error_relative + kNearnessRoundoff) * 2 * std::fabs(least);
    clip(p.g.a, p.g.b, p.g.c - least + margin);
  }
  p.least = least;
  p.first_row = p.end_row = 0;
  if (n == 0) return {0, 0};
  Vec2 low(w, h), high(0, 0);
  for (std::size_t i = 0; i < n; ++i) {
    low = glm::min(low, corners[i]);
    high = glm::max(high, corners[i]);
  }
  const auto from = [](double v) { return std::max(0, static_cast<int>(std::floor(v)) - 1); };
  const auto to = [](double v, int most) {
    return std::min(most, static_cast<int>(std::ceil(v)) + 1);
  };
  p.first_row = from(low.y);
  p.end_row = to(high.y, space.height);
  return {from(low.x), to(high.x, space.width)};
}

Span widest_span(const Polygon& p, int row, int width, bool& undecided) {
  const double y = row + kPixelCentre;
  double begin = 0, end = width;
  undecided = false;
  for (int edge = 0; edge < 3; ++edge) {
    const RowEdge& e = p.edges[edge];
    const double x = e.x0 + e.k * y;
    if (p.kinds[edge] == EdgeKind::kFlat) {
      if (x < -e.slack) return {0, 0};
      undecided |= !(x > e.slack);
      continue;
    }
    const double low = std::floor(x + kPixelCentre - e.slack),
                 high = std::floor(x + kPixelCentre + e.slack);
    undecided |= low != high;
    if (p.kinds[edge] == EdgeKind::kLower) {
      begin = std::max(begin, low);
    } else {
      end = std::min(end, high);
    }
  }
  if (!(begin < end)) return {0, 0};  // also where undecided: even the widest reading is empty
  return {static_cast<int>(begin), static_cast<int>(end)};
}

Span exact_span(const Polygon& p, const ExactPolygon& exact, int row, ExactStats& stats) {
  const double y = row + kPixelCentre;
  const int width = exact.view.width;
  Span span{0, width};
  for (int k = 0; k < 3; ++k) {
    const RowEdge& e = p.edges[k];
    const auto inside = [&](int column) {
      return edge_side(exact.view, column, row, exact.corners[k], exact.corners[(k + 1) % 3],
                       exact.light, stats) == exact.facing;
    };
    // First pixel of [from, to) whose side differs from that of its predecessors; `to` if none.
    const auto change = [&](int from, int to, bool before) {
      while (from < to) {
        const int middle = from + (to - from) / 2;
        if (inside(middle) == before) {
          from = middle + 1;
        } else {
          to = middle;
        }
      }
      return from;
    };
    if (p.kinds[k] == EdgeKind::kFlat) {
      const double v = e.x0 + e.k * y;
      if (v > e.slack) continue;
      if (v < -e.slack) return {0, 0};
      const bool first = inside(0);
      const int at = change(0, width, first);
      if (first) {
        span.end = std::min(span.end, at);
      } else {
        span.begin = std::max(span.begin, at);
      }
      continue;
    }
    const double x = e.x0 + e.k * y + kPixelCentre;
    const auto pixel = [&](double v) {
      return static_cast<int>(std::clamp(std::floor(v), 0.0, double(width)));
    };
    const int from = pixel(x - e.slack), to = pixel(x + e.slack);
    if (p.kinds[k] == EdgeKind::kLower) {
      span.begin = std::max(span.begin, change(from, to, false));
    } else {
      span.end = std::min(span.end, change(from, to, true));
    }
  }
  if (span.begin >= span.end) return {0, 0};
  return span;
}

}  // namespace gnomon
