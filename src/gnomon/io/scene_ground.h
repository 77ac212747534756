// The ground of a scene under construction, for what is put on it last.
#pragma once

#include <gnomon/io/model.h>
#include <gnomon/scene/scene.h>

namespace gnomon {

// In scene coordinates: the height of the scene's terrain (is_terrain, footprints.h) below a point;
// nothing where it has a hole, or has ended. An empty function where the scene has no terrain.
GroundAt terrain_at(const Scene& scene);

// In CRS coordinates (scene coordinates + frame.origin): terrain_at(); where it has a hole, or has
// ended, the height of the nearest point of its border. In a scene without terrain, that of the
// lowest vertex of the object whose box is nearest to it, seen from above (heights above ground do
// not count). Nothing in an empty scene. It keeps copies of what it needs, but counts in
// `beside_terrain`, which must live as long, how often it took the border; not to be called from
// several threads. Not counted is what lies less than about half a cell beside it: the triangles of
// a surface model end at the centres of its outermost cells.
GroundAt ground_of(const Scene& scene, std::size_t& beside_terrain);

}  // namespace gnomon
