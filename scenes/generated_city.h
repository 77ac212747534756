// A town of any size: streets, blocks, lots with boxes, gabled and hipped houses and annexes on
// gently uneven terrain.
#pragma once

#include <cstddef>
#include <cstdint>

#include <gnomon/scene/scene.h>
#include <gnomon/view/view.h>

namespace gnomon::scenes {

struct CityOptions {
  int buildings = 10000;
  // If not 0: instead of `buildings`, as many as make about this many triangles (within a tenth; up
  // to 10^7 and more).
  std::size_t triangles = 0;
  std::uint64_t seed = 1;  // equal options give the equal town
};

// Welded. Each building is an object of its own ("building 17"), of closed, consistently wound
// shells that reach below the terrain; the terrain is one object ("terrain", semantic TINRelief).
// Corners are on whole millimetres, the town is about square and around the origin, +x is the
// longer side of blocks.
Scene generated_city(const CityOptions& options = {});

// The square that holds all buildings, metres.
Bounds2 city_bounds(const CityOptions& options);

}  // namespace gnomon::scenes
