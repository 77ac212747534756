// "Did you mean": the names nearest to one that is not there.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>

namespace gnomon {

// At most `most` of the names, the nearest first, each in quotes, with commas between them; empty
// where there are none. Those that contain `wanted` come first, then those that fewest insertions,
// deletions and replacements away. Case does not count, nor do wildcards in `wanted`.
std::string nearest_names(std::string_view wanted, const std::set<std::string_view>& names,
                          std::size_t most = 3);

}  // namespace gnomon
