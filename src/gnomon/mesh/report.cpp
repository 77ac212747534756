#include <gnomon/mesh/report.h>

#include <gnomon/mesh/triangle_sets.h>

namespace gnomon {
namespace {

// Six times the volume of the tetrahedron of a triangle and `from`.
double volume6(const TriMesh& mesh, const Triangle& t, const Vec3& from) {
  const Vec3 a = mesh.positions[t[0]] - from, b = mesh.positions[t[1]] - from,
             c = mesh.positions[t[2]] - from;
  return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
         a.z * (b.x * c.y - b.y * c.x);
}

void count_edge(EdgeCounts& counts, std::uint32_t triangles, std::uint32_t backward) {
  const std::uint32_t forward = triangles - backward;
  ++counts.edges;
  counts.boundary += triangles == 1;
  counts.non_manifold += triangles > 2;
  counts.mis_wound += triangles == 2 && forward != backward;
  counts.unbalanced += forward != backward;
}

SurfaceKind kind_of(const Component& c) {
  if (c.counts.boundary > 0) return SurfaceKind::open;
  if (c.counts.non_manifold > 0) return SurfaceKind::non_manifold;
  if (c.counts.unbalanced > 0) return SurfaceKind::mis_wound;
  return c.volume > 0 ? SurfaceKind::solid : SurfaceKind::inside_out;
}

constexpr SurfaceKind kKinds[] = {SurfaceKind::solid, SurfaceKind::inside_out,
                                  SurfaceKind::non_manifold, SurfaceKind::mis_wound,
                                  SurfaceKind::open};

}  // namespace

MeshReport report_mesh(const TriMesh& mesh, const EdgeTable& edges) {
  MeshReport report;
  const std::size_t n = mesh.triangles.size();
  TriangleSets sets(n);
  for (std::size_t k = 0; k < edges.vertices.size(); ++k) {
    for (std::uint32_t i = edges.first[k] + 1; i < edges.first[k + 1]; ++i) {
      sets.join(edges.incidence[i - 1] >> 1, edges.incidence[i] >> 1);
    }
  }

  // The root of a set comes before its other triangles, so components are numbered in order.
  report.component_of.resize(n);
  for (std::uint32_t t = 0; t < n; ++t) {
    const std::uint32_t root = sets.root(t);
    if (root == t) {
      report.component_of[t] = static_cast<std::uint32_t>(report.components.size());
      report.components.emplace_back().first_triangle = t;
    } else {
      report.component_of[t] = report.component_of[root];
    }
    Component& c = report.components[report.component_of[t]];
    ++c.counts.triangles;
    const Vec3& from = mesh.positions[mesh.triangles[c.first_triangle][0]];
    c.volume += volume6(mesh, mesh.triangles[t], from) / 6;
  }
  for (std::size_t k = 0; k < edges.vertices.size(); ++k) {
    const std::uint32_t triangles = edges.first[k + 1] - edges.first[k];
    if (triangles == 0) continue;
    std::uint32_t backward = 0;
    for (std::uint32_t i = edges.first[k]; i < edges.first[k + 1]; ++i) {
      backward += edges.incidence[i] & 1u;
    }
    const std::uint32_t component = report.component_of[edges.incidence[edges.first[k]] >> 1];
    count_edge(report.components[component].counts, triangles, backward);
    count_edge(report.total, triangles, backward);
  }
  report.total.triangles = n;

  for (Component& c : report.components) {
    c.kind = kind_of(c);
    ++report.of_kind[static_cast<std::size_t>(c.kind)];
    if (c.kind == SurfaceKind::solid) report.weight_one_triangles += c.counts.triangles;
  }
  return report;
}

const char* name_of(SurfaceKind kind) {
  switch (kind) {
    case SurfaceKind::solid:
      return "solid";
    case SurfaceKind::inside_out:
      return "inside out";
    case SurfaceKind::non_manifold:
      return "non-manifold";
    case SurfaceKind::mis_wound:
      return "mis-wound";
    case SurfaceKind::open:
      return "open";
  }
  return "";
}

std::string classification(const MeshReport& report) {
  const std::size_t n = report.components.size();
  std::string line = std::to_string(n) + (n == 1 ? " component" : " components");
  const char* separator = ": ";
  for (const SurfaceKind kind : kKinds) {
    const std::size_t count = report.of_kind[static_cast<std::size_t>(kind)];
    if (count == 0) continue;
    line += separator + std::to_string(count) + " " + name_of(kind);
    separator = ", ";
  }
  return line + "; " + std::to_string(report.total.boundary) + " boundary edges, " +
         std::to_string(report.total.non_manifold) + " non-manifold, " +
         std::to_string(report.total.mis_wound) + " mis-wound";
}

}  // namespace gnomon
