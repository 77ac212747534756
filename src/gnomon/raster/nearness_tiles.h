// Nearness by tiles, and its bounds over squares of 8, 32, 128 and 512 pixels (NearnessTiles,
// view/receivers.h): made once per view, used for all lights. Based on: Aila, Akenine-Moller, A
// hierarchical shadow volume algorithm, 2004.
#pragma once

#include <cstddef>

#include <gnomon/view/receivers.h>

namespace gnomon {

// Stored nearness is taken for what it may be off by (Receivers::nearness); where it is unknown it
// may be anything: in front of a camera, anything above 0.
NearnessTiles nearness_tiles(const Receivers& receivers, int threads);

inline constexpr std::size_t kTileSamples = std::size_t{kTile} * kTile;
inline constexpr std::size_t kBlockTiles = 256;

}  // namespace gnomon
