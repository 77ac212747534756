#include <gnomon/scene/appearance.h>

#include <utility>

namespace gnomon {
namespace {

template <class T>
void keep(std::vector<T>& list, const std::vector<std::uint32_t>& kept) {
  if (list.empty()) return;
  std::vector<T> out;
  out.reserve(kept.size());
  for (const std::uint32_t t : kept) out.push_back(list[t]);
  list = std::move(out);
}

}  // namespace

void fill_up(Appearance& a, std::size_t triangles) {
  if (a.material_of.empty()) return;
  a.material_of.resize(triangles, kNoMaterial);
  if (!a.uv.empty()) a.uv.resize(triangles, {});
  if (!a.normals.empty()) a.normals.resize(triangles, {});
}

void keep_triangles(Appearance& a, const std::vector<std::uint32_t>& kept) {
  keep(a.material_of, kept);
  keep(a.uv, kept);
  keep(a.normals, kept);
}

}  // namespace gnomon
