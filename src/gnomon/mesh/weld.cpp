#include <gnomon/mesh/weld.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <tuple>

#include <gnomon/core/exact.h>

namespace gnomon {
namespace {

std::uint64_t hash(const Vec3& p) {
  std::uint64_t h = 0x9e3779b97f4a7c15u;
  for (int k = 0; k < 3; ++k) {
    h ^= std::bit_cast<std::uint64_t>(p[k]);
    h *= 0xff51afd7ed558ccdu;
    h ^= h >> 32;
  }
  return h;
}

}  // namespace

WeldReport weld(TriMesh& mesh, std::vector<std::uint32_t>& per_triangle) {
  WeldReport report;
  for (Vec3& p : mesh.positions) {
    for (int k = 0; k < 3; ++k) {
      const double s =
          snapped(p[k]) + 0.0;  // + 0.0 turns -0 into 0, so that equal coordinates have equal bits
      if (s != p[k]) ++report.snapped_coordinates;
      p[k] = s;
    }
  }

  // Open addressing over the first vertex with each position; new indices in order of first use, so
  // that the result does not depend on unused vertices.
  constexpr std::uint32_t kFree = 0xffffffffu;
  const std::size_t n = mesh.positions.size();
  const std::size_t slots = std::bit_ceil(std::max<std::size_t>(16, 2 * n));
  std::vector<std::uint32_t> table(slots, kFree), renamed(n, kFree);
  std::vector<Vec3> kept;
  kept.reserve(n);
  const auto rename = [&](std::uint32_t v) {
    if (renamed[v] != kFree) return renamed[v];
    std::size_t slot = hash(mesh.positions[v]) & (slots - 1);
    while (table[slot] != kFree && kept[table[slot]] != mesh.positions[v])
      slot = (slot + 1) & (slots - 1);
    if (table[slot] == kFree) {
      table[slot] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(mesh.positions[v]);
    }
    return renamed[v] = table[slot];
  };

  std::size_t out = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& in = mesh.triangles[t];
    const Vec3 &a = mesh.positions[in[0]], &b = mesh.positions[in[1]], &c = mesh.positions[in[2]];
    if (a == b || b == c || c == a || zero_area(a, b, c)) {
      if (report.zero_area_triangles++ == 0) report.first_zero_area = t;
      continue;
    }
    mesh.triangles[out] = {rename(in[0]), rename(in[1]), rename(in[2])};
    per_triangle[out] = per_triangle[t];
    ++out;
  }
  mesh.triangles.resize(out);
  mesh.triangles.shrink_to_fit();
  per_triangle.resize(out);
  per_triangle.shrink_to_fit();
  report.merged_vertices = n - kept.size();
  kept.shrink_to_fit();
  mesh.positions = std::move(kept);
  return report;
}

Coincident find_coincident(const TriMesh& mesh) {
  std::vector<Triangle> corners = mesh.triangles;  // in ascending order each
  for (Triangle& t : corners) std::sort(t.begin(), t.end());
  std::vector<std::uint32_t> order(corners.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(corners[a], a) < std::tie(corners[b], b);
  });
  Coincident found;
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (corners[order[k]] != corners[order[k - 1]]) continue;
    if (found.triangles++ == 0 || order[k] < found.first) found.first = order[k];
  }
  return found;
}

}  // namespace gnomon
