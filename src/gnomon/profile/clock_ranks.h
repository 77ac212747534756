// Clock times as small numbers that keep their order, so that the first and the last of them can be
// kept in 16 bits a sample.
#pragma once

#include <cstdint>
#include <vector>

namespace gnomon {

struct ClockRanks {
  std::vector<std::int32_t> times;   // ascending, at most 65535; a rank is an index into it
  std::vector<std::uint16_t> ranks;  // of each time given, in their order
};

enum class SharedRank { kEarliest, kLatest };

// Ranks of `times`. Equal times have equal ranks, later ones no smaller ones. Of more than 65535
// different times, neighbours share ranks, as few as possible, and `shared` says which of them
// stands for all.
ClockRanks rank_clock_times(const std::vector<std::int32_t>& times, SharedRank shared);

}  // namespace gnomon
