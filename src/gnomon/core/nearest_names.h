// "Did you mean": the names nearest to one that is not there.
#pragma once

#include <cstddef>
#include <limits>
#include <set>
#include <string>
#include <string_view>

namespace gnomon {

// At most `most` of the names, the nearest first, each in quotes, with commas between them; empty
// where there are none. Those that contain `wanted` come first, then those that fewest insertions,
// deletions and replacements away. Case does not count, nor do wildcards in `wanted`.
// Names more than `farthest` of these away are left out.
std::string nearest_names(std::string_view wanted, const std::set<std::string_view>& names,
                          std::size_t most = 3,
                          std::size_t farthest = std::numeric_limits<std::size_t>::max());

}  // namespace gnomon
