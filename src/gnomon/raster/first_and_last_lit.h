// Masks to the first and last light that reaches a sample, as fast as memory allows.
#pragma once

#include <cstdint>

namespace gnomon {

// Where mask[k] is 0, that is where the light reaches sample k: lowers first[k] to `begin` and
// raises last[k] to `end` where they lie on the other side; k in [0, n).
void keep_first_and_last_lit(const std::uint8_t* mask, int n, std::uint16_t begin,
                             std::uint16_t end, std::uint16_t* first, std::uint16_t* last);

// The specification: the same, one sample after the other.
void keep_first_and_last_lit_reference(const std::uint8_t* mask, int n, std::uint16_t begin,
                                       std::uint16_t end, std::uint16_t* first,
                                       std::uint16_t* last);

}  // namespace gnomon
