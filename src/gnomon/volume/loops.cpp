#include <gnomon/volume/loops.h>

#include <algorithm>
#include <cassert>
#include <cstdlib>

namespace gnomon {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

}  // namespace

Loops find_loops(std::span<const SilhouetteEdge> silhouette, LoopScratch* scratch) {
  LoopScratch own;
  std::vector<std::uint32_t>& slot_of = (scratch != nullptr ? *scratch : own).slot_of;

  // The silhouette's vertices, numbered as they come; `first_out` first counts edges that leave.
  std::vector<std::uint32_t> vertex_at, first_out;
  std::uint32_t edges = 0;
  for (const SilhouetteEdge& e : silhouette) {
    for (const std::uint32_t v : {e.a, e.b}) {
      if (v >= slot_of.size()) slot_of.resize(std::size_t{v} + 1, kNone);
      if (slot_of[v] != kNone) continue;
      slot_of[v] = static_cast<std::uint32_t>(vertex_at.size());
      vertex_at.push_back(v);
      first_out.push_back(0);
    }
    const auto times = static_cast<std::uint32_t>(std::abs(e.multiplicity));
    first_out[slot_of[e.multiplicity > 0 ? e.a : e.b]] += times;
    edges += times;
  }
  const std::size_t n = vertex_at.size();
  std::uint32_t offset = 0;
  for (std::uint32_t& count : first_out) {
    const std::uint32_t here = offset;
    offset += count;
    count = here;
  }
  first_out.push_back(offset);
  std::vector<std::uint32_t> next(first_out.begin(), first_out.end() - 1), head(edges);
  for (const SilhouetteEdge& e : silhouette) {
    const std::uint32_t a = slot_of[e.a], b = slot_of[e.b];
    for (int k = std::abs(e.multiplicity); k > 0; --k) {
      if (e.multiplicity > 0) {
        head[next[a]++] = b;
      } else {
        head[next[b]++] = a;
      }
    }
  }
  for (const std::uint32_t v : vertex_at) slot_of[v] = kNone;

  Loops loops;
  loops.vertices.reserve(edges);
  next.assign(first_out.begin(), first_out.end() - 1);
  std::vector<std::uint32_t> path, place(n, kNone);  // place: of a vertex on the path
  for (std::uint32_t start = 0; start < n; ++start) {
    path.assign(1, start);
    place[start] = 0;
    for (;;) {
      const std::uint32_t from = path.back();
      if (next[from] == first_out[from + 1]) break;
      const std::uint32_t to = head[next[from]++];
      if (place[to] == kNone) {
        place[to] = static_cast<std::uint32_t>(path.size());
        path.push_back(to);
        continue;
      }
      const std::uint32_t begin = place[to];
      for (std::size_t k = begin; k < path.size(); ++k) {
        loops.vertices.push_back(vertex_at[path[k]]);
        place[path[k]] = kNone;
      }
      loops.first.push_back(static_cast<std::uint32_t>(loops.vertices.size()));
      path.resize(begin + 1);
      place[to] = begin;
    }
    // Where as many edges come in as go out, a walk can only end where it began.
    assert(path.size() == 1 && "find_loops: multiplicities do not balance");
    for (const std::uint32_t v : path) place[v] = kNone;
  }
  return loops;
}

}  // namespace gnomon
