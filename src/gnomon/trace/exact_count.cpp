#include <gnomon/trace/exact_count.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include <gnomon/core/parallel.h>
#include <gnomon/trace/oracle_predicates.h>

namespace gnomon {
namespace {

using oracle::Pixel;
using oracle::Points;
using oracle::points_of;

// What all samples of one picture share.
struct Shot {
  const Scene& scene;
  const Receivers& receivers;
  Light light;
  std::vector<std::int8_t> lit;  // per triangle: sign |t;L|
};

// The six 2x2 minors of the rows a and b: |a;b;x;y| is their product with the minors of (x, y). See
// line_product().
template <class T>
std::array<T, 6> minors(const H4<T>& a, const H4<T>& b) {
  return {a.x * b.y - a.y * b.x, a.x * b.z - a.z * b.x, a.x * b.w - a.w * b.x,
          a.y * b.z - a.z * b.y, a.y * b.w - a.w * b.y, a.z * b.w - a.w * b.z};
}

// |a; b; x; y| for the line's minors of (a, b), by Laplace's expansion along the first two rows.
Approx line_product(const std::array<Approx, 6>& line, const Vec3& x, const Vec3& y) {
  const std::array<Approx, 6> m = minors(lift<Approx>(x), lift<Approx>(y));
  return ((line[0] * m[5] - line[1] * m[4]) + (line[2] * m[3] + line[3] * m[2])) -
         (line[4] * m[1] - line[5] * m[0]);
}

// A sample in floating point that knows how wrong it is; used to decide quickly, never wrongly.
struct NearSample {
  H4<Approx> p;                // weight positive, if certain
  std::array<Approx, 6> line;  // minors of (L, p)
};

NearSample near_sample(const oracle::SamplePoint& sample, int seen, const Light& light) {
  NearSample s;
  const H4<Approx> p = sample.at<Approx>(0, 0);
  const Approx sign(static_cast<double>(seen));
  s.p = {sign * p.x, sign * p.y, sign * p.z, sign * p.w};
  s.line = minors(lift<Approx>(light), s.p);
  return s;
}

// The segment from the sample to the light; false where the sample's place is not known well enough
// to have bounds.
bool probe_of(const NearSample& s, const Light& light, Probe& probe) {
  if (!s.p.w.certain()) return false;
  const Approx p[3] = {s.p.x / s.p.w, s.p.y / s.p.w, s.p.z / s.p.w};
  Vec3 origin, error, towards;
  for (int k = 0; k < 3; ++k) {
    if (!std::isfinite(p[k].value) || !std::isfinite(p[k].error)) return false;
    origin[k] = p[k].value;
    error[k] = p[k].error;
    towards[k] = light.w == 0 ? light[k] : light[k] - origin[k];
  }
  // A point light's segment starts wrong by `error` and ends exactly at the light: in between it is
  // wrong by less.
  probe = make_probe(origin, error, towards, 0.0,
                     light.w == 0 ? std::numeric_limits<double>::infinity() : 1.0);
  return true;
}

// oracle::crosses() with the same answer, decided from the approximate sample where that is
// certain.
bool crosses(const Shot& shot, const oracle::SamplePoint& sample, const NearSample& s,
             std::uint32_t receiver, int seen, std::uint32_t caster, ExactStats& stats) {
  const Points t = points_of(shot.scene.mesh, caster);
  const int front = -shot.lit[caster];
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = t[k], &b = t[(k + 1) % 3];
    const Approx side = line_product(s.line, a, b);
    const int sign =
        side.certain() ? side.sign() : seen * oracle::edge_side_of(sample, shot.light, a, b, stats);
    if (sign != front) return false;
  }
  if (caster == receiver) return seen == front;
  const int side = seen * oracle::sample_side(sample, t, stats);
  return (side != 0 ? side : oracle::eye_side(sample.view(), t, stats)) == front;
}

std::int32_t at_least_one_if_turned_away(const Scene& scene, std::uint32_t receiver, int lit,
                                         int seen, std::int32_t n) {
  return n == 0 && lit != seen && !casts(scene, receiver) ? 1 : n;
}

std::int32_t count_at(const Shot& shot, const Bvh& bvh, const Pixel& at, std::uint32_t receiver,
                      OracleStats& stats) {
  const View& view = shot.receivers.view;
  const Points r = points_of(shot.scene.mesh, receiver);
  const int seen = oracle::eye_side(view, r, stats.signs);
  const oracle::SamplePoint point(view, at, r);
  const NearSample sample = near_sample(point, seen, shot.light);
  std::int32_t n = 0;
  const auto test = [&](std::uint32_t caster) {
    ++stats.candidates;
    n += crosses(shot, point, sample, receiver, seen, caster, stats.signs) ? 1 : 0;
  };
  ++stats.samples;
  Probe probe;
  if (probe_of(sample, shot.light, probe)) {
    walk(bvh, probe, test);
  } else {
    ++stats.unbounded;
    for (const std::uint32_t caster : bvh.triangles) test(caster);
  }
  return at_least_one_if_turned_away(shot.scene, receiver, shot.lit[receiver], seen, n);
}

// The bounds of the ray of a pixel within the box of all receivers.
bool ray_probe(const View& view, const Pixel& at, const BvhNode& root, Probe& probe) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const H4<Approx> q = oracle::pixel<Approx>(view, at, 0);
  const Vec3 point(q.x.value, q.y.value, q.z.value), error(q.x.error, q.y.error, q.z.error),
      e(view.eye);
  if (is_parallel(view)) {
    probe = make_probe(point, error, -e, -kInfinity, kInfinity);
    return true;
  }
  // Inside the box e + t q holds on every axis, so t is at most the least of the three; the error
  // of q grows with t.
  double last = kInfinity;
  for (int k = 0; k < 3; ++k) {
    const double least = std::fabs(point[k]) - error[k];
    if (!(least > 0)) continue;
    const double reach = point[k] > 0 ? root.hi[k] - e[k] : e[k] - root.lo[k];
    if (reach < 0) return false;
    last = std::min(last, reach / least * (1 + kSlabError));
  }
  if (!std::isfinite(last)) {  // the direction is all doubt
    probe = make_probe(Vec3(0.0), Vec3(kLargestCoordinate), Vec3(0.0), 0.0, 1.0);
    return true;
  }
  probe = make_probe(e, error * (last * (1 + kSlabError)), point, 0.0, last);
  for (int k = 0; k < 3;
       ++k) {  // a direction that is as good as 0: all the segment is within |q| t of the eye
    if (probe.flat[static_cast<std::size_t>(k)]) {
      const double pad = (std::fabs(point[k]) + error[k]) * last * (1 + kSlabError);
      probe.low[k] = std::nextafter(e[k] - pad, -kInfinity);
      probe.high[k] = std::nextafter(e[k] + pad, kInfinity);
    }
  }
  return true;
}

// True if the pixel's ray meets t in front of the eye.
bool meets(const View& view, const Pixel& at, const std::array<Approx, 6>& line, const Points& t,
           int seen, ExactStats& stats) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = t[k], &b = t[(k + 1) % 3];
    const Approx side = line_product(line, a, b);
    if ((side.certain() ? side.sign() : oracle::ray_side(view, at, a, b, stats)) != seen)
      return false;
  }
  return true;
}

// True if the ray meets t before it meets `best`, or in the same plane and t has the lower index.
// The sample on `best` is behind t if it lies on the other side of t than the eye.
bool replaces(const Scene& scene, const View& view, const Pixel& at, std::uint32_t t, int seen_t,
              std::uint32_t best, int seen_best, ExactStats& stats) {
  if (best == kNoTriangle) return true;
  const int side = oracle::sample_side(oracle::SamplePoint(view, at, points_of(scene.mesh, best)),
                                       points_of(scene.mesh, t), stats);
  return side == 0 ? t < best : seen_best * side != seen_t;
}

std::vector<std::int8_t> signs_for_all(const Scene& scene, int threads, OracleStats* stats,
                                       const std::function<int(const Points&, ExactStats&)>& sign) {
  constexpr std::size_t kChunk = 4096;
  const std::size_t n = scene.mesh.triangles.size();
  const int chunks = static_cast<int>((n + kChunk - 1) / kChunk);
  std::vector<std::int8_t> signs(n);
  std::vector<ExactStats> each(static_cast<std::size_t>(chunks));
  parallel_for(chunks, threads, [&](int c) {
    const std::size_t first = static_cast<std::size_t>(c) * kChunk;
    for (std::size_t t = first; t < std::min(n, first + kChunk); ++t) {
      signs[t] = static_cast<std::int8_t>(sign(points_of(scene.mesh, static_cast<std::uint32_t>(t)),
                                               each[static_cast<std::size_t>(c)]));
    }
  });
  if (stats) {
    for (const ExactStats& s : each) stats->signs += s;
  }
  return signs;
}

void sum_rows(const std::vector<OracleStats>& rows, OracleStats* stats) {
  if (!stats) return;
  for (const OracleStats& s : rows) *stats += s;
}

std::vector<std::uint8_t> flags(const Scene& scene, bool (*chosen)(const Scene&, std::uint32_t)) {
  std::vector<std::uint8_t> f(scene.mesh.triangles.size());
  for (std::size_t t = 0; t < f.size(); ++t)
    f[t] = chosen(scene, static_cast<std::uint32_t>(t)) ? 1 : 0;
  return f;
}

}  // namespace

Oracle build_oracle(const Scene& scene) {
  return {&scene, build_bvh(scene.mesh, flags(scene, casts)),
          build_bvh(scene.mesh, flags(scene, receives))};
}

std::vector<std::int32_t> exact_counts(const Oracle& oracle, const Receivers& receivers,
                                       const Light& light, int threads, OracleStats* stats) {
  const Scene& scene = *oracle.scene;
  Shot shot{scene, receivers, snapped(light), {}};
  shot.lit = signs_for_all(scene, threads, stats, [&](const Points& t, ExactStats& s) {
    return oracle::light_side_of(t, shot.light, s);
  });
  const View& view = receivers.view;
  std::vector<std::int32_t> counts(receivers.triangle.size(), 0);
  std::vector<OracleStats> rows(static_cast<std::size_t>(view.height));
  parallel_for(view.height, threads, [&](int row) {
    const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(view.width);
    for (int column = 0; column < view.width; ++column) {
      const std::size_t k = first + static_cast<std::size_t>(column);
      const std::uint32_t r = receivers.triangle[k];
      if (r == kNoTriangle) continue;
      counts[k] =
          count_at(shot, oracle.casters, {column, row}, r, rows[static_cast<std::size_t>(row)]);
    }
  });
  sum_rows(rows, stats);
  return counts;
}

std::vector<std::int32_t> exact_counts(const Scene& scene, const Receivers& receivers,
                                       const Light& light, int threads, OracleStats* stats) {
  return exact_counts(build_oracle(scene), receivers, light, threads, stats);
}

std::int32_t exact_count_at(const Scene& scene, const Receivers& receivers, const Light& light,
                            int column, int row, ExactStats* stats) {
  ExactStats own;
  ExactStats& s = stats ? *stats : own;
  const View& view = receivers.view;
  const std::uint32_t receiver =
      receivers.triangle[static_cast<std::size_t>(row) * static_cast<std::size_t>(view.width) +
                         static_cast<std::size_t>(column)];
  if (receiver == kNoTriangle) return 0;
  const Light from = snapped(light);
  const Points r = points_of(scene.mesh, receiver);
  const int seen = oracle::eye_side(view, r, s);
  const oracle::SamplePoint sample(view, {column, row}, r);
  std::int32_t n = 0;
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (!casts(scene, t)) continue;
    const Points caster = points_of(scene.mesh, t);
    const int lit = oracle::light_side_of(caster, from, s);
    n += oracle::crosses(sample, seen, caster, lit, from, s) ? 1 : 0;
  }
  return at_least_one_if_turned_away(scene, receiver, oracle::light_side_of(r, from, s), seen, n);
}

std::vector<std::uint32_t> exact_receivers(const Oracle& oracle, const View& view, int threads,
                                           OracleStats* stats) {
  const Scene& scene = *oracle.scene;
  std::vector<std::uint32_t> result(
      static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height), kNoTriangle);
  if (oracle.receivers.nodes.empty()) return result;
  const std::vector<std::int8_t> seen =
      signs_for_all(scene, threads, stats,
                    [&](const Points& t, ExactStats& s) { return oracle::eye_side(view, t, s); });
  std::vector<OracleStats> rows(static_cast<std::size_t>(view.height));
  parallel_for(view.height, threads, [&](int row) {
    OracleStats& s = rows[static_cast<std::size_t>(row)];
    for (int column = 0; column < view.width; ++column) {
      const Pixel at{column, row};
      const H4<Approx> q = oracle::pixel<Approx>(view, at, 0), e = oracle::eye<Approx>(view, 0);
      const std::array<Approx, 6> line = minors(q, e);
      Probe probe;
      if (!ray_probe(view, at, oracle.receivers.nodes[0], probe)) continue;
      std::uint32_t best = kNoTriangle;
      walk(oracle.receivers, probe, [&](std::uint32_t t) {
        ++s.candidates;
        const Points points = points_of(scene.mesh, t);
        if (!meets(view, at, line, points, seen[t], s.signs)) return;
        if (!replaces(scene, view, at, t, seen[t], best, best == kNoTriangle ? 0 : seen[best],
                      s.signs))
          return;
        best = t;
        // The ray's point on t is e - (|t;e| / |t;q|) q, for a parallel view q - (|t;q| / |t;e|) e:
        // beyond it nothing matters.
        const Approx te = oracle::plane<Approx>(points, e), tq = oracle::plane<Approx>(points, q);
        const bool parallel = is_parallel(view);
        if (!(parallel ? te : tq).certain()) return;
        const Approx hit = parallel ? tq / te : -te / tq;
        probe.t1 = std::min(probe.t1, std::nextafter(hit.value + hit.error,
                                                     std::numeric_limits<double>::infinity()));
      });
      result[static_cast<std::size_t>(row) * static_cast<std::size_t>(view.width) +
             static_cast<std::size_t>(column)] = best;
      if (best != kNoTriangle) ++s.samples;
    }
  });
  sum_rows(rows, stats);
  return result;
}

std::uint32_t exact_receiver_at(const Scene& scene, const View& view, int column, int row,
                                ExactStats* stats) {
  ExactStats own;
  ExactStats& s = stats ? *stats : own;
  const Pixel at{column, row};
  std::uint32_t best = kNoTriangle;
  int seen_best = 0;
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (!receives(scene, t)) continue;
    const Points points = points_of(scene.mesh, t);
    const int seen = oracle::eye_side(view, points, s);
    bool inside = true;
    for (std::size_t k = 0; k < 3 && inside; ++k) {
      inside = oracle::ray_side(view, at, points[k], points[(k + 1) % 3], s) == seen;
    }
    if (!inside || !replaces(scene, view, at, t, seen, best, seen_best, s)) continue;
    best = t;
    seen_best = seen;
  }
  return best;
}

}  // namespace gnomon
