// The colours of hours: from sunlit cream over amber and rose to the indigo of lasting shadow.
#pragma once

#include <array>

#include <gnomon/io/picture.h>

namespace gnomon {

// 256 colours whose CIELAB lightness L* falls evenly from 96 to 14, so that equal differences in
// hours look equal, the order survives grey printing and colour-blind eyes, and dark means shadow.
// Made for Gnomon from eight points in CIELAB; see docs/outputs.md.
const std::array<Rgb, 256>& hours_colours();

// `share` in [0, 1] of the longest time, clamped.
Rgb hours_colour(double share);

}  // namespace gnomon
