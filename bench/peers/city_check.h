// Whether a renderer's shadows of the box city are right: against the exact mask.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <gnomon/core/vec.h>

namespace gnomon::bench {

struct CityCheck {
  std::size_t samples = 0;  // pixels that show a face turned to the lamp: others are dark anyhow
  std::size_t shadow = 0;   // of these, those in shadow
  std::size_t wrong = 0;    // of these, those that the picture has otherwise
};

// Pictures of city_view.h's camera, size x size, three bytes a pixel (red, green, blue), row 0 at
// the top. A pixel is in shadow where any colour is darker than in the picture without shadows.
// Precondition: both hold 3 * size * size bytes.
CityCheck check_city(const std::vector<std::uint8_t>& shadowed,
                     const std::vector<std::uint8_t>& unshadowed, int size, const Vec3& lamp);

}  // namespace gnomon::bench
