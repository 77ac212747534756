#include <gnomon/raster/count_shadows.h>

#include <algorithm>
#include <cassert>
#include <memory>
#include <mutex>

#include <gnomon/core/parallel.h>
#include <gnomon/raster/count_bands.h>
#include <gnomon/raster/count_blocks.h>
#include <gnomon/raster/light_setup.h>

namespace gnomon {
namespace {

// What is set up takes as many bytes before it is filled: several lights share one pass over the
// picture.
constexpr std::size_t kBatchBytes = std::size_t{96} << 20;
constexpr std::size_t kBatchLights = 16;

// Memory of parts of the picture that nobody works on.
template <class Memory>
class Memories {
 public:
  std::unique_ptr<Memory> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<Memory>();
    std::unique_ptr<Memory> m = std::move(free_.back());
    free_.pop_back();
    return m;
  }
  void give(std::unique_ptr<Memory> m) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(m));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Memory>> free_;
};

// finish(counter, setup, light): hands a part of the picture to a sink.
template <class Finish>
CountStats count(const Casters& casters, const Receivers& receivers, std::span<const Light> lights,
                 int threads, const Finish& finish) {
  CountStats stats;
  if (receivers.triangle.empty()) return stats;
  std::mutex stats_mutex;
  const ViewSetup view = set_up_view(casters, receivers, threads);
  stats.signs += view.stats;
  // A third of the edges of closed meshes are on the silhouette of a sun at most; the rest is
  // refused when it is set up.
  const std::size_t bytes = std::max<std::size_t>(
      1, casters.edges.vertices.size() / 3 *
             (in_bands(receivers) ? sizeof(Strip) + sizeof(Polygon) / 4 : sizeof(Side)));
  const std::size_t batch = std::clamp<std::size_t>(kBatchBytes / bytes, 1, kBatchLights);

  EdgeTree tree;
  if (lights.size() >= kLightsForTree) tree = build_edge_tree(casters.scene->mesh, casters.edges);

  std::vector<LightSetup> setups(std::min(batch, lights.size()));
  // Parts of the picture outside, lights inside.
  const auto fill = [&]<class Counter, class Memory>(int parts, std::size_t begin, std::size_t n,
                                                     Memories<Memory>& memories) {
    parallel_for(parts, threads, [&](int part) {
      std::unique_ptr<Memory> memory = memories.take();
      Counter counter(casters, receivers, view, *memory, part);
      for (std::size_t i = 0; i < n; ++i) finish(counter, setups[i], static_cast<int>(begin + i));
      memories.give(std::move(memory));
      const std::lock_guard lock(stats_mutex);
      stats.spans += counter.stats.spans;
      stats.depths += counter.stats.depths;
      stats.close += counter.stats.close;
    });
  };
  Memories<BandMemory> bands;
  Memories<BlockMemory> blocks;
  for (std::size_t begin = 0; begin < lights.size(); begin += batch) {
    const std::size_t n = std::min(batch, lights.size() - begin);
    set_up_lights(setups, casters, receivers, view,
                  lights.size() >= kLightsForTree ? &tree : nullptr, lights.subspan(begin, n),
                  threads);
    if (in_bands(receivers)) {
      fill.template operator()<BandCounter>(view.bands, begin, n, bands);
    } else {
      const NearnessTiles& tiles = tiles_of(view, receivers);
      fill.template operator()<BlockCounter>(tiles.blocks_wide * tiles.blocks_high, begin, n,
                                             blocks);
    }
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
                         std::span<const Light> lights, const CountSink& sink, int threads) {
  return count(
      casters, receivers, lights, threads,
      [&](auto& counter, const LightSetup& s, int light) { sink(counter.counts(s, light)); });
}

CountStats count_shadows(const Casters& casters, const Receivers& receivers,
                         std::span<const Light> lights, std::span<std::int32_t* const> counts,
                         int threads) {
  assert(counts.size() == lights.size());
  const std::ptrdiff_t width = receivers.view.width;
  const CountSink copy = [&](const CountRect& part) {
    std::int32_t* to =
        counts[static_cast<std::size_t>(part.light)] + part.first_row * width + part.first_column;
    for (int row = 0; row < part.rows; ++row)
      std::copy_n(part.counts + static_cast<std::ptrdiff_t>(row) * part.stride, part.columns,
                  to + row * width);
  };
  return count_shadows(casters, receivers, lights, copy, threads);
}

CountStats mask_shadows(const Casters& casters, const Receivers& receivers,
                        std::span<const Light> lights, const MaskSink& sink, int threads) {
  return count(
      casters, receivers, lights, threads,
      [&](auto& counter, const LightSetup& s, int light) { sink(counter.mask(s, light)); });
}

CountStats mask_shadows(const Casters& casters, const Receivers& receivers,
                        std::span<const Light> lights, std::span<std::uint8_t* const> masks,
                        int threads) {
  assert(masks.size() == lights.size());
  return count(casters, receivers, lights, threads,
               [&](auto& counter, const LightSetup& s, int light) {
                 counter.mask(s, masks[static_cast<std::size_t>(light)]);
               });
}

}  // namespace gnomon
