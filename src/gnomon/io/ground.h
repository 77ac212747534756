// The ground that buildings stand on, where a model has none.
#pragma once

#include <string>

#include <gnomon/core/result.h>
#include <gnomon/scene/scene.h>
#include <gnomon/view/view.h>

namespace gnomon {

struct GroundOptions {
  // "auto": nothing if the model brings terrain (TINRelief, LandUse, Road, Railway, WaterBody, PlantCover, TransportSquare,
  // Waterway surfaces); else a surface triangulated through the buildings' GroundSurface polygons (objects without any: the outline of their lowest
  // vertices), so that buildings on a slope do not float, level beyond them.
  // "none": nothing. A number: a level plane at that height (metres, model CRS).
  std::string mode = "auto";
  Bounds2 extent;  // scene coordinates: the ground reaches at least this far (besides below the model itself)
};

// What became of the ground, in one sentence for summary.json.
struct GroundReport {
  std::string kind;  // "model terrain", "through ground surfaces", "level", "none"
  std::size_t triangles = 0;
};

// Adds the ground's triangles to the scene as surface {object "Ground", group "Ground", semantic "Ground"}; the mesh must be
// welded again afterwards by the caller. Adds warnings to the scene (e.g. footprints that had to be repaired).
Result<GroundReport> add_ground(Scene& scene, const GroundOptions& options);

}  // namespace gnomon
