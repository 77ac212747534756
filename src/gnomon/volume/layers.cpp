#include <gnomon/volume/layers.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

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

struct Polygon {
  std::array<Vec2, 4> at;
  int size = 0;
};

// A grid of cells, in each the number of items that touch it.
struct Grid {
  int n;
  double slack;  // in cells: how far a computed point may be from the true one
  std::vector<std::uint32_t> count, stamp;  // stamp: 1 + the last item that was counted here
  std::vector<double> low, high;            // per row, of the polygon at hand

  Grid(int cells, int faces, double slack_in_cells)
      : n(cells), slack(slack_in_cells), low(size(1)), high(size(1)) {
    count.assign(size(1) * size(1) * static_cast<std::size_t>(faces), 0);
    stamp = count;
  }
  std::size_t size(int k) const {
    return static_cast<std::size_t>(n) * static_cast<std::size_t>(k);
  }
  int cell(double x) const {  // that holds x; nearest one of the grid
    return static_cast<int>(std::clamp(std::floor(x), 0.0, static_cast<double>(n - 1)));
  }

  // Counts item once in all cells that the convex polygon, grown by the slack, can touch.
  // The true figure lies within the slack of the computed one, point by point; so what of it is in
  // the row [j, j+1] lies within the slack of what the computed one has in [j - slack, j+1 +
  // slack].
  void add(const Polygon& p, int face, std::uint32_t item) {
    if (p.size == 0) return;
    Vec2 lo = p.at[0], hi = p.at[0];
    for (int k = 1; k < p.size; ++k) {
      lo = {std::min(lo.x, p.at[k].x), std::min(lo.y, p.at[k].y)};
      hi = {std::max(hi.x, p.at[k].x), std::max(hi.y, p.at[k].y)};
    }
    if (lo.x - slack > n || lo.y - slack > n || hi.x + slack < 0 || hi.y + slack < 0) return;
    const int first_row = cell(lo.y - slack), last_row = cell(hi.y + slack);
    if (first_row == last_row) {
      add_row(face, first_row, lo.x, hi.x, item);
      return;
    }
    for (int j = first_row; j <= last_row; ++j) {
      low[static_cast<std::size_t>(j)] = HUGE_VAL;
      high[static_cast<std::size_t>(j)] = -HUGE_VAL;
    }
    for (int k = 0; k < p.size; ++k) widen_rows(p.at[k], p.at[(k + 1) % p.size]);
    for (int j = first_row; j <= last_row; ++j) {
      add_row(face, j, low[static_cast<std::size_t>(j)], high[static_cast<std::size_t>(j)], item);
    }
  }

  void widen_rows(Vec2 a, Vec2 b) {
    if (a.y > b.y) std::swap(a, b);
    if (a.y - slack > n || b.y + slack < 0) return;
    const int first_row = cell(a.y - slack), last_row = cell(b.y + slack);
    const double rise = b.y - a.y;
    for (int j = first_row; j <= last_row; ++j) {
      double from = 0, to = 1;  // along the edge, what lies in the grown row
      if (rise > 0) {
        from = std::clamp((j - slack - a.y) / rise, 0.0, 1.0);
        to = std::clamp((j + 1 + slack - a.y) / rise, 0.0, 1.0);
      }
      const double x0 = a.x + from * (b.x - a.x), x1 = a.x + to * (b.x - a.x);
      double &l = low[static_cast<std::size_t>(j)], &h = high[static_cast<std::size_t>(j)];
      l = std::min({l, x0, x1});
      h = std::max({h, x0, x1});
    }
  }

  void add_row(int face, int row, double from, double to, std::uint32_t item) {
    if (from - slack > n || to + slack < 0 || from > to) return;
    const std::size_t start = (size(face) + static_cast<std::size_t>(row)) * size(1);
    for (std::size_t k = start + static_cast<std::size_t>(cell(from - slack)),
                     end = start + static_cast<std::size_t>(cell(to + slack));
         k <= end; ++k) {
      if (stamp[k] == item + 1) continue;
      stamp[k] = item + 1;
      ++count[k];
    }
  }

  int fullest() const { return static_cast<int>(*std::max_element(count.begin(), count.end())); }
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

double largest_coordinate(const TriMesh& mesh, const LayerItems& items, int k) {
  double largest = 0;
  for (const std::uint32_t t : items.triangles) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      largest = std::max(largest, std::fabs(mesh.positions[v][k]));
    }
  }
  return largest;
}

int point_bound(const TriMesh& mesh, const LayerItems& items, const Light& light, int cells) {
  double s = 0;
  for (int k = 0; k < 3; ++k) {
    s = std::max(s, largest_coordinate(mesh, items, k) * light.w + std::fabs(light[k]));
  }
  static_assert(kPlaceError * 1024 < kTouch);
  const double touch = kTouch * s;
  Grid grid(cells, 6, kPointSlack * 0.5 * cells);
  int everywhere = 0;
  for (std::uint32_t item = 0; item + 1 < items.first.size(); ++item) {
    for (std::uint32_t k = items.first[item]; k < items.first[item + 1]; ++k) {
      Corners3 r = corners(mesh, items.triangles[k]);
      for (Vec3& p : r) p = p * light.w - Vec3(light);
      if (!clear_of_light(r, touch)) {
        ++everywhere;  // what was counted in cells before stays: once too often, no harm
        break;
      }
      for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const double sign = face % 2 == 0 ? 1 : -1;
        if (std::max({sign * r[0][axis], sign * r[1][axis], sign * r[2][axis]}) < touch / 2) {
          continue;
        }
        grid.add(on_face(r, axis, sign, touch / 2, cells), face, item);
      }
    }
  }
  return everywhere + grid.fullest();
}

int plane_bound(const TriMesh& mesh, const LayerItems& items, const Light& light, int cells) {
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::fabs(light[k]) > std::fabs(light[axis])) axis = k;
  }
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const double di = light[i] / light[axis], dj = light[j] / light[axis];
  const auto seen = [&](const Vec3& p) { return Vec2(p[i] - p[axis] * di, p[j] - p[axis] * dj); };
  double s = 0;
  for (int k = 0; k < 3; ++k) s = std::max(s, largest_coordinate(mesh, items, k));
  Vec2 lo(HUGE_VAL), hi(-HUGE_VAL);
  for (const std::uint32_t t : items.triangles) {
    for (const Vec3& p : corners(mesh, t)) {
      const Vec2 q = seen(p);
      lo = {std::min(lo.x, q.x), std::min(lo.y, q.y)};
      hi = {std::max(hi.x, q.x), std::max(hi.y, q.y)};
    }
  }
  const Vec2 scale = {cells / std::max(hi.x - lo.x, kLeastExtent * s),
                      cells / std::max(hi.y - lo.y, kLeastExtent * s)};
  // Scaling and interpolating rounds by some 2^-52 of `cells`.
  Grid grid(cells, 1, 2 * kPlaneError * s * std::max(scale.x, scale.y) + 0x1p-30);
  for (std::uint32_t item = 0; item + 1 < items.first.size(); ++item) {
    for (std::uint32_t k = items.first[item]; k < items.first[item + 1]; ++k) {
      Polygon p;
      p.size = 3;
      const Corners3 c = corners(mesh, items.triangles[k]);
      for (std::size_t m = 0; m < 3; ++m) p.at[m] = (seen(c[m]) - lo) * scale;
      grid.add(p, 0, item);
    }
  }
  return grid.fullest();
}

}  // namespace

LayerItems layer_items(const Parts& parts, const std::vector<std::int8_t>& sides,
                       const std::vector<std::uint8_t>& cap) {
  LayerItems items;
  const auto end_item = [&] {
    const auto end = static_cast<std::uint32_t>(items.triangles.size());
    if (end != items.first.back()) items.first.push_back(end);
  };
  for (const Part& part : parts.parts) {
    for (const int side : {1, -1}) {
      for (const std::uint32_t t : part.triangles) {
        if (sides[t] != side || (!cap.empty() && cap[t] == 0)) continue;
        items.triangles.push_back(t);
        if (!part.convex) end_item();
      }
      end_item();
    }
  }
  return items;
}

int layer_bound(const TriMesh& mesh, const LayerItems& items, const Light& light, int cells) {
  assert(1 <= cells && cells <= 1024);
  if (items.triangles.empty()) return 0;
  return light.w == 0 ? plane_bound(mesh, items, light, cells)
                      : point_bound(mesh, items, light, cells);
}

}  // namespace gnomon
