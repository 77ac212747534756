// The ground of a scene under construction, for what is put on it last.
#pragma once

#include <gnomon/io/model.h>
#include <gnomon/scene/scene.h>

namespace gnomon {

enum class GroundSearch {
  below,    // nothing where the terrain has a hole, or ends
  nearest,  // there the height of the nearest point of its border
};

// In CRS coordinates (scene coordinates + frame.origin): the height of the scene's terrain
// (is_terrain, footprints.h) below a point. In a scene without terrain, that of the lowest vertex
// of the object whose box is nearest to it, seen from above (heights above ground do not count).
// Nothing in an empty scene. It keeps copies of what it needs, but counts in `beside_terrain`,
// which must live as long, how often it took the nearest; not to be called from several threads.
GroundAt ground_of(const Scene& scene, GroundSearch search, std::size_t& beside_terrain);

}  // namespace gnomon
