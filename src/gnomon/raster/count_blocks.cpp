#include <gnomon/raster/count_blocks.h>

#include <algorithm>

namespace gnomon {

BlockCounter::BlockCounter(const Casters& casters, const Receivers& receivers,
                           const ViewSetup& view, BlockMemory& memory, int block)
    : casters_(casters),
      receivers_(receivers),
      view_(view),
      tiles_(tiles_of(view, receivers)),
      memory_(memory),
      block_(static_cast<std::uint32_t>(block)),
      first_column_(block % tiles_.blocks_wide * kBlock),
      first_row_(block / tiles_.blocks_wide * kBlock),
      columns_(std::min(kBlock, tiles_.width - first_column_)),
      rows_(std::min(kBlock, tiles_.height - first_row_)) {}

CountRect BlockCounter::counts(const LightSetup& s, int light) {
  fill(s);
  memory_.rows_of_counts.resize(static_cast<std::size_t>(kBlock) * kBlock);
  std::int32_t* counts = memory_.rows_of_counts.data();
  take_block_counts(memory_.counts, tiles_, block_, counts, kBlock);
  for_each_unlit(s, [&](int column, int row) {
    std::int32_t& c = counts[row * kBlock + column];
    c = std::max(c, 1);
  });
  return {light, first_column_, first_row_, columns_, rows_, kBlock, counts};
}

MaskRect BlockCounter::mask(const LightSetup& s, int light) {
  memory_.rows_of_mask.resize(static_cast<std::size_t>(kBlock) * kBlock);
  take(s, memory_.rows_of_mask.data(), kBlock);
  return {light, first_column_, first_row_, columns_, rows_, kBlock, memory_.rows_of_mask.data()};
}

void BlockCounter::mask(const LightSetup& s, std::uint8_t* to) {
  const std::ptrdiff_t width = tiles_.width;
  take(s, to + first_row_ * width + first_column_, width);
}

// `to`: of the block's first sample.
void BlockCounter::take(const LightSetup& s, std::uint8_t* to, std::ptrdiff_t stride) {
  fill(s);
  take_block_mask(memory_.counts, tiles_, block_, to, stride);
  for_each_unlit(s, [&](int column, int row) { to[row * stride + column] = 1; });
}

void BlockCounter::fill(const LightSetup& s) {
  memory_.counts.block = s.eye_count + s.block_counts[block_];
  const std::span<const std::uint32_t> selected = s.side_bins.of(block_);
  if (selected.empty()) return;
  ExactDecisions exact(casters_, view_, receivers_, s);
  BlockJob job;
  job.sides = s.sides.get();
  job.selected = selected.data();
  job.count = selected.size();
  job.tiles = &tiles_;
  job.block = block_;
  job.counts = &memory_.counts;
  job.exact = &exact;
  fill_block(job);
  stats.spans += exact.spans;
  stats.depths += exact.depths;
  stats.close += exact.close;
}

template <class F>
void BlockCounter::for_each_unlit(const LightSetup& s, F f) const {
  if (s.unlit.empty()) return;
  for (int row = 0; row < rows_; ++row) {
    const std::uint32_t* triangle = receivers_.triangle.data() +
                                    static_cast<std::ptrdiff_t>(first_row_ + row) * tiles_.width +
                                    first_column_;
    for (int column = 0; column < columns_; ++column) {
      if (triangle[column] != kNoTriangle && s.unlit[triangle[column]] != 0) f(column, row);
    }
  }
}

}  // namespace gnomon
