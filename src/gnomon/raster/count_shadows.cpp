#include <gnomon/raster/count_shadows.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>

#include <hwy/aligned_allocator.h>
#include <glm/common.hpp>

#include <gnomon/core/parallel.h>
#include <gnomon/raster/fill_band.h>
#include <gnomon/raster/fill_strips.h>
#include <gnomon/raster/least_cells.h>
#include <gnomon/raster/polygon.h>
#include <gnomon/raster/strip.h>
#include <gnomon/silhouette/edge_tree.h>
#include <gnomon/silhouette/silhouette.h>
#include <gnomon/silhouette/vector_silhouette.h>

namespace gnomon {
namespace {

constexpr int kBandRows = 32;  // counts and nearness of a band stay in the second-level cache
static_assert(kBandRows <= kBandRowsMax && kBandRows <= kStripRowsMax);
static_assert(kBandRows % (1 << kCellShift) == 0);  // whole cells

// Polygons of this many bytes are set up before they are filled: several lights share one pass over
// the bands.
constexpr std::size_t kBatchBytes = std::size_t{96} << 20;
constexpr std::size_t kBatchLights = 16;
// A tree of edges is built for as many lights: one light costs brute force 8 ns a triangle and the
// tree 1, and building it, by one thread, 500 to 2000 (docs/silhouettes.md).
constexpr std::size_t kLightsForTree = 512;

Corners corners_of(const Scene& scene, std::uint32_t triangle) {
  const Triangle& t = scene.mesh.triangles[triangle];
  return triangle_corners(scene.mesh.positions[t[0]], scene.mesh.positions[t[1]],
                          scene.mesh.positions[t[2]]);
}

bool is_caster(const Casters& c, std::uint32_t triangle) {
  return c.selected.empty() || c.selected[triangle] != 0;
}

// What all lights share.
struct ViewSetup {
  ScreenSpace space;
  ScreenPoints screen;
  LeastCells made_cells;           // where the receivers have none
  double least_nearness = 0;       // of all samples; infinity: there are none
  std::vector<double> band_least;  // per band
};

// CSR: what touches each band.
struct Bins {
  std::vector<std::uint32_t> first, items;
  std::span<const std::uint32_t> of(std::size_t band) const {
    return {items.data() + first[band], first[band + 1] - first[band]};
  }
};

// Silhouette edges are set up in runs of this many, in parallel. The strips of a run begin at the
// index of its first edge; what follows the last one is not used.
constexpr std::size_t kRun = 4096;
struct Run {
  std::size_t strips = 0;
  std::vector<std::uint32_t> ids;  // of edges that are no point
  std::vector<UnsureStrip> unsure;
  std::vector<Polygon> polygons;
  ExactStats stats;
};

// One light, ready to be filled.
struct LightSetup {
  Light light{0, 0, 0, 0};
  Silhouette silhouette;
  std::vector<Polygon>
      polygons;           // sides first (id: index into silhouette), then casters (id: triangle)
  std::size_t sides = 0;  // how many of the polygons are sides
  Bins bins;              // of the polygons
  std::vector<Strip> strips;  // the sides that need no polygon, run by run
  std::vector<Run> runs;
  bool looks_with_light = false;            // there are no sides
  std::vector<std::int8_t> triangle_sides;  // as light_sides(); empty where they are not needed
  StripLight strip_light;
  Bins strip_bins;
  ScreenPoint<double> minus_light{};
  EquationErrors errors;       // of the sides' equations
  std::int32_t eye_count = 0;  // C(e)
  std::vector<std::uint8_t>
      unlit;  // per triangle that receives but does not cast: the light is not on its seen side
  ExactStats stats;
  ExtractionScratch scratch;
  Silhouette unsorted;
};

const LeastCells& cells_of(const ViewSetup& v, const Receivers& r) {
  return r.cells.levels.empty() ? v.made_cells : r.cells;
}

ViewSetup set_up_view(const Casters& casters, const Receivers& r, int threads) {
  ViewSetup v;
  v.space = screen_space(r.view);
  v.screen = project_all(v.space, casters.scene->mesh.positions, threads);
  if (r.cells.levels.empty()) v.made_cells = least_cells(*casters.scene, r, threads);
  const LeastCells::Level& cells = cells_of(v, r).levels[0];
  const int bands = (r.view.height + kBandRows - 1) / kBandRows;
  for (int b = 0; b < bands; ++b) {
    const auto begin = cells.least.begin() +
                       static_cast<std::ptrdiff_t>((b * kBandRows) >> kCellShift) * cells.width;
    const auto end = cells.least.begin() + static_cast<std::ptrdiff_t>(std::min(
                                               ((b + 1) * kBandRows) >> kCellShift, cells.height)) *
                                               cells.width;
    v.band_least.push_back(static_cast<double>(*std::min_element(begin, end)));
  }
  v.least_nearness = *std::min_element(v.band_least.begin(), v.band_least.end());
  return v;
}

PolygonEquations<double> equations_of_side(const LightSetup& s, const ViewSetup& v,
                                           std::uint32_t index) {
  const SilhouetteEdge& e = s.silhouette[index];
  return polygon_equations(v.screen.points[e.a], v.screen.points[e.b], s.minus_light);
}

Corners corners_of_side(const LightSetup& s, const Casters& casters, std::uint32_t index) {
  const SilhouetteEdge& e = s.silhouette[index];
  return side_corners(casters.scene->mesh.positions[e.a], casters.scene->mesh.positions[e.b]);
}

// `rows`: that it touches at most.
void add_side(const LightSetup& s, Run& run, const ViewSetup& v, const Casters& casters,
              const View& view, const ScreenPoint<Bound>& light_bound, std::uint32_t index,
              std::pair<int, int> rows) {
  const SilhouetteEdge& e = s.silhouette[index];
  const Vec3 &a = casters.scene->mesh.positions[e.a], &b = casters.scene->mesh.positions[e.b];
  const PolygonEquations<double> q = equations_of_side(s, v, index);
  if (std::fabs(q.f) <= s.errors.f && seen_end_on(view, a, b)) return;
  Polygon& p = run.polygons.emplace_back();
  set_up(p, q, s.errors, v.space, view, side_corners(a, b), s.light, run.stats);
  const bool strip = is_parallel(view) && s.light.w == 0 &&
                     set_rows_of_strip(p, v.screen.points[e.a], v.screen.points[e.b], s.minus_light,
                                       v.screen.bound, light_bound, v.space, v.least_nearness);
  if (!strip) set_rows(p, q, s.errors, v.space, v.least_nearness);
  p.first_row = std::max(p.first_row, rows.first);
  p.end_row = std::min(p.end_row, rows.second);
  p.add = -e.multiplicity * p.facing;
  p.id = index;
  if (p.first_row >= p.end_row) run.polygons.pop_back();
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

// for_each(f) calls f(index, first row, end row) for each item, which is not empty; the same twice.
template <class ForEach>
void bin(Bins& bins, int bands, const ForEach& for_each) {
  bins.first.assign(static_cast<std::size_t>(bands) + 2, 0);
  for_each([&](std::size_t, int first, int end) {
    for (int b = first / kBandRows; b <= (end - 1) / kBandRows; ++b)
      ++bins.first[static_cast<std::size_t>(b) + 2];
  });
  for (std::size_t b = 2; b < bins.first.size(); ++b) bins.first[b] += bins.first[b - 1];
  bins.items.resize(bins.first.back());
  for_each([&](std::size_t index, int first, int end) {  // first[b + 1] moves on to first[b + 2]
    for (int b = first / kBandRows; b <= (end - 1) / kBandRows; ++b)
      bins.items[bins.first[static_cast<std::size_t>(b) + 1]++] = static_cast<std::uint32_t>(index);
  });
}

// The first step of a light: which edges are its silhouette. `tree`: of the casters' edges, or
// nullptr.
void find_sides(LightSetup& s, const Casters& casters, const Receivers& r, const ViewSetup& v,
                const EdgeTree* tree, const Light& light, int threads) {
  s.polygons.clear();  // but keep their memory: pages that the system must not clear again
  s.stats = {};
  s.light = snapped(light);
  const Scene& scene = *casters.scene;
  const bool sides_alone =
      is_parallel(r.view) && s.light.w == 0 && !r.casters_in_front && !r.receivers_not_casting;
  if (tree == nullptr || !sides_alone) {
    sides_from_planes(s.triangle_sides, scene.mesh, casters.planes, s.light, threads, &s.stats);
  }
  if (tree == nullptr) {
    find_silhouette_in_vectors(s.silhouette, casters.edges, s.triangle_sides, threads);
  } else {
    ExtractionStats extraction;
    find_silhouette(s.silhouette, *tree, scene.mesh, s.light, s.scratch, &extraction);
    sort_as_table(s.silhouette, s.unsorted);  // sides that lie together fill rows that do
    s.stats += extraction.exact;
  }
  s.minus_light = project(v.space, -s.light);
  const ScreenPoint<Bound> light_bound = project_bound(v.space, glm::abs(s.light));
  s.errors =
      equation_errors(v.screen.bound, v.screen.bound, light_bound, r.view.width, r.view.height);
  s.looks_with_light = looks_with_light(r.view, s.light);
  s.strip_light = {};
  if (is_parallel(r.view) && s.light.w == 0) {
    s.strip_light = strip_light(s.minus_light, v.screen.bound, light_bound, r.nearness_floor,
                                r.view.width, r.view.height);
  }
  if (s.strip_light.usable && s.strips.size() < s.silhouette.size())
    s.strips.resize(s.silhouette.size() + s.silhouette.size() / 4);
  s.runs.resize(s.looks_with_light ? 0 : (s.silhouette.size() + kRun - 1) / kRun);
}

// The second: the sides over a run of edges, as strips where the view and the light allow it, else
// as polygons.
void set_up_run(LightSetup& s, std::size_t index, const Casters& casters, const Receivers& r,
                const ViewSetup& v) {
  Run& run = s.runs[index];
  const View& view = r.view;
  run.strips = 0;
  run.polygons.clear();
  run.stats = {};
  const ScreenPoint<Bound> light_bound = project_bound(v.space, glm::abs(s.light));
  const std::size_t begin = index * kRun, end = std::min(s.silhouette.size(), begin + kRun);
  const auto add = [&](std::uint32_t id, int first_row, int end_row) {
    add_side(s, run, v, casters, view, light_bound, id, {first_row, end_row});
  };
  if (!s.strip_light.usable) {
    for (std::size_t i = begin; i < end; ++i) add(static_cast<std::uint32_t>(i), 0, view.height);
    return;
  }
  run.ids.clear();
  for (std::size_t i = begin; i < end; ++i) {
    const SilhouetteEdge& e = s.silhouette[i];
    const ScreenPoint<double>&a = v.screen.points[e.a], &b = v.screen.points[e.b];
    // Seen from above every vertical wall edge is a point.
    if (a.x == b.x && a.y == b.y &&
        seen_end_on(view, casters.scene->mesh.positions[e.a], casters.scene->mesh.positions[e.b])) {
      continue;
    }
    run.ids.push_back(static_cast<std::uint32_t>(i));
  }
  run.unsure.clear();
  run.strips = make_strips(s.silhouette.data(), run.ids.data(), run.ids.size(),
                           v.screen.points.data(), s.strip_light, cells_of(v, r),
                           v.space.orientation, s.strips.data() + begin, run.unsure);
  for (const UnsureStrip& u : run.unsure) add(u.id, u.first_row, u.end_row);
}

// The third: everything else.
void finish_light(LightSetup& s, const Casters& casters, const Receivers& r, const ViewSetup& v,
                  int threads) {
  const Scene& scene = *casters.scene;
  const std::vector<std::int8_t>& sides = s.triangle_sides;
  for (const Run& run : s.runs) {
    s.polygons.insert(s.polygons.end(), run.polygons.begin(), run.polygons.end());
    s.stats += run.stats;
  }
  s.sides = s.polygons.size();
  if (r.casters_in_front) add_casters(s, v, casters, r.view, sides);
  s.eye_count = count_between_eye_and_light(scene.mesh, casters.selected, casters.boxes, r.view,
                                            s.light, threads, s.stats);
  const int bands = static_cast<int>(v.band_least.size());
  bin(s.bins, bands, [&](const auto& f) {
    for (std::size_t i = 0; i < s.polygons.size(); ++i)
      f(i, s.polygons[i].first_row, s.polygons[i].end_row);
  });
  bin(s.strip_bins, bands, [&](const auto& f) {
    for (std::size_t run = 0; run < s.runs.size(); ++run) {
      for (std::size_t i = run * kRun; i < run * kRun + s.runs[run].strips; ++i)
        f(i, s.strips[i].first_row, s.strips[i].first_row + s.strips[i].rows);
    }
  });
  if (r.receivers_not_casting) {
    s.unlit.assign(scene.mesh.triangles.size(), 0);
    for (std::uint32_t t = 0; t < s.unlit.size(); ++t) {
      if (!receives(scene, t) || is_caster(casters, t)) continue;
      s.unlit[t] = sides[t] != facing(r.view, corners_of(scene, t), s.light, s.stats);
    }
  }
}

// Sets up lights, one after the other or at once.
void set_up_lights(std::span<LightSetup> setups, const Casters& casters, const Receivers& r,
                   const ViewSetup& v, const EdgeTree* tree, std::span<const Light> lights,
                   int threads) {
  const int n = static_cast<int>(lights.size());
  const int inner = n == 1 ? threads : 1;  // several lights keep the threads busy as they are
  parallel_for(n, threads, [&](int i) {
    find_sides(setups[static_cast<std::size_t>(i)], casters, r, v, tree,
               lights[static_cast<std::size_t>(i)], inner);
  });
  std::vector<std::pair<LightSetup*, std::size_t>> runs;
  for (LightSetup& s : setups.first(lights.size())) {
    for (std::size_t k = 0; k < s.runs.size(); ++k) runs.emplace_back(&s, k);
  }
  parallel_for(static_cast<int>(runs.size()), threads, [&](int k) {
    const auto& [s, run] = runs[static_cast<std::size_t>(k)];
    set_up_run(*s, run, casters, r, v);
  });
  parallel_for(n, threads, [&](int i) {
    finish_light(setups[static_cast<std::size_t>(i)], casters, r, v, inner);
  });
}

class Exact final : public ExactDecisions, public ExactStripDecisions {
 public:
  Exact(const Casters& casters, const ViewSetup& view, const Receivers& receivers,
        const LightSetup& light)
      : casters_(casters), view_(view), receivers_(receivers), light_(light) {}

  Span span(const Strip& s, int row) override { return span(polygon(s), row); }
  bool in_front(const Strip& s, int column, int row) override {
    return in_front(polygon(s), column, row);
  }

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
  // What a strip stands for.
  const Polygon& polygon(const Strip& s) {
    if (strip_ != &s) {
      strip_ = &s;
      last_polygon_ = nullptr;
      set_up(of_strip_, equations_of_side(light_, view_, s.id), light_.errors, view_.space,
             receivers_.view, corners_of_side(light_, casters_, s.id), light_.light, depths);
      of_strip_.id = s.id;
    }
    return of_strip_;
  }

  bool is_side(const Polygon& p) const {
    return &p == &of_strip_ || static_cast<std::size_t>(&p - light_.polygons.data()) < light_.sides;
  }

  Corners corners(const Polygon& p) const {
    return is_side(p) ? corners_of_side(light_, casters_, p.id) : corners_of(*casters_.scene, p.id);
  }

  // A receiver in the polygon's plane: the answer is one for all pixels (docs/exactness.md).
  struct InPlane {
    std::uint32_t triangle;
    bool in_front;
  };

  const Casters& casters_;
  const ViewSetup& view_;
  const Receivers& receivers_;
  const LightSetup& light_;
  const Strip* strip_ = nullptr;
  Polygon of_strip_;  // of strip_
  std::uint32_t last_triangle_ = kNoTriangle;
  int last_facing_ = 0;
  const Polygon* last_polygon_ = nullptr;
  std::vector<InPlane> in_plane_;  // of last_polygon_
};

// Rows of the picture with everything that does not depend on the light. Only what is used is made.
struct BandMemory {
  int band = 0, first_row = 0, rows = 0, stride = 0;
  const float* nearness = nullptr;
  std::vector<float> padded;  // of the last band, beyond whose end nothing may be read
  std::vector<std::int32_t> counts;

  // For strips: interleaved (fill_strips.h).
  bool quads = false;  // are those of the band
  std::size_t quad_stride = 0;
  hwy::AlignedFreeUniquePtr<float[]> quad_nearness;
  hwy::AlignedFreeUniquePtr<std::int32_t[]> quad_counts;  // zero between lights

  void move_to(const Receivers& r, int index) {
    band = index;
    first_row = band * kBandRows;
    rows = std::min(kBandRows, r.view.height - first_row);
    stride = r.view.width + kPadding;
    nearness = nullptr;
    quads = false;
  }

  std::size_t size() const { return static_cast<std::size_t>(rows * stride); }

  void need_rows(const Receivers& r) {
    if (nearness != nullptr) return;
    const std::size_t width = static_cast<std::size_t>(r.view.width),
                      n = static_cast<std::size_t>(rows);
    nearness = r.nearness.data() + static_cast<std::size_t>(first_row) * width;
    if (r.nearness.size() < static_cast<std::size_t>(first_row + rows) * width + kPadding) {
      padded.assign(n * width + kPadding, 0.0F);
      std::copy_n(nearness, n * width, padded.data());
      nearness = padded.data();
    }
  }

  void need_quads(const Receivers& r) {
    if (quads) return;
    quads = true;
    if (!quad_nearness) {
      quad_stride = gnomon::quad_stride(r.view.width);
      const std::size_t n = static_cast<std::size_t>(kBandRows / kQuadRows) * quad_stride;
      quad_nearness = hwy::AllocateAligned<float>(n);
      quad_counts = hwy::AllocateAligned<std::int32_t>(n);
      std::fill_n(quad_nearness.get(), n, 0.0F);
      std::fill_n(quad_counts.get(), n, 0);
    }
    interleave_rows(r.nearness.data() + static_cast<std::size_t>(first_row) *
                                            static_cast<std::size_t>(r.view.width),
                    r.view.width, rows, quad_nearness.get(), quad_stride);
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

// Polygons that are filled among strips: with more of them it pays to go row by row.
constexpr std::size_t kFewPolygons = 32;

// The counts of one light in one band, row by row or, if only a mask is wanted, that.
class BandCounter {
 public:
  BandCounter(const Casters& casters, const Receivers& receivers, const ViewSetup& view,
              BandMemory& memory)
      : casters_(casters), receivers_(receivers), view_(view), memory_(memory) {}

  CountBand counts(const LightSetup& s, int light) {
    fill_quads(s);
    fill_rows(s);
    return {light,          memory_.first_row,    memory_.rows, receivers_.view.width,
            memory_.stride, memory_.counts.data()};
  }

  // `to`: of the whole picture.
  void mask(const LightSetup& s, std::uint8_t* to) {
    const int width = receivers_.view.width;
    to += static_cast<std::ptrdiff_t>(memory_.first_row) * width;
    fill_quads(s);
    if (polygons_in_quads(s) && s.eye_count == 0 && s.unlit.empty()) {
      if (!memory_.quads) {
        std::fill_n(to, static_cast<std::ptrdiff_t>(memory_.rows) * width, std::uint8_t{0});
        return;
      }
      take_mask(memory_.quad_counts.get(), memory_.quad_stride, width, memory_.rows, to, width);
      return;
    }
    fill_rows(s);
    for (int row = 0; row < memory_.rows; ++row, to += width) {
      const std::int32_t* from =
          memory_.counts.data() + static_cast<std::ptrdiff_t>(row) * memory_.stride;
      for (int x = 0; x < width; ++x) to[x] = from[x] > 0 ? 1 : 0;
    }
  }

  CountStats stats;

 private:
  std::size_t band() const { return static_cast<std::size_t>(memory_.band); }

  bool polygons_in_quads(const LightSetup& s) const {
    return s.strip_light.usable && s.bins.of(band()).size() <= kFewPolygons;
  }

  // Strips, and the few polygons among them.
  void fill_quads(const LightSetup& s) {
    const std::span<const std::uint32_t> selected = s.strip_bins.of(band());
    const bool polygons = polygons_in_quads(s) && !s.bins.of(band()).empty();
    if (selected.empty() && !polygons) return;
    memory_.need_quads(receivers_);
    Exact exact(casters_, view_, receivers_, s);
    StripJob job;
    job.strips = s.strips.data();
    job.selected = selected.data();
    job.count = selected.size();
    job.slope = static_cast<float>(s.strip_light.k);
    job.first_row = memory_.first_row;
    job.rows = memory_.rows;
    job.nearness = memory_.quad_nearness.get();
    job.counts = memory_.quad_counts.get();
    job.stride = memory_.quad_stride;
    job.exact = &exact;
    fill_strips(job);
    if (polygons) {
      for (const std::uint32_t index : s.bins.of(band()))
        fill_polygon_in_quads(s.polygons[index], exact);
    }
    add(exact);
  }

  // Sample by sample, in double.
  void fill_polygon_in_quads(const Polygon& p, Exact& exact) {
    const BandMemory& m = memory_;
    const int width = receivers_.view.width;
    const int end = std::min(p.end_row, m.first_row + m.rows);
    for (int row = std::max(p.first_row, m.first_row); row < end; ++row) {
      bool undecided = false;
      Span span = widest_span(p, row, width, undecided);
      if (span.begin >= span.end) continue;
      if (undecided) span = exact.span(p, row);
      const double at_row = p.g.c + p.g.b * (row + kPixelCentre);
      const std::size_t base =
          static_cast<std::size_t>((row - m.first_row) / kQuadRows) * m.quad_stride +
          static_cast<std::size_t>((row - m.first_row) % kQuadRows);
      for (int x = span.begin; x < span.end; ++x) {
        const std::size_t k = base + static_cast<std::size_t>(x) * kQuadRows;
        const double nearness = at_row + p.g.a * (x + kPixelCentre);
        const double difference = nearness - static_cast<double>(m.quad_nearness[k]);
        const double error =
            (static_cast<double>(p.error_absolute) + receivers_.nearness_floor +
             (static_cast<double>(p.error_relative) + kFloatCompare) * std::fabs(nearness)) *
            (1 + 0x1p-20);
        const bool sure = std::fabs(difference) > error;  // false for NaN
        if (sure ? difference > 0 : exact.in_front(p, x, row)) m.quad_counts[k] += p.add;
      }
    }
  }

  // Everything, in memory_.counts.
  void fill_rows(const LightSetup& s) {
    BandMemory& m = memory_;
    m.counts.assign(static_cast<std::size_t>(m.rows * m.stride), 0);
    if (s.eye_count != 0)
      for_each_sample(receivers_, m, [&](std::uint32_t, std::int32_t& c) { c = s.eye_count; });
    if (m.quads) {
      take_counts(m.quad_counts.get(), m.quad_stride, receivers_.view.width, m.rows,
                  m.counts.data(), m.stride);
    }
    const std::span<const std::uint32_t> selected = s.bins.of(band());
    if (!selected.empty() && !polygons_in_quads(s)) {
      m.need_rows(receivers_);
      Exact exact(casters_, view_, receivers_, s);
      BandJob job;
      job.polygons = s.polygons.data();
      job.selected = selected.data();
      job.count = selected.size();
      job.first_row = m.first_row;
      job.rows = m.rows;
      job.width = receivers_.view.width;
      job.stride = m.stride;
      job.nearness = m.nearness;
      job.nearness_stride = receivers_.view.width;
      job.counts = m.counts.data();
      job.least_nearness = view_.band_least[band()];
      job.nearness_floor = receivers_.nearness_floor;
      job.exact = &exact;
      fill_band(job);
      add(exact);
    }
    if (!s.unlit.empty()) {
      for_each_sample(receivers_, m, [&](std::uint32_t t, std::int32_t& c) {
        if (s.unlit[t] != 0) c = std::max(c, 1);
      });
    }
  }

  void add(const Exact& exact) {
    stats.spans += exact.spans;
    stats.depths += exact.depths;
    stats.close += exact.close;
  }

  const Casters& casters_;
  const Receivers& receivers_;
  const ViewSetup& view_;
  BandMemory& memory_;
};

// Memory of bands that nobody works on.
class BandMemories {
 public:
  std::unique_ptr<BandMemory> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<BandMemory>();
    std::unique_ptr<BandMemory> m = std::move(free_.back());
    free_.pop_back();
    return m;
  }
  void give(std::unique_ptr<BandMemory> m) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(m));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<BandMemory>> free_;
};

// finish(counter, setup, light): hands the band to a sink.
template <class Finish>
CountStats count(const Casters& casters, const Receivers& receivers, std::span<const Light> lights,
                 int threads, const Finish& finish) {
  CountStats stats;
  std::mutex stats_mutex;
  const ViewSetup view = set_up_view(casters, receivers, threads);
  const int bands = static_cast<int>(view.band_least.size());
  // A third of the edges of closed meshes are on the silhouette of a sun at most; the rest is
  // refused when it is set up.
  const std::size_t bytes =
      std::max<std::size_t>(1, casters.edges.vertices.size() / 3 * sizeof(Polygon));
  const std::size_t batch = std::clamp<std::size_t>(kBatchBytes / bytes, 1, kBatchLights);

  EdgeTree tree;
  if (lights.size() >= kLightsForTree) tree = build_edge_tree(casters.scene->mesh, casters.edges);

  BandMemories memories;
  std::vector<LightSetup> setups(std::min(batch, lights.size()));
  for (std::size_t begin = 0; begin < lights.size(); begin += batch) {
    const std::size_t n = std::min(batch, lights.size() - begin);
    set_up_lights(setups, casters, receivers, view,
                  lights.size() >= kLightsForTree ? &tree : nullptr, lights.subspan(begin, n),
                  threads);
    parallel_for(bands, threads, [&](int b) {
      std::unique_ptr<BandMemory> memory = memories.take();
      memory->move_to(receivers, b);
      BandCounter counter(casters, receivers, view, *memory);
      for (std::size_t i = 0; i < n; ++i) finish(counter, setups[i], static_cast<int>(begin + i));
      memories.give(std::move(memory));
      const std::lock_guard lock(stats_mutex);
      stats.spans += counter.stats.spans;
      stats.depths += counter.stats.depths;
      stats.close += counter.stats.close;
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
  c.planes = light_planes(scene.mesh, 1);
  c.boxes = run_boxes(scene.mesh, c.selected);
  return c;
}

CountStats count_shadows(const Casters& casters, const Receivers& receivers,
                         std::span<const Light> lights, const BandSink& sink, int threads) {
  return count(casters, receivers, lights, threads,
               [&](BandCounter& counter, const LightSetup& s, int light) {
                 sink(counter.counts(s, light));
               });
}

CountStats mask_shadows(const Casters& casters, const Receivers& receivers,
                        std::span<const Light> lights, std::span<std::uint8_t* const> masks,
                        int threads) {
  assert(masks.size() == lights.size());
  return count(casters, receivers, lights, threads,
               [&](BandCounter& counter, const LightSetup& s, int light) {
                 counter.mask(s, masks[static_cast<std::size_t>(light)]);
               });
}

}  // namespace gnomon
