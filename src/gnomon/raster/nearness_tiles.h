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

// A tile's samples lie in four quads of four by four, left and right, above and below.
constexpr std::size_t index_in_tile(int column, int row) {
  return static_cast<std::size_t>((row / 4 * 2 + column / 4) * 16 + row % 4 * 4 + column % 4);
}
constexpr int column_in_tile(std::size_t index) {
  return static_cast<int>(index / 16 % 2 * 4 + index % 4);
}
constexpr int row_in_tile(std::size_t index) {
  return static_cast<int>(index / 32 * 4 + index / 4 % 4);
}

}  // namespace gnomon
