// The counter: how many casters lie between each sample and each light, from the sides of the
// shadow volume. DEFINITIONS "The prism and the count"; docs/counting.md.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <gnomon/core/exact.h>
#include <gnomon/mesh/edge_table.h>
#include <gnomon/raster/eye_count.h>
#include <gnomon/scene/scene.h>
#include <gnomon/silhouette/light_planes.h>
#include <gnomon/view/receivers.h>

namespace gnomon {

// What casts, prepared once for all lights and views. Refers to the scene, which must outlive it.
struct Casters {
  const Scene* scene = nullptr;
  std::vector<std::uint8_t> selected;  // per triangle: 1 if it casts; empty: all cast
  EdgeTable edges;                     // of the casting triangles
  LightPlanes planes;                  // of all triangles
  RunBoxes boxes;                      // of the casting triangles
};
Casters prepare_casters(const Scene& scene);

// The finished counts of one light over a part of the picture.
struct CountRect {
  int light = 0;  // index into the lights
  int first_column = 0, first_row = 0, columns = 0, rows = 0;
  int stride = 0;  // from one row of counts to the next
  // n(p) of DEFINITIONS; where the light is not strictly on the seen side of a receiver that does
  // not cast, at least 1. So a sample is in shadow exactly if its count is > 0. Pixels without a
  // sample: 0.
  const std::int32_t* counts = nullptr;
};

// The same as a mask: 1 where the count is > 0, else 0.
struct MaskRect {
  int light = 0;
  int first_column = 0, first_row = 0, columns = 0, rows = 0;
  int stride = 0;  // from one row to the next
  const std::uint8_t* mask = nullptr;
};

// Called for rectangles that together are the picture, once for each and each light; concurrently
// for different rectangles, one light after the other for the same one.
using CountSink = std::function<void(const CountRect&)>;
using MaskSink = std::function<void(const MaskRect&)>;

struct CountStats {
  ExactStats signs;             // light sides of triangles, facings, C(e)
  ExactStats spans;             // ends of spans; samples and tiles against the edges of sides
  ExactStats depths;            // samples against strips, polygons and sides
  std::uint64_t close = 0;      // samples within a float filter's bound of one, decided exactly
  std::uint64_t sides = 0;      // silhouette edges over all lights
  std::uint64_t triangles = 0;  // casting triangles over all lights
};

// Counts for all lights over one view: lights in batches, bands of rows outside, lights inside.
// Masks do not depend on `threads` (0: all), nor on the order or winding of triangles. Lights'
// components are snapped (exact.h).
CountStats count_shadows(const Casters& casters, const Receivers& receivers,
                         std::span<const Light> lights, const CountSink& sink, int threads = 0);

// The same for whoever wants them whole: counts[i] receives width * height counts, row-major, of
// light i. Precondition: as many as lights.
CountStats count_shadows(const Casters& casters, const Receivers& receivers,
                         std::span<const Light> lights, std::span<std::int32_t* const> counts,
                         int threads = 0);

// The same for whoever wants no counts, and faster.
CountStats mask_shadows(const Casters& casters, const Receivers& receivers,
                        std::span<const Light> lights, const MaskSink& sink, int threads = 0);

// Masks whole: masks[i] receives width * height bytes,
// row-major, of light i: 1 where the count is > 0, else 0. Precondition: as many masks as lights.
CountStats mask_shadows(const Casters& casters, const Receivers& receivers,
                        std::span<const Light> lights, std::span<std::uint8_t* const> masks,
                        int threads = 0);

// The specification: every sample against every side and caster by the exact predicates, no spans,
// no filter of its own. Slow. Row-major counts as in CountRect.
std::vector<std::int32_t> count_shadows_reference(const Casters& casters,
                                                  const Receivers& receivers, const Light& light);

}  // namespace gnomon
