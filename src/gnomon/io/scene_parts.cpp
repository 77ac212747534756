#include <gnomon/io/scene_parts.h>

#include <algorithm>
#include <unordered_map>
#include <utility>

#include <gnomon/io/picture_shading.h>
#include <gnomon/scene/objects.h>

namespace gnomon {
namespace {

std::string material_name(const Surface& s) {
  if (!s.semantic.empty()) return s.semantic;
  if (!s.material.empty()) return s.material;
  return s.group.empty() ? "Surface" : s.group;
}

}  // namespace

SceneParts scene_parts(const Scene& scene) {
  SceneParts out;
  const Objects all = objects(scene);
  std::unordered_map<std::uint32_t, std::size_t> numbers;  // of those that have triangles
  std::unordered_map<std::string, std::uint32_t> materials;
  struct Where {
    bool known = false;
    std::size_t object = 0, part = 0;
  };
  std::vector<Where> places(scene.surfaces.size());
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    const std::uint32_t s = scene.surface_of[t];
    Where& place = places[s];
    if (!place.known) {
      const Surface& surface = scene.surfaces[s];
      const auto [object, new_object] = numbers.try_emplace(all.of_surface[s], out.objects.size());
      if (new_object) out.objects.push_back({surface.object, {}});
      const std::string name = material_name(surface);
      const auto [material, new_material] =
          materials.try_emplace(name, static_cast<std::uint32_t>(out.materials.size()));
      if (new_material) out.materials.push_back({name, surface_colour(surface)});
      place = {true, object->second, out.objects[object->second].parts.size()};
      out.objects[object->second].parts.push_back({s, material->second, {}});
    }
    out.objects[place.object].parts[place.part].triangles.push_back(t);
  }
  // A file that has said `o name` cannot take it back, so what has no name comes before.
  std::stable_partition(out.objects.begin(), out.objects.end(),
                        [](const SceneObject& o) { return o.name.empty(); });
  return out;
}

}  // namespace gnomon
