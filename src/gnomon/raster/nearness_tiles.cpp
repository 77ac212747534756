#include <gnomon/raster/nearness_tiles.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <gnomon/core/approx.h>
#include <gnomon/core/parallel.h>

namespace gnomon {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

void resize(NearnessTiles::Bounds& b, std::size_t n) {
  b.least.assign(n, kInfinity);
  b.greatest.assign(n, -kInfinity);
}

// The bounds of 16 squares, which lie side by side.
void join(const NearnessTiles::Bounds& from, std::size_t first, NearnessTiles::Bounds& to,
          std::size_t index) {
  const auto least = from.least.begin() + static_cast<std::ptrdiff_t>(first);
  const auto greatest = from.greatest.begin() + static_cast<std::ptrdiff_t>(first);
  to.least[index] = *std::min_element(least, least + 16);
  to.greatest[index] = *std::max_element(greatest, greatest + 16);
}

int squares(int pixels, int side) { return (pixels + side - 1) / side; }

// Of the square (x, y) of a grid whose groups of four by four follow row by row, `groups_wide` in a
// row.
std::size_t index_in_groups(int x, int y, int groups_wide) {
  const std::size_t group =
      static_cast<std::size_t>(y / 4) * static_cast<std::size_t>(groups_wide) +
      static_cast<std::size_t>(x / 4);
  return group * 16 + static_cast<std::size_t>((y % 4) * 4 + x % 4);
}

}  // namespace

NearnessTiles nearness_tiles(const Receivers& r, int threads) {
  NearnessTiles out;
  out.width = r.view.width;
  out.height = r.view.height;
  out.blocks_wide = squares(out.width, kBlock);
  out.blocks_high = squares(out.height, kBlock);
  const int fields_wide = squares(out.width, kField), fields_high = squares(out.height, kField);
  const int roots_wide = squares(fields_wide, 4), roots_high = squares(fields_high, 4);
  const std::size_t blocks =
      static_cast<std::size_t>(out.blocks_wide) * static_cast<std::size_t>(out.blocks_high);
  resize(out.tiles, blocks * kBlockTiles);
  resize(out.patches, blocks * 16);
  resize(out.blocks,
         static_cast<std::size_t>(fields_wide) * static_cast<std::size_t>(fields_high) * 16);
  resize(out.fields,
         static_cast<std::size_t>(roots_wide) * static_cast<std::size_t>(roots_high) * 16);
  out.nearness.resize(blocks * kBlockTiles * kTileSamples);
  out.full.resize(blocks * kBlockTiles);

  const double lowest_unknown = is_parallel(r.view) ? -std::numeric_limits<double>::infinity() : 0;
  const auto take_tile = [&](std::size_t tile, int x0, int y0) {
    float* to = out.nearness.data() + tile * kTileSamples;
    std::fill_n(to, kTileSamples, kInfinity);
    const int columns = std::min(kTile, out.width - x0), rows = std::min(kTile, out.height - y0);
    if (columns <= 0 || rows <= 0) return;
    float least = kInfinity, greatest = -kInfinity;
    bool unknown = false, full = columns == kTile && rows == kTile;
    for (int y = 0; y < rows; ++y) {
      const float* from = r.nearness.data() +
                          static_cast<std::size_t>(y0 + y) * static_cast<std::size_t>(out.width) +
                          x0;
      for (int x = 0; x < columns; ++x) {
        const float n = from[x];
        to[index_in_tile(x, y)] = n;
        least = n < least ? n : least;  // false for NaN
        greatest = n > greatest && n < kInfinity ? n : greatest;
        unknown |= n != n;
        full &= n != kInfinity;
      }
    }
    out.full[tile] = full ? 1 : 0;
    double low = static_cast<double>(least), high = static_cast<double>(greatest);
    if (std::isfinite(low)) {
      low -= std::fabs(low) * kNearnessRounding + r.nearness_floor;
      high += std::fabs(high) * kNearnessRounding + r.nearness_floor;
    }
    if (unknown) {
      low = std::min(low, lowest_unknown);
      high = std::numeric_limits<double>::infinity();
    }
    out.tiles.least[tile] = rounded_down(low);
    out.tiles.greatest[tile] = rounded_up(high);
  };
  parallel_for(static_cast<int>(blocks), threads, [&](int b) {
    const int x0 = b % out.blocks_wide * kBlock, y0 = b / out.blocks_wide * kBlock;
    for (int k = 0; k < 16; ++k) {
      const std::size_t patch = static_cast<std::size_t>(b) * 16 + static_cast<std::size_t>(k);
      for (int t = 0; t < 16; ++t) {
        take_tile(patch * 16 + static_cast<std::size_t>(t), x0 + k % 4 * kPatch + t % 4 * kTile,
                  y0 + k / 4 * kPatch + t / 4 * kTile);
      }
      join(out.tiles, patch * 16, out.patches, patch);
    }
  });
  for (int y = 0; y < out.blocks_high; ++y) {
    for (int x = 0; x < out.blocks_wide; ++x) {
      join(out.patches,
           (static_cast<std::size_t>(y) * static_cast<std::size_t>(out.blocks_wide) +
            static_cast<std::size_t>(x)) *
               16,
           out.blocks, index_in_groups(x, y, fields_wide));
    }
  }
  for (int y = 0; y < fields_high; ++y) {
    for (int x = 0; x < fields_wide; ++x) {
      join(out.blocks,
           (static_cast<std::size_t>(y) * static_cast<std::size_t>(fields_wide) +
            static_cast<std::size_t>(x)) *
               16,
           out.fields, index_in_groups(x, y, roots_wide));
    }
  }
  return out;
}

}  // namespace gnomon
