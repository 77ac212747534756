// Where the model stands: said, and compared with the clock that is named.
#pragma once

#include <string>

#include <gnomon/core/place.h>
#include <gnomon/core/warnings.h>
#include <gnomon/io/load_scene.h>

namespace gnomon::app {

// "place 48.2058 N, 16.3490 E, from the CRS"; empty where the scene has no place.
std::string place_line(const LoadedScene& loaded);

// Warns of a place so far from the zone's own that latitude and longitude seem to be swapped, or
// the zone another's.
void check_place(Warnings& warnings, const Place& place, const std::string& zone);

}  // namespace gnomon::app
