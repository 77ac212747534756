// Disjoint sets of triangles (union-find). Every root is the lowest index of its set, so that
// numbering roots as they are met orders sets by their lowest triangle, whatever order they were
// joined in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace gnomon {

struct TriangleSets {
  std::vector<std::uint32_t> parent;

  explicit TriangleSets(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0u); }
  std::uint32_t root(std::uint32_t t) {
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    if (a < b) parent[b] = a;
    if (b < a) parent[a] = b;
  }
};

}  // namespace gnomon
