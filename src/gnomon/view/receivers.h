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

struct Receivers {
  View view;
  // Row-major, row 0 at the top, width * height each.
  std::vector<std::uint32_t> triangle;  // index into the scene's triangles; kNoTriangle: the ray
                                        // meets no receiver (nodata)
  // Nearness (see view.h), rounded to float with relative error at most 2^-23 or absolute error
  // nearness_floor, whichever is larger. +infinity where there is no sample. NaN: too uncertain for
  // a float, always decided exactly.
  std::vector<float> nearness;
  double nearness_floor = 0;
  bool casters_in_front =
      false;  // some caster does not receive: rays may cross casters before they reach their sample
  bool receivers_not_casting = false;
  LeastCells
      cells;  // of nearness; without levels: not made yet. Whoever changes nearness empties it.
};

}  // namespace gnomon
