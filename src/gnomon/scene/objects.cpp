#include <gnomon/scene/objects.h>

#include <map>
#include <utility>

namespace gnomon {
namespace {

template <class Name>
Objects grouped(const Scene& scene, const Name& name_of) {
  Objects out;
  out.of_surface.reserve(scene.surfaces.size());
  std::map<std::pair<std::uint32_t, std::string>, std::uint32_t> numbers;
  for (const Surface& s : scene.surfaces) {
    std::string name = name_of(s);
    const auto number = static_cast<std::uint32_t>(out.names.size());
    const auto [at, is_new] = numbers.try_emplace({s.file, name}, number);
    if (is_new) out.names.push_back(std::move(name));
    out.of_surface.push_back(at->second);
  }
  return out;
}

}  // namespace

Objects objects(const Scene& scene) {
  return grouped(scene, [](const Surface& s) { return s.object; });
}

Objects whole_objects(const Scene& scene) {
  return grouped(
      scene, [](const Surface& s) { return s.whole > 0 ? s.object.substr(0, s.whole) : s.object; });
}

}  // namespace gnomon
