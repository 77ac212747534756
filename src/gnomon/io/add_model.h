// A Model into a Scene: its polygons as triangles, with their looks.
#pragma once

#include <cstdint>

#include <gnomon/io/model.h>
#include <gnomon/scene/scene.h>

namespace gnomon {

// Appends the model's triangles, surfaces, looks and warnings, in coordinates from the scene's
// origin; not welded. `file`: its number among the scene's files; `city`: its groups are CityJSON's
// words. Counts FileReport::triangles; the model's surfaces and looks are moved away. Precondition:
// coordinates in metres are finite and at most kLargestCoordinate.
void add_model(Scene& scene, Model& m, std::uint32_t file, bool city);

}  // namespace gnomon
