// The ground of a scene under construction, for what is put on it last.
#pragma once

#include <gnomon/io/model.h>
#include <gnomon/scene/scene.h>

namespace gnomon {

// In CRS coordinates (scene coordinates + frame.origin): the height of the scene's terrain
// (is_terrain, footprints.h); where it has none below a point, that of the lowest vertex of the
// object whose box is nearest to it, seen from above. Nothing in an empty scene. It keeps copies of
// what it needs.
GroundAt ground_of(const Scene& scene);

}  // namespace gnomon
