// What the counter prepares before it fills: the view, once for all lights; then each light, from
// its silhouette to the strips or sides that each part of the picture meets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <gnomon/raster/count_shadows.h>
#include <gnomon/raster/fill_tiles.h>
#include <gnomon/raster/polygon.h>
#include <gnomon/raster/side.h>
#include <gnomon/raster/strip.h>
#include <gnomon/silhouette/edge_tree.h>
#include <gnomon/silhouette/silhouette.h>

namespace gnomon {

// Counts and nearness of a band stay in the second-level cache.
inline constexpr int kBandRows = 32;

// A tree of edges is built for as many lights: one light costs brute force 2 to 3 ns a triangle and
// the tree 1, and building it, by one thread, 500 to 2000 (docs/silhouettes.md).
inline constexpr std::size_t kLightsForTree = 512;

// CSR: what touches each band or block.
struct Bins {
  std::vector<std::uint32_t> first, items;
  std::span<const std::uint32_t> of(std::size_t bin) const {
    return {items.data() + first[bin], first[bin + 1] - first[bin]};
  }
};

// What all lights share.
struct ViewSetup {
  ScreenSpace space;
  ScreenPoints screen;
  LeastCells made_cells;     // where the receivers have none and need them
  NearnessTiles made_tiles;  // the same
  int bands = 0;
  std::vector<Polygon> casters;  // of a parallel view: that receivers may lie behind; add: facing
  Bins caster_bins;
  ExactStats stats;  // of the casters' facings
};

// Silhouette edges are set up in runs of this many, in parallel. The strips or sides of a run begin
// at the index of its first edge; what follows the last one is not used.
inline constexpr std::size_t kRun = 1024;
struct SetupRun {
  std::size_t made = 0;            // strips or sides
  std::vector<std::uint32_t> ids;  // of edges that are no point, or of triangles
  std::vector<UnsureStrip> unsure;
  std::vector<Polygon> polygons;
  BlockHits hits;
  ExactStats stats;
};

// One light, ready to be filled.
struct LightSetup {
  Light light{0, 0, 0, 0};
  Silhouette silhouette;
  std::vector<std::int8_t> triangle_sides;  // as light_sides(); empty where they are not needed
  bool looks_with_light = false;            // there are no sides
  StripLight strip_light;
  ScreenPoint<double> minus_light{};
  EquationErrors errors;  // of the sides' equations
  std::vector<SetupRun> runs;
  std::size_t edge_runs = 0;  // of runs; then, in blocks, those of casters

  // In bands.
  std::vector<Strip> strips;
  Bins strip_bins;
  std::vector<Polygon> polygons;  // sides that are no strips; id: index into silhouette
  Bins bins;                      // of the polygons

  // In blocks.
  std::unique_ptr<Side[]> sides;  // not set to zero: much of it is never used
  std::size_t room_for_sides = 0;
  Bins side_bins;                          // by block
  std::vector<std::int32_t> block_counts;  // of the sides that cover whole blocks

  std::int32_t eye_count = 0;  // C(e)
  std::vector<std::uint8_t>
      unlit;  // per triangle that receives but does not cast: the light is not on its seen side
  ExactStats stats;
  ExtractionScratch scratch;
  Silhouette unsorted;
};

Corners corners_of(const Scene& scene, std::uint32_t triangle);
bool is_caster(const Casters& c, std::uint32_t triangle);

// Parallel views are counted in bands, by strips and polygons; cameras in blocks, by sides.
inline bool in_bands(const Receivers& r) { return is_parallel(r.view); }

inline const LeastCells& cells_of(const ViewSetup& v, const Receivers& r) {
  return r.cells.levels.empty() ? v.made_cells : r.cells;
}
inline const NearnessTiles& tiles_of(const ViewSetup& v, const Receivers& r) {
  return r.tiles.width == 0 ? v.made_tiles : r.tiles;
}

PolygonEquations<double> equations_of_side(const LightSetup& s, const ViewSetup& v,
                                           std::uint32_t index);
Corners corners_of_side(const LightSetup& s, const Casters& casters, std::uint32_t index);

ViewSetup set_up_view(const Casters& casters, const Receivers& receivers, int threads);

// As many setups as lights; what they hold is replaced and their memory used again. `tree`: of the
// casters' edges, or nullptr.
void set_up_lights(std::span<LightSetup> setups, const Casters& casters, const Receivers& receivers,
                   const ViewSetup& view, const EdgeTree* tree, std::span<const Light> lights,
                   int threads);

}  // namespace gnomon
