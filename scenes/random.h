// Random numbers of generated scenes: the same on every machine. The standard's distributions
// differ between libraries.
// Based on: Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014 (SplitMix64).
#pragma once

#include <cstdint>

namespace gnomon::scenes {

struct Random {
  std::uint64_t state;
  std::uint64_t bits() {
    std::uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double between(double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(bits() >> 11) * 0x1p-53;
  }
};

}  // namespace gnomon::scenes
