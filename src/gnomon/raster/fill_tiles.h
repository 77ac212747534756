// The inner loop of the counter for cameras and lamps: sides against squares of the picture, from
// large to small, 16 at a time. A square that a side does not touch, or that lies in front of it
// altogether, is passed over; one that it covers and is in front of everywhere is counted whole;
// only tiles of 8 x 8 samples that neither is true of are tested sample by sample, in float. What
// lies within the error bounds is handed to the exact predicates, so the result is the exact one
// whatever the instruction set. Based on: Aila, Akenine-Moller, A hierarchical shadow volume
// algorithm, 2004. docs/counting.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <gnomon/raster/nearness_tiles.h>
#include <gnomon/raster/side.h>

namespace gnomon {

// Blocks that need a closer look, and blocks that the side covers in front of all samples.
struct SideInBlock {
  std::uint32_t block = 0;  // row by row
  std::uint32_t side = 0;
};
struct WholeBlock {
  std::uint32_t block = 0;
  std::int32_t add = 0;
};
struct BlockHits {
  std::vector<SideInBlock> some;
  std::vector<WholeBlock> whole;
};

// Of sides[begin, end), appended.
void find_blocks(const Side* sides, std::size_t begin, std::size_t end, const NearnessTiles& tiles,
                 BlockHits& hits);

// The exact decisions that the loop asks for.
class ExactSideDecisions {
 public:
  virtual ~ExactSideDecisions() = default;
  virtual bool covers(const Side& s, int column, int row) = 0;
  // 1: it covers all pixels of a tile, -1: none, 0: some, or that is not known.
  virtual int covers_tile(const Side& s, int column, int row) = 0;
  // True if the side is in front of the sample; false where there is no sample. Precondition: it
  // covers it.
  virtual bool in_front(const Side& s, int column, int row) = 0;
};

// Counts of one light over one block: what a sample has is the sum of its own, its tile's, its
// patch's and the block's. All zero between lights.
struct BlockCounts {
  alignas(64) std::int32_t samples[kBlockTiles * kTileSamples] = {};  // tile by tile
  std::int32_t tiles[kBlockTiles] = {};
  std::int32_t patches[16] = {};
  std::int32_t block = 0;
  std::uint8_t touched[kBlockTiles] = {};  // tiles with counts of samples
};

struct BlockJob {
  const Side* sides = nullptr;
  const std::uint32_t* selected = nullptr;  // indices into sides
  std::size_t count = 0;
  const NearnessTiles* tiles = nullptr;
  std::uint32_t block = 0;
  BlockCounts* counts = nullptr;  // added to
  ExactSideDecisions* exact = nullptr;
};
void fill_block(const BlockJob& job);

// Counts to 1 where they are > 0 and there is a sample, else 0; and to zero. `to`: of the block's
// first sample; rows are `stride` apart. Nothing is written outside the picture.
void take_block_mask(BlockCounts& counts, const NearnessTiles& tiles, std::uint32_t block,
                     std::uint8_t* to, std::ptrdiff_t stride);

// Counts, 0 where there is no sample; and to zero. `to` as above.
void take_block_counts(BlockCounts& counts, const NearnessTiles& tiles, std::uint32_t block,
                       std::int32_t* to, std::ptrdiff_t stride);

}  // namespace gnomon
