#include <gnomon/trace/bvh.h>

#include <gnomon/core/exact.h>

namespace gnomon {
namespace {

constexpr std::uint32_t kLeafSize = 2;
constexpr int kBins = 16;
// Deeper nodes are halved by count, so the depth stays under kMaxSahDepth + 32 (2^32 triangles) and
// walk()'s stack suffices.
constexpr int kMaxSahDepth = 64;

struct Box {
  Vec3 lo{std::numeric_limits<double>::infinity()};
  Vec3 hi{-std::numeric_limits<double>::infinity()};

  void add(const Vec3& l, const Vec3& h) {
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], l[k]);
      hi[k] = std::max(hi[k], h[k]);
    }
  }
  double half_area() const {
    const Vec3 d = hi - lo;
    return d.x < 0 ? 0.0 : d.x * d.y + d.y * d.z + d.z * d.x;
  }
};

struct Item {
  Box box;
  Vec3 centre;  // twice the centre; only steers the split
  std::uint32_t triangle;
};

struct Bin {
  Box box;
  std::size_t count = 0;
};

// How many of the items go left, after reordering them; 0: none of the splits is useful.
std::size_t split(std::vector<Item>& items, std::size_t first, std::size_t last, bool by_count) {
  const auto begin = items.begin() + static_cast<std::ptrdiff_t>(first);
  const auto end = items.begin() + static_cast<std::ptrdiff_t>(last);
  Box centres;
  for (auto i = begin; i != end; ++i) centres.add(i->centre, i->centre);
  const Vec3 extent = centres.hi - centres.lo;
  const std::size_t n = last - first;

  int best_axis = -1, best_bin = 0;
  double best_cost = std::numeric_limits<double>::infinity();
  const auto bin_of = [&](const Item& item, int axis) {
    const double x = (item.centre[axis] - centres.lo[axis]) / extent[axis];
    return std::min(kBins - 1, static_cast<int>(x * kBins));
  };
  for (int axis = 0; axis < 3 && !by_count; ++axis) {
    if (!(extent[axis] > 0)) continue;
    std::array<Bin, kBins> bins;
    for (auto i = begin; i != end; ++i) {
      Bin& b = bins[static_cast<std::size_t>(bin_of(*i, axis))];
      b.box.add(i->box.lo, i->box.hi);
      ++b.count;
    }
    std::array<double, kBins> right_cost{};
    Box box;
    std::size_t count = 0;
    for (std::size_t b = kBins - 1; b > 0; --b) {
      box.add(bins[b].box.lo, bins[b].box.hi);
      count += bins[b].count;
      right_cost[b] = box.half_area() * static_cast<double>(count);
    }
    box = Box();
    count = 0;
    for (std::size_t b = 0; b + 1 < kBins; ++b) {
      box.add(bins[b].box.lo, bins[b].box.hi);
      count += bins[b].count;
      if (count == 0 || count == n) continue;
      const double cost = box.half_area() * static_cast<double>(count) + right_cost[b + 1];
      if (cost < best_cost) {
        best_cost = cost;
        best_axis = axis;
        best_bin = static_cast<int>(b);
      }
    }
  }
  if (best_axis >= 0) {
    const auto middle =
        std::partition(begin, end, [&](const Item& i) { return bin_of(i, best_axis) <= best_bin; });
    return static_cast<std::size_t>(middle - begin);
  }
  const int axis =
      extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
  std::nth_element(
      begin, begin + static_cast<std::ptrdiff_t>(n / 2), end,
      [axis](const Item& a, const Item& b) { return a.centre[axis] < b.centre[axis]; });
  return n / 2;
}

}  // namespace

Bvh build_bvh(const TriMesh& mesh, const std::vector<std::uint8_t>& selected) {
  std::vector<Item> items;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!selected.empty() && selected[t] == 0) continue;
    Item item;
    for (const std::uint32_t v : mesh.triangles[t])
      item.box.add(mesh.positions[v], mesh.positions[v]);
    item.centre = item.box.lo + item.box.hi;
    item.triangle = static_cast<std::uint32_t>(t);
    items.push_back(item);
  }
  Bvh bvh;
  if (items.empty()) return bvh;

  struct Task {
    std::uint32_t node;
    std::size_t first, last;
    int depth;
  };
  bvh.nodes.reserve(items.size() * 2);
  bvh.nodes.emplace_back();
  std::vector<Task> tasks{{0, 0, items.size(), 0}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    Box box;
    for (std::size_t k = task.first; k < task.last; ++k) box.add(items[k].box.lo, items[k].box.hi);
    bvh.nodes[task.node].lo = box.lo;
    bvh.nodes[task.node].hi = box.hi;
    if (task.last - task.first <= kLeafSize) {
      bvh.nodes[task.node].first = static_cast<std::uint32_t>(task.first);
      bvh.nodes[task.node].count = static_cast<std::uint32_t>(task.last - task.first);
      continue;
    }
    const std::size_t middle =
        task.first + split(items, task.first, task.last, task.depth >= kMaxSahDepth);
    const auto left = static_cast<std::uint32_t>(bvh.nodes.size());
    bvh.nodes[task.node].first = left;
    bvh.nodes.resize(bvh.nodes.size() + 2);
    tasks.push_back({left, task.first, middle, task.depth + 1});
    tasks.push_back({left + 1, middle, task.last, task.depth + 1});
  }
  bvh.triangles.reserve(items.size());
  for (const Item& item : items) bvh.triangles.push_back(item.triangle);
  return bvh;
}

Probe make_probe(const Vec3& origin, const Vec3& error, const Vec3& direction, double t0,
                 double t1) {
  Probe p;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  p.t0 = t0;
  p.t1 = t1;
  for (int k = 0; k < 3; ++k) {
    const double d = direction[k];
    const bool flat = std::fabs(d) < kSmallestCoordinate;
    const double pad = flat ? error[k] + std::fabs(d) : error[k];
    p.flat[static_cast<std::size_t>(k)] = flat;
    p.low[k] = std::nextafter(origin[k] - std::nextafter(pad, kInfinity), -kInfinity);
    p.high[k] = std::nextafter(origin[k] + std::nextafter(pad, kInfinity), kInfinity);
    p.inverse[k] = flat ? 0.0 : 1.0 / d;
  }
  return p;
}

}  // namespace gnomon
