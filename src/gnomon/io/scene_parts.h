// A scene as files for other programs have it: objects, and in each of them the triangles of one
// surface after the other.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <gnomon/io/picture.h>
#include <gnomon/scene/scene.h>

namespace gnomon {

struct ScenePart {
  std::uint32_t surface = 0;             // index into Scene::surfaces
  std::uint32_t material = 0;            // index into SceneParts::materials
  std::vector<std::uint32_t> triangles;  // of the scene, ascending; never empty
};

struct SceneObject {
  std::string name;  // Surface::object; may be empty
  std::vector<ScenePart> parts;
};

struct PartMaterial {
  std::string name;  // semantic surface, else material, else group, else "Surface"; unique
  Rgb colour;        // surface_colour() of the first surface that has this name
};

struct SceneParts {
  std::vector<SceneObject> objects;  // in the scene's order, but those without a name first
  std::vector<PartMaterial> materials;
};

// All triangles of the scene, each in one part.
SceneParts scene_parts(const Scene& scene);

}  // namespace gnomon
