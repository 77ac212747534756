#include <gnomon/volume/lit_regions.h>

#include <gnomon/mesh/triangle_sets.h>

namespace gnomon {

LitRegions find_lit_regions(const EdgeTable& edges, const std::vector<std::int8_t>& sides,
                            const std::vector<std::uint8_t>& cap) {
  constexpr std::uint32_t kNone = 0xffffffffu;
  const auto n = static_cast<std::uint32_t>(sides.size());

  // One pass over the edges: who is connected, and which edges stay.
  struct Found {
    std::uint32_t edge, triangle;
    std::int32_t multiplicity;
  };
  std::vector<Found> found;
  TriangleSets sets(n);
  for (std::uint32_t k = 0; k < edges.vertices.size(); ++k) {
    std::uint32_t last = kNone;
    std::int32_t m = 0;
    for (std::uint32_t i = edges.first[k]; i < edges.first[k + 1]; ++i) {
      const std::uint32_t t = edges.incidence[i] >> 1;
      if (cap[t] == 0) continue;
      m += (edges.incidence[i] & 1u) != 0 ? -sides[t] : sides[t];
      if (last != kNone) sets.join(last, t);
      last = t;
    }
    if (m != 0) found.push_back({k, last, m});
  }

  LitRegions regions;
  regions.region_of.assign(n, kNoRegion);
  std::vector<std::uint32_t> next;  // per region: first its size, then where its next entry goes
  for (std::uint32_t t = 0; t < n; ++t) {
    if (cap[t] == 0) continue;
    const std::uint32_t root = sets.root(t);
    if (root == t) {
      regions.region_of[t] = static_cast<std::uint32_t>(next.size());
      next.push_back(0);
    } else {
      regions.region_of[t] = regions.region_of[root];
    }
    ++next[regions.region_of[t]];
  }

  const auto to_offsets = [&](std::vector<std::uint32_t>& first) {
    first.assign(next.size() + 1, 0);
    for (std::size_t k = 0; k < next.size(); ++k) {
      first[k + 1] = first[k] + next[k];
      next[k] = first[k];
    }
  };
  to_offsets(regions.first_triangle);
  regions.triangles.resize(regions.first_triangle.back());
  for (std::uint32_t t = 0; t < n; ++t) {
    if (cap[t] != 0) regions.triangles[next[regions.region_of[t]]++] = t;
  }
  next.assign(next.size(), 0);
  for (const Found& f : found) ++next[regions.region_of[f.triangle]];
  to_offsets(regions.first_edge);
  regions.edges.resize(found.size());
  for (const Found& f : found) {
    const auto [a, b] = edges.vertices[f.edge];
    regions.edges[next[regions.region_of[f.triangle]]++] = {a, b, f.multiplicity};
  }
  return regions;
}

LitRegions find_lit_regions(const EdgeTable& edges, const std::vector<std::int8_t>& sides, int lit,
                            const std::vector<std::uint8_t>& selected) {
  std::vector<std::uint8_t> cap(sides.size());
  for (std::size_t t = 0; t < sides.size(); ++t) {
    cap[t] = sides[t] == lit && (selected.empty() || selected[t] != 0);
  }
  return find_lit_regions(edges, sides, cap);
}

}  // namespace gnomon
