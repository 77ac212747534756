// The samples of a view: which triangle each pixel's ray meets first. Filled by raster
// (visible_surfaces).
#pragma once

#include <cstdint>
#include <vector>

#include <gnomon/view/view.h>

namespace gnomon {

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

// The lowest nearness under any rectangle of the picture: what a shadow volume's side can matter
// for ends there. raster/least_cells.h makes it and asks it.
inline constexpr int kCellShift = 4;  // cells of 16 x 16 pixels at the lowest level
struct LeastCells {
  struct Level {  // cells of 2^(kCellShift + level) pixels a side
    int width = 0, height = 0;
    std::vector<float> least;  // row-major; no sample's exact nearness is below; infinity where
                               // there are no samples
  };
  int width = 0, height = 0;  // pixels
  std::vector<Level> levels;  // the last has one cell
};

// Nearness once more, tile by tile, with its least and greatest over squares of four sizes: what
// the sides that cameras and lamps see are tested against. raster/nearness_tiles.h makes it.
inline constexpr int kTile = 8;  // pixels a side
inline constexpr int kPatch = 4 * kTile;
inline constexpr int kBlock = 4 * kPatch;
inline constexpr int kField = 4 * kBlock;
struct NearnessTiles {
  // Of the samples in each square; both bounds hold for exact nearness. least: +infinity where
  // there are no samples; greatest: -infinity. The 16 squares of the next larger one lie side by
  // side, row by row.
  struct Bounds {
    std::vector<float> least, greatest;
  };
  int width = 0, height = 0;  // pixels
  int blocks_wide = 0, blocks_high = 0;
  Bounds tiles, patches;           // blocks follow row by row
  Bounds blocks;                   // fields follow row by row
  Bounds fields;                   // squares of 4 x 4 fields follow row by row
  std::vector<float> nearness;     // 64 a tile (nearness_tiles.h); +infinity outside the picture
  std::vector<std::uint8_t> full;  // per tile: 1 if all its pixels have samples
};

// In magnitude; beyond it nearness is not known as a float, which must have room to reckon with it.
inline constexpr double kLargestNearness = 1e28;

// What stored nearness is taken to be wrong by where bounds are made of it, as a share of it: twice
// what it may be (Receivers::nearness), which pays for the bound's own rounding. nearness_floor is
// added.
inline constexpr double kNearnessRounding = 0x1p-22;

struct Receivers {
  View view;
  // Row-major, row 0 at the top, width * height each.
  std::vector<std::uint32_t> triangle;  // index into the scene's triangles; kNoTriangle: the ray
                                        // meets no receiver (nodata)
  // Nearness (see view.h), rounded to float with relative error at most 2^-23 plus absolute error
  // nearness_floor. +infinity where there is no sample. NaN: too uncertain for a float, or above
  // kLargestNearness; always decided exactly.
  std::vector<float> nearness;
  double nearness_floor = 0;
  bool casters_in_front =
      false;  // some caster does not receive: rays may cross casters before they reach their sample
  bool receivers_not_casting = false;
  // Of nearness, made with it: cells for parallel views, tiles for cameras. Without levels, or of
  // width 0: not made yet. Whoever changes nearness empties both.
  LeastCells cells;
  NearnessTiles tiles;
};

}  // namespace gnomon
