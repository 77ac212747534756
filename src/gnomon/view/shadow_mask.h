// The shadow of one light: the answer for every sample of a view.
#pragma once

#include <cstdint>
#include <vector>

namespace gnomon {

// Row-major, row 0 at the top, width * height entries: one of the three constants.
struct ShadowMask {
  static constexpr std::uint8_t kLit = 0, kShadow = 1, kNoSample = 255;
  int width = 0, height = 0;
  std::vector<std::uint8_t> state;
};

}  // namespace gnomon
