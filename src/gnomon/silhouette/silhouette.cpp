#include <gnomon/silhouette/silhouette.h>

namespace gnomon {

Silhouette find_silhouette(const EdgeTable& edges, const std::vector<std::int8_t>& sides) {
  Silhouette silhouette;
  for (std::size_t k = 0; k < edges.vertices.size(); ++k) {
    std::int32_t m = 0;
    for (std::uint32_t i = edges.first[k]; i < edges.first[k + 1]; ++i) {
      const std::uint32_t incidence = edges.incidence[i];
      const std::int32_t side = sides[incidence >> 1];
      m += (incidence & 1) != 0 ? -side : side;
    }
    if (m != 0) silhouette.push_back({edges.vertices[k][0], edges.vertices[k][1], m});
  }
  return silhouette;
}

}  // namespace gnomon
