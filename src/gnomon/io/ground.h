// The ground that buildings stand on, where a model has none.
#pragma once

#include <string>

#include <gnomon/core/result.h>
#include <gnomon/scene/scene.h>
#include <gnomon/view/view.h>

namespace gnomon {

struct GroundOptions {
  // "auto": nothing if the model brings terrain (TINRelief, LandUse, Road, Railway, WaterBody,
  // PlantCover, TransportSquare, Waterway); else a surface through the lower edges of the
  // buildings, level beyond them (docs/ground.md); for a scene that names no city object, a level
  // plane at its lowest point. "none": nothing. A number: a level plane at that height (metres,
  // model CRS).
  std::string mode = "auto";
  Bounds2 extent;  // scene coordinates: the ground reaches at least this far, and below the model
};

// True for the surface that add_ground() makes, also where a converted scene is read again.
bool is_made_ground(const Surface& surface);

// What became of the ground, in one sentence for summary.json.
struct GroundReport {
  std::string kind;  // "model terrain", "through ground surfaces", "level", "none"
  std::size_t triangles = 0;
};

// Adds the ground's triangles to the scene as its last surface {object, group and semantic
// "Ground"}. They look up, but for upright skirts below parts that start more than a storey above
// their neighbours; their vertices equal those of the buildings exactly, so the caller welds the
// mesh again. Adds a warning to the scene where the ground could not follow every footprint edge.
// Errors: a mode that is not understood; a plane without extent; footprints that GEOS cannot unite.
Result<GroundReport> add_ground(Scene& scene, const GroundOptions& options);

}  // namespace gnomon
