// Extraction from an EdgeTree. Signs come from floats where their error is too small to matter, and
// from the exact predicate elsewhere: the answer is that of light_sides(), for every instruction
// set.
#include <algorithm>
#include <bit>
#include <cstring>

#include <gnomon/silhouette/certified_plane.h>
#include <gnomon/silhouette/edge_tree.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gnomon/silhouette/edge_tree_find.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef GNOMON_EDGE_TREE_FIND_ONCE
#define GNOMON_EDGE_TREE_FIND_ONCE
namespace gnomon {

// Which of a leaf's planes have the light on their positive side, and which float cannot tell.
struct LeafSigns {
  std::uint64_t positive, undecided;
};
// Of a node's 16 boxes, the same: wholly positive, wholly negative.
struct NodeSigns {
  std::uint32_t positive, negative;
};
// Of the four products and their sum, and of middle and scale times the light in float, per unit of
// their magnitudes: less than 16 roundings of 2^-24.
constexpr float kFloatRounding = 0x1p-20F;

constexpr std::uint32_t kFirstPositive = 0x80000000u;

struct Extraction {
  const TriMesh* mesh = nullptr;
  Light light{0, 0, 1, 0};
  DualLight dual;
  Silhouette* out = nullptr;
  ExtractionScratch* scratch = nullptr;
  ExactStats exact;
  std::uint64_t bytes = 0;
};

inline std::uint64_t decide(const LeafSigns& signs, const EdgeTree& tree,
                            const EdgeTree::Leaf& leaf, Extraction& x) {
  std::uint64_t positive = signs.positive;
  for (std::uint64_t left = signs.undecided; left != 0; left &= left - 1) {
    const int i = std::countr_zero(left);
    const std::uint32_t key = tree.triangle[leaf.first_triangle + std::uint32_t(i)];
    const Triangle& t = x.mesh->triangles[key >> 1];
    const int side = light_side(x.mesh->positions[t[0]], x.mesh->positions[t[1]],
                                x.mesh->positions[t[2]], x.light, x.exact);
    if ((side > 0) != ((key & 1) != 0)) positive |= 1ull << i;
  }
  return positive;
}

// +2 where the first plane is positive, -2 where it is not; the other way round if backward.
// Without a branch, which nothing could predict.
inline SilhouetteEdge oriented(const EdgeTree::Edge& e, bool first_positive) {
  const std::uint32_t up = (e.b >> 31) ^ (first_positive ? 1u : 0u);
  return {e.a, e.b & ~EdgeTree::kBackward, static_cast<std::int32_t>(up * 4) - 2};
}
static_assert(EdgeTree::kBackward == 1u << 31);

// A leaf as it lies in memory. Edges come in whole vectors: those beyond the last have one plane
// twice, and are never hit.
struct LeafView {
  const EdgeTree::Leaf& head;
  const std::int16_t* dual;
  const std::uint8_t *first_plane, *second_plane;
};
inline std::size_t padded_edges(const EdgeTree::Leaf& leaf) {
  return (std::size_t(leaf.edges) + EdgeTree::kVector - 1) / EdgeTree::kVector * EdgeTree::kVector;
}
inline LeafView view_leaf(const EdgeTree& tree, std::uint32_t line) {
  const std::uint8_t* bytes = reinterpret_cast<const std::uint8_t*>(tree.lines.data()) +
                              std::size_t(line) * sizeof(EdgeTree::Line);
  const auto& head = *reinterpret_cast<const EdgeTree::Leaf*>(bytes);
  const std::uint8_t *dual = bytes + sizeof(EdgeTree::Line),
                     *plane = dual + std::size_t(head.padded) * 4 * sizeof(std::int16_t);
  return {head, reinterpret_cast<const std::int16_t*>(dual), plane, plane + padded_edges(head)};
}
inline std::uint64_t all_planes(const EdgeTree::Leaf& leaf) {
  return leaf.planes == 64 ? ~0ull : (1ull << leaf.planes) - 1;
}

}  // namespace gnomon
#endif

HWY_BEFORE_NAMESPACE();
namespace gnomon {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;

template <class D, class M>
std::uint64_t BitsOf(D d, M mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  std::uint64_t bits = 0;
  std::memcpy(&bits, bytes, sizeof(bits));
  return bits & ((1ull << hn::Lanes(d)) - 1);  // at most 16 lanes
}

LeafSigns SignsOfLeaf(const LeafView& view, const DualLight& light) {
  const EdgeTree::Leaf& leaf = view.head;
  const Floats d;
  const hn::Rebind<std::int32_t, Floats> di;
  const hn::Rebind<std::int16_t, Floats> d16;
  float base = 0, sum = 0, error = light.slack;
  float c[4];
  for (std::size_t k = 0; k < 4; ++k) {
    const float at = light.l[k] * leaf.middle[k];
    base += at;
    c[k] = light.l[k] * leaf.scale[k];
    sum += std::fabs(at) + std::fabs(c[k]) * 32768.0F;
    error += std::fabs(light.l[k]) * leaf.error[k];
  }
  error = error * (1 + kFloatRounding) + sum * kFloatRounding;
  const auto from = hn::Set(d, base), most = hn::Set(d, error), least = hn::Set(d, -error);
  const auto c0 = hn::Set(d, c[0]), c1 = hn::Set(d, c[1]), c2 = hn::Set(d, c[2]),
             c3 = hn::Set(d, c[3]);
  const std::size_t n = leaf.padded;
  const std::int16_t* dual = view.dual;
  const auto at = [&](std::size_t k, std::size_t i) {
    return hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d16, dual + k * n + i)));
  };
  LeafSigns out{0, 0};
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const auto v = hn::Add(from, hn::Add(hn::Add(hn::Mul(c0, at(0, i)), hn::Mul(c1, at(1, i))),
                                         hn::Add(hn::Mul(c2, at(2, i)), hn::Mul(c3, at(3, i)))));
    const auto positive = hn::Gt(v, most);
    out.positive |= BitsOf(d, positive) << i;
    out.undecided |= BitsOf(d, hn::Not(hn::Or(positive, hn::Lt(v, least)))) << i;
  }
  const std::uint64_t all = all_planes(leaf);
  return {out.positive & all, out.undecided & all};
}

NodeSigns SignsOfNode(const EdgeTree::Node& node, const DualLight& light) {
  const Floats d;
  NodeSigns out{0, 0};
  for (std::size_t i = 0; i < 16; i += hn::Lanes(d)) {
    auto v = hn::Zero(d), r = hn::Set(d, light.slack);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto l = hn::Set(d, light.l[k]);
      v = hn::Add(v, hn::Mul(l, hn::Load(d, node.middle[k].data() + i)));
      r = hn::Add(r, hn::Mul(hn::Abs(l), hn::Load(d, node.half[k].data() + i)));
    }
    out.positive |= static_cast<std::uint32_t>(BitsOf(d, hn::Gt(v, r)) << i);
    out.negative |= static_cast<std::uint32_t>(BitsOf(d, hn::Lt(v, hn::Neg(r))) << i);
  }
  return out;
}

// On which side of its planes the light is, exactly, a bit each.
std::uint64_t PositiveOf(const EdgeTree& tree, const LeafView& leaf, Extraction& x) {
  const LeafSigns signs = SignsOfLeaf(leaf, x.dual);
  x.bytes += sizeof(EdgeTree::Line) + std::size_t(leaf.head.padded) * 4 * sizeof(std::int16_t);
  if (HWY_LIKELY(signs.undecided == 0)) return signs.positive;
  return decide(signs, tree, leaf.head, x);
}

// Of `lanes` planes by their numbers, whether they are positive: bit 0.
template <class D, class V>
V SignBits(D d, V low, V high, const std::uint8_t* plane) {
  const hn::Rebind<std::uint8_t, D> d8;
  const V number = hn::PromoteTo(d, hn::LoadU(d8, plane));
  const V word = hn::IfThenElse(hn::Gt(number, hn::Set(d, 31)), high, low);
  return hn::Shr(word, hn::And(number, hn::Set(d, 31)));
}

// Writes the numbers of the leaf's edges that are on the silhouette, with kFirstPositive, and
// perhaps some more that do not count. Returns how many count.
std::size_t HitsOf(const EdgeTree& tree, const LeafView& leaf, Extraction& x, std::uint32_t* to) {
  const std::uint64_t positive = PositiveOf(tree, leaf, x);
  if (positive == 0 || positive == all_planes(leaf.head)) return 0;
  const hn::CappedTag<std::uint32_t, 16> d;
  const auto low = hn::Set(d, static_cast<std::uint32_t>(positive)),
             high = hn::Set(d, static_cast<std::uint32_t>(positive >> 32));
  const std::size_t edges = leaf.head.edges;
  x.bytes += padded_edges(leaf.head) * 2;
  std::size_t n = 0;
  for (std::size_t e = 0; e < edges; e += hn::Lanes(d)) {
    const auto one = SignBits(d, low, high, leaf.first_plane + e),
               two = SignBits(d, low, high, leaf.second_plane + e);
    const auto bit = hn::Set(d, 1);
    // (Iota() of what is not constant goes through memory.)
    const auto number =
        hn::Add(hn::Iota(d, 0), hn::Set(d, leaf.head.first_edge + static_cast<std::uint32_t>(e)));
    const auto hit = hn::TestBit(hn::Xor(one, two), bit);
    // In a register and stored whole: storing lanes by a mask is slow on some processors.
    hn::StoreU(hn::Compress(hn::Or(number, hn::ShiftLeft<31>(hn::And(one, bit))), hit), d, to + n);
    n += hn::CountTrue(d, hit);
  }
  return n;
}

// Into the second-level cache: the first has no room for as many lines on their way as it takes to
// wait for memory only once.
void PrefetchFar(const void* p) {
#if defined(__GNUC__)
  __builtin_prefetch(p, 0, 2);
#else
  hwy::Prefetch(static_cast<const char*>(p));
#endif
}

void PrefetchLeaf(const EdgeTree& tree, std::uint32_t line) {
  constexpr std::size_t kLines = 11;  // of the largest
  for (std::size_t k = 0; k < kLines; ++k) PrefetchFar(tree.lines.data() + line + k);
}

// Leaves that may hold an edge of the silhouette; those of boxes on two sides of the light are
// written at once.
void Descend(const EdgeTree& tree, Extraction& x) {
  std::vector<std::uint32_t>& nodes = x.scratch->nodes;
  nodes.assign(1, 0);
  // Level by level: the children of a node lie one after the other.
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const EdgeTree::Node& n = tree.nodes[nodes[k]];
    const NodeSigns s = SignsOfNode(n, x.dual);
    const std::uint32_t valid = (1u << n.children) - 1;
    const std::uint32_t first = s.positive & valid, second = (s.positive >> 8) & valid;
    const std::uint32_t not_first = s.negative & valid, not_second = (s.negative >> 8) & valid;
    std::uint32_t on = (first & not_second) | (not_first & second);
    std::uint32_t closer = valid & ~(on | (first & second) | (not_first & not_second));
    for (; on != 0; on &= on - 1) {
      const auto c = static_cast<std::size_t>(std::countr_zero(on));
      const bool positive = ((first >> c) & 1) != 0;
      std::size_t at = x.out->size();
      x.out->resize(at + n.first_edge[c + 1] - n.first_edge[c]);
      for (std::uint32_t e = n.first_edge[c]; e < n.first_edge[c + 1]; ++e)
        (*x.out)[at++] = oriented(tree.edges[e], positive);
    }
    for (; closer != 0; closer &= closer - 1) {
      const std::uint32_t child = n.child[static_cast<std::size_t>(std::countr_zero(closer))];
      if ((child & EdgeTree::kLeaf) != 0) {
        x.scratch->leaves.push_back(child & ~EdgeTree::kLeaf);
      } else {
        nodes.push_back(child);
        const auto* from = reinterpret_cast<const std::uint8_t*>(&tree.nodes[child]);
        for (std::size_t i = 0; i < sizeof(EdgeTree::Node); i += 64) PrefetchFar(from + i);
      }
    }
  }
}

// Finds the edges first, then fetches their vertices: each on its way from memory long before it is
// needed.
void Leaves(const EdgeTree& tree, const std::vector<std::uint32_t>& leaves, Extraction& x) {
  constexpr std::size_t kLeavesAhead = 16;
  std::vector<std::uint32_t>& hits = x.scratch->hits;
  std::size_t n = 0;
  for (std::size_t k = 0; k < leaves.size(); ++k) {
    if (k + kLeavesAhead < leaves.size()) PrefetchLeaf(tree, leaves[k + kLeavesAhead]);
    if (hits.size() < n + 2 * EdgeTree::kMostEdges) hits.resize(2 * n + 4096);
    const std::size_t found = HitsOf(tree, view_leaf(tree, leaves[k]), x, hits.data() + n);
    for (std::size_t i = n; i < n + found; ++i)
      PrefetchFar(tree.edges.data() + (hits[i] & ~kFirstPositive));
    n += found;
  }
  Silhouette& out = *x.out;
  std::size_t at = out.size();
  out.resize(at + n);
  for (std::size_t k = 0; k < n; ++k) {
    out[at++] = oriented(tree.edges[hits[k] & ~kFirstPositive], (hits[k] & kFirstPositive) != 0);
  }
}

void Extract(const EdgeTree& tree, bool linear, Extraction& x) {
  x.scratch->leaves.clear();
  if (!linear && !tree.nodes.empty()) Descend(tree, x);
  Leaves(tree, linear ? tree.leaves : x.scratch->leaves, x);
  for (const std::uint32_t line : tree.irregular_leaves) {
    const LeafView leaf = view_leaf(tree, line);
    const std::uint64_t positive = PositiveOf(tree, leaf, x);
    for (std::uint32_t i = 0; i < leaf.head.planes; ++i)
      x.scratch->sides.push_back(((positive >> i) & 1) != 0 ? 1 : -1);
  }
}

// Triangles on whose plane the light lies within the light's slack: what is left undecided.
void NearPlanes(const EdgeTree& tree, const DualLight& light, ExtractionScratch& scratch,
                std::vector<std::uint32_t>& out) {
  const auto add = [&](std::uint32_t line) {
    const LeafView leaf = view_leaf(tree, line);
    for (std::uint64_t left = SignsOfLeaf(leaf, light).undecided; left != 0; left &= left - 1) {
      out.push_back(
          tree.triangle[leaf.head.first_triangle + std::uint32_t(std::countr_zero(left))] >> 1);
    }
  };
  std::vector<std::uint32_t>& nodes = scratch.nodes;
  nodes.clear();
  if (!tree.nodes.empty()) nodes.push_back(0);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const EdgeTree::Node& n = tree.nodes[nodes[k]];
    const NodeSigns s = SignsOfNode(n, light);
    const std::uint32_t decided = s.positive | s.negative;
    std::uint32_t closer = ((1u << n.children) - 1) & ~(decided & (decided >> 8));
    for (; closer != 0; closer &= closer - 1) {
      const std::uint32_t child = n.child[static_cast<std::size_t>(std::countr_zero(closer))];
      if ((child & EdgeTree::kLeaf) != 0) {
        add(child & ~EdgeTree::kLeaf);
      } else {
        nodes.push_back(child);
      }
    }
  }
  for (const std::uint32_t line : tree.irregular_leaves) add(line);
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon {
namespace {

HWY_EXPORT(Extract);
HWY_EXPORT(NearPlanes);

void find(Silhouette& out, const EdgeTree& tree, const TriMesh& mesh, const Light& light,
          ExtractionScratch& scratch, ExtractionStats* stats, bool linear) {
  out.clear();
  scratch.sides.clear();
  Extraction x;
  x.mesh = &mesh;
  x.light = light;
  x.dual = dual_light(light, tree.centre, tree.largest_w);
  x.out = &out;
  x.scratch = &scratch;
  HWY_DYNAMIC_DISPATCH(Extract)(tree, linear, x);
  for (std::size_t k = 0; k < tree.irregular.size(); ++k) {
    std::int32_t m = 0;
    for (std::uint32_t i = tree.irregular_first[k]; i < tree.irregular_first[k + 1]; ++i) {
      const std::int32_t side = scratch.sides[tree.irregular_plane[i] >> 1];
      m += (tree.irregular_plane[i] & 1) != 0 ? -side : side;
    }
    if (m != 0) out.push_back({tree.irregular[k][0], tree.irregular[k][1], m});
  }
  if (stats == nullptr) return;
  stats->exact += x.exact;
  if (!linear) stats->nodes += scratch.nodes.size();
  stats->leaves += linear ? tree.leaves.size() : scratch.leaves.size();
  stats->bytes += x.bytes + out.size() * sizeof(SilhouetteEdge) +
                  (linear ? 0 : scratch.nodes.size() * sizeof(EdgeTree::Node)) +
                  scratch.sides.size() * (4 * sizeof(std::int16_t) + 2) +
                  tree.irregular_plane.size() * sizeof(std::uint32_t) +
                  tree.irregular.size() * 3 * sizeof(std::uint32_t);
}

}  // namespace

void find_silhouette(Silhouette& out, const EdgeTree& tree, const TriMesh& mesh, const Light& light,
                     ExtractionScratch& scratch, ExtractionStats* stats) {
  find(out, tree, mesh, light, scratch, stats, false);
}

void find_silhouette_linear(Silhouette& out, const EdgeTree& tree, const TriMesh& mesh,
                            const Light& light, ExtractionScratch& scratch,
                            ExtractionStats* stats) {
  find(out, tree, mesh, light, scratch, stats, true);
}

void find_near_planes(std::vector<std::uint32_t>& out, const EdgeTree& tree, const Light& light,
                      double distance, ExtractionScratch& scratch) {
  out.clear();
  DualLight dual = dual_light(light, tree.centre, tree.largest_w);
  // Normals are up to kLargestNormal long; the rest is rounding to float.
  dual.slack += static_cast<float>(distance * dual.factor * (kLargestNormal * (1 + 0x1p-20)));
  HWY_DYNAMIC_DISPATCH(NearPlanes)(tree, dual, scratch, out);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
}

}  // namespace gnomon
#endif
