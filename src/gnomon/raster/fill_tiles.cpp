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
// slopes, five sums, over at most 8 pixels; fewer roundings of 2^-24 of |value| + 16 than these.
constexpr float kEdgeInFloat = 3 * 0x1p-23F;
// The same of nearness, and the rounding of the sample's own (2^-23) and of the difference, as a
// share of |value| + 16 times its slopes.
constexpr float kNearnessInFloat = 0x1p-20F;
// The same over squares of `side` pixels, as a share of |value| + 16 `side` times the slopes.
constexpr float kSquareInFloat = 0x1p-21F;

HWY_INLINE V Set(float x) { return hn::Set(F(), x); }

using D = hn::CappedTag<double, kSideFunctions>;
using DF = hn::Rebind<float, D>;

// A side's functions over squares of `pixels` pixels from a place, in float: their values at the
// middle of its first pixel and their slopes; what, added to a value, is above the function in the
// whole square, with all that may be wrong with it, and what, subtracted, is below it.
struct Local {
  HWY_ALIGN float at[kSideFunctions], a[kSideFunctions], b[kSideFunctions];
  HWY_ALIGN float up[kSideFunctions], down[kSideFunctions];
};

// Which functions are also wrong by Side::relative of their value; and what FillTile(), which does
// not ask for the bounds of nearness, adds for rounding.
HWY_ALIGN constexpr float kOfNearness[kSideFunctions] = {0, 0, 0, 1, 1, 1, 0, 0};
HWY_ALIGN constexpr float kInFloat[kSideFunctions] = {
    kEdgeInFloat, kEdgeInFloat, kEdgeInFloat, kNearnessInFloat, 0, 0, 0, 0};

// `rounding`: of |value| + 16 `pixels` times the slopes.
HWY_INLINE void FindLocal(const Side& s, int x, int y, float pixels, float rounding, Local& out) {
  const D d;
  const DF f;
  const auto px = hn::Set(d, x + kPixelCentre), py = hn::Set(d, y + kPixelCentre);
  const auto zero = hn::Zero(f), span = hn::Set(f, pixels - 1), far = hn::Set(f, 16 * pixels),
             round = hn::Set(f, rounding), relative = hn::Set(f, s.relative);
  for (std::size_t k = 0; k < kSideFunctions; k += hn::Lanes(d)) {
    const auto a = hn::Load(d, s.a + k), b = hn::Load(d, s.b + k), c = hn::Load(d, s.c + k);
    const auto at = hn::DemoteTo(f, hn::Add(hn::Add(c, hn::Mul(a, px)), hn::Mul(b, py)));
    const auto fa = hn::DemoteTo(f, a), fb = hn::DemoteTo(f, b);
    const auto size = hn::Add(hn::Abs(fa), hn::Abs(fb));
    const auto share = hn::Add(round, hn::Mul(relative, hn::Load(f, kOfNearness + k)));
    const auto error =
        hn::Add(hn::Load(f, s.slack + k), hn::Mul(share, hn::Add(hn::Abs(at), hn::Mul(far, size))));
    const auto rise = hn::Add(hn::Max(fa, zero), hn::Max(fb, zero)),
               fall = hn::Add(hn::Min(fa, zero), hn::Min(fb, zero));
    hn::Store(at, f, out.at + k);
    hn::Store(fa, f, out.a + k);
    hn::Store(fb, f, out.b + k);
    hn::Store(hn::Add(error, hn::Mul(span, rise)), f, out.up + k);
    hn::Store(hn::Sub(error, hn::Mul(span, fall)), f, out.down + k);
  }
}

// The 16 squares of `side` pixels whose first pixel is (x, y), some lanes at a time: take(index of
// the first, mask of those that need a closer look, mask of those that the side covers in front of
// all samples). Squares without samples are in neither.
template <class Take>
HWY_INLINE void TestSquares(const Side& s, int x, int y, int side, const float* least,
                            const float* greatest, Take take) {
  const F f;
  const FI fi;
  const auto step = static_cast<float>(side);
  Local l;
  FindLocal(s, x, y, step, kSquareInFloat, l);
  for (std::size_t i = 0; i < 16; i += hn::Lanes(f)) {
    const auto lane = hn::Add(hn::Set(fi, static_cast<std::int32_t>(i)), hn::Iota(fi, 0));
    const V columns = hn::Mul(hn::ConvertTo(f, hn::And(lane, hn::Set(fi, 3))), Set(step)),
            rows = hn::Mul(hn::ConvertTo(f, hn::ShiftRight<2>(lane)), Set(step));
    const auto at = [&](int k) HWY_ATTR {
      return hn::Add(Set(l.at[k]),
                     hn::Add(hn::Mul(Set(l.a[k]), columns), hn::Mul(Set(l.b[k]), rows)));
    };
    const auto above = [&](V value, int k) HWY_ATTR { return hn::Add(value, Set(l.up[k])); };
    const auto below = [&](V value, int k) HWY_ATTR { return hn::Sub(value, Set(l.down[k])); };
    const V zero = hn::Zero(f), lowest = hn::LoadU(f, least + i), most = hn::LoadU(f, greatest + i);
    const V e0 = at(kEdge), e1 = at(kEdge + 1), e2 = at(kEdge + 2), g = at(kNearness);
    const M outside =
        hn::Or(hn::Or(hn::Lt(above(e0, kEdge), zero), hn::Lt(above(e1, kEdge + 1), zero)),
               hn::Lt(above(e2, kEdge + 2), zero));
    const M behind = hn::Or(
        hn::Or(hn::Lt(above(g, kNearness), lowest), hn::Lt(above(at(kUpper), kUpper), lowest)),
        hn::Eq(lowest, Set(std::numeric_limits<float>::infinity())));
    const M covered =
        hn::And(hn::And(hn::Gt(below(e0, kEdge), zero), hn::Gt(below(e1, kEdge + 1), zero)),
                hn::Gt(below(e2, kEdge + 2), zero));
    const M front =
        hn::Or(hn::Gt(below(g, kNearness), most), hn::Gt(below(at(kLower), kLower), most));
    const M passed = hn::Or(outside, behind);
    const M whole = hn::AndNot(passed, hn::And(front, covered));
    take(i, hn::RebindMask(fi, hn::Not(hn::Or(passed, whole))), hn::RebindMask(fi, whole));
  }
}

// Squares to look at, by number. Each step goes through a list of them and makes the next one, so
// that what is done for one does not wait for the other.
constexpr std::size_t kChunk = 256;
struct List {
  std::size_t n = 0;
  std::uint32_t at[kChunk * 16 + 16];  // the last store may be a whole vector
};

// Appends first + lane for each lane in the mask.
template <class Mask>
HWY_INLINE void Append(List& list, std::size_t first, Mask mask) {
  const FI fi;
  const hn::RebindToUnsigned<FI> fu;
  const auto lane = hn::Add(hn::Set(fi, static_cast<std::int32_t>(first)), hn::Iota(fi, 0));
  // Compressing straight into memory is slow on some processors.
  hn::StoreU(hn::BitCast(fu, hn::Compress(lane, mask)), fu, list.at + list.n);
  list.n += hn::CountTrue(fi, mask);
}

// to[lane] += add for each lane in the mask.
template <class Mask>
HWY_INLINE void AddTo(std::int32_t* to, Mask mask, std::int32_t add) {
  const FI fi;
  hn::StoreU(hn::Add(hn::LoadU(fi, to), hn::IfThenElseZero(mask, hn::Set(fi, add))), fi, to);
}

void FindBlocks(const Side* sides, std::size_t begin, std::size_t end, const NearnessTiles& tiles,
                BlockHits& hits) {
  const FI fi;
  const int fields_wide = (tiles.width + kField - 1) / kField;
  const int roots_wide = (fields_wide + 3) / 4;
  const std::size_t roots = tiles.fields.least.size() / 16;
  List fields, blocks, whole;
  for (std::size_t root = 0; root < roots; ++root) {
    const int rx = static_cast<int>(root) % roots_wide * 4,
              ry = static_cast<int>(root) / roots_wide * 4;
    // A block of the picture: (side of the chunk, field of the root, block of the field). A field
    // that is covered altogether is looked at like any other.
    const auto block_of = [&](std::uint32_t code) {
      const int field = static_cast<int>(code >> 4) % 16, block = static_cast<int>(code % 16);
      const int x = (rx + field % 4) * 4 + block % 4, y = (ry + field / 4) * 4 + block / 4;
      return static_cast<std::uint32_t>(y * tiles.blocks_wide + x);
    };
    for (std::size_t chunk = begin; chunk < end; chunk += kChunk) {
      fields.n = 0;
      for (std::size_t i = chunk; i < std::min(end, chunk + kChunk); ++i) {
        TestSquares(sides[i], rx * kField, ry * kField, kField,
                    tiles.fields.least.data() + root * 16, tiles.fields.greatest.data() + root * 16,
                    [&](std::size_t k, auto some, auto all)
                        HWY_ATTR { Append(fields, (i - chunk) * 16 + k, hn::Or(some, all)); });
      }
      for (std::size_t from = 0; from < fields.n; from += kChunk) {
        blocks.n = whole.n = 0;
        for (std::size_t i = from; i < std::min(fields.n, from + kChunk); ++i) {
          const std::uint32_t code = fields.at[i];
          const int x = rx + static_cast<int>(code % 4), y = ry + static_cast<int>(code / 4 % 4);
          const std::size_t first = static_cast<std::size_t>(y * fields_wide + x) * 16;
          TestSquares(sides[chunk + code / 16], x * kField, y * kField, kBlock,
                      tiles.blocks.least.data() + first, tiles.blocks.greatest.data() + first,
                      [&](std::size_t k, auto some, auto all) HWY_ATTR {
                        Append(blocks, code * 16 + k, some);
                        if (HWY_UNLIKELY(!hn::AllFalse(fi, all))) Append(whole, code * 16 + k, all);
                      });
        }
        for (std::size_t i = 0; i < blocks.n; ++i) {
          const std::uint32_t code = blocks.at[i];
          hits.some.push_back({block_of(code), static_cast<std::uint32_t>(chunk + (code >> 8))});
        }
        for (std::size_t i = 0; i < whole.n; ++i) {
          const std::uint32_t code = whole.at[i];
          hits.whole.push_back({block_of(code), sides[chunk + (code >> 8)].add});
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
  int asked = 0;  // samples, whether the side covers them
  int whole = 0;  // ExactSideDecisions::covers_tile(), when it has been asked
};
// Of a side with an edge that no float knows (a lamp over its vertex) all samples are open: then
// the tile is asked for as a whole.
constexpr int kAskedOneByOne = 4;

// The samples of a vector that float cannot decide: `open`; `covered`: those that the side surely
// covers. `index`: of the first, in the tile.
template <class Mask>
HWY_NOINLINE void DecideOpen(TileJob& t, Mask open, Mask covered, std::size_t index) {
  const F f;
  HWY_ALIGN float is_open[16], is_covered[16];
  hn::Store(hn::IfThenElseZero(open, Set(1)), f, is_open);
  hn::Store(hn::IfThenElseZero(covered, Set(1)), f, is_covered);
  for (std::size_t lane = 0; lane < hn::Lanes(f); ++lane) {
    if (is_open[lane] == 0) continue;
    const std::size_t k = index + lane;
    // No sample, or outside the picture.
    if (t.nearness[k] == std::numeric_limits<float>::infinity()) continue;
    const int column = t.column + column_in_tile(k), row = t.row + row_in_tile(k);
    if (is_covered[lane] == 0) {
      if (t.asked++ == kAskedOneByOne) t.whole = t.exact->covers_tile(t.side, t.column, t.row);
      if (t.whole != 0 ? t.whole < 0 : !t.exact->covers(t.side, column, row)) continue;
    }
    if (t.exact->in_front(t.side, column, row)) t.counts[k] += t.side.add;
  }
}

// Four by four samples at a time.
HWY_INLINE void FillTile(TileJob t) {
  const D d;
  const DF df;
  const F f;
  const FI fi;
  constexpr std::size_t kQuads = kTileSamples / 16;
  // What is not below the functions at each quad's first sample, and, subtracted, what is not
  // above.
  HWY_ALIGN float most[kQuads][kSideFunctions], a[kSideFunctions], b[kSideFunctions],
      twice[kSideFunctions];
  const Side& s = t.side;
  const auto px = hn::Set(d, t.column + kPixelCentre), py = hn::Set(d, t.row + kPixelCentre);
  const auto far = hn::Set(df, 16), four = hn::Set(df, 4), relative = hn::Set(df, s.relative);
  for (std::size_t k = 0; k < kSideFunctions; k += hn::Lanes(d)) {
    const auto da = hn::Load(d, s.a + k), db = hn::Load(d, s.b + k), dc = hn::Load(d, s.c + k);
    const auto value = hn::DemoteTo(df, hn::Add(hn::Add(dc, hn::Mul(da, px)), hn::Mul(db, py)));
    const auto fa = hn::DemoteTo(df, da), fb = hn::DemoteTo(df, db);
    const auto rounding =
        hn::Add(hn::Load(df, kInFloat + k), hn::Mul(relative, hn::Load(df, kOfNearness + k)));
    const auto size = hn::Add(hn::Abs(value), hn::Mul(far, hn::Add(hn::Abs(fa), hn::Abs(fb))));
    const auto error = hn::Add(hn::Load(df, s.slack + k), hn::Mul(rounding, size));
    const auto right = hn::Mul(fa, four), first = hn::Add(value, error),
               below = hn::Add(first, hn::Mul(fb, four));
    hn::Store(fa, df, a + k);
    hn::Store(fb, df, b + k);
    hn::Store(hn::Add(error, error), df, twice + k);
    hn::Store(first, df, most[0] + k);
    hn::Store(hn::Add(first, right), df, most[1] + k);
    hn::Store(below, df, most[2] + k);
    hn::Store(hn::Add(below, right), df, most[3] + k);
  }
  const V zero = hn::Zero(f);
  const auto add = hn::Set(fi, s.add);
  for (std::size_t i = 0; i < 16; i += hn::Lanes(f)) {
    const auto lane = hn::Add(hn::Set(fi, static_cast<std::int32_t>(i)), hn::Iota(fi, 0));
    const V columns = hn::ConvertTo(f, hn::And(lane, hn::Set(fi, 3))),
            rows = hn::ConvertTo(f, hn::ShiftRight<2>(lane));
    const auto off = [&](int k) HWY_ATTR {
      return hn::Add(hn::Mul(Set(a[k]), columns), hn::Mul(Set(b[k]), rows));
    };
    const V off0 = off(kEdge), off1 = off(kEdge + 1), off2 = off(kEdge + 2), off3 = off(kNearness);
    for (std::size_t q = 0; q < kQuads; ++q) {
      const V e0 = hn::Add(Set(most[q][kEdge]), off0), e1 = hn::Add(Set(most[q][kEdge + 1]), off1),
              e2 = hn::Add(Set(most[q][kEdge + 2]), off2);
      const M passed = hn::Lt(hn::Min(hn::Min(e0, e1), e2), zero);
      const std::size_t index = q * 16 + i;
      const auto less = [&](V value, int k) HWY_ATTR { return hn::Sub(value, Set(twice[k])); };
      const V nearer =
          hn::Sub(hn::Add(Set(most[q][kNearness]), off3), hn::LoadU(f, t.nearness + index));
      const M covered =
          hn::Gt(hn::Min(hn::Min(less(e0, kEdge), less(e1, kEdge + 1)), less(e2, kEdge + 2)), zero);
      const M added = hn::And(covered, hn::Gt(less(nearer, kNearness), zero));
      std::int32_t* counts = t.counts + index;
      hn::Store(hn::Add(hn::Load(fi, counts), hn::IfThenElseZero(hn::RebindMask(fi, added), add)),
                fi, counts);
      const M open = hn::Not(hn::Or(hn::Or(passed, hn::Lt(nearer, zero)), added));
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
  List patches, tiles;
  for (std::size_t chunk = 0; chunk < job.count; chunk += kChunk) {
    const auto side = [&](std::size_t i) -> const Side& {
      return job.sides[job.selected[chunk + i]];
    };
    patches.n = 0;
    for (std::size_t i = 0; i < std::min(kChunk, job.count - chunk); ++i) {
      const Side& s = side(i);
      TestSquares(s, x0, y0, kPatch, n.patches.least.data() + first_patch,
                  n.patches.greatest.data() + first_patch,
                  [&](std::size_t k, auto some, auto all) HWY_ATTR {
                    Append(patches, i * 16 + k, some);
                    AddTo(c.patches + k, all, s.add);
                  });
    }
    for (std::size_t from = 0; from < patches.n; from += kChunk) {
      tiles.n = 0;
      for (std::size_t i = from; i < std::min(patches.n, from + kChunk); ++i) {
        const std::uint32_t code = patches.at[i], patch = code % 16;
        const Side& s = side(code / 16);
        const std::size_t first = (first_patch + patch) * 16;
        TestSquares(s, x0 + static_cast<int>(patch % 4) * kPatch,
                    y0 + static_cast<int>(patch / 4) * kPatch, kTile, n.tiles.least.data() + first,
                    n.tiles.greatest.data() + first,
                    [&](std::size_t k, auto some, auto all) HWY_ATTR {
                      Append(tiles, code * 16 + k, some);
                      AddTo(c.tiles + patch * 16 + k, all, s.add);
                    });
      }
      for (std::size_t i = 0; i < tiles.n; ++i) {
        const std::uint32_t code = tiles.at[i], tile = code % 256;  // of the block
        c.touched[tile] = 1;
        FillTile(
            {side(code / 256),
             x0 + static_cast<int>(tile / 16 % 4) * kPatch + static_cast<int>(tile % 4) * kTile,
             y0 + static_cast<int>(tile / 64) * kPatch + static_cast<int>(tile / 4 % 4) * kTile,
             n.nearness.data() + (std::size_t{job.block} * kBlockTiles + tile) * kTileSamples,
             c.samples + tile * kTileSamples, job.exact});
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
  ForEachTile(c, n, block,
              [&](std::uint32_t t, int column, int row, int columns, int rows, std::int32_t count)
                  HWY_ATTR {
                    const std::size_t tile = std::size_t{block} * kBlockTiles + t;
                    std::uint8_t* first = to + row * stride + column;
                    if (c.touched[t] == 0 && (count <= 0 || n.full[tile] != 0)) {
                      for (int y = 0; y < rows; ++y)
                        std::memset(first + y * stride, count > 0 ? 1 : 0,
                                    static_cast<std::size_t>(columns));
                      return;
                    }
                    HWY_ALIGN std::uint8_t mask[kTileSamples];
                    MaskOfTile(c.samples + t * kTileSamples,
                               n.nearness.data() + tile * kTileSamples, count, mask);
                    if (HWY_LIKELY(columns == kTile && rows == kTile)) {
                      for (int y = 0; y < kTile; ++y) {
                        const std::uint8_t* from = mask + index_in_tile(0, y);
                        std::memcpy(first + y * stride, from, 4);
                        std::memcpy(first + y * stride + 4, from + 16, 4);
                      }
                      return;
                    }
                    for (int y = 0; y < rows; ++y) {
                      for (int x = 0; x < columns; ++x)
                        first[y * stride + x] = mask[index_in_tile(x, y)];
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
            const std::size_t k = index_in_tile(x, y);
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
