// The height of a surface at a place, seen from straight above.
#pragma once

#include <array>
#include <vector>

#include <gnomon/core/vec.h>
#include <gnomon/io/model.h>

namespace gnomon {

// A function that returns, for (x, y), the z of the highest of the triangles above or below that
// place, and nothing where there is none. Edges and vertices belong to their triangles: whether a
// place is inside is decided exactly, so neighbours leave no gap. z is interpolated in double: at a
// vertex it is the vertex's own, elsewhere rounded, and never outside of the heights of the
// triangle's corners. Triangles that are vertical, or have no area, count for nothing; winding does
// not matter. The function owns the triangles (72 bytes each, and some 10 to 70 for its grid); it
// can be called from several threads at once, and takes under a microsecond on terrain. Its answer
// does not depend on the order of the triangles. Preconditions: coordinates are finite and at most
// kLargestCoordinate (core/exact.h); fewer than 2^32 triangles.
GroundAt ground_at(std::vector<std::array<Vec3, 3>> triangles);

}  // namespace gnomon
