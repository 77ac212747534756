// From samples to map pixels: hours as colours, with light relief and thin outlines, at a size fit
// for a page.
#pragma once

#include <array>

#include <gnomon/io/picture.h>
#include <gnomon/io/picture_shading.h>
#include <gnomon/profile/profile.h>

namespace gnomon {

inline constexpr int kLongestMapSide = 1600;  // pixels: a page's width at 200 dots per inch
inline constexpr Rgb kNoDataColour{226, 228, 232};

// Size of the map for so many samples: both sides shrunk alike to kLongestMapSide, or enlarged by
// the largest whole factor that keeps the longer side within 1280 pixels.
struct MapSize {
  int width = 0, height = 0;
  int enlarged = 1;    // pixels per sample where enlarged; 1 else
  double scale = 1.0;  // pixels per sample
};
MapSize map_size(int width, int height);

// Colours are those of hours_colour(hours / daylight). Shrinking averages hours over each pixel's
// area (not colours, which would not be on the legend). Preconditions as draw_plan.
Picture draw_hours(const Profile& profile, const PlanRelief& relief, int threads);

// The same in other colours, from no hour to all of the daylight.
Picture draw_hours(const Profile& profile, const PlanRelief& relief,
                   const std::array<Rgb, 256>& colours, int threads);

}  // namespace gnomon
