// The second paper's tree of silhouettes, kept for the record: dual edges in a 4D octree
// ("hextree"). Based on: "Geometry of shadows in real time" (paper 001), section 4, with its
// misprints mended: the dual of a vertex is (n, -v.n); a node is looked into when the light's signs
// at the two extreme corners of its cube differ. docs/silhouettes.md. For work, edge_tree.h.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <gnomon/core/exact.h>
#include <gnomon/mesh/edge_table.h>
#include <gnomon/silhouette/edge_tree.h>
#include <gnomon/silhouette/silhouette.h>

namespace gnomon {

// What a dual edge runs between.
enum class DualForm : std::uint8_t {
  // The planes of its two triangles: the silhouette of the facets, exactly, with multiplicities.
  // Edges of one or of more triangles are tested every time.
  facets,
  // The tangent planes at its two vertices, with normals that are means of their triangles': the
  // paper's. That is the contour of a smooth surface, which crosses edges: no closed loops, no
  // volume. Edges with the contour between their ends have multiplicity 2.
  vertices
};

struct Hextree {
  static constexpr int kDepth = 4;  // the paper's

  struct Node {
    std::array<double, 4> lo{};  // of its cube
    double width = 2;
    std::array<std::uint32_t, 16> child{};  // 0: none
    std::vector<std::uint32_t> edges;       // that no smaller cube encloses
    double error = 0;                       // largest one of the duals in it and below
  };
  struct Dual {
    std::array<double, 4> q{};  // of length 1
    double error = 0;           // of each coordinate
  };
  struct Edge {
    std::uint32_t a, b;
    std::uint32_t first, second;  // duals; facets: (triangle << 1) | negated
    bool backward = false;
  };

  DualForm form = DualForm::facets;
  Vec3 centre{0.0};
  double size = 1;          // metres: coordinates are measured in it
  std::vector<Node> nodes;  // the root first
  std::vector<Dual> duals;  // of triangles, or of vertices
  std::vector<Edge> edges;
  EdgeTable always;  // facets: edges of one or of more than two triangles
};

// Preconditions: `edges` was built from this mesh.
Hextree build_hextree(const TriMesh& mesh, const EdgeTable& edges, DualForm form);

// `facets`: the edges of find_silhouette(), in another order. `light`: snapped. `out` is replaced.
void find_silhouette(Silhouette& out, const Hextree& tree, const TriMesh& mesh, const Light& light,
                     ExtractionStats* stats = nullptr);

}  // namespace gnomon
