#include <gnomon/mesh/edge_table.h>

#include <algorithm>

namespace gnomon {

EdgeTable build_edge_table(const TriMesh& mesh, const std::vector<std::uint8_t>& selected) {
  // Half-edges counted into buckets by their smaller vertex, then sorted inside the (small)
  // buckets.
  struct Half {
    std::uint32_t high, incidence;
  };
  const auto chosen = [&](std::size_t t) { return selected.empty() || selected[t] != 0; };
  std::vector<std::uint32_t> bucket(mesh.positions.size() + 1, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!chosen(t)) continue;
    const Triangle& v = mesh.triangles[t];
    for (int k = 0; k < 3; ++k) ++bucket[std::min(v[k], v[(k + 1) % 3]) + 1];
  }
  for (std::size_t v = 0; v + 1 < bucket.size(); ++v) bucket[v + 1] += bucket[v];
  std::vector<Half> halves(bucket.back());
  {
    std::vector<std::uint32_t> next(bucket.begin(), bucket.end() - 1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (!chosen(t)) continue;
      const Triangle& v = mesh.triangles[t];
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t from = v[k], to = v[(k + 1) % 3];
        const std::uint32_t backward = from > to ? 1 : 0;
        halves[next[std::min(from, to)]++] = {std::max(from, to),
                                              (static_cast<std::uint32_t>(t) << 1) | backward};
      }
    }
  }

  EdgeTable table;
  table.incidence.reserve(halves.size());
  for (std::uint32_t low = 0; low + 1 < bucket.size(); ++low) {
    const auto begin = halves.begin() + bucket[low], end = halves.begin() + bucket[low + 1];
    std::sort(begin, end, [](const Half& a, const Half& b) {
      return a.high != b.high ? a.high < b.high : a.incidence < b.incidence;
    });
    for (auto h = begin; h != end; ++h) {
      if (h == begin || h->high != (h - 1)->high) {
        table.vertices.push_back({low, h->high});
        table.first.push_back(static_cast<std::uint32_t>(table.incidence.size()));
      }
      table.incidence.push_back(h->incidence);
    }
  }
  table.first.push_back(static_cast<std::uint32_t>(table.incidence.size()));
  table.vertices.shrink_to_fit();
  table.first.shrink_to_fit();
  return table;
}

}  // namespace gnomon
