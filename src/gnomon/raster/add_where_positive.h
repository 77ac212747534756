// Counts to sums, as fast as memory allows.
#pragma once

#include <cstdint>

namespace gnomon {

// Adds weight to sums[k] where counts[k] > 0, for k in [0, n).
void add_where_positive(const std::int32_t* counts, int n, std::uint32_t weight,
                        std::uint32_t* sums);

// Name of the instruction set that the counter uses on this machine ("AVX3", "AVX2", "SCALAR",
// ...).
const char* instruction_set();

}  // namespace gnomon
