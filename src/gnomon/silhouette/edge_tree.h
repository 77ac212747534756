// Silhouettes whose cost follows the silhouette: edges of two triangles, gathered by where their
// two planes lie in dual space, in a tree whose nodes say "on the silhouette", "not on it" or "look
// closer". For any light, any mesh, however wound; edges of one or of many triangles are looked at
// every time, for they are nearly always on it.
// Based on: "Geometry of shadows in real time" (paper 001), section 4 (planes as points of a 4D
// dual space, boxes tested against the light's hyperplane), with pairs of boxes in place of its
// cubes. docs/silhouettes.md.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <gnomon/core/exact.h>
#include <gnomon/mesh/edge_table.h>
#include <gnomon/silhouette/silhouette.h>

namespace gnomon {

struct EdgeTree {
  static constexpr int kChildren = 8;
  static constexpr std::size_t kVector = 16;  // dual points and edges of a leaf: multiples of it
  static constexpr std::size_t kMostPlanes = 64, kMostEdges = 64;  // of a leaf: a bit each

  // Boxes round dual points: middle and half width, with all that rounding can do.
  struct Node {
    // Lanes 0 to 7: the children's first planes (those on whose side the edge runs from a to b),
    // 8 to 15: their second ones, negated where both run the same way.
    alignas(64) std::array<std::array<float, 2 * kChildren>, 4> middle{}, half{};
    std::array<std::uint32_t, kChildren> child{};           // node, or kLeaf + line
    std::array<std::uint32_t, kChildren + 1> first_edge{};  // of each child; then the end
    std::uint32_t children = 0;
  };
  static constexpr std::uint32_t kLeaf = 0x80000000u;

  // A leaf is whole lines of memory: this; the dual points of its triangles, 16 bits a coordinate
  // (all x, all y, all z, all w: q[k] = middle[k] + scale[k] i[k]), `padded` of them; the first
  // plane of each edge; the second plane of each edge, a byte each, padded with zeros.
  struct Leaf {
    std::array<float, 4> middle{}, scale{};
    std::array<float, 4> error{};  // |q[k] - exact| is no more
    std::uint32_t first_triangle = 0, first_edge = 0;
    std::uint8_t planes = 0, padded = 0, edges = 0;
  };
  struct alignas(64) Line {
    std::array<std::uint8_t, 64> bytes{};
  };

  // An edge runs from a to b on the side of its first triangle: its multiplicity is the first
  // triangle's light side minus the (negated) second one's, and is negated if `backward`.
  struct Edge {
    std::uint32_t a, b;  // a < b; b with kBackward
  };
  static constexpr std::uint32_t kBackward = 0x80000000u;

  Vec3 centre{0.0};
  double largest_w = 0;
  std::vector<Node> nodes;  // the root first
  std::vector<Line> lines;  // leaves; then what would be leaves of the irregular edges' triangles
  std::vector<std::uint32_t> leaves;    // their first lines
  std::vector<std::uint32_t> triangle;  // per leaf, `planes`: (triangle << 1) | negated
  std::vector<Edge> edges;              // in the leaves' order

  // Edges of one, or of more than two triangles.
  std::vector<std::uint32_t> irregular_leaves;          // first lines; no edges in them
  std::vector<std::array<std::uint32_t, 2>> irregular;  // a < b
  std::vector<std::uint32_t> irregular_first;           // CSR into irregular_plane
  std::vector<std::uint32_t> irregular_plane;           // (plane << 1) | backward
};
static_assert(sizeof(EdgeTree::Leaf) == 64 - 4);

// Preconditions: `edges` was built from this mesh, at most 2^31-1 vertices and edges.
EdgeTree build_edge_tree(const TriMesh& mesh, const EdgeTable& edges);

// After vertices have moved: the same triangles, the same tree, new planes. It stays right however
// they moved, triangles without area included, and fast as long as neighbours stay neighbours.
// Linear in the mesh: takes as long as about a dozen silhouettes by brute force.
void refresh_planes(EdgeTree& tree, const TriMesh& mesh);

// What one extraction did.
struct ExtractionStats {
  std::uint64_t nodes = 0, leaves = 0;  // that were looked at
  std::uint64_t bytes = 0;              // read and written, but for exact decisions
  ExactStats exact;
};

// Memory that calls can share.
struct ExtractionScratch {
  std::vector<std::uint32_t> nodes, leaves, hits;
  std::vector<std::int8_t> sides;
};

// The edges of find_silhouette() with their multiplicities, in another order, which is the same for
// every instruction set. `light` in the mesh's coordinates, its components snapped (exact.h): a
// caster that is moved as a whole moves its light instead, and nothing is built anew. `out` is
// replaced.
void find_silhouette(Silhouette& out, const EdgeTree& tree, const TriMesh& mesh, const Light& light,
                     ExtractionScratch& scratch, ExtractionStats* stats = nullptr);

// The same by testing every leaf: brute force on the tree's data.
void find_silhouette_linear(Silhouette& out, const EdgeTree& tree, const TriMesh& mesh,
                            const Light& light, ExtractionScratch& scratch,
                            ExtractionStats* stats = nullptr);

// The triangles whose plane the light is no farther from than `distance`, and perhaps some more;
// each once, ascending. Metres; of a directional light: |n.L|, n the plane's unit normal. Only
// triangles with an edge in the tree. `out` is replaced.
void find_near_planes(std::vector<std::uint32_t>& out, const EdgeTree& tree, const Light& light,
                      double distance, ExtractionScratch& scratch);

}  // namespace gnomon
