#include <gnomon/raster/count_shadows.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include <glm/common.hpp>

#include <gnomon/core/parallel.h>
#include <gnomon/raster/fill_band.h>
#include <gnomon/raster/polygon.h>
#include <gnomon/silhouette/edge_tree.h>
#include <gnomon/silhouette/light_sides.h>
#include <gnomon/silhouette/silhouette.h>

namespace gnomon {
namespace {

constexpr int kBandRows = 32;  // counts and nearness of a band stay in the second-level cache
static_assert(kBandRows <= kBandRowsMax);

// Polygons of this many bytes are set up before they are filled: several lights share one pass over
// the bands.
constexpr std::size_t kBatchBytes = std::size_t{96} << 20;
constexpr std::size_t kBatchLights = 16;
// A tree of edges is built for as many lights: one light costs brute force 8 ns a triangle and the
// tree 1, and building it, by one thread, 700 to 3000 (docs/silhouettes.md).
constexpr std::size_t kLightsForTree = 512;

Corners corners_of(const Scene& scene, std::uint32_t triangle) {
  const Triangle& t = scene.mesh.triangles[triangle];
  return triangle_corners(scene.mesh.positions[t[0]], scene.mesh.positions[t[1]],
                          scene.mesh.positions[t[2]]);
}

bool is_caster(const Casters& c, std::uint32_t triangle) {
  return c.selected.empty() || c.selected[triangle] != 0;
}

// Receivers::nearness is wrong by at most 2^-23 of itself or by nearness_floor; twice that share is
// taken off.
constexpr double kNearnessRounding = 0x1p-22;

// What all lights share.
struct ViewSetup {
  ScreenSpace space;
  ScreenPoints screen;
  double least_nearness = 0;       // of all samples; infinity: there are none
  std::vector<double> band_least;  // per band
  Vec4 largest{0, 0, 0, 1};        // bounds of the vertices' coordinates
  std::vector<std::int8_t>
      eye_sides;  // sign of |A; B; C; eye| per triangle; empty where C(e) is never needed
};

// One light, ready to be filled.
struct LightSetup {
  Light light{0, 0, 0, 0};
  Silhouette silhouette;
  std::vector<Polygon>
      polygons;           // sides first (id: index into silhouette), then casters (id: triangle)
  std::size_t sides = 0;  // how many of the polygons are sides
  std::vector<std::uint32_t> bin_first;  // CSR: polygons of each band
  std::vector<std::uint32_t> bins;
  std::int32_t eye_count = 0;  // C(e)
  std::vector<std::uint8_t>
      unlit;  // per triangle that receives but does not cast: the light is not on its seen side
  ExactStats stats;
  ExtractionScratch scratch;
  Silhouette unsorted;
};

// Nearness below which no sample of a triangle lies, for samples whose own nearness is unknown:
// that of its lowest vertex in a parallel view; in front of a camera nearness is positive.
double least_of_triangle(const Casters& casters, const ViewSetup& v, bool parallel,
                         std::uint32_t triangle) {
  if (!parallel) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t vertex : casters.scene->mesh.triangles[triangle]) {
    least = std::min(least, v.screen.points[vertex].z - v.screen.bound.z.error);
  }
  return least;
}

ViewSetup set_up_view(const Casters& casters, const Receivers& r, std::span<const Light> lights,
                      int threads) {
  ViewSetup v;
  const bool points =
      std::any_of(lights.begin(), lights.end(), [](const Light& l) { return l.w != 0; });
  if (!is_parallel(r.view) || points) {
    v.eye_sides =
        light_sides(casters.scene->mesh, r.view.eye);  // the tie rule moves eyes as it moves lights
    for (const Vec3& p : casters.scene->mesh.positions) {
      for (int k = 0; k < 3; ++k) v.largest[k] = std::max(v.largest[k], std::fabs(p[k]));
    }
  }
  v.space = screen_space(r.view);
  v.screen = project_all(v.space, casters.scene->mesh.positions, threads);
  const bool parallel = is_parallel(r.view);
  const int bands = (r.view.height + kBandRows - 1) / kBandRows;
  v.band_least.resize(static_cast<std::size_t>(bands));
  parallel_for(bands, threads, [&](int b) {
    const std::size_t width = static_cast<std::size_t>(r.view.width);
    const std::size_t first = static_cast<std::size_t>(b) * kBandRows * width;
    const std::size_t end = std::min(r.nearness.size(), first + kBandRows * width);
    double least = std::numeric_limits<double>::infinity();
    // A stored nearness may lie above the exact one by its rounding (Receivers::nearness).
    const auto below = [&](float n) {
      return static_cast<double>(n) - std::fabs(static_cast<double>(n)) * kNearnessRounding -
             r.nearness_floor;
    };
    for (std::size_t k = first; k < end; ++k) {
      const float n = r.nearness[k];
      if (std::isnan(n)) {
        least = std::min(least, least_of_triangle(casters, v, parallel, r.triangle[k]));
      } else {
        least = std::min(least, below(n));
      }
    }
    v.band_least[static_cast<std::size_t>(b)] = least;
  });
  v.least_nearness = *std::min_element(v.band_least.begin(), v.band_least.end());
  return v;
}

// C(e): casters crossed by the segment from the eye to the light. Between two points at infinity
// there is none. Most casters have both on one side; of the others most are passed by so widely
// that plain double can tell.
std::int32_t count_at_eye(const Casters& casters, const ViewSetup& v, const View& view,
                          const Light& light, const std::vector<std::int8_t>& sides,
                          ExactStats& stats) {
  if (is_parallel(view) && light.w == 0) return 0;
  const TriMesh& mesh = casters.scene->mesh;
  const H4<Bound> vertex = lift<Bound>(v.largest);
  const double error = det4(lift<Bound>(light), lift<Bound>(view.eye), vertex, vertex).error;
  const H4<double> l{light.x, light.y, light.z, light.w},
      e{view.eye.x, view.eye.y, view.eye.z, view.eye.w};
  const auto passed_by = [&](const Vec3& a, const Vec3& b, int side) {
    return det4<double>(l, e, {a.x, a.y, a.z, 1.0}, {b.x, b.y, b.z, 1.0}) * side < -error;
  };
  std::int32_t count = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const int eye = v.eye_sides[t];
    if (sides[t] == eye || !is_caster(casters, t)) continue;
    const Triangle& c = mesh.triangles[t];
    const Vec3 &p0 = mesh.positions[c[0]], &p1 = mesh.positions[c[1]], &p2 = mesh.positions[c[2]];
    if (passed_by(p0, p1, eye) || passed_by(p1, p2, eye) || passed_by(p2, p0, eye)) continue;
    if (between_eye_and_light(view, triangle_corners(p0, p1, p2), light, stats)) ++count;
  }
  return count;
}

void add_side(LightSetup& s, const ViewSetup& v, const Casters& casters, const View& view,
              const EquationErrors& errors, const ScreenPoint<double>& minus_light,
              const ScreenPoint<Bound>& light_bound, std::uint32_t index) {
  const SilhouetteEdge& e = s.silhouette[index];
  const PolygonEquations<double> q =
      polygon_equations(v.screen.points[e.a], v.screen.points[e.b], minus_light);
  const Vec3 &a = casters.scene->mesh.positions[e.a], &b = casters.scene->mesh.positions[e.b];
  if (std::fabs(q.f) <= errors.f && seen_end_on(view, a, b)) return;
  Polygon& p = s.polygons.emplace_back();
  set_up(p, q, errors, v.space, view, side_corners(a, b), s.light, s.stats);
  const bool strip = is_parallel(view) && s.light.w == 0 &&
                     set_rows_of_strip(p, v.screen.points[e.a], v.screen.points[e.b], minus_light,
                                       v.screen.bound, light_bound, v.space, v.least_nearness);
  if (!strip) set_rows(p, q, errors, v.space, v.least_nearness);
  p.add = -e.multiplicity * p.facing;
  p.id = index;
  if (p.first_row >= p.end_row) s.polygons.pop_back();
}

// Casters that do not receive: rays may cross them before they reach their sample. One that
// receives cannot be in front of the first receiver.
void add_casters(LightSetup& s, const ViewSetup& v, const Casters& casters, const View& view,
                 const std::vector<std::int8_t>& sides) {
  const Scene& scene = *casters.scene;
  const EquationErrors errors =
      equation_errors(v.screen.bound, v.screen.bound, v.screen.bound, view.width, view.height);
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (!is_caster(casters, t) || receives(scene, t)) continue;
    const Triangle& c = scene.mesh.triangles[t];
    const PolygonEquations<double> q =
        polygon_equations(v.screen.points[c[0]], v.screen.points[c[1]], v.screen.points[c[2]]);
    if (is_parallel(view) && std::fabs(q.f) <= errors.f &&
        seen_edge_on(view, scene.mesh.positions[c[0]], scene.mesh.positions[c[1]],
                     scene.mesh.positions[c[2]])) {
      continue;  // a wall seen from above
    }
    Polygon& p = s.polygons.emplace_back();
    set_up(p, q, errors, v.space, view, corners_of(scene, t), s.light, s.stats);
    set_rows(p, q, errors, v.space, v.least_nearness);
    p.add = sides[t] * p.facing;  // +1 from the lit to the unlit side
    p.id = t;
    if (p.first_row >= p.end_row) s.polygons.pop_back();
  }
}

void bin_polygons(LightSetup& s, int bands) {
  s.bin_first.assign(static_cast<std::size_t>(bands) + 1, 0);
  for (const Polygon& p : s.polygons) {
    for (int b = p.first_row / kBandRows; b <= (p.end_row - 1) / kBandRows; ++b) {
      ++s.bin_first[static_cast<std::size_t>(b) + 1];
    }
  }
  for (std::size_t b = 0; b < static_cast<std::size_t>(bands); ++b)
    s.bin_first[b + 1] += s.bin_first[b];
  s.bins.resize(s.bin_first.back());
  std::vector<std::uint32_t> next(s.bin_first.begin(), s.bin_first.end() - 1);
  for (std::uint32_t i = 0; i < s.polygons.size(); ++i) {
    const Polygon& p = s.polygons[i];
    for (int b = p.first_row / kBandRows; b <= (p.end_row - 1) / kBandRows; ++b) {
      s.bins[next[static_cast<std::size_t>(b)]++] = i;
    }
  }
}

// `tree`: of the casters' edges, or nullptr.
void set_up_light(LightSetup& s, const Casters& casters, const Receivers& r, const ViewSetup& v,
                  const EdgeTree* tree, const Light& light) {
  s.polygons.clear();  // but keep their memory: pages that the system must not clear again
  s.stats = {};
  s.light = snapped(light);
  const Scene& scene = *casters.scene;
  std::vector<std::int8_t> sides;
  const bool sides_alone =
      is_parallel(r.view) && s.light.w == 0 && !r.casters_in_front && !r.receivers_not_casting;
  if (tree == nullptr || !sides_alone) sides = light_sides(scene.mesh, s.light, &s.stats);
  if (tree == nullptr) {
    s.silhouette = find_silhouette(casters.edges, sides);
  } else {
    ExtractionStats extraction;
    find_silhouette(s.silhouette, *tree, scene.mesh, s.light, s.scratch, &extraction);
    sort_as_table(s.silhouette, s.unsorted);  // sides that lie together fill rows that do
    s.stats += extraction.exact;
  }
  const ScreenPoint<double> minus_light = project(v.space, -s.light);
  const ScreenPoint<Bound> light_bound = project_bound(v.space, glm::abs(s.light));
  const EquationErrors errors =
      equation_errors(v.screen.bound, v.screen.bound, light_bound, r.view.width, r.view.height);
  const std::size_t sides_in_front = looks_with_light(r.view, s.light) ? 0 : s.silhouette.size();
  s.polygons.reserve(sides_in_front);
  for (std::uint32_t i = 0; i < sides_in_front; ++i) {
    add_side(s, v, casters, r.view, errors, minus_light, light_bound, i);
  }
  s.sides = s.polygons.size();
  if (r.casters_in_front) add_casters(s, v, casters, r.view, sides);
  s.eye_count = count_at_eye(casters, v, r.view, s.light, sides, s.stats);
  bin_polygons(s, static_cast<int>(v.band_least.size()));
  if (r.receivers_not_casting) {
    s.unlit.assign(scene.mesh.triangles.size(), 0);
    for (std::uint32_t t = 0; t < s.unlit.size(); ++t) {
      if (!receives(scene, t) || is_caster(casters, t)) continue;
      s.unlit[t] = sides[t] != facing(r.view, corners_of(scene, t), s.light, s.stats);
    }
  }
}

class Exact final : public ExactDecisions {
 public:
  Exact(const Casters& casters, const Receivers& receivers, const LightSetup& light)
      : casters_(casters), receivers_(receivers), light_(light) {}

  Span span(const Polygon& p, int row) override {
    return exact_span(p, {receivers_.view, corners(p), p.facing, light_.light}, row, spans);
  }

  bool in_front(const Polygon& p, int column, int row) override {
    const std::uint32_t triangle =
        receivers_.triangle[static_cast<std::size_t>(row) *
                                static_cast<std::size_t>(receivers_.view.width) +
                            static_cast<std::size_t>(column)];
    if (triangle == kNoTriangle) return false;
    if (last_polygon_ != &p) {
      last_polygon_ = &p;
      in_plane_.clear();
    }
    for (const InPlane& known : in_plane_) {
      if (known.triangle != triangle) continue;
      ++close;
      ++depths.exact;
      ++depths.ties;
      return known.in_front;
    }
    const Corners r = corners_of(*casters_.scene, triangle), c = corners(p);
    if (triangle != last_triangle_) {
      last_triangle_ = triangle;
      last_facing_ = facing(receivers_.view, r, light_.light, depths);
    }
    ++close;
    const std::uint64_t ties = depths.ties;
    const bool front = gnomon::in_front(receivers_.view, column, row, c, p.facing, r, last_facing_,
                                        light_.light, depths);
    if (depths.ties > ties && in_one_plane(c, r, light_.light))
      in_plane_.push_back({triangle, front});
    return front;
  }

  ExactStats spans, depths;
  std::uint64_t close = 0;  // samples that left the float filter

 private:
  bool is_side(const Polygon& p) const {
    return static_cast<std::size_t>(&p - light_.polygons.data()) < light_.sides;
  }

  Corners corners(const Polygon& p) const {
    if (!is_side(p)) return corners_of(*casters_.scene, p.id);
    const SilhouetteEdge& e = light_.silhouette[p.id];
    return side_corners(casters_.scene->mesh.positions[e.a], casters_.scene->mesh.positions[e.b]);
  }

  // A receiver in the polygon's plane: the answer is one for all pixels (docs/exactness.md).
  struct InPlane {
    std::uint32_t triangle;
    bool in_front;
  };

  const Casters& casters_;
  const Receivers& receivers_;
  const LightSetup& light_;
  std::uint32_t last_triangle_ = kNoTriangle;
  int last_facing_ = 0;
  const Polygon* last_polygon_ = nullptr;
  std::vector<InPlane> in_plane_;  // of last_polygon_
};

// Rows of the picture with everything that does not depend on the light.
struct BandMemory {
  int first_row, rows, stride;
  const float* nearness;
  std::vector<float> padded;  // of the last band, beyond whose end nothing may be read
  std::vector<std::int32_t> counts;

  BandMemory(const Receivers& r, int band)
      : first_row(band * kBandRows),
        rows(std::min(kBandRows, r.view.height - first_row)),
        stride(r.view.width + kPadding) {
    const std::size_t width = static_cast<std::size_t>(r.view.width),
                      n = static_cast<std::size_t>(rows);
    nearness = r.nearness.data() + static_cast<std::size_t>(first_row) * width;
    if (r.nearness.size() < static_cast<std::size_t>(first_row + rows) * width + kPadding) {
      padded.assign(n * width + kPadding, 0.0F);
      std::copy_n(nearness, n * width, padded.data());
      nearness = padded.data();
    }
    counts.resize(n * static_cast<std::size_t>(stride));
  }
};

template <class F>
void for_each_sample(const Receivers& r, BandMemory& m, F f) {
  for (int row = 0; row < m.rows; ++row) {
    const std::uint32_t* triangle =
        r.triangle.data() +
        static_cast<std::size_t>(m.first_row + row) * static_cast<std::size_t>(r.view.width);
    std::int32_t* counts =
        m.counts.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(m.stride);
    for (int x = 0; x < r.view.width; ++x) {
      if (triangle[x] != kNoTriangle) f(triangle[x], counts[x]);
    }
  }
}

}  // namespace

Casters prepare_casters(const Scene& scene) {
  Casters c;
  c.scene = &scene;
  const auto all = std::all_of(scene.surfaces.begin(), scene.surfaces.end(),
                               [](const Surface& s) { return s.casts; });
  if (!all) {
    c.selected.resize(scene.mesh.triangles.size());
    for (std::uint32_t t = 0; t < c.selected.size(); ++t) c.selected[t] = casts(scene, t) ? 1 : 0;
  }
  c.edges = build_edge_table(scene.mesh, c.selected);
  return c;
}

CountStats count_shadows(const Casters& casters, const Receivers& receivers,
                         std::span<const Light> lights, const BandSink& sink, int threads) {
  CountStats stats;
  std::mutex stats_mutex;
  const ViewSetup view = set_up_view(casters, receivers, lights, threads);
  const int bands = static_cast<int>(view.band_least.size());
  // A third of the edges of closed meshes are on the silhouette of a sun at most; the rest is
  // refused when it is set up.
  const std::size_t bytes =
      std::max<std::size_t>(1, casters.edges.vertices.size() / 3 * sizeof(Polygon));
  const std::size_t batch = std::clamp<std::size_t>(kBatchBytes / bytes, 1, kBatchLights);

  EdgeTree tree;
  if (lights.size() >= kLightsForTree) tree = build_edge_tree(casters.scene->mesh, casters.edges);

  std::vector<LightSetup> setups(std::min(batch, lights.size()));
  for (std::size_t begin = 0; begin < lights.size(); begin += batch) {
    const std::size_t n = std::min(batch, lights.size() - begin);
    parallel_for(static_cast<int>(n), threads, [&](int i) {
      set_up_light(setups[static_cast<std::size_t>(i)], casters, receivers, view,
                   lights.size() >= kLightsForTree ? &tree : nullptr,
                   lights[begin + static_cast<std::size_t>(i)]);
    });
    parallel_for(bands, threads, [&](int b) {
      BandMemory memory(receivers, b);
      CountStats local;
      for (std::size_t i = 0; i < n; ++i) {
        const LightSetup& s = setups[i];
        std::fill(memory.counts.begin(), memory.counts.end(), 0);
        if (s.eye_count != 0) {
          for_each_sample(receivers, memory,
                          [&](std::uint32_t, std::int32_t& c) { c = s.eye_count; });
        }
        Exact exact(casters, receivers, s);
        BandJob job;
        job.polygons = s.polygons.data();
        job.selected = s.bins.data() + s.bin_first[static_cast<std::size_t>(b)];
        job.count =
            s.bin_first[static_cast<std::size_t>(b) + 1] - s.bin_first[static_cast<std::size_t>(b)];
        job.first_row = memory.first_row;
        job.rows = memory.rows;
        job.width = receivers.view.width;
        job.stride = memory.stride;
        job.nearness = memory.nearness;
        job.nearness_stride = receivers.view.width;
        job.counts = memory.counts.data();
        job.least_nearness = view.band_least[static_cast<std::size_t>(b)];
        job.nearness_floor = receivers.nearness_floor;
        job.exact = &exact;
        fill_band(job);
        if (!s.unlit.empty()) {
          for_each_sample(receivers, memory, [&](std::uint32_t t, std::int32_t& c) {
            if (s.unlit[t] != 0) c = std::max(c, 1);
          });
        }
        sink({static_cast<int>(begin + i), memory.first_row, memory.rows, receivers.view.width,
              memory.stride, memory.counts.data()});
        local.spans += exact.spans;
        local.depths += exact.depths;
        local.close += exact.close;
      }
      const std::lock_guard lock(stats_mutex);
      stats.spans += local.spans;
      stats.depths += local.depths;
      stats.close += local.close;
    });
    for (std::size_t i = 0; i < n; ++i) {
      const LightSetup& s = setups[i];
      stats.signs += s.stats;
      stats.sides += s.silhouette.size();
      stats.triangles += casters.scene->mesh.triangles.size();
    }
  }
  return stats;
}

}  // namespace gnomon
