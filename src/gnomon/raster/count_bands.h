// Bands of rows of a parallel view, and the strips and polygons over them: the counts of one light
// after the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <hwy/aligned_allocator.h>

#include <gnomon/raster/count_shadows.h>
#include <gnomon/raster/exact_decisions.h>
#include <gnomon/raster/light_setup.h>

namespace gnomon {

// Samples of a band, interleaved (fill_strips.h), whatever the light. Used again for other bands of
// the same view.
struct BandMemory {
  int first_row = 0, rows = 0;
  bool filled = false;  // nearness is the band's
  std::size_t stride = 0;
  hwy::AlignedFreeUniquePtr<float[]> nearness;
  hwy::AlignedFreeUniquePtr<std::int32_t[]> counts;  // zero between lights
  std::vector<std::int32_t> rows_of_counts;
  std::vector<std::uint8_t> rows_of_mask;
};

class BandCounter {
 public:
  BandCounter(const Casters& casters, const Receivers& receivers, const ViewSetup& view,
              BandMemory& memory, int band);

  // Of a light in bands; what it returns holds until the next call.
  CountRect counts(const LightSetup& s, int light);
  MaskRect mask(const LightSetup& s, int light);
  // `to`: of the whole picture.
  void mask(const LightSetup& s, std::uint8_t* to);

  CountStats stats;

 private:
  bool fill(const LightSetup& s);
  void take(const LightSetup& s, std::uint8_t* to);
  void need_nearness();

  const Casters& casters_;
  const Receivers& receivers_;
  const ViewSetup& view_;
  BandMemory& memory_;
  std::size_t band_;
};

}  // namespace gnomon
