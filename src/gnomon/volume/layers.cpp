#include <gnomon/volume/layers.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include <glm/common.hpp>

// Notation: S the largest coordinate relative to the light (see scale_of); r a vertex relative to
// the light; x the component of r along the axis of a face of the cube, y and z the others;
// (u, v) = (y/x, z/x), or the coordinates of a directional light's grid, in cells.

namespace gnomon {
namespace {

// Of S: triangles that come closer to a point light than about this count everywhere. All others
// are seen under directions that are certain to kPointSlack.
constexpr double kTouch = 0x1p-28;
// Of S: a bound on the errors of r and of points clipped from them. r = p w - L is wrong by at most
// two roundings of S, 2^-52 S; a point on an edge, r0 + t (r1 - r0) with t wrong by 4 roundings, by
// 12 of S, which is below 2^-49 S.
constexpr double kPlaceError = 0x1p-48;
// Directions y/x in a face of the cube, |y| <= x and x > kTouch S: both coordinates are wrong by
// kPlaceError S, so that y/x is by 2^-48 * 2 / (2^-28 - 2^-48) < 2^-18; corners have |y/x| up to
// 2^30, and dividing, scaling and interpolating them rounds by less than 2^-20. In all below this,
// as part of the face's half width.
constexpr double kPointSlack = 0x1p-17;
// Of S: coordinates p_i - p_k d_i / d_k, |d_i| <= |d_k|, are wrong by 4 roundings of S at most.
constexpr double kPlaneError = 0x1p-50;
// Of S: the least extent that a directional light's grid is given.
constexpr double kLeastExtent = 0x1p-40;
// In cells: edges that rise less are taken as wide as they are in every row that they touch.
constexpr double kFlat = 0x1p-30;

struct Polygon {
  std::array<Vec2, 4> at;
  int size = 0;
};

// A grid of cells, in each the half layers of the items that touch it; as differences along rows
// until fullest() adds them up.
struct Grid {
  int n;
  Vec2 slack;                      // in cells: how far a computed point may be from the true one
  std::vector<std::int32_t> step;  // n + 1 a row: count of a cell minus that of the one before
  std::vector<double> low, high;   // per row, of the figure at hand

  Grid(int cells, int faces, const Vec2& slack_in_cells)
      : n(cells), slack(slack_in_cells), low(size(cells)), high(size(cells)) {
    step.assign((size(cells) + 1) * size(cells) * size(faces), 0);
  }
  static std::size_t size(int k) { return static_cast<std::size_t>(k); }
  int cell(double x) const {  // that holds x; nearest one of the grid
    return static_cast<int>(std::min(std::max(x, 0.0), n - 1.0));
  }

  // Counts so many half layers in all cells that the convex figure, grown by the slack, can touch.
  // `edges` go round it, in any order.
  // The true figure lies within the slack of the computed one, point by point; so what of it is in
  // the row [j, j+1] lies within the slack of what the computed one has in [j - slack, j+1 +
  // slack].
  void add(std::span<const std::array<Vec2, 2>> edges, int face, int halves) {
    if (edges.empty()) return;
    Vec2 lo = edges[0][0], hi = lo;
    for (const auto& edge : edges) {
      for (const Vec2& p : edge) {
        lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
      }
    }
    if (lo.x - slack.x > n || lo.y - slack.y > n || hi.x + slack.x < 0 || hi.y + slack.y < 0)
      return;
    const int first_row = cell(lo.y - slack.y), last_row = cell(hi.y + slack.y);
    if (first_row == last_row) {
      add_row(face, first_row, lo.x, hi.x, halves);
      return;
    }
    for (int j = first_row; j <= last_row; ++j) {
      low[size(j)] = HUGE_VAL;
      high[size(j)] = -HUGE_VAL;
    }
    for (const auto& [a, b] : edges) widen_rows(a, b);
    for (int j = first_row; j <= last_row; ++j)
      add_row(face, j, low[size(j)], high[size(j)], halves);
  }

  void widen_rows(Vec2 a, Vec2 b) {
    if (a.y > b.y) std::swap(a, b);
    if (a.y - slack.y > n || b.y + slack.y < 0) return;
    const int first_row = cell(a.y - slack.y), last_row = cell(b.y + slack.y);
    const double rise = b.y - a.y;
    if (rise < kFlat) {
      for (int j = first_row; j <= last_row; ++j) {
        low[size(j)] = std::min({low[size(j)], a.x, b.x});
        high[size(j)] = std::max({high[size(j)], a.x, b.x});
      }
      return;
    }
    // Along the edge, what lies in the grown row.
    const double slope = (b.x - a.x) / rise, from = -slack.y - a.y, to = 1 + slack.y - a.y;
    for (int j = first_row; j <= last_row; ++j) {
      const double y0 = std::min(std::max(j + from, 0.0), rise),
                   y1 = std::min(std::max(j + to, 0.0), rise);
      const double x0 = a.x + y0 * slope, x1 = a.x + y1 * slope;
      low[size(j)] = std::min(low[size(j)], std::min(x0, x1));
      high[size(j)] = std::max(high[size(j)], std::max(x0, x1));
    }
  }

  void add_row(int face, int row, double from, double to, int halves) {
    if (from - slack.x > n || to + slack.x < 0 || from > to) return;
    std::int32_t* start = step.data() + (size(face) * size(n) + size(row)) * (size(n) + 1);
    start[cell(from - slack.x)] += halves;
    start[cell(to + slack.x) + 1] -= halves;
  }

  std::int32_t fullest() const {
    std::int32_t most = 0;
    for (std::size_t row = 0; row < step.size(); row += size(n) + 1) {
      std::int32_t count = 0;
      for (std::size_t k = row; k < row + size(n); ++k) most = std::max(most, count += step[k]);
    }
    return most;
  }
};

using Corners3 = std::array<Vec3, 3>;

Corners3 corners(const TriMesh& mesh, std::uint32_t t) {
  const Triangle& v = mesh.triangles[t];
  return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
}

// All corners beyond 3 touch |n| (sum norm) on one side along n: then no point of the triangle has
// all coordinates within touch of 0. One touch pays for the errors of r (kPlaceError S) and one for
// those of the dot products (2^-51 S |n|), amply.
bool apart_along(const Corners3& r, const Vec3& n, double touch) {
  const double least = 3 * touch * (std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z));
  int above = 0, below = 0;
  for (const Vec3& p : r) {
    const double d = n.x * p.x + n.y * p.y + n.z * p.z;
    above += d > least;
    below += d < -least;
  }
  return above == 3 || below == 3;
}

Vec3 cross(const Vec3& u, const Vec3& v) {
  return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

// True only if the triangle stays out of the cube |x|, |y|, |z| <= touch around the light: the
// planes that separate a triangle from a cube are along these normals.
bool clear_of_light(const Corners3& r, double touch) {
  constexpr double kAxes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const auto& a : kAxes) {
    if (apart_along(r, {a[0], a[1], a[2]}, touch)) return true;
  }
  if (apart_along(r, cross(r[1] - r[0], r[2] - r[0]), touch)) return true;
  for (std::size_t k = 0; k < 3; ++k) {
    for (const auto& a : kAxes) {
      if (apart_along(r, cross(r[(k + 1) % 3] - r[k], {a[0], a[1], a[2]}), touch)) return true;
    }
  }
  return false;
}

// What of the triangle has x >= near, seen on a face of the cube; x = sign * r[axis].
Polygon on_face(const Corners3& r, int axis, double sign, double near, int cells) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const double half = 0.5 * cells;
  Polygon p;
  const auto put = [&](double x, double y, double z) {
    p.at[static_cast<std::size_t>(p.size++)] = {(y / x + 1) * half, (z / x + 1) * half};
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = r[k], &b = r[(k + 1) % 3];
    const double xa = sign * a[axis], xb = sign * b[axis];
    if (xa >= near) put(xa, a[i], a[j]);
    if ((xa >= near) != (xb >= near)) {
      const double t = (xa - near) / (xa - xb);
      put(near, a[i] + t * (b[i] - a[i]), a[j] + t * (b[j] - a[j]));
    }
  }
  return p;
}

double largest_coordinate(const LayerItems& items) {
  double largest = 0;
  for (int k = 0; k < 3; ++k)
    largest = std::max({largest, std::fabs(items.lo[k]), std::fabs(items.hi[k])});
  return largest;
}

std::int32_t point_bound(const TriMesh& mesh, const LayerItems& items, const Light& light,
                         int cells) {
  double s = 0;
  for (int k = 0; k < 3; ++k) {
    s = std::max(s, std::max(std::fabs(items.lo[k]), std::fabs(items.hi[k])) * light.w +
                        std::fabs(light[k]));
  }
  static_assert(kPlaceError * 1024 < kTouch);
  const double touch = kTouch * s;
  Grid grid(cells, 6, Vec2(kPointSlack * 0.5 * cells));
  std::int32_t everywhere = 0;
  std::vector<Corners3> relative;          // an item's triangles
  std::vector<std::array<Vec2, 2>> edges;  // what of them is seen on a face
  for (std::size_t item = 0; item + 1 < items.first.size(); ++item) {
    relative.clear();
    for (std::uint32_t k = items.first[item]; k < items.first[item + 1]; ++k) {
      relative.push_back(corners(mesh, items.triangles[k]));
      for (Vec3& p : relative.back()) p = p * light.w - Vec3(light);
    }
    if (!std::all_of(relative.begin(), relative.end(),
                     [&](const Corners3& r) { return clear_of_light(r, touch); })) {
      everywhere += items.halves[item];
      continue;
    }
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2;
      const double sign = face % 2 == 0 ? 1 : -1;
      edges.clear();
      for (const Corners3& r : relative) {
        if (std::max({sign * r[0][axis], sign * r[1][axis], sign * r[2][axis]}) < touch / 2)
          continue;
        const Polygon p = on_face(r, axis, sign, touch / 2, cells);
        for (int k = 0; k < p.size; ++k) edges.push_back({p.at[k], p.at[(k + 1) % p.size]});
      }
      grid.add(edges, face, items.halves[item]);
    }
  }
  return everywhere + grid.fullest();
}

std::int32_t plane_bound(const TriMesh& mesh, const LayerItems& items, const Light& light,
                         int cells, double spread, const PartSilhouettes* outlines) {
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::fabs(light[k]) > std::fabs(light[axis])) axis = k;
  }
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const double di = light[i] / light[axis], dj = light[j] / light[axis];
  const auto seen = [&](const Vec3& p) { return Vec2(p[i] - p[axis] * di, p[j] - p[axis] * dj); };
  const double s = largest_coordinate(items);

  // All edges, item by item; of a convex part those of its outline, if there is one: they go round
  // its shadow.
  std::vector<std::array<Vec2, 2>> edges;
  std::vector<std::size_t> first{0};  // per item
  edges.reserve(3 * items.triangles.size());
  first.reserve(items.first.size());
  for (std::size_t item = 0; item + 1 < items.first.size(); ++item) {
    if (outlines != nullptr && items.convex_part[item] != kNoPart) {
      for (const SilhouetteEdge& e : outlines->of(items.convex_part[item]))
        edges.push_back({seen(mesh.positions[e.a]), seen(mesh.positions[e.b])});
    } else {
      for (std::uint32_t k = items.first[item]; k < items.first[item + 1]; ++k) {
        const Corners3 c = corners(mesh, items.triangles[k]);
        const Vec2 at[3] = {seen(c[0]), seen(c[1]), seen(c[2])};
        edges.insert(edges.end(), {{at[0], at[1]}, {at[1], at[2]}, {at[2], at[0]}});
      }
    }
    first.push_back(edges.size());
  }
  Vec2 lo(HUGE_VAL), hi(-HUGE_VAL);
  for (const auto& edge : edges) {
    lo = {std::min(lo.x, edge[0].x), std::min(lo.y, edge[0].y)};
    hi = {std::max(hi.x, edge[0].x), std::max(hi.y, edge[0].y)};
    lo = {std::min(lo.x, edge[1].x), std::min(lo.y, edge[1].y)};
    hi = {std::max(hi.x, edge[1].x), std::max(hi.y, edge[1].y)};
  }
  const Vec2 scale = {cells / std::max(hi.x - lo.x, kLeastExtent * s),
                      cells / std::max(hi.y - lo.y, kLeastExtent * s)};
  // Under another light a point is seen p_axis (d_i/d_axis - d'_i/d'_axis) farther: all by the same
  // as a point halfway between nearest and farthest, which is no matter, and by at most half the
  // depth times the spread. Scaling and interpolating rounds by some 2^-52 of `cells`.
  const double moved = (items.hi[axis] - items.lo[axis]) / 2 * spread * (1 + 0x1p-40);
  Grid grid(cells, 1, (2 * kPlaneError * s + moved) * scale + 0x1p-30);
  for (auto& [a, b] : edges) {
    a = (a - lo) * scale;
    b = (b - lo) * scale;
  }
  for (std::size_t item = 0; item + 1 < first.size(); ++item) {
    grid.add(std::span(edges).subspan(first[item], first[item + 1] - first[item]), 0,
             items.halves[item]);
  }
  return grid.fullest();
}

}  // namespace

LayerItems layer_items(const Parts& parts, std::span<const CastingSides> sides) {
  LayerItems items;
  const auto end_item = [&](int halves, std::uint32_t part) {
    items.convex_part.push_back(part);
    items.first.push_back(static_cast<std::uint32_t>(items.triangles.size()));
    items.halves.push_back(static_cast<std::uint8_t>(halves));
  };
  for (std::uint32_t p = 0; p < parts.parts.size(); ++p) {
    const Part& part = parts.parts[p];
    const CastingSides of = sides.empty() ? CastingSides::both : sides[p];
    if (of == CastingSides::none) continue;
    items.lo = glm::min(items.lo, part.lo);
    items.hi = glm::max(items.hi, part.hi);
    const int halves = of == CastingSides::one ? 1 : 2;
    for (const std::uint32_t t : part.triangles) {
      items.triangles.push_back(t);
      if (!part.convex) end_item(halves, kNoPart);
    }
    if (part.convex) end_item(2 * halves, p);
  }
  return items;
}

int layer_bound(const TriMesh& mesh, const LayerItems& items, const Light& light, int cells,
                double spread, const PartSilhouettes* outlines) {
  assert(1 <= cells && cells <= 1024 && spread >= 0);
  if (items.triangles.empty()) return 0;
  const std::int32_t halves = light.w == 0
                                  ? plane_bound(mesh, items, light, cells, spread, outlines)
                                  : point_bound(mesh, items, light, cells);
  return static_cast<int>(halves / 2);
}

bool near(const Light& light, const Light& other, double spread) {
  if (light == other) return true;
  if (light.w != 0 || other.w != 0) return false;
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::fabs(light[k]) > std::fabs(light[axis])) axis = k;
  }
  // The same direction, not the opposite one: rays that end at the caster are others then.
  if (!(light[axis] * other[axis] > 0)) return false;
  for (int k = 0; k < 3; ++k) {
    const double d = std::fabs(light[k] / light[axis] - other[k] / other[axis]);
    if (!(d <= spread * (1 - 0x1p-40) - 0x1p-50)) return false;  // rounding pays for itself
  }
  return true;
}

}  // namespace gnomon
