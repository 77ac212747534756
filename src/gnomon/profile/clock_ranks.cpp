#include <gnomon/profile/clock_ranks.h>

#include <algorithm>

#include <gnomon/profile/profile.h>

namespace gnomon {

ClockRanks rank_clock_times(const std::vector<std::int32_t>& times, SharedRank shared) {
  std::vector<std::int32_t> different = times;
  std::sort(different.begin(), different.end());
  different.erase(std::unique(different.begin(), different.end()), different.end());
  constexpr std::size_t kMostRanks = kNeverLit;  // 0 .. kNeverLit - 1
  const std::size_t group = (different.size() + kMostRanks - 1) / kMostRanks;

  ClockRanks out;
  for (std::size_t begin = 0; begin < different.size(); begin += group) {
    const std::size_t last = std::min(begin + group, different.size()) - 1;
    out.times.push_back(different[shared == SharedRank::kEarliest ? begin : last]);
  }
  out.ranks.reserve(times.size());
  for (const std::int32_t t : times) {
    const auto at = std::lower_bound(different.begin(), different.end(), t) - different.begin();
    out.ranks.push_back(static_cast<std::uint16_t>(static_cast<std::size_t>(at) / group));
  }
  return out;
}

}  // namespace gnomon
