// A tree of boxes over some triangles of a mesh, walked conservatively: no triangle that an
// inexactly known segment could touch is left out. The tree of the exact oracle (exact_count.h); it
// only proposes candidates, exact predicates decide on each.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gnomon/core/approx.h>
#include <gnomon/mesh/tri_mesh.h>

namespace gnomon {

struct BvhNode {
  Vec3 lo, hi;              // closed box, exact: corners are coordinates of vertices
  std::uint32_t first = 0;  // leaf: first of `count` entries in Bvh::triangles; inner node: left
                            // child, right one follows
  std::uint32_t count = 0;  // 0: inner node
};

struct Bvh {
  std::vector<BvhNode> nodes;  // nodes[0] is the root; empty where there are no triangles
  std::vector<std::uint32_t> triangles;
};

// Binned surface area heuristic. `selected`: one flag per triangle, empty means all.
Bvh build_bvh(const TriMesh& mesh, const std::vector<std::uint8_t>& selected);

// The points origin + t * direction, t0 <= t <= t1, each with every coordinate wrong by up to
// `error`.
struct Probe {
  Vec3 low, high;            // origin - error, origin + error, rounded outwards
  Vec3 inverse;              // 1 / direction
  std::array<bool, 3> flat;  // the axis does not move: `low`, `high` hold all of the segment
  double t0 = 0, t1 = 0;     // may be infinite
};

// Relative error of one computed slab distance (bound - origin) / direction: the direction may be a
// rounded difference, its reciprocal, the difference and the product round as well: 4 roundings,
// and 2 more where slabs_meet() widens the result. Eight roundings pay for all of these and for
// their products.
inline constexpr double kSlabError = 8 * kUnitRoundoff;

// `direction` is exact or correctly rounded, per component. Preconditions: `error` finite and not
// negative; an axis whose |direction| is below kSmallestCoordinate moves by at most |direction| (t1
// <= 1) or is exactly 0.
Probe make_probe(const Vec3& origin, const Vec3& error, const Vec3& direction, double t0,
                 double t1);

// True if the probe could touch the closed box; `entry` is then a lower bound of t there.
inline bool slabs_meet(const Probe& p, const Vec3& lo, const Vec3& hi, double& entry) {
  double near = p.t0, far = p.t1;
  for (int k = 0; k < 3; ++k) {
    if (p.flat[static_cast<std::size_t>(k)]) {
      if (lo[k] > p.high[k] || hi[k] < p.low[k]) return false;
      continue;
    }
    const double a = (lo[k] - p.high[k]) * p.inverse[k], b = (hi[k] - p.low[k]) * p.inverse[k];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  entry = std::isinf(near) ? near : near - kSlabError * std::fabs(near);
  return entry <= (std::isinf(far) ? far : far + kSlabError * std::fabs(far));
}

// Calls visit(triangle) for every triangle whose box the probe could touch, nearest boxes first.
// `visit` may lower probe.t1.
template <class Visit>
void walk(const Bvh& bvh, Probe& probe, const Visit& visit) {
  struct Entry {
    std::uint32_t node;
    double t;
  };
  // One entry for each level below the root, and one: build_bvh() keeps the depth under kMaxDepth.
  std::array<Entry, 128> stack;
  int size = 0;
  double t = 0;
  if (bvh.nodes.empty() || !slabs_meet(probe, bvh.nodes[0].lo, bvh.nodes[0].hi, t)) return;
  stack[static_cast<std::size_t>(size++)] = {0, t};
  while (size > 0) {
    const Entry e = stack[static_cast<std::size_t>(--size)];
    if (e.t > probe.t1) continue;
    const BvhNode& node = bvh.nodes[e.node];
    if (node.count > 0) {
      for (std::uint32_t k = 0; k < node.count; ++k) visit(bvh.triangles[node.first + k]);
      continue;
    }
    const BvhNode &left = bvh.nodes[node.first], &right = bvh.nodes[node.first + 1];
    double tl = 0, tr = 0;
    const bool l = slabs_meet(probe, left.lo, left.hi, tl),
               r = slabs_meet(probe, right.lo, right.hi, tr);
    Entry near{node.first, tl}, far{node.first + 1, tr};
    if (l && r && tr < tl) std::swap(near, far);
    if (l && r) {
      stack[static_cast<std::size_t>(size++)] = far;
      stack[static_cast<std::size_t>(size++)] = near;
    } else if (l || r) {
      stack[static_cast<std::size_t>(size++)] =
          l ? Entry{node.first, tl} : Entry{node.first + 1, tr};
    }
  }
}

}  // namespace gnomon
