// The tree of edge_tree.h: which edges lie together, then what their planes are.
#include <gnomon/silhouette/edge_tree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <glm/geometric.hpp>

#include <gnomon/silhouette/certified_plane.h>

namespace gnomon {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kLevel = 32767;  // of 16 bits, from -kLevel to kLevel
constexpr std::size_t kVector = EdgeTree::kVector;
// Edges of a full leaf. Of a smooth mesh 60 have just below kMostPlanes planes; where edges have
// more (in towns nearly two each), leaves must hold fewer, or they would be cut in halves and leave
// nodes with few children.
constexpr std::uint32_t kFullestLeaf = 60, kLeastFullLeaf = 16, kLeafStep = 4;
// Leaves looked at to decide how full they can be, of which so many are to hold that many; and what
// half as many edges lose of planes that they shared.
constexpr std::size_t kProbes = 256;
constexpr double kFitting = 0.9, kShared = 0.93;
// Boxes are widened by this share of their numbers: four products and their sum in float, and the
// light's and the box's own rounding, are wrong by less (2^-24 each).
constexpr float kWiden = 0x1p-19F;

// A dual point to sort by, in steps: exactness is of no matter there.
struct Dual {
  std::array<std::int16_t, 4> q{};
};

std::uint32_t plane_key(std::uint32_t triangle, bool negated) {
  return (triangle << 1) | (negated ? 1u : 0u);
}

std::size_t whole_vectors(std::size_t n) { return (n + kVector - 1) / kVector * kVector; }

std::uint8_t* bytes_at(EdgeTree& tree, std::uint32_t line) {
  return reinterpret_cast<std::uint8_t*>(tree.lines.data()) +
         std::size_t(line) * sizeof(EdgeTree::Line);
}
EdgeTree::Leaf& leaf_at(EdgeTree& tree, std::uint32_t line) {
  return *reinterpret_cast<EdgeTree::Leaf*>(bytes_at(tree, line));
}
std::int16_t* dual_at(EdgeTree& tree, std::uint32_t line) {
  return reinterpret_cast<std::int16_t*>(bytes_at(tree, line) + sizeof(EdgeTree::Line));
}
std::uint8_t* first_plane_at(EdgeTree& tree, std::uint32_t line) {
  return bytes_at(tree, line) + sizeof(EdgeTree::Line) +
         std::size_t(leaf_at(tree, line).padded) * 4 * sizeof(std::int16_t);
}

// A leaf without its edges' planes and without numbers. Its first line.
std::uint32_t append_leaf(EdgeTree& tree, std::span<const std::uint32_t> planes,
                          std::size_t edges) {
  EdgeTree::Leaf leaf;
  leaf.planes = static_cast<std::uint8_t>(planes.size());
  leaf.padded = static_cast<std::uint8_t>(whole_vectors(planes.size()));
  leaf.edges = static_cast<std::uint8_t>(edges);
  leaf.first_triangle = static_cast<std::uint32_t>(tree.triangle.size());
  leaf.first_edge = static_cast<std::uint32_t>(tree.edges.size());
  tree.triangle.insert(tree.triangle.end(), planes.begin(), planes.end());
  const std::size_t line = tree.lines.size();
  const std::size_t bytes = sizeof(EdgeTree::Line) +
                            std::size_t(leaf.padded) * 4 * sizeof(std::int16_t) +
                            2 * whole_vectors(edges);
  tree.lines.resize(line + (bytes + sizeof(EdgeTree::Line) - 1) / sizeof(EdgeTree::Line));
  leaf_at(tree, static_cast<std::uint32_t>(line)) = leaf;
  return static_cast<std::uint32_t>(line);
}

// The largest distance from the centre.
double size_of(const TriMesh& mesh, const Vec3& centre) {
  double squared = 0;
  for (const Vec3& p : mesh.positions)
    squared = std::max(squared, glm::dot(p - centre, p - centre));
  return squared > 0 ? std::sqrt(squared) : 1.0;
}

// Sorts edges into leaves. Points of an edge: both dual points, w in units of the mesh's size.
class Sorter {
 public:
  Sorter(EdgeTree& tree, const TriMesh& mesh, const EdgeTable& table) : tree_(tree) {
    const double scale = size_of(mesh, tree.centre);
    std::vector<Dual> duals(mesh.triangles.size());
    for (std::size_t t = 0; t < duals.size(); ++t) {
      const Triangle& v = mesh.triangles[t];
      const Vec3& corner = mesh.positions[v[0]];
      const Vec3 n = glm::cross(mesh.positions[v[1]] - corner, mesh.positions[v[2]] - corner);
      const double length = glm::length(n);
      if (!(length > 0) || !std::isfinite(length)) continue;
      const Vec3 unit = n / length;
      const double q[4] = {-unit.x, -unit.y, -unit.z, glm::dot(unit, corner - tree.centre) / scale};
      for (std::size_t k = 0; k < 4; ++k)
        duals[t].q[k] = static_cast<std::int16_t>(std::clamp(q[k], -1.0, 1.0) * kLevel);
    }
    for (std::uint32_t e = 0; e < table.vertices.size(); ++e) {
      const std::uint32_t first = table.first[e];
      if (table.first[e + 1] - first != 2) continue;
      const std::uint32_t one = table.incidence[first], two = table.incidence[first + 1];
      // The first plane is that of the triangle on whose side the edge runs forward, if any.
      const bool swap = (one & 1) != 0 && (two & 1) == 0;
      const bool backward = (one & 1) != 0 && (two & 1) != 0;
      const bool same_way = (one & 1) == (two & 1);
      edges_.push_back(
          {plane_key((swap ? two : one) >> 1, false),
           plane_key((swap ? one : two) >> 1, same_way),
           {table.vertices[e][0], table.vertices[e][1] | (backward ? EdgeTree::kBackward : 0)}});
    }
    points_.resize(edges_.size());
    for (std::uint32_t e = 0; e < points_.size(); ++e) {
      points_[e].edge = e;
      for (std::size_t side = 0; side < 2; ++side) {
        const std::uint32_t key = side == 0 ? edges_[e].first : edges_[e].second;
        for (std::size_t k = 0; k < 4; ++k) {
          const std::int16_t q = duals[key >> 1].q[k];
          points_[e].q[4 * side + k] = (key & 1) != 0 ? static_cast<std::int16_t>(-q) : q;
        }
      }
    }
  }

  void sort() {
    if (edges_.empty()) return;
    tree_.edges.reserve(edges_.size());
    try_sort();
    if (!decided_) decide();
    if (again_) {
      tree_.nodes.clear();
      tree_.edges.clear();
      tree_.lines.clear();
      tree_.leaves.clear();
      tree_.triangle.clear();
      try_sort();
    }
  }

 private:
  struct Item {
    std::uint32_t first, second;  // plane keys
    EdgeTree::Edge edge;
  };
  struct Point {
    std::array<std::int16_t, 8> q;  // both dual points
    std::uint32_t edge;
  };
  struct Range {
    std::uint32_t begin, end;
    std::uint32_t size() const { return end - begin; }
  };

  void try_sort() {
    again_ = false;
    tree_.nodes.emplace_back();
    fill(0, 0, static_cast<std::uint32_t>(points_.size()));
  }

  // How full leaves are to be, after the first of them; whether to begin again.
  void decide() {
    decided_ = true;
    if (probes_.empty()) return;
    const auto at = probes_.begin() + static_cast<std::ptrdiff_t>(
                                          (1 - kFitting) * static_cast<double>(probes_.size()));
    std::nth_element(probes_.begin(), at, probes_.end());
    const std::uint32_t full = std::clamp(static_cast<std::uint32_t>(*at) / kLeafStep * kLeafStep,
                                          kLeastFullLeaf, kFullestLeaf);
    again_ = full < full_;
    full_ = full;
  }

  // Precondition: fits_leaf() saw the range last.
  void probe(const Range& r) {
    if (decided_ || r.size() <= full_ / 2) return;
    probes_.push_back(kShared * double(EdgeTree::kMostPlanes) * r.size() / double(planes_.size()));
    if (probes_.size() == kProbes) decide();
  }

  // Cuts a range by the axis over which its points are spread widest, `first` of them to one side.
  std::uint32_t split(const Range& r, std::uint32_t first) {
    std::array<std::int16_t, 8> lo, hi;
    lo.fill(kLevel);
    hi.fill(-kLevel);
    const auto begin = points_.begin() + r.begin, end = points_.begin() + r.end;
    for (auto p = begin; p != end; ++p) {
      for (std::size_t axis = 0; axis < 8; ++axis) {
        lo[axis] = std::min(lo[axis], p->q[axis]);
        hi[axis] = std::max(hi[axis], p->q[axis]);
      }
    }
    std::size_t widest = 0;
    for (std::size_t axis = 1; axis < 8; ++axis) {
      if (hi[axis] - lo[axis] > hi[widest] - lo[widest]) widest = axis;
    }
    // Of equal ones the first edges of the table.
    std::nth_element(begin, begin + first, end, [widest](const Point& a, const Point& b) {
      return a.q[widest] != b.q[widest] ? a.q[widest] < b.q[widest] : a.edge < b.edge;
    });
    return r.begin + first;
  }

  bool fits_leaf(const Range& r) {
    if (r.size() > EdgeTree::kMostEdges) return false;
    planes_.clear();
    for (std::uint32_t k = r.begin; k < r.end; ++k) {
      planes_.push_back(edges_[points_[k].edge].first);
      planes_.push_back(edges_[points_[k].edge].second);
    }
    std::sort(planes_.begin(), planes_.end());
    planes_.erase(std::unique(planes_.begin(), planes_.end()), planes_.end());
    return planes_.size() <= EdgeTree::kMostPlanes;
  }

  // Precondition: fits_leaf() saw the range last.
  std::uint32_t add_leaf(const Range& r) {
    const std::uint32_t line = append_leaf(tree_, planes_, r.size());
    tree_.leaves.push_back(line);
    std::uint8_t* first = first_plane_at(tree_, line);
    const auto index = [&](std::uint32_t key) {
      return static_cast<std::uint8_t>(std::lower_bound(planes_.begin(), planes_.end(), key) -
                                       planes_.begin());
    };
    for (std::uint32_t k = 0; k < r.size(); ++k) {
      const Item& item = edges_[points_[r.begin + k].edge];
      tree_.edges.push_back(item.edge);
      first[k] = index(item.first);
      first[whole_vectors(r.size()) + k] = index(item.second);
    }
    return EdgeTree::kLeaf | line;
  }

  // The children of a node: its range cut in halves, and these again, but at whole multiples of
  // what a full child holds, so that leaves and nodes are full. Where the planes of full_ edges are
  // too many for a leaf, the children hold fewer. Their edges come in the order of the ranges.
  void fill(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
    std::uint32_t full = full_;
    while (std::uint64_t(full) * EdgeTree::kChildren < end - begin) full *= EdgeTree::kChildren;
    if (end - begin <= full_) full = std::max<std::uint32_t>(1, (end - begin + 1) / 2);
    std::vector<Range> ranges;
    cut({begin, end}, full, ranges);
    std::array<std::uint32_t, EdgeTree::kChildren> child{};
    std::array<bool, EdgeTree::kChildren> is_leaf{};
    // Inner children first, one after the other; then what is below them, in the order of edges.
    for (std::size_t k = 0; k < ranges.size(); ++k) {
      is_leaf[k] = ranges[k].size() == 1 || fits_leaf(ranges[k]);
      if (full == full_) probe(ranges[k]);
      if (again_) return;
      if (is_leaf[k]) continue;
      child[k] = static_cast<std::uint32_t>(tree_.nodes.size());
      tree_.nodes.emplace_back();
    }
    for (std::size_t k = 0; k < ranges.size(); ++k) {
      tree_.nodes[node].first_edge[k] = static_cast<std::uint32_t>(tree_.edges.size());
      if (is_leaf[k]) {
        fits_leaf(ranges[k]);  // its planes
        child[k] = add_leaf(ranges[k]);
      } else {
        fill(child[k], ranges[k].begin, ranges[k].end);
        if (again_) return;
      }
    }
    EdgeTree::Node& n = tree_.nodes[node];
    n.children = static_cast<std::uint32_t>(ranges.size());
    n.child = child;
    for (std::size_t k = ranges.size(); k < n.first_edge.size(); ++k)
      n.first_edge[k] = static_cast<std::uint32_t>(tree_.edges.size());
  }

  // Appends pieces of at most `full` edges, at most eight.
  void cut(const Range& r, std::uint32_t full, std::vector<Range>& to) {
    if (r.size() <= full) return to.push_back(r);
    const std::uint32_t pieces = (r.size() + full - 1) / full;
    const std::uint32_t middle = split(r, pieces / 2 * full);
    cut({r.begin, middle}, full, to);
    cut({middle, r.end}, full, to);
  }

  EdgeTree& tree_;
  std::vector<Item> edges_;
  std::vector<Point> points_;          // in the tree's order, when sorted
  std::vector<std::uint32_t> planes_;  // of the range that fits_leaf() saw last
  std::uint32_t full_ = kFullestLeaf;
  std::vector<double> probes_;  // edges that would have filled the leaves seen so far
  bool decided_ = false, again_ = false;
};

// Triangles of irregular edges, in blocks of their own.
void add_irregular(EdgeTree& tree, const EdgeTable& table) {
  tree.irregular_first.push_back(0);
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t e = 0; e < table.vertices.size(); ++e) {
    if (table.first[e + 1] - table.first[e] == 2) continue;
    for (std::uint32_t i = table.first[e]; i < table.first[e + 1]; ++i)
      triangles.push_back(table.incidence[i] >> 1);
  }
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  for (std::uint32_t e = 0; e < table.vertices.size(); ++e) {
    if (table.first[e + 1] - table.first[e] == 2) continue;
    tree.irregular.push_back(table.vertices[e]);
    for (std::uint32_t i = table.first[e]; i < table.first[e + 1]; ++i) {
      const auto plane = static_cast<std::uint32_t>(
          std::lower_bound(triangles.begin(), triangles.end(), table.incidence[i] >> 1) -
          triangles.begin());
      tree.irregular_plane.push_back((plane << 1) | (table.incidence[i] & 1));
    }
    tree.irregular_first.push_back(static_cast<std::uint32_t>(tree.irregular_plane.size()));
  }
  for (std::size_t k = 0; k < triangles.size(); k += EdgeTree::kMostPlanes) {
    std::vector<std::uint32_t> planes;
    const std::size_t end = std::min(k + EdgeTree::kMostPlanes, triangles.size());
    for (std::size_t i = k; i < end; ++i) planes.push_back(plane_key(triangles[i], false));
    tree.irregular_leaves.push_back(append_leaf(tree, planes, 0));
  }
}

struct Box {
  std::array<double, 4> lo, hi;
  Box() {
    lo.fill(kInfinity);
    hi.fill(-kInfinity);
  }
  void add(const Box& o) {
    for (std::size_t k = 0; k < 4; ++k) {
      lo[k] = std::min(lo[k], o.lo[k]);
      hi[k] = std::max(hi[k], o.hi[k]);
    }
  }
};

CertifiedPlane plane_of(const EdgeTree& tree, const TriMesh& mesh, std::uint32_t key) {
  CertifiedPlane p = certified_plane(mesh, key >> 1, tree.centre);
  if ((key & 1) != 0) {
    for (double& q : p.q) q = -q;
  }
  return p;
}

// Writes a leaf's dual points, and returns what is certain of each.
std::vector<CertifiedPlane> fill_leaf(EdgeTree& tree, const TriMesh& mesh, std::uint32_t line) {
  EdgeTree::Leaf& leaf = leaf_at(tree, line);
  std::vector<CertifiedPlane> planes(leaf.planes);
  std::array<double, 4> lo, hi;
  lo.fill(kInfinity);
  hi.fill(-kInfinity);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    planes[i] = plane_of(tree, mesh, tree.triangle[leaf.first_triangle + i]);
    for (std::size_t k = 0; k < 4; ++k) {
      lo[k] = std::min(lo[k], planes[i].q[k]);
      hi[k] = std::max(hi[k], planes[i].q[k]);
    }
    tree.largest_w = std::max(tree.largest_w, std::fabs(planes[i].q[3]));
  }
  std::int16_t* to = dual_at(tree, line);
  for (std::size_t k = 0; k < 4; ++k) {
    leaf.middle[k] = static_cast<float>((lo[k] + hi[k]) / 2);
    leaf.scale[k] = static_cast<float>(
        std::max(hi[k] - double(leaf.middle[k]), double(leaf.middle[k]) - lo[k]) / kLevel);
    double error = 0;
    for (std::size_t i = 0; i < planes.size(); ++i) {
      const double steps =
          leaf.scale[k] > 0 ? std::round((planes[i].q[k] - leaf.middle[k]) / leaf.scale[k]) : 0.0;
      const double level = std::clamp(steps, double(-kLevel), double(kLevel));
      to[k * leaf.padded + i] = static_cast<std::int16_t>(level);
      // Exact in double: 24 bits times 16.
      const double stored = double(leaf.middle[k]) + double(leaf.scale[k]) * level;
      error = std::max(error,
                       (std::fabs(stored - planes[i].q[k]) + planes[i].error[k]) * (1 + 0x1p-40));
    }
    leaf.error[k] = std::nextafter(static_cast<float>(error), kInfinity);
  }
  return planes;
}

void set_box(EdgeTree::Node& n, std::size_t lane, const Box& box) {
  for (std::size_t k = 0; k < 4; ++k) {
    if (!(box.hi[k] - box.lo[k] < kInfinity)) {  // of a triangle of which nothing is known
      n.middle[k][lane] = 0;
      n.half[k][lane] = kInfinity;
      continue;
    }
    const auto middle = static_cast<float>((box.lo[k] + box.hi[k]) / 2);
    const double half = std::max(box.hi[k] - double(middle), double(middle) - box.lo[k]);
    n.middle[k][lane] = middle;
    n.half[k][lane] = (static_cast<float>(half) + std::fabs(middle) * kWiden) * (1 + kWiden);
  }
}

using Boxes = std::array<Box, 2>;  // of edges' first and second planes

// Writes a leaf's numbers.
Boxes fill_edges(EdgeTree& tree, const TriMesh& mesh, std::uint32_t line) {
  const std::vector<CertifiedPlane> planes = fill_leaf(tree, mesh, line);
  const std::size_t edges = leaf_at(tree, line).edges;
  const std::uint8_t* plane = first_plane_at(tree, line);
  Boxes boxes;
  for (std::size_t side = 0; side < 2; ++side) {
    Box& box = boxes[side];
    for (std::size_t e = 0; e < edges; ++e) {
      const CertifiedPlane& p = planes[plane[side * whole_vectors(edges) + e]];
      for (std::size_t k = 0; k < 4; ++k) {
        box.lo[k] = std::min(box.lo[k], p.q[k] - p.error[k]);
        box.hi[k] = std::max(box.hi[k], p.q[k] + p.error[k]);
      }
    }
  }
  return boxes;
}

// Writes the numbers of a node and all below it.
Boxes fill_node(EdgeTree& tree, const TriMesh& mesh, std::uint32_t node) {
  Boxes all;
  for (std::uint32_t k = 0; k < tree.nodes[node].children; ++k) {
    const std::uint32_t child = tree.nodes[node].child[k];
    const Boxes boxes = (child & EdgeTree::kLeaf) != 0
                            ? fill_edges(tree, mesh, child & ~EdgeTree::kLeaf)
                            : fill_node(tree, mesh, child);
    for (std::size_t side = 0; side < 2; ++side) {
      set_box(tree.nodes[node], side * EdgeTree::kChildren + k, boxes[side]);
      all[side].add(boxes[side]);
    }
  }
  return all;
}

}  // namespace

EdgeTree build_edge_tree(const TriMesh& mesh, const EdgeTable& edges) {
  EdgeTree tree;
  tree.centre = dual_centre(mesh);
  Sorter(tree, mesh, edges).sort();
  add_irregular(tree, edges);
  tree.lines.emplace_back();  // whole vectors are read, which may reach beyond the last leaf
  refresh_planes(tree, mesh);
  return tree;
}

void refresh_planes(EdgeTree& tree, const TriMesh& mesh) {
  tree.centre = dual_centre(mesh);
  tree.largest_w = 0;
  if (!tree.nodes.empty()) fill_node(tree, mesh, 0);
  for (const std::uint32_t line : tree.irregular_leaves) fill_leaf(tree, mesh, line);
}

}  // namespace gnomon
