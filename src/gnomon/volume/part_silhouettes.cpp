#include <gnomon/volume/part_silhouettes.h>

namespace gnomon {
namespace {

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {  // a < b
  return (std::uint64_t{a} << 32) | b;
}

}  // namespace

PartsOfEdges parts_of_edges(const EdgeTable& edges, const Parts& parts, std::size_t vertices) {
  PartsOfEdges out;
  out.of_vertex.assign(vertices, kNoPart);
  const auto part = [&](std::size_t k) {
    return parts.part_of[edges.incidence[edges.first[k]] >> 1];
  };
  for (std::size_t k = 0; k < edges.vertices.size(); ++k) {
    for (const std::uint32_t v : edges.vertices[k]) {
      std::uint32_t& of = out.of_vertex[v];
      of = of == kNoPart || of == part(k) ? part(k) : kManyParts;
    }
  }
  for (std::size_t k = 0; k < edges.vertices.size(); ++k) {
    const auto [a, b] = edges.vertices[k];
    if (out.of_vertex[a] == kManyParts && out.of_vertex[b] == kManyParts)
      out.of_edge.emplace(edge_key(a, b), part(k));
  }
  return out;
}

PartSilhouettes split_by_part(const Silhouette& silhouette, const PartsOfEdges& parts,
                              std::span<const CastingSides> sides) {
  std::vector<std::uint32_t> part_of(silhouette.size());
  PartSilhouettes out;
  out.first.assign(sides.size() + 1, 0);
  for (std::size_t k = 0; k < silhouette.size(); ++k) {
    const SilhouetteEdge& e = silhouette[k];
    const std::uint32_t a = parts.of_vertex[e.a], b = parts.of_vertex[e.b];
    part_of[k] = a != kManyParts ? a : b != kManyParts ? b : parts.of_edge.at(edge_key(e.a, e.b));
    if (sides[part_of[k]] != CastingSides::none) ++out.first[part_of[k] + 1];
  }
  for (std::size_t p = 0; p < sides.size(); ++p) out.first[p + 1] += out.first[p];
  std::vector<std::uint32_t> next(out.first.begin(), out.first.end() - 1);
  out.edges.resize(out.first.back());
  for (std::size_t k = 0; k < silhouette.size(); ++k) {
    const CastingSides side = sides[part_of[k]];
    if (side == CastingSides::none) continue;
    SilhouetteEdge& e = out.edges[next[part_of[k]]++];
    e = silhouette[k];
    if (side == CastingSides::one) e.multiplicity /= 2;
  }
  return out;
}

}  // namespace gnomon
