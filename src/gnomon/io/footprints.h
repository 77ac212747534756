// Where the objects of a scene touch the ground: the first step of the ground surface, see
// docs/ground.md.
#pragma once

#include <array>
#include <vector>

#include <gnomon/core/vec.h>
#include <gnomon/core/warnings.h>
#include <gnomon/scene/scene.h>

namespace gnomon {

struct Footprints {
  // Triangles that close a building from below (scene coordinates; never vertical). The ground
  // leaves them open.
  std::vector<std::array<Vec3, 3>> closed;
  // Lower edges of objects that are open from below; the ground passes under these objects, through
  // these edges.
  std::vector<std::array<Vec3, 2>> open;
  // No file names city objects: all of the scene counts as one object (an OBJ, say), which stands
  // on level ground at its lowest point. Beside files that do, each such file is one object.
  bool one_object = false;
};

// True where an object of this CityJSON type is ground itself: TINRelief, LandUse, Road, Railway,
// WaterBody, PlantCover, TransportSquare, Waterway. Of other formats, whose groups have the names
// that designers gave them, only what Gnomon wrote itself: TINRelief, and ground that it made.
bool is_terrain(const Surface& surface);

// False for what hangs on or stands in a building, spans the ground or runs below it.
bool stands_on_ground(const Surface& surface);

// True for surfaces of rasters with heights above the ground.
bool is_height_above_ground(const Surface& surface);

Footprints find_footprints(const Scene& scene);

// Sign of the turn a -> b -> c seen from above, exact: 1 counter-clockwise, -1 clockwise, 0
// straight.
int turn(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace gnomon
