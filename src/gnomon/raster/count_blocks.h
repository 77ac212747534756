// Blocks of 128 x 128 samples (kBlock) and the sides over them: the counts of one light after the
// other.
#pragma once

#include <cstdint>
#include <vector>

#include <gnomon/raster/count_shadows.h>
#include <gnomon/raster/exact_decisions.h>
#include <gnomon/raster/fill_tiles.h>
#include <gnomon/raster/light_setup.h>

namespace gnomon {

struct BlockMemory {
  BlockCounts counts;
  std::vector<std::int32_t> rows_of_counts;
};

class BlockCounter {
 public:
  BlockCounter(const Casters& casters, const Receivers& receivers, const ViewSetup& view,
               BlockMemory& memory, int block);

  // Of a light that is not by strips; what it returns holds until the next call.
  CountRect counts(const LightSetup& s, int light);
  // `to`: of the whole picture.
  void mask(const LightSetup& s, std::uint8_t* to);

  CountStats stats;

 private:
  void fill(const LightSetup& s);
  // For each sample of a receiver that does not cast and turns away from the light.
  template <class F>
  void for_each_unlit(const LightSetup& s, F f) const;

  const Casters& casters_;
  const Receivers& receivers_;
  const ViewSetup& view_;
  const NearnessTiles& tiles_;
  BlockMemory& memory_;
  std::uint32_t block_;
  int first_column_, first_row_, columns_, rows_;
};

}  // namespace gnomon
