#include <gnomon/raster/fill_tiles.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gnomon/raster/fill_tiles.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gnomon {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, 16>;
using FI = hn::Rebind<std::int32_t, F>;
using V = hn::Vec<F>;
using M = hn::Mask<F>;

// Rounding to float of an edge function: its value at the first pixel, two products with rounded
// slopes, three sums, over at most 8 pixels; fewer roundings of 2^-24 of |value| + 16 than these.
constexpr float kEdgeInFloat = 0x1p-22F;
// The same of nearness, and the rounding of the sample's own (2^-23) and of the difference, as a
// share of |value| + 16 times its slopes.
constexpr float kNearnessInFloat = 0x1p-20F;
// The same over squares of `side` pixels, as a share of |value| + 16 `side` times the slopes.
constexpr float kSquareInFloat = 0x1p-21F;

HWY_INLINE V Set(float x) { return hn::Set(F(), x); }

// A side's functions per pixel, in float.
struct Slopes {
  HWY_ALIGN float a[kSideFunctions], b[kSideFunctions];
  // Over a pixel: the most and the least that a step right and down adds; |a| + |b|.
  HWY_ALIGN float rise[kSideFunctions], fall[kSideFunctions], size[kSideFunctions];
};

using D = hn::CappedTag<double, kSideFunctions>;
using DF = hn::Rebind<float, D>;

void FindSlopes(const Side& s, Slopes& out) {
  const D d;
  const DF f;
  const auto zero = hn::Zero(f);
  for (std::size_t k = 0; k < kSideFunctions; k += hn::Lanes(d)) {
    const auto a = hn::DemoteTo(f, hn::Load(d, s.a + k)), b = hn::DemoteTo(f, hn::Load(d, s.b + k));
    hn::Store(a, f, out.a + k);
    hn::Store(b, f, out.b + k);
    hn::Store(hn::Add(hn::Max(a, zero), hn::Max(b, zero)), f, out.rise + k);
    hn::Store(hn::Add(hn::Min(a, zero), hn::Min(b, zero)), f, out.fall + k);
    hn::Store(hn::Add(hn::Abs(a), hn::Abs(b)), f, out.size + k);
  }
}

// A side's functions at the middle of a pixel, and what is wrong with them over squares of
// 4 `step` pixels from there.
struct Values {
  HWY_ALIGN float at[kSideFunctions], error[kSideFunctions];
};

// `rounding`: of |value| + 16 `step` times the slopes.
HWY_INLINE void FindValues(const Side& s, const Slopes& slopes, int x, int y, float step,
                           float rounding, Values& out) {
  const D d;
  const DF f;
  const auto px = hn::Set(d, x + kPixelCentre), py = hn::Set(d, y + kPixelCentre);
  const auto far = hn::Set(f, 16 * step), round = hn::Set(f, rounding);
  for (std::size_t k = 0; k < kSideFunctions; k += hn::Lanes(d)) {
    const auto value = hn::Add(hn::Add(hn::Load(d, s.c + k), hn::Mul(hn::Load(d, s.a + k), px)),
                               hn::Mul(hn::Load(d, s.b + k), py));
    const auto at = hn::DemoteTo(f, value);
    const auto most = hn::Add(hn::Abs(at), hn::Mul(far, hn::Load(f, slopes.size + k)));
    hn::Store(at, f, out.at + k);
    hn::Store(hn::Add(hn::Load(f, s.slack + k), hn::Mul(round, most)), f, out.error + k);
  }
}

struct Squares {
  std::uint32_t some = 0, whole = 0;  // one bit each; `whole` in none of `some`
};

// The 16 squares of `side` pixels whose first pixel is (x, y). Those without samples are passed
// over.
HWY_INLINE Squares TestSquares(const Side& s, const Slopes& slopes, int x, int y, int side,
                               const float* least, const float* greatest) {
  const F f;
  const FI fi;
  const float span = static_cast<float>(side - 1), step = static_cast<float>(side);
  Values v;
  FindValues(s, slopes, x, y, step, kSquareInFloat, v);
  const auto relative = [&](int k) {
    return v.error[k] + s.relative * (std::fabs(v.at[k]) + 4 * step * slopes.size[k]);
  };
  const float of_nearness = relative(kNearness);
  const float highest = span * slopes.rise[kNearness] + of_nearness,
              deepest = span * slopes.fall[kNearness] - of_nearness,
              upper = span * slopes.rise[kUpper] + relative(kUpper),
              lower = span * slopes.fall[kLower] - relative(kLower);
  Squares out;
  const std::size_t lanes = hn::Lanes(f);
  for (std::size_t i = 0; i < 16; i += lanes) {
    const auto lane = hn::Iota(fi, static_cast<std::int32_t>(i));
    const V columns = hn::Mul(hn::ConvertTo(f, hn::And(lane, hn::Set(fi, 3))), Set(step)),
            rows = hn::Mul(hn::ConvertTo(f, hn::ShiftRight<2>(lane)), Set(step));
    const auto at = [&](int k) HWY_ATTR {
      return hn::Add(Set(v.at[k]),
                     hn::Add(hn::Mul(Set(slopes.a[k]), columns), hn::Mul(Set(slopes.b[k]), rows)));
    };
    const V e0 = at(0), e1 = at(1), e2 = at(2);
    const auto outside = [&](V e, int k) HWY_ATTR {
      return hn::Lt(e, Set(-v.error[k] - span * slopes.rise[k]));
    };
    const auto inside = [&](V e, int k)
                            HWY_ATTR { return hn::Gt(e, Set(v.error[k] - span * slopes.fall[k])); };
    const V lowest = hn::LoadU(f, least + i);
    const V g = at(kNearness);
    const M behind = hn::Or(hn::Or(hn::Lt(hn::Add(g, Set(highest)), lowest),
                                   hn::Lt(hn::Add(at(kUpper), Set(upper)), lowest)),
                            hn::Eq(lowest, Set(std::numeric_limits<float>::infinity())));
    const M passed = hn::Or(hn::Or(outside(e0, 0), outside(e1, 1)), hn::Or(outside(e2, 2), behind));
    const V most = hn::LoadU(f, greatest + i);
    const M front = hn::Or(hn::Gt(hn::Add(g, Set(deepest)), most),
                           hn::Gt(hn::Add(at(kLower), Set(lower)), most));
    const M covered = hn::And(hn::And(inside(e0, 0), inside(e1, 1)), inside(e2, 2));
    const M whole = hn::AndNot(passed, hn::And(front, covered));
    const M some = hn::Not(hn::Or(passed, whole));
    std::uint8_t bits[8] = {};
    std::uint32_t n = 0;
    hn::StoreMaskBits(f, some, bits);
    std::memcpy(&n, bits, sizeof(n));
    out.some |= (n & ((1U << lanes) - 1)) << i;
    std::memset(bits, 0, sizeof(bits));
    hn::StoreMaskBits(f, whole, bits);
    std::memcpy(&n, bits, sizeof(n));
    out.whole |= (n & ((1U << lanes) - 1)) << i;
  }
  return out;
}

// Takes the lowest bit off.
HWY_INLINE std::uint32_t TakeBit(std::uint32_t& bits) {
  const int k = std::countr_zero(bits);
  bits &= bits - 1;
  return static_cast<std::uint32_t>(k);
}

void FindBlocks(const Side* sides, std::size_t begin, std::size_t end, const NearnessTiles& tiles,
                BlockHits& hits) {
  const int fields_wide = (tiles.width + kField - 1) / kField;
  const int roots_wide = (fields_wide + 3) / 4;
  const std::size_t roots = tiles.fields.least.size() / 16;
  for (std::size_t i = begin; i < end; ++i) {
    const Side& s = sides[i];
    Slopes slopes;
    FindSlopes(s, slopes);
    // The picture may end before the square does.
    const auto add_whole = [&](int bx, int by) {
      if (bx < tiles.blocks_wide && by < tiles.blocks_high)
        hits.whole.push_back({static_cast<std::uint32_t>(by * tiles.blocks_wide + bx), s.add});
    };
    for (std::size_t root = 0; root < roots; ++root) {
      const int rx = static_cast<int>(root) % roots_wide, ry = static_cast<int>(root) / roots_wide;
      Squares fields = TestSquares(s, slopes, rx * 4 * kField, ry * 4 * kField, kField,
                                   tiles.fields.least.data() + root * 16,
                                   tiles.fields.greatest.data() + root * 16);
      while (fields.whole != 0) {
        const auto k = static_cast<int>(TakeBit(fields.whole));
        const int bx = (rx * 4 + k % 4) * 4, by = (ry * 4 + k / 4) * 4;
        for (int b = 0; b < 16; ++b) add_whole(bx + b % 4, by + b / 4);
      }
      while (fields.some != 0) {
        const auto k = static_cast<int>(TakeBit(fields.some));
        const int fx = rx * 4 + k % 4, fy = ry * 4 + k / 4;
        const std::size_t first = static_cast<std::size_t>(fy * fields_wide + fx) * 16;
        Squares blocks =
            TestSquares(s, slopes, fx * kField, fy * kField, kBlock,
                        tiles.blocks.least.data() + first, tiles.blocks.greatest.data() + first);
        while (blocks.whole != 0) {
          const auto b = static_cast<int>(TakeBit(blocks.whole));
          add_whole(fx * 4 + b % 4, fy * 4 + b / 4);
        }
        while (blocks.some != 0) {
          const auto b = static_cast<int>(TakeBit(blocks.some));
          const int bx = fx * 4 + b % 4, by = fy * 4 + b / 4;
          if (bx < tiles.blocks_wide && by < tiles.blocks_high) {
            hits.some.push_back({static_cast<std::uint32_t>(by * tiles.blocks_wide + bx),
                                 static_cast<std::uint32_t>(i)});
          }
        }
      }
    }
  }
}

// A tile whose samples are known to lie in front of or behind the side only one by one.
struct TileJob {
  const Side& side;
  int column, row;  // of the first sample
  const float* nearness;
  std::int32_t* counts;
  ExactSideDecisions* exact;
};

// The samples of a vector that float cannot decide: `open`; `covered`: those that the side surely
// covers.
template <class Mask>
HWY_NOINLINE void DecideOpen(const TileJob& t, Mask open, Mask covered, int index) {
  const F f;
  HWY_ALIGN float is_open[16], is_covered[16];
  hn::Store(hn::IfThenElseZero(open, Set(1)), f, is_open);
  hn::Store(hn::IfThenElseZero(covered, Set(1)), f, is_covered);
  for (int lane = 0; lane < static_cast<int>(hn::Lanes(f)); ++lane) {
    if (is_open[lane] == 0) continue;
    const int column = t.column + (index + lane) % kTile, row = t.row + (index + lane) / kTile;
    if ((is_covered[lane] != 0 || t.exact->covers(t.side, column, row)) &&
        t.exact->in_front(t.side, column, row)) {
      t.counts[index + lane] += t.side.add;
    }
  }
}

HWY_INLINE void FillTile(const TileJob& t, const Slopes& slopes) {
  const F f;
  const FI fi;
  const Side& s = t.side;
  const int lanes = static_cast<int>(hn::Lanes(f)), columns = std::min(lanes, kTile),
            rows = lanes / columns;
  Values v;
  FindValues(s, slopes, t.column, t.row, 1, kEdgeInFloat, v);
  const float nearness_error =
      s.slack[kNearness] +
      (s.relative + kNearnessInFloat) * (std::fabs(v.at[kNearness]) + 16 * slopes.size[kNearness]);
  const V error0 = Set(v.error[0]), error1 = Set(v.error[1]), error2 = Set(v.error[2]),
          error3 = Set(nearness_error);
  const auto lane = hn::Iota(fi, 0);
  const V lane_row = hn::ConvertTo(f, hn::ShiftRight<3>(lane)),
          lane_column = hn::ConvertTo(f, hn::And(lane, hn::Set(fi, 7)));
  const auto add = hn::Set(fi, s.add);
  for (int x = 0; x < kTile; x += columns) {
    const V column = hn::Add(lane_column, Set(static_cast<float>(x)));
    const auto off = [&](int k) HWY_ATTR {
      return hn::Add(hn::Mul(Set(slopes.a[k]), column), hn::Mul(Set(slopes.b[k]), lane_row));
    };
    const V off0 = off(0), off1 = off(1), off2 = off(2), off3 = off(3);
    for (int y = 0; y < kTile; y += rows) {
      const auto at = [&](V o, int k) HWY_ATTR {
        return hn::Add(Set(v.at[k] + slopes.b[k] * static_cast<float>(y)), o);
      };
      const V e0 = at(off0, 0), e1 = at(off1, 1), e2 = at(off2, 2), g = at(off3, 3);
      const int index = y * kTile + x;
      const V difference = hn::Sub(g, hn::LoadU(f, t.nearness + index));
      const M covered =
          hn::And(hn::And(hn::Gt(e0, error0), hn::Gt(e1, error1)), hn::Gt(e2, error2));
      const M outside =
          hn::Or(hn::Or(hn::Lt(e0, hn::Neg(error0)), hn::Lt(e1, hn::Neg(error1))),
                 hn::Or(hn::Lt(e2, hn::Neg(error2)), hn::Lt(difference, hn::Neg(error3))));
      const M front = hn::And(covered, hn::Gt(difference, error3));
      std::int32_t* counts = t.counts + index;
      hn::Store(hn::Add(hn::Load(fi, counts), hn::IfThenElseZero(hn::RebindMask(fi, front), add)),
                fi, counts);
      const M open = hn::Not(hn::Or(outside, front));
      if (HWY_UNLIKELY(!hn::AllFalse(f, open))) DecideOpen(t, open, covered, index);
    }
  }
}

void FillBlock(const BlockJob& job) {
  const NearnessTiles& n = *job.tiles;
  const int x0 = static_cast<int>(job.block) % n.blocks_wide * kBlock,
            y0 = static_cast<int>(job.block) / n.blocks_wide * kBlock;
  const std::size_t first_patch = std::size_t{job.block} * 16;
  BlockCounts& c = *job.counts;
  for (std::size_t i = 0; i < job.count; ++i) {
    const Side& s = job.sides[job.selected[i]];
    Slopes slopes;
    FindSlopes(s, slopes);
    Squares patches = TestSquares(s, slopes, x0, y0, kPatch, n.patches.least.data() + first_patch,
                                  n.patches.greatest.data() + first_patch);
    while (patches.whole != 0) c.patches[TakeBit(patches.whole)] += s.add;
    while (patches.some != 0) {
      const std::uint32_t p = TakeBit(patches.some);
      const int x = x0 + static_cast<int>(p % 4) * kPatch,
                y = y0 + static_cast<int>(p / 4) * kPatch;
      const std::size_t first_tile = (first_patch + p) * 16;
      Squares tiles = TestSquares(s, slopes, x, y, kTile, n.tiles.least.data() + first_tile,
                                  n.tiles.greatest.data() + first_tile);
      while (tiles.whole != 0) c.tiles[p * 16 + TakeBit(tiles.whole)] += s.add;
      while (tiles.some != 0) {
        const std::uint32_t t = TakeBit(tiles.some), in_block = p * 16 + t;
        c.touched[in_block] = 1;
        FillTile({s, x + static_cast<int>(t % 4) * kTile, y + static_cast<int>(t / 4) * kTile,
                  n.nearness.data() + (first_tile + t) * kTileSamples,
                  c.samples + in_block * kTileSamples, job.exact},
                 slopes);
      }
    }
  }
}

// take(tile, column, row, columns, rows, count): of each tile in the picture, from the block's
// first sample; count: of the tile, without its samples' own.
template <class Take>
HWY_INLINE void ForEachTile(BlockCounts& c, const NearnessTiles& n, std::uint32_t block,
                            Take take) {
  const int width = n.width - static_cast<int>(block) % n.blocks_wide * kBlock,
            height = n.height - static_cast<int>(block) / n.blocks_wide * kBlock;
  for (std::uint32_t t = 0; t < kBlockTiles; ++t) {
    const int column = static_cast<int>(t / 16 % 4) * kPatch + static_cast<int>(t % 4) * kTile,
              row = static_cast<int>(t / 64) * kPatch + static_cast<int>(t / 4 % 4) * kTile;
    const int columns = std::min(kTile, width - column), rows = std::min(kTile, height - row);
    if (columns > 0 && rows > 0)
      take(t, column, row, columns, rows, c.block + c.patches[t / 16] + c.tiles[t]);
    if (c.touched[t] != 0) std::fill_n(c.samples + t * kTileSamples, kTileSamples, 0);
  }
  std::fill_n(c.tiles, kBlockTiles, 0);
  std::fill_n(c.patches, 16, 0);
  c.block = 0;
  std::fill_n(c.touched, kBlockTiles, std::uint8_t{0});
}

// A sample's count > 0 as 1, else 0; tile by tile into 64 bytes.
HWY_INLINE void MaskOfTile(const std::int32_t* counts, const float* nearness, std::int32_t more,
                           std::uint8_t* out) {
  const F f;
  const FI fi;
  const hn::Rebind<std::uint8_t, F> bytes;
  const V none = Set(std::numeric_limits<float>::infinity());
  // Unknown nearness (NaN) is a sample's; Ne() would be false for it.
  const auto threshold = hn::Set(fi, -more);
  for (std::size_t i = 0; i < kTileSamples; i += hn::Lanes(f)) {
    const auto dark =
        hn::And(hn::Gt(hn::Load(fi, counts + i), threshold),
                hn::Not(hn::RebindMask(fi, hn::Eq(hn::LoadU(f, nearness + i), none))));
    hn::StoreU(hn::DemoteTo(bytes, hn::IfThenElseZero(dark, hn::Set(fi, 1))), bytes, out + i);
  }
}

void TakeBlockMask(BlockCounts& c, const NearnessTiles& n, std::uint32_t block, std::uint8_t* to,
                   std::ptrdiff_t stride) {
  HWY_ALIGN std::uint8_t mask[kTileSamples];
  ForEachTile(c, n, block,
              [&](std::uint32_t t, int column, int row, int columns, int rows, std::int32_t count)
                  HWY_ATTR {
                    const float* nearness =
                        n.nearness.data() + (std::size_t{block} * kBlockTiles + t) * kTileSamples;
                    if (c.touched[t] == 0 && count <= 0) {
                      std::memset(mask, 0, sizeof(mask));
                    } else {
                      MaskOfTile(c.samples + t * kTileSamples, nearness, count, mask);
                    }
                    std::uint8_t* first = to + row * stride + column;
                    for (int y = 0; y < rows; ++y) {
                      if (HWY_LIKELY(columns == kTile)) {
                        std::memcpy(first + y * stride, mask + y * kTile, kTile);
                      } else {
                        std::copy_n(mask + y * kTile, columns, first + y * stride);
                      }
                    }
                  });
}

void TakeBlockCounts(BlockCounts& c, const NearnessTiles& n, std::uint32_t block, std::int32_t* to,
                     std::ptrdiff_t stride) {
  ForEachTile(
      c, n, block,
      [&](std::uint32_t t, int column, int row, int columns, int rows, std::int32_t count) {
        const float* nearness =
            n.nearness.data() + (std::size_t{block} * kBlockTiles + t) * kTileSamples;
        const std::int32_t* counts = c.samples + t * kTileSamples;
        for (int y = 0; y < rows; ++y) {
          std::int32_t* line = to + (row + y) * stride + column;
          for (int x = 0; x < columns; ++x) {
            const int k = y * kTile + x;
            line[x] = nearness[k] == std::numeric_limits<float>::infinity() ? 0 : counts[k] + count;
          }
        }
      });
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon {

HWY_EXPORT(FindBlocks);
HWY_EXPORT(FillBlock);
HWY_EXPORT(TakeBlockMask);
HWY_EXPORT(TakeBlockCounts);

void find_blocks(const Side* sides, std::size_t begin, std::size_t end, const NearnessTiles& tiles,
                 BlockHits& hits) {
  HWY_DYNAMIC_DISPATCH(FindBlocks)(sides, begin, end, tiles, hits);
}

void fill_block(const BlockJob& job) { HWY_DYNAMIC_DISPATCH(FillBlock)(job); }

void take_block_mask(BlockCounts& counts, const NearnessTiles& tiles, std::uint32_t block,
                     std::uint8_t* to, std::ptrdiff_t stride) {
  HWY_DYNAMIC_DISPATCH(TakeBlockMask)(counts, tiles, block, to, stride);
}

void take_block_counts(BlockCounts& counts, const NearnessTiles& tiles, std::uint32_t block,
                       std::int32_t* to, std::ptrdiff_t stride) {
  HWY_DYNAMIC_DISPATCH(TakeBlockCounts)(counts, tiles, block, to, stride);
}

}  // namespace gnomon
#endif
