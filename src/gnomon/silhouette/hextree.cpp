#include <gnomon/silhouette/hextree.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include <gnomon/silhouette/certified_plane.h>

namespace gnomon {
namespace {

// Rounding of a sum of four products of numbers up to 1, several times over.
constexpr double kRounding = 0x1p-48;

void make_unit(Hextree::Dual& d) {
  double squared = 0;
  for (const double q : d.q) squared += q * q;
  if (!(squared > 0)) return;
  const double scale = 1 / std::sqrt(squared);
  for (double& q : d.q) q *= scale;
  d.error = d.error * scale + kRounding;
}

std::vector<Hextree::Dual> duals_of_triangles(const TriMesh& mesh, const Vec3& centre,
                                              double size) {
  std::vector<Hextree::Dual> out(mesh.triangles.size());
  for (std::uint32_t t = 0; t < out.size(); ++t) {
    const CertifiedPlane p = certified_plane(mesh, t, centre);
    out[t].q = {p.q[0], p.q[1], p.q[2], p.q[3] / size};
    out[t].error = std::max({p.error[0], p.error[1], p.error[2], p.error[3] / size}) + kRounding;
    make_unit(out[t]);
  }
  return out;
}

std::vector<Hextree::Dual> duals_of_vertices(const TriMesh& mesh, const Vec3& centre, double size) {
  std::vector<Vec3> normal(mesh.positions.size(), Vec3(0.0));
  for (const Triangle& t : mesh.triangles) {
    const Vec3 n = glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                              mesh.positions[t[2]] - mesh.positions[t[0]]);
    for (const std::uint32_t v : t) normal[v] += n;
  }
  std::vector<Hextree::Dual> out(mesh.positions.size());
  for (std::size_t v = 0; v < out.size(); ++v) {
    const double length = glm::length(normal[v]);
    const Vec3 n = length > 0 ? normal[v] / length : Vec3(0.0);
    out[v].q = {-n.x, -n.y, -n.z, glm::dot(n, mesh.positions[v] - centre) / size};
    make_unit(out[v]);
  }
  return out;
}

struct Plane {
  std::array<double, 4> q;
  explicit Plane(const Hextree::Dual& d, bool negated) : q(d.q) {
    if (!negated) return;
    for (double& x : q) x = -x;
  }
};

// The child of a node whose cube holds both points; 16: none.
std::size_t child_of(const Hextree::Node& n, const Plane& a, const Plane& b) {
  std::size_t child = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double middle = n.lo[k] + n.width / 2;
    const bool high = a.q[k] >= middle;
    if (high != (b.q[k] >= middle)) return 16;
    child = child * 2 + (high ? 1 : 0);
  }
  return child;
}

void insert(Hextree& tree, std::uint32_t edge, const Plane& a, const Plane& b, double error) {
  std::uint32_t node = 0;
  tree.nodes[0].error = std::max(tree.nodes[0].error, error);
  for (int level = 0; level < Hextree::kDepth; ++level) {
    const std::size_t k = child_of(tree.nodes[node], a, b);
    if (k == 16) break;
    std::uint32_t next = tree.nodes[node].child[k];
    if (next == 0) {
      next = static_cast<std::uint32_t>(tree.nodes.size());
      Hextree::Node made;
      made.width = tree.nodes[node].width / 2;
      for (std::size_t i = 0; i < 4; ++i)
        made.lo[i] = tree.nodes[node].lo[i] + ((k >> (3 - i)) & 1 ? made.width : 0.0);
      tree.nodes.push_back(std::move(made));
      tree.nodes[node].child[k] = next;
    }
    node = next;
    tree.nodes[node].error = std::max(tree.nodes[node].error, error);
  }
  tree.nodes[node].edges.push_back(edge);
}

struct Search {
  const Hextree& tree;
  const TriMesh& mesh;
  Light light;
  std::array<double, 4> l;  // in the tree's coordinates
  double slack;             // what rounding may change of l . q, the dual's own error aside
  double sum;               // of |l|
  std::size_t corner = 0;   // the paper's index of the corner where l . v is least
  Silhouette& out;
  ExtractionStats& stats;

  double dot(const std::array<double, 4>& q) const {
    return (l[0] * q[0] + l[1] * q[1]) + (l[2] * q[2] + l[3] * q[3]);
  }

  // Of a facet the exact one, of a vertex what double says; negated planes turned.
  int side(std::uint32_t key) {
    const bool facets = tree.form == DualForm::facets;
    const std::uint32_t index = facets ? key >> 1 : key;
    const double v = dot(tree.duals[index].q);
    int s = v >= 0 ? 1 : -1;
    if (facets && !(std::fabs(v) > slack + sum * tree.duals[index].error)) {
      const Triangle& t = mesh.triangles[index];
      s = light_side(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], light,
                     stats.exact);
    }
    return facets && (key & 1) != 0 ? -s : s;
  }

  void test(const Hextree::Edge& e) {
    const int first = side(e.first), second = side(e.second);
    if (first == second) return;
    const int m = tree.form == DualForm::vertices ? 2 : (first > 0) != e.backward ? 2 : -2;
    out.push_back({e.a, e.b, m});
  }

  // l . v at the corners of the node's cube where it is least and most.
  bool may_cross(const Hextree::Node& n) const {
    std::array<double, 4> least, most;
    for (std::size_t k = 0; k < 4; ++k) {
      const bool high = ((corner >> (3 - k)) & 1) != 0;
      least[k] = n.lo[k] + (high ? n.width : 0.0);
      most[k] = n.lo[k] + (high ? 0.0 : n.width);
    }
    const double error = slack + sum * n.error;
    return !(dot(least) > error) && !(dot(most) < -error);
  }

  void visit(std::uint32_t node) {
    const Hextree::Node& n = tree.nodes[node];
    ++stats.nodes;
    stats.bytes += sizeof(Hextree::Node) +
                   n.edges.size() *
                       (sizeof(std::uint32_t) + sizeof(Hextree::Edge) + 2 * sizeof(Hextree::Dual));
    for (const std::uint32_t e : n.edges) test(tree.edges[e]);
    for (const std::uint32_t c : n.child) {
      if (c != 0 && may_cross(tree.nodes[c])) visit(c);
    }
  }
};

}  // namespace

Hextree build_hextree(const TriMesh& mesh, const EdgeTable& edges, DualForm form) {
  Hextree tree;
  tree.form = form;
  tree.centre = dual_centre(mesh);
  double squared = 0;
  for (const Vec3& p : mesh.positions)
    squared = std::max(squared, glm::dot(p - tree.centre, p - tree.centre));
  if (squared > 0) tree.size = std::sqrt(squared);
  const bool facets = form == DualForm::facets;
  tree.duals = facets ? duals_of_triangles(mesh, tree.centre, tree.size)
                      : duals_of_vertices(mesh, tree.centre, tree.size);
  Hextree::Node root;
  root.lo.fill(-1);
  tree.nodes.push_back(root);
  tree.always.first.push_back(0);
  for (std::uint32_t e = 0; e < edges.vertices.size(); ++e) {
    const auto& [a, b] = edges.vertices[e];
    const std::uint32_t begin = edges.first[e], end = edges.first[e + 1];
    Hextree::Edge edge{a, b, a, b};
    if (facets && end - begin != 2) {
      tree.always.vertices.push_back(edges.vertices[e]);
      tree.always.incidence.insert(tree.always.incidence.end(), edges.incidence.begin() + begin,
                                   edges.incidence.begin() + end);
      tree.always.first.push_back(static_cast<std::uint32_t>(tree.always.incidence.size()));
      continue;
    }
    if (facets) {
      const std::uint32_t one = edges.incidence[begin], two = edges.incidence[begin + 1];
      const bool swap = (one & 1) != 0 && (two & 1) == 0;
      edge.first = (swap ? two : one) & ~1u;
      edge.second = ((swap ? one : two) & ~1u) | ((one & 1) == (two & 1) ? 1u : 0u);
      edge.backward = (one & 1) != 0 && (two & 1) != 0;
    }
    const auto plane = [&](std::uint32_t key) {
      return facets ? Plane(tree.duals[key >> 1], (key & 1) != 0) : Plane(tree.duals[key], false);
    };
    tree.edges.push_back(edge);
    const auto error = [&](std::uint32_t key) { return tree.duals[facets ? key >> 1 : key].error; };
    insert(tree, static_cast<std::uint32_t>(tree.edges.size() - 1), plane(edge.first),
           plane(edge.second), std::max(error(edge.first), error(edge.second)));
  }
  return tree;
}

void find_silhouette(Silhouette& out, const Hextree& tree, const TriMesh& mesh, const Light& light,
                     ExtractionStats* stats) {
  ExtractionStats own;
  out.clear();
  const DualLight dual = dual_light(light, tree.centre, tree.size);
  Search search{tree, mesh, light, dual.exact, 0, 0, 0, out, stats != nullptr ? *stats : own};
  search.l[3] *= tree.size;
  for (std::size_t k = 0; k < 4; ++k) {
    search.sum += std::fabs(search.l[k]);
    search.corner = search.corner * 2 + (search.l[k] >= 0 ? 0 : 1);
  }
  search.slack = search.sum * kRounding + double(dual.slack);
  search.visit(0);
  for (std::size_t k = 0; k < tree.always.vertices.size(); ++k) {
    std::int32_t m = 0;
    for (std::uint32_t i = tree.always.first[k]; i < tree.always.first[k + 1]; ++i) {
      const std::uint32_t incidence = tree.always.incidence[i];
      const int s = search.side(incidence & ~1u);
      m += (incidence & 1) != 0 ? -s : s;
    }
    if (m != 0) out.push_back({tree.always.vertices[k][0], tree.always.vertices[k][1], m});
  }
}

}  // namespace gnomon
