#include <gnomon/raster/light_setup.h>

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <gnomon/core/parallel.h>
#include <gnomon/raster/least_cells.h>
#include <gnomon/silhouette/vector_silhouette.h>

namespace gnomon {

Corners corners_of(const Scene& scene, std::uint32_t triangle) {
  const Triangle& t = scene.mesh.triangles[triangle];
  return triangle_corners(scene.mesh.positions[t[0]], scene.mesh.positions[t[1]],
                          scene.mesh.positions[t[2]]);
}

bool is_caster(const Casters& c, std::uint32_t triangle) {
  return c.selected.empty() || c.selected[triangle] != 0;
}

namespace {

// Under which light, if any, sides are strips.
StripLight strips_under(const ViewSetup& v, const Receivers& r, const Light& light) {
  // Casters in front of receivers have no strips, and are counted together with the sides.
  if (!is_parallel(r.view) || light.w != 0 || r.casters_in_front) return {};
  return strip_light(project(v.space, -light), v.screen.bound,
                     project_bound(v.space, glm::abs(light)), r.nearness_floor, r.view.width,
                     r.view.height);
}

double least_nearness(const LeastCells& cells) {
  return static_cast<double>(cells.levels.back().least[0]);
}
double least_nearness(const NearnessTiles& tiles) {
  return static_cast<double>(
      *std::min_element(tiles.fields.least.begin(), tiles.fields.least.end()));
}

// A side that is no strip. `rows`: that it touches at most.
void add_polygon(const LightSetup& s, SetupRun& run, const ViewSetup& v, const Casters& casters,
                 const Receivers& r, const UnsureStrip& unsure) {
  const SilhouetteEdge& e = s.silhouette[unsure.id];
  const Vec3 &a = casters.scene->mesh.positions[e.a], &b = casters.scene->mesh.positions[e.b];
  const PolygonEquations<double> q = equations_of_side(s, v, unsure.id);
  if (std::fabs(q.f) <= s.errors.f && seen_end_on(r.view, a, b)) return;
  Polygon& p = run.polygons.emplace_back();
  set_up(p, q, s.errors, v.space, r.view, side_corners(a, b), s.light, run.stats);
  const double least = least_nearness(cells_of(v, r));
  if (!set_rows_of_strip(p, v.screen.points[e.a], v.screen.points[e.b], s.minus_light,
                         v.screen.bound, s.strip_light.light, v.space, least)) {
    set_rows(p, q, s.errors, v.space, least);
  }
  p.first_row = std::max(p.first_row, unsure.first_row);
  p.end_row = std::min(p.end_row, unsure.end_row);
  p.add = -e.multiplicity * p.facing;
  p.id = unsure.id;
  if (p.first_row >= p.end_row) run.polygons.pop_back();
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
  s.strip_light = strips_under(v, r, s.light);
  s.by_strips = s.strip_light.usable;
  s.edge_runs = s.looks_with_light ? 0 : (s.silhouette.size() + kRun - 1) / kRun;
  const std::size_t caster_runs =
      r.casters_in_front ? (scene.mesh.triangles.size() + kRun - 1) / kRun : 0;
  s.runs.resize(s.edge_runs + caster_runs);
  // With room to grow: the next light has another silhouette.
  const std::size_t most = s.runs.size() * kRun;
  if (s.by_strips && s.strips.size() < most) {
    s.strips.resize(most + most / 4);
  } else if (!s.by_strips && s.room_for_sides < most) {
    s.room_for_sides = most + most / 4;
    s.sides = std::make_unique_for_overwrite<Side[]>(s.room_for_sides);
  }
}

bool at_eye(const View& v, const Light& l) { return !is_parallel(v) && l.w == 1 && v.eye == l; }

bool in_box(const Vec3& a, const Vec3& b, const Vec3& p) {
  return glm::all(glm::lessThanEqual(glm::min(a, b), p)) &&
         glm::all(glm::lessThanEqual(p, glm::max(a, b)));
}

// The second, over a run of edges: their strips, and polygons for what strips cannot be trusted
// with.
void make_strips_of_run(LightSetup& s, std::size_t index, const Casters& casters,
                        const Receivers& r, const ViewSetup& v) {
  SetupRun& run = s.runs[index];
  run.ids.clear();
  const std::size_t begin = index * kRun, end = std::min(s.silhouette.size(), begin + kRun);
  for (std::size_t i = begin; i < end; ++i) {
    const SilhouetteEdge& e = s.silhouette[i];
    const ScreenPoint<double>&a = v.screen.points[e.a], &b = v.screen.points[e.b];
    // Seen from above every vertical wall edge is a point.
    if (a.x == b.x && a.y == b.y &&
        seen_end_on(r.view, casters.scene->mesh.positions[e.a],
                    casters.scene->mesh.positions[e.b])) {
      continue;
    }
    run.ids.push_back(static_cast<std::uint32_t>(i));
  }
  run.unsure.clear();
  run.made = make_strips(s.silhouette.data(), run.ids.data(), run.ids.size(),
                         v.screen.points.data(), s.strip_light, cells_of(v, r), v.space.orientation,
                         s.strips.data() + begin, run.unsure);
  for (const UnsureStrip& u : run.unsure) add_polygon(s, run, v, casters, r, u);
}

// The same as sides, and the blocks that they reach.
void make_sides_of_run(LightSetup& s, std::size_t index, const Casters& casters, const Receivers& r,
                       const ViewSetup& v) {
  SetupRun& run = s.runs[index];
  const Scene& scene = *casters.scene;
  const std::vector<Vec3>& positions = scene.mesh.positions;
  const NearnessTiles& tiles = tiles_of(v, r);
  const std::size_t first = index * kRun;
  SideSetup setup;
  setup.space = &v.space;
  setup.points = v.screen.points.data();
  setup.least_nearness = least_nearness(tiles);
  setup.nearness_floor = r.nearness_floor;
  if (index < s.edge_runs) {
    setup.errors = s.errors;
    setup.facing = [&](std::uint32_t id) {
      const SilhouetteEdge& e = s.silhouette[id];
      if (seen_end_on(r.view, positions[e.a], positions[e.b])) return 0;
      // Seen from the lamp itself every side is its edge and nothing else (docs/exactness.md).
      if (at_eye(r.view, s.light) && !in_box(positions[e.a], positions[e.b], Vec3(s.light)))
        return 0;
      return facing(r.view, corners_of_side(s, casters, id), s.light, run.stats);
    };
    run.made =
        make_sides(setup, s.silhouette.data(), first, std::min(s.silhouette.size(), first + kRun),
                   s.minus_light, s.sides.get() + first);
  } else {
    // Casters that do not receive: rays may cross them before they reach their sample. One that
    // receives cannot be in front of the first receiver.
    const std::size_t begin = (index - s.edge_runs) * kRun,
                      end = std::min(scene.mesh.triangles.size(), begin + kRun);
    run.ids.clear();
    for (std::size_t i = begin; i < end; ++i) {
      const auto t = static_cast<std::uint32_t>(i);
      if (is_caster(casters, t) && !receives(scene, t)) run.ids.push_back(t);
    }
    setup.errors = equation_errors(v.screen.bound, v.screen.bound, v.screen.bound, r.view.width,
                                   r.view.height);
    setup.facing = [&](std::uint32_t id) {
      const Triangle& t = scene.mesh.triangles[id];
      if (is_parallel(r.view) &&
          seen_edge_on(r.view, positions[t[0]], positions[t[1]], positions[t[2]])) {
        return 0;  // a wall seen from above
      }
      return facing(r.view, corners_of(scene, id), s.light, run.stats);
    };
    run.made = make_caster_sides(setup, scene.mesh.triangles.data(), run.ids.data(), run.ids.size(),
                                 s.triangle_sides.data(), s.sides.get() + first);
  }
  run.hits.some.clear();
  run.hits.whole.clear();
  find_blocks(s.sides.get(), first, first + run.made, tiles, run.hits);
}

void set_up_run(LightSetup& s, std::size_t index, const Casters& casters, const Receivers& r,
                const ViewSetup& v) {
  SetupRun& run = s.runs[index];
  run.made = 0;
  run.polygons.clear();  // but keep their memory: pages that the system must not clear again
  run.stats = {};
  if (s.by_strips) {
    make_strips_of_run(s, index, casters, r, v);
  } else {
    make_sides_of_run(s, index, casters, r, v);
  }
}

void bin_strips(LightSetup& s, int bands) {
  s.polygons.clear();
  for (const SetupRun& run : s.runs)
    s.polygons.insert(s.polygons.end(), run.polygons.begin(), run.polygons.end());
  bin(s.bins, bands, [&](const auto& f) {
    for (std::size_t i = 0; i < s.polygons.size(); ++i)
      f(i, s.polygons[i].first_row, s.polygons[i].end_row);
  });
  bin(s.strip_bins, bands, [&](const auto& f) {
    for (std::size_t run = 0; run < s.runs.size(); ++run) {
      for (std::size_t i = run * kRun; i < run * kRun + s.runs[run].made; ++i)
        f(i, s.strips[i].first_row, s.strips[i].first_row + s.strips[i].rows);
    }
  });
}

void bin_sides(LightSetup& s, const NearnessTiles& tiles) {
  const std::size_t blocks =
      static_cast<std::size_t>(tiles.blocks_wide) * static_cast<std::size_t>(tiles.blocks_high);
  s.block_counts.assign(blocks, 0);
  std::vector<std::uint32_t>& first = s.side_bins.first;
  first.assign(blocks + 2, 0);
  for (const SetupRun& run : s.runs) {
    for (const WholeBlock& w : run.hits.whole) s.block_counts[w.block] += w.add;
    for (const SideInBlock& hit : run.hits.some) ++first[hit.block + 2];
  }
  for (std::size_t b = 2; b < first.size(); ++b) first[b] += first[b - 1];
  s.side_bins.items.resize(first.back());
  for (const SetupRun& run : s.runs) {
    for (const SideInBlock& hit : run.hits.some)
      s.side_bins.items[first[hit.block + 1]++] = hit.side;
  }
}

// The third: everything else.
void finish_light(LightSetup& s, const Casters& casters, const Receivers& r, const ViewSetup& v,
                  int threads) {
  const Scene& scene = *casters.scene;
  const std::vector<std::int8_t>& sides = s.triangle_sides;
  for (const SetupRun& run : s.runs) s.stats += run.stats;
  s.eye_count = count_between_eye_and_light(scene.mesh, casters.selected, casters.boxes, r.view,
                                            s.light, threads, s.stats);
  if (s.by_strips) {
    bin_strips(s, v.bands);
  } else {
    bin_sides(s, tiles_of(v, r));
  }
  s.unlit.clear();
  if (r.receivers_not_casting) {
    s.unlit.assign(scene.mesh.triangles.size(), 0);
    for (std::uint32_t t = 0; t < s.unlit.size(); ++t) {
      if (!receives(scene, t) || is_caster(casters, t)) continue;
      s.unlit[t] = sides[t] != facing(r.view, corners_of(scene, t), s.light, s.stats);
    }
  }
}

}  // namespace

PolygonEquations<double> equations_of_side(const LightSetup& s, const ViewSetup& v,
                                           std::uint32_t index) {
  const SilhouetteEdge& e = s.silhouette[index];
  return polygon_equations(v.screen.points[e.a], v.screen.points[e.b], s.minus_light);
}

Corners corners_of_side(const LightSetup& s, const Casters& casters, std::uint32_t index) {
  const SilhouetteEdge& e = s.silhouette[index];
  return side_corners(casters.scene->mesh.positions[e.a], casters.scene->mesh.positions[e.b]);
}

ViewSetup set_up_view(const Casters& casters, const Receivers& r, std::span<const Light> lights,
                      int threads) {
  ViewSetup v;
  v.bands = (r.view.height + kBandRows - 1) / kBandRows;
  v.space = screen_space(r.view);
  v.screen = project_all(v.space, casters.scene->mesh.positions, threads);
  bool strips = false, sides = false;
  for (const Light& light : lights) {
    const bool usable = strips_under(v, r, snapped(light)).usable;
    strips |= usable;
    sides |= !usable;
  }
  if (strips && r.cells.levels.empty()) v.made_cells = least_cells(*casters.scene, r, threads);
  if (sides && r.tiles.width == 0) v.made_tiles = nearness_tiles(r, threads);
  return v;
}

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

}  // namespace gnomon
