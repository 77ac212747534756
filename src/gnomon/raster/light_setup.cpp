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

// Adds the polygon of three corners, where samples may lie behind it. `rows`: that it touches at
// most. `p`: facing and nearness are made, add and id.
void add_polygon(std::vector<Polygon>& to, const ViewSetup& v, const Receivers& r, Polygon& p,
                 const PolygonEquations<double>& q, const EquationErrors& errors,
                 std::pair<int, int> rows) {
  const LeastCells& cells = cells_of(v, r);
  const auto touched = [&](double least) {
    const Span columns = set_rows(p, q, errors, v.space, least);
    p.first_row = std::max(p.first_row, rows.first);
    p.end_row = std::min(p.end_row, rows.second);
    return columns;
  };
  const Span columns = touched(static_cast<double>(cells.levels.back().least[0]));
  if (p.first_row >= p.end_row || columns.begin >= columns.end) return;
  const double least =
      least_under(cells, columns.begin, columns.end - 1, p.first_row, p.end_row - 1);
  if (std::isinf(least) && least > 0) return;  // there are no samples
  touched(least);
  if (p.first_row < p.end_row) to.push_back(p);
}

// A side that is no strip.
void add_side(const LightSetup& s, SetupRun& run, const ViewSetup& v, const Casters& casters,
              const Receivers& r, std::uint32_t index, std::pair<int, int> rows) {
  const SilhouetteEdge& e = s.silhouette[index];
  const Vec3 &a = casters.scene->mesh.positions[e.a], &b = casters.scene->mesh.positions[e.b];
  const PolygonEquations<double> q = equations_of_side(s, v, index);
  if (std::fabs(q.f) <= s.errors.f && seen_end_on(r.view, a, b)) return;
  Polygon p;
  set_up(p, q, s.errors, v.space, r.view, side_corners(a, b), s.light, run.stats);
  p.add = -e.multiplicity * p.facing;
  p.id = index;
  add_polygon(run.polygons, v, r, p, q, s.errors, rows);
}

// The triangles [begin, begin + kRun) that cast and do not receive: rays may cross them before they
// reach their sample. One that receives cannot be in front of the first receiver.
void find_casters(std::vector<std::uint32_t>& ids, std::size_t begin, const Casters& casters) {
  const Scene& scene = *casters.scene;
  ids.clear();
  for (std::size_t i = begin; i < std::min(scene.mesh.triangles.size(), begin + kRun); ++i) {
    const auto t = static_cast<std::uint32_t>(i);
    if (is_caster(casters, t) && !receives(scene, t)) ids.push_back(t);
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

// Casters in front of receivers, whatever the light (facings of triangles do not depend on it).
void add_casters(ViewSetup& v, const Casters& casters, const Receivers& r, int threads) {
  const Scene& scene = *casters.scene;
  const std::vector<Vec3>& at = scene.mesh.positions;
  const EquationErrors errors =
      equation_errors(v.screen.bound, v.screen.bound, v.screen.bound, r.view.width, r.view.height);
  std::vector<SetupRun> runs((scene.mesh.triangles.size() + kRun - 1) / kRun);
  parallel_for(static_cast<int>(runs.size()), threads, [&](int k) {
    SetupRun& run = runs[static_cast<std::size_t>(k)];
    find_casters(run.ids, static_cast<std::size_t>(k) * kRun, casters);
    for (const std::uint32_t id : run.ids) {
      const Triangle& t = scene.mesh.triangles[id];
      const PolygonEquations<double> q =
          polygon_equations(v.screen.points[t[0]], v.screen.points[t[1]], v.screen.points[t[2]]);
      if (std::fabs(q.f) <= errors.f && seen_edge_on(r.view, at[t[0]], at[t[1]], at[t[2]]))
        continue;  // a wall seen from above
      Polygon p;
      set_up(p, q, errors, v.space, r.view, corners_of(scene, id), Light(0.0), run.stats);
      p.add = p.facing;  // times the light's side: +1 from the lit to the unlit side
      p.id = id;
      p.caster = true;
      add_polygon(run.polygons, v, r, p, q, errors, {0, r.view.height});
    }
  });
  for (const SetupRun& run : runs) {
    v.casters.insert(v.casters.end(), run.polygons.begin(), run.polygons.end());
    v.stats += run.stats;
  }
  bin(v.caster_bins, v.bands, [&](const auto& f) {
    for (std::size_t i = 0; i < v.casters.size(); ++i)
      f(i, v.casters[i].first_row, v.casters[i].end_row);
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
  s.strip_light = {};
  if (in_bands(r) && s.light.w == 0) {
    s.strip_light = strip_light(s.minus_light, v.screen.bound, light_bound, r.nearness_floor,
                                r.view.width, r.view.height);
  }
  s.edge_runs = s.looks_with_light ? 0 : (s.silhouette.size() + kRun - 1) / kRun;
  const std::size_t caster_runs =
      r.casters_in_front && !in_bands(r) ? (scene.mesh.triangles.size() + kRun - 1) / kRun : 0;
  s.runs.resize(s.edge_runs + caster_runs);
  // With room to grow: the next light has another silhouette.
  const std::size_t most = s.runs.size() * kRun;
  if (s.strip_light.usable && s.strips.size() < most) s.strips.resize(most + most / 4);
  if (!in_bands(r) && s.room_for_sides < most) {
    s.room_for_sides = most + most / 4;
    s.sides = std::make_unique_for_overwrite<Side[]>(s.room_for_sides);
  }
}

bool at_eye(const View& v, const Light& l) { return !is_parallel(v) && l.w == 1 && v.eye == l; }

bool in_box(const Vec3& a, const Vec3& b, const Vec3& p) {
  return glm::all(glm::lessThanEqual(glm::min(a, b), p)) &&
         glm::all(glm::lessThanEqual(p, glm::max(a, b)));
}

// The second, in bands: the strips of a run, and polygons for what is none.
void set_up_run_for_bands(LightSetup& s, std::size_t index, const Casters& casters,
                          const Receivers& r, const ViewSetup& v) {
  SetupRun& run = s.runs[index];
  const std::size_t begin = index * kRun, end = std::min(s.silhouette.size(), begin + kRun);
  if (!s.strip_light.usable) {
    for (std::size_t i = begin; i < end; ++i) {
      add_side(s, run, v, casters, r, static_cast<std::uint32_t>(i), {0, r.view.height});
    }
    return;
  }
  run.ids.clear();
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
  for (const UnsureStrip& u : run.unsure)
    add_side(s, run, v, casters, r, u.id, {u.first_row, u.end_row});
}

// The same in blocks: the sides of a run, and which blocks they reach.
void set_up_run_for_blocks(LightSetup& s, std::size_t index, const Casters& casters,
                           const Receivers& r, const ViewSetup& v) {
  SetupRun& run = s.runs[index];
  const Scene& scene = *casters.scene;
  const std::vector<Vec3>& positions = scene.mesh.positions;
  const NearnessTiles& tiles = tiles_of(v, r);
  const std::size_t first = index * kRun;
  SideSetup setup;
  setup.space = &v.space;
  setup.points = v.screen.points.data();
  setup.least_nearness =
      static_cast<double>(*std::min_element(tiles.fields.least.begin(), tiles.fields.least.end()));
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
    find_casters(run.ids, (index - s.edge_runs) * kRun, casters);
    setup.errors = equation_errors(v.screen.bound, v.screen.bound, v.screen.bound, r.view.width,
                                   r.view.height);
    setup.facing = [&](std::uint32_t id) {
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
  if (in_bands(r)) {
    set_up_run_for_bands(s, index, casters, r, v);
  } else {
    set_up_run_for_blocks(s, index, casters, r, v);
  }
}

void bin_to_bands(LightSetup& s, int bands) {
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

void bin_to_blocks(LightSetup& s, const NearnessTiles& tiles) {
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
  if (in_bands(r)) {
    bin_to_bands(s, v.bands);
  } else {
    bin_to_blocks(s, tiles_of(v, r));
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

ViewSetup set_up_view(const Casters& casters, const Receivers& r, int threads) {
  ViewSetup v;
  v.bands = (r.view.height + kBandRows - 1) / kBandRows;
  v.space = screen_space(r.view);
  v.screen = project_all(v.space, casters.scene->mesh.positions, threads);
  if (in_bands(r) && r.cells.levels.empty()) v.made_cells = least_cells(*casters.scene, r, threads);
  if (!in_bands(r) && r.tiles.width == 0) v.made_tiles = nearness_tiles(r, threads);
  if (in_bands(r) && r.casters_in_front) add_casters(v, casters, r, threads);
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
