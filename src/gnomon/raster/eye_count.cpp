#include <gnomon/raster/eye_count.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <gnomon/core/approx.h>
#include <gnomon/core/parallel.h>
#include <gnomon/view/predicates.h>

namespace gnomon {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Boxes that one thread takes at a time: some 15 microseconds' worth, where nearly all are apart.
constexpr std::size_t kChunk = 8192;

// d_i (y_j - p_j) - d_j (x_i - p_i): 0 on the plane through the line p + t d along the third axis.
template <class T>
T off_plane(const T& di, const T& dj, const T& xi, const T& xj, const T& pi, const T& pj) {
  return di * (xj - pj) - dj * (xi - pi);
}

// The segment from the eye to the light, or the ray where one of them is at infinity.
struct Segment {
  std::array<double, 3> p{}, d{};    // a finite end; the line's direction, rounded
  std::array<double, 3> lo{}, hi{};  // its box, exactly
  std::array<double, 3> error{};     // of off_plane() along each axis, anywhere in the boxes
  bool plain = true;                 // w of both is 0 or 1: else nothing is said of boxes
  H4<double> light{}, eye{};
  double edge_error = 0;  // of |light; eye; a; b|

  Segment(const Vec4& e, const Vec4& l, const Vec3& largest)
      : plain((e.w == 0 || e.w == 1) && (l.w == 0 || l.w == 1)),
        light{l.x, l.y, l.z, l.w},
        eye{e.x, e.y, e.z, e.w} {
    const Vec4 &from = e.w != 0 ? e : l, &to = e.w != 0 ? l : e;  // from: finite
    std::array<Bound, 3> direction;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      p[i] = from[k];
      d[i] = to.w != 0 ? to[k] - from[k] : to[k];
      direction[i] = to.w != 0 ? Bound(to[k]) - Bound(from[k]) : Bound(to[k]);
      const double end = to.w != 0 ? to[k] : to[k] > 0 ? kInfinity : to[k] < 0 ? -kInfinity : p[i];
      lo[i] = std::min(p[i], end);
      hi[i] = std::max(p[i], end);
    }
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      error[static_cast<std::size_t>(k)] =
          off_plane(direction[static_cast<std::size_t>(i)], direction[static_cast<std::size_t>(j)],
                    Bound(largest[i]), Bound(largest[j]), Bound(from[i]), Bound(from[j]))
              .error +
          kUnderflowGuard;
    }
    const H4<Bound> vertex = lift<Bound>(point(largest));
    edge_error = det4(lift<Bound>(l), lift<Bound>(e), vertex, vertex).error + kUnderflowGuard;
  }

  // True only if no point of the box is on the segment. Strictly apart from it: what the tie rule
  // moves by infinitesimals stays apart.
  bool apart(const std::array<double, 3>& low, const std::array<double, 3>& high) const {
    if (!plain) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      if (low[k] > hi[k] || high[k] < lo[k]) return true;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      // Corners where off_plane() is least and greatest.
      const bool up_i = d[j] > 0, up_j = d[i] > 0;
      const double least =
          off_plane(d[i], d[j], up_i ? high[i] : low[i], up_j ? low[j] : high[j], p[i], p[j]);
      if (least > error[k]) return true;
      const double most =
          off_plane(d[i], d[j], up_i ? low[i] : high[i], up_j ? high[j] : low[j], p[i], p[j]);
      if (most < -error[k]) return true;
    }
    return false;
  }

  bool apart(const RunBox& box) const {
    const auto in_double = [](const std::array<float, 3>& v) {
      return std::array<double, 3>{v[0], v[1], v[2]};
    };
    return apart(in_double(box.lo), in_double(box.hi));
  }

  bool apart(const Vec3& a, const Vec3& b, const Vec3& c) const {
    std::array<double, 3> low, high;
    for (int k = 0; k < 3; ++k) {
      low[static_cast<std::size_t>(k)] = std::min(std::min(a[k], b[k]), c[k]);
      high[static_cast<std::size_t>(k)] = std::max(std::max(a[k], b[k]), c[k]);
    }
    return apart(low, high);
  }

  // True only if the line passes by the triangle: two edges see it on different sides.
  bool passes_by(const Vec3& a, const Vec3& b, const Vec3& c) const {
    const H4<double> pa{a.x, a.y, a.z, 1.0}, pb{b.x, b.y, b.z, 1.0}, pc{c.x, c.y, c.z, 1.0};
    const double ab = det4(light, eye, pa, pb), bc = det4(light, eye, pb, pc),
                 ca = det4(light, eye, pc, pa);
    return std::max({ab, bc, ca}) > edge_error && std::min({ab, bc, ca}) < -edge_error;
  }
};

}  // namespace

RunBoxes run_boxes(const TriMesh& mesh, const std::vector<std::uint8_t>& selected) {
  RunBoxes out;
  const std::size_t n = mesh.triangles.size();
  out.boxes.reserve((n + kBoxRun - 1) / kBoxRun);
  for (std::size_t begin = 0; begin < n; begin += kBoxRun) {
    Vec3 lo(kInfinity), hi(-kInfinity);
    for (std::size_t t = begin; t < std::min(n, begin + kBoxRun); ++t) {
      if (!selected.empty() && selected[t] == 0) continue;
      for (const std::uint32_t v : mesh.triangles[t]) {
        for (int k = 0; k < 3; ++k) {
          lo[k] = std::min(lo[k], mesh.positions[v][k]);
          hi[k] = std::max(hi[k], mesh.positions[v][k]);
        }
      }
    }
    RunBox& box = out.boxes.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      box.lo[i] = rounded_down(lo[k]);
      box.hi[i] = rounded_up(hi[k]);
      if (lo[k] > hi[k]) continue;
      out.largest[k] = std::max({out.largest[k], std::fabs(static_cast<double>(box.lo[i])),
                                 std::fabs(static_cast<double>(box.hi[i]))});
    }
  }
  return out;
}

std::int32_t count_between_eye_and_light(const TriMesh& mesh,
                                         const std::vector<std::uint8_t>& selected,
                                         const RunBoxes& boxes, const View& view,
                                         const Light& light, int threads, ExactStats& stats) {
  if (is_parallel(view) && light.w == 0) return 0;
  const Segment segment(view.eye, light, boxes.largest);
  struct Found {
    std::int32_t count = 0;
    ExactStats stats;
  };
  std::vector<Found> found((boxes.boxes.size() + kChunk - 1) / kChunk);
  parallel_for(static_cast<int>(found.size()), threads, [&](int chunk) {
    Found& f = found[static_cast<std::size_t>(chunk)];
    const std::size_t first = static_cast<std::size_t>(chunk) * kChunk;
    for (std::size_t b = first; b < std::min(boxes.boxes.size(), first + kChunk); ++b) {
      if (segment.apart(boxes.boxes[b])) continue;
      const std::size_t end = std::min(mesh.triangles.size(), (b + 1) * kBoxRun);
      for (std::size_t t = b * kBoxRun; t < end; ++t) {
        if (!selected.empty() && selected[t] == 0) continue;
        const Triangle& c = mesh.triangles[t];
        const Vec3 &p0 = mesh.positions[c[0]], &p1 = mesh.positions[c[1]],
                   &p2 = mesh.positions[c[2]];
        if (segment.apart(p0, p1, p2) || segment.passes_by(p0, p1, p2)) continue;
        if (between_eye_and_light(view, triangle_corners(p0, p1, p2), light, f.stats)) ++f.count;
      }
    }
  });
  std::int32_t count = 0;
  for (const Found& f : found) {
    count += f.count;
    stats += f.stats;
  }
  return count;
}

}  // namespace gnomon
