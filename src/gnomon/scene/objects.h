// Which surfaces of a scene belong together.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <gnomon/scene/scene.h>

namespace gnomon {

struct Objects {
  std::vector<std::uint32_t> of_surface;  // per surface: index into names
  std::vector<std::string> names;         // in the order of the surfaces
};

// Surfaces of one file (Surface::file) and one object name are an object.
Objects objects(const Scene& scene);

// The same, but a part ("parent/part") counts with its outermost parent (Surface::whole).
Objects whole_objects(const Scene& scene);

}  // namespace gnomon
