#include <gnomon/silhouette/silhouette.h>

#include <algorithm>
#include <array>

namespace gnomon {

Silhouette find_silhouette(const EdgeTable& edges, const std::vector<std::int8_t>& sides) {
  Silhouette silhouette;
  // Which edges are on it nobody can foresee: each is written, and the next one over it if it is
  // not.
  std::array<SilhouetteEdge, 256> found;
  std::size_t n = 0;
  for (std::size_t k = 0; k < edges.vertices.size(); ++k) {
    std::int32_t m = 0;
    for (std::uint32_t i = edges.first[k]; i < edges.first[k + 1]; ++i) {
      const std::uint32_t incidence = edges.incidence[i];
      const std::int32_t side = sides[incidence >> 1];
      const std::int32_t backward = incidence & 1;
      m += (side ^ -backward) + backward;
    }
    found[n] = {edges.vertices[k][0], edges.vertices[k][1], m};
    n += m != 0 ? 1 : 0;
    if (n == found.size()) {
      silhouette.insert(silhouette.end(), found.begin(), found.end());
      n = 0;
    }
  }
  silhouette.insert(silhouette.end(), found.begin(),
                    found.begin() + static_cast<std::ptrdiff_t>(n));
  return silhouette;
}

void sort_as_table(Silhouette& silhouette, Silhouette& scratch) {
  // By a in steps of eleven bits; then by b among the few of one a.
  constexpr int kBits = 11;
  constexpr std::uint32_t kMask = (1u << kBits) - 1;
  std::uint32_t largest = 0;
  for (const SilhouetteEdge& e : silhouette) largest = std::max(largest, e.a);
  scratch.resize(silhouette.size());
  std::array<std::uint32_t, kMask + 2> first;
  for (int shift = 0; shift < 32 && largest >> shift != 0; shift += kBits) {
    first.fill(0);
    for (const SilhouetteEdge& e : silhouette) ++first[((e.a >> shift) & kMask) + 1];
    for (std::size_t k = 0; k < kMask; ++k) first[k + 1] += first[k];
    for (const SilhouetteEdge& e : silhouette) scratch[first[(e.a >> shift) & kMask]++] = e;
    silhouette.swap(scratch);
  }
  for (std::size_t begin = 0, end = 0; begin < silhouette.size(); begin = end) {
    while (end < silhouette.size() && silhouette[end].a == silhouette[begin].a) ++end;
    std::sort(silhouette.begin() + std::ptrdiff_t(begin), silhouette.begin() + std::ptrdiff_t(end),
              [](const SilhouetteEdge& x, const SilhouetteEdge& y) { return x.b < y.b; });
  }
}

}  // namespace gnomon
