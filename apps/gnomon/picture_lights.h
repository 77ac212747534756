// The suns of view.png.
#pragma once

#include <vector>

#include <gnomon/profile/study_times.h>

namespace gnomon::app {

// At most 33 suns that are up: the instants of one day thinned evenly, both ends kept; of a range,
// each from another part of it, at times of day that the golden ratio spreads evenly.
std::vector<Light> picture_lights(const Samples& samples);

// Azimuth in the scene's grid of the sun in the middle of the time it is up; never on the side away
// from the highest sun.
double middle_azimuth(const Samples& samples);

}  // namespace gnomon::app
