// Models into the coordinates of the scene: from another CRS, or from local coordinates at a site.
// docs/placing.md.
#pragma once

#include <optional>
#include <string>

#include <gnomon/core/result.h>
#include <gnomon/io/load_scene.h>
#include <gnomon/io/model.h>

namespace gnomon {

// Moves vertices from one CRS to another; heights stay. Errors name the file.
std::optional<Error> move_to_crs(Model& model, const std::string& from, const std::string& to);

// Local coordinates in a CRS: p becomes at + p turned clockwise by `turn`.
struct SiteTurn {
  Vec2 at;      // the local origin
  double turn;  // radians, from the grid's +y to the local +y
};

// Of a file whose origin stands at `place` and whose +y looks `north` radians counter-clockwise of
// true north (clockwise from +y to true north, as everywhere). Errors name the file.
Result<SiteTurn> site_turn(const std::string& path, const Place& place, double north,
                           const std::string& crs);

// The ground as it is seen in local coordinates; heights stay.
GroundAt ground_from(const SiteTurn& at, const GroundAt& ground);

// Moves a model in local metres to its site in `crs`. A site on the ground takes the height that
// `ground` has below the model's origin; where that knows none, height 0, with a warning. The
// grid's scale is not applied: a metre of the model is a metre of the grid. Errors name the file.
std::optional<Error> place_at_site(Model& model, const Site& site, double north,
                                   const std::string& crs, const GroundAt& ground);

// Smallest and largest x, y, z of the corners of polygons, model.vertices * scale + translate.
// Nothing where there are none.
struct ModelBox {
  Vec3 low, high;
};
std::optional<ModelBox> box_of(const Model& model);

}  // namespace gnomon
