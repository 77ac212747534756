// A closed, smooth, finely triangulated body.
#pragma once

#include <gnomon/scene/scene.h>

namespace gnomon::scenes {

// A sphere of the given radius around `centre` (metres), of 20 * 4^levels triangles wound outwards.
// `bumps` in [0, 0.5): height of smooth bumps, as a part of the radius; 0: none. One object,
// "sphere". Precondition: 0 <= levels <= 11.
Scene generated_sphere(int levels, double radius, const Vec3& centre = Vec3(0.0), double bumps = 0);

}  // namespace gnomon::scenes
