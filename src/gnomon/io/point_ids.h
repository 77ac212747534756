// Points of the plane, found again by their coordinates to the bit.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <gnomon/core/vec.h>

namespace gnomon {

// Numbers points of the plane by their exact coordinates.
struct PointIds {
  struct Hash {
    std::size_t operator()(const std::array<std::uint64_t, 2>& k) const {
      return (k[0] * 0x9E3779B97F4A7C15u) ^ ((k[1] * 0xC2B2AE3D27D4EB4Fu) >> 7);
    }
  };
  std::unordered_map<std::array<std::uint64_t, 2>, std::uint32_t, Hash> ids;
  std::vector<Vec2> points;

  std::uint32_t operator()(const Vec2& p) {
    const std::array<std::uint64_t, 2> key = {std::bit_cast<std::uint64_t>(p.x + 0.0),
                                              std::bit_cast<std::uint64_t>(p.y + 0.0)};
    const auto [at, is_new] = ids.emplace(key, static_cast<std::uint32_t>(points.size()));
    if (is_new) points.push_back(p);
    return at->second;
  }
};

}  // namespace gnomon
