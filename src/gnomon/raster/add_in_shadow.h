// Masks to sums, as fast as memory allows.
#pragma once

#include <cstdint>

namespace gnomon {

// Adds weight to sums[k] where mask[k] is not 0, for k in [0, n).
void add_in_shadow(const std::uint8_t* mask, int n, std::uint32_t weight, std::uint32_t* sums);

// Name of the instruction set that the counter uses on this machine ("AVX3", "AVX2", "SCALAR",
// ...).
const char* instruction_set();

}  // namespace gnomon
