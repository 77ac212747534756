// The oracle: how many casters lie between each sample and the light, by the definition, one exact
// decision after another. DEFINITIONS "The prism and the count". It shares no code with silhouette,
// volume or raster.
#pragma once

#include <cstdint>
#include <vector>

#include <gnomon/core/exact.h>
#include <gnomon/scene/scene.h>
#include <gnomon/trace/bvh.h>
#include <gnomon/view/receivers.h>

namespace gnomon {

struct OracleStats {
  std::uint64_t samples = 0;     // pixels with a receiver
  std::uint64_t candidates = 0;  // triangles proposed by the tree
  std::uint64_t unbounded =
      0;  // samples whose place is too uncertain for the tree: tested against all triangles
  ExactStats signs;  // decisions that left floating point; ties
  OracleStats& operator+=(const OracleStats& o) {
    samples += o.samples;
    candidates += o.candidates;
    unbounded += o.unbounded;
    signs += o.signs;
    return *this;
  }
};

// Prepared once per scene, which must outlive it.
struct Oracle {
  const Scene* scene = nullptr;
  Bvh casters;
  Bvh receivers;
};
Oracle build_oracle(const Scene& scene);

// n(p) per pixel, row-major; where the light is not strictly on the seen side of a receiver that
// does not cast, at least 1 (so that a sample is in shadow exactly if its count is > 0); 0 where
// the pixel has no sample. Preconditions: receivers.triangle are triangles of the scene that the
// pixels' rays meet; light.w is 0 or 1. The light's components are snapped (exact.h). `threads` 0:
// all. `stats` is added to.
std::vector<std::int32_t> exact_counts(const Oracle& oracle, const Receivers& receivers,
                                       const Light& light, int threads = 0,
                                       OracleStats* stats = nullptr);
std::vector<std::int32_t> exact_counts(const Scene& scene, const Receivers& receivers,
                                       const Light& light, int threads = 0,
                                       OracleStats* stats = nullptr);

// The same for one pixel, against every caster of the scene and without a tree or a filter of its
// own.
std::int32_t exact_count_at(const Scene& scene, const Receivers& receivers, const Light& light,
                            int column, int row, ExactStats* stats = nullptr);

// Per pixel, row-major: the receiving triangle that its ray meets first (of coplanar ones the one
// with the lowest index), or kNoTriangle.
std::vector<std::uint32_t> exact_receivers(const Oracle& oracle, const View& view, int threads = 0,
                                           OracleStats* stats = nullptr);

// The same for one pixel, against every receiver.
std::uint32_t exact_receiver_at(const Scene& scene, const View& view, int column, int row,
                                ExactStats* stats = nullptr);

}  // namespace gnomon
