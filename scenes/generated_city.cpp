#include <scenes/generated_city.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <gnomon/core/place.h>
#include <gnomon/mesh/weld.h>
#include <scenes/random.h>

namespace gnomon::scenes {
namespace {

// The plan of the town, metres.
constexpr double kLot = 22, kStreet = 12;
constexpr int kLotsAcross = 6, kLotsDeep = 2;  // of a block
constexpr double kBlockX = kLotsAcross * kLot + kStreet, kBlockY = kLotsDeep * kLot + kStreet;
constexpr double kSunk = 1.0;  // buildings reach this far below the lowest ground beneath them
constexpr double kShellTriangles = 23.93;  // of a building, on average: measured

double millimetres(double x) { return std::round(x * 1000) / 1000; }

double terrain_height(double x, double y) {
  return 3.5 * std::sin(x / 190 + 0.4) * std::cos(y / 230) + 1.2 * std::sin((x + 2 * y) / 75);
}

struct Grid {  // of blocks, around the origin
  int across, deep;
  double x0() const { return -0.5 * across * kBlockX; }
  double y0() const { return -0.5 * deep * kBlockY; }
};

Grid grid_for(int buildings) {
  const double blocks = std::max(1.0, std::ceil(buildings / double(kLotsAcross * kLotsDeep)));
  Grid g;
  g.across = std::max(1, static_cast<int>(std::round(std::sqrt(blocks * kBlockY / kBlockX))));
  g.deep = static_cast<int>(std::ceil(blocks / g.across));
  return g;
}

// Cells of the terrain: about the size of a lot, over one block more than the town on each side.
struct Cells {
  int x, y;
};
Cells terrain_cells(const Grid& g) {
  return {(g.across + 2) * (kLotsAcross + 1), (g.deep + 2) * (kLotsDeep + 1)};
}

int building_count(const CityOptions& o) {
  if (o.triangles == 0) return std::max(0, o.buildings);
  int count = 1;
  for (int round = 0; round < 4;
       ++round) {  // the terrain's share depends on the count; it settles at once
    const Cells cells = terrain_cells(grid_for(count));
    const double left = static_cast<double>(o.triangles) - 2.0 * cells.x * cells.y;
    count = std::max(1, static_cast<int>(left / kShellTriangles));
  }
  return count;
}

// Adds shells to the scene; local coordinates are turned and moved to the lot.
class Builder {
 public:
  explicit Builder(Scene& scene) : scene_(scene) {}

  void place(double x, double y, double angle, std::uint32_t surface) {
    x_ = x;
    y_ = y;
    cos_ = std::cos(angle);
    sin_ = std::sin(angle);
    surface_ = surface;
  }
  Vec2 world(double x, double y) const {
    return {x_ + cos_ * x - sin_ * y, y_ + sin_ * x + cos_ * y};
  }
  std::uint32_t vertex(double x, double y, double z) {
    const Vec2 w = world(x, y);
    return plain_vertex(w.x, w.y, z);
  }
  std::uint32_t plain_vertex(double x, double y, double z) {
    scene_.mesh.positions.push_back({millimetres(x), millimetres(y), millimetres(z)});
    return static_cast<std::uint32_t>(scene_.mesh.positions.size() - 1);
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    scene_.mesh.triangles.push_back({a, b, c});
    scene_.surface_of.push_back(surface_);
  }
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }

  enum class Roof { flat, gabled, hipped };

  // A house over the rectangle [x0,x1] x [y0,y1] from z0 to the eaves z1 and the ridge z2 along x.
  // Closed, wound outwards.
  void house(double x0, double y0, double x1, double y1, double z0, double z1, double z2,
             Roof roof) {
    std::array<std::uint32_t, 4> low, high;
    const std::array<Vec2, 4> corner = {Vec2(x0, y0), Vec2(x1, y0), Vec2(x1, y1), Vec2(x0, y1)};
    for (std::size_t k = 0; k < 4; ++k) {
      low[k] = vertex(corner[k].x, corner[k].y, z0);
      high[k] = vertex(corner[k].x, corner[k].y, z1);
    }
    for (std::size_t k = 0; k < 4; ++k) quad(low[k], low[(k + 1) % 4], high[(k + 1) % 4], high[k]);
    quad(low[3], low[2], low[1], low[0]);
    if (roof == Roof::flat) {
      quad(high[0], high[1], high[2], high[3]);
      return;
    }
    const double inset = roof == Roof::hipped ? 0.4 * std::min(y1 - y0, x1 - x0) : 0;
    const std::uint32_t west = vertex(x0 + inset, (y0 + y1) / 2, z2),
                        east = vertex(x1 - inset, (y0 + y1) / 2, z2);
    quad(high[0], high[1], east, west);
    quad(high[2], high[3], west, east);
    triangle(high[1], high[2], east);
    triangle(high[3], high[0], west);
  }

 private:
  Scene& scene_;
  double x_ = 0, y_ = 0, cos_ = 1, sin_ = 0;
  std::uint32_t surface_ = 0;
};

void add_building(Builder& b, Random& random, double x, double y) {
  const double kind = random.between(0, 1);
  const bool tower = kind < 0.25;
  const double half_x = random.between(5, tower ? 9 : 7.5),
               half_y = random.between(4, tower ? 8 : 5.5);
  double ground_low = terrain_height(x, y), ground_high = ground_low;
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      const Vec2 w = b.world(sx * half_x, sy * half_y);
      ground_low = std::min(ground_low, terrain_height(w.x, w.y));
      ground_high = std::max(ground_high, terrain_height(w.x, w.y));
    }
  }
  const double z0 = ground_low - kSunk;
  if (tower) {
    const double height =
        random.between(0, 1) < 0.1 ? random.between(30, 60) : random.between(9, 24);
    b.house(-half_x, -half_y, half_x, half_y, z0, ground_high + height, 0, Builder::Roof::flat);
    if (random.between(0, 1) < 0.6) {  // the lift's machine room
      b.house(-2, -1.5, 1.5, 1.5, ground_high + height - 0.5, ground_high + height + 3, 0,
              Builder::Roof::flat);
    }
    return;
  }
  const double eaves = ground_high + random.between(3, 9);
  const double ridge = eaves + half_y * random.between(0.6, 1.2);
  b.house(-half_x, -half_y, half_x, half_y, z0, eaves, ridge,
          kind < 0.7 ? Builder::Roof::gabled : Builder::Roof::hipped);
  if (random.between(0, 1) < 0.5) {  // a chimney
    const double cx = random.between(-0.6, 0.6) * half_x, cy = random.between(-0.5, 0.5) * half_y;
    b.house(cx - 0.4, cy - 0.4, cx + 0.4, cy + 0.4, eaves, ridge + 0.8, 0, Builder::Roof::flat);
  }
  if (random.between(0, 1) < 0.3) {  // an annex
    b.house(half_x - 0.5, -half_y + 0.7, half_x + 2.5, half_y - 1.5, z0, ground_high + 2.8, 0,
            Builder::Roof::flat);
  }
}

void add_terrain(Builder& b, const Grid& grid) {
  const int nx = terrain_cells(grid).x, ny = terrain_cells(grid).y;
  const double dx = (grid.across + 2) * kBlockX / nx, dy = (grid.deep + 2) * kBlockY / ny;
  const double x0 = grid.x0() - kBlockX, y0 = grid.y0() - kBlockY;
  std::uint32_t first = 0;
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      const double x = x0 + i * dx, y = y0 + j * dy;
      const std::uint32_t v = b.plain_vertex(x, y, terrain_height(x, y));
      if (i == 0 && j == 0) first = v;
    }
  }
  const auto at = [&](int i, int j) {
    return first + static_cast<std::uint32_t>(j * (nx + 1) + i);
  };
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) b.quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
}

}  // namespace

Bounds2 city_bounds(const CityOptions& options) {
  const Grid grid = grid_for(building_count(options));
  const double half = 0.5 * std::max(grid.across * kBlockX, grid.deep * kBlockY);
  return {-half, -half, half, half};
}

Scene generated_city(const CityOptions& options) {
  const int count = building_count(options);
  const Grid grid = grid_for(count);
  Scene scene;
  scene.surfaces.push_back(
      {.object = "terrain", .group = "TINRelief", .material = {}, .semantic = "TINRelief"});
  Builder b(scene);
  add_terrain(b, grid);
  Random random{options.seed};
  constexpr double kTurn = 5 * kDegree;  // blocks and houses do not all stand in line
  for (int k = 0; k < count; ++k) {
    const int lot = k % (kLotsAcross * kLotsDeep), block = k / (kLotsAcross * kLotsDeep);
    const double x = grid.x0() + (block % grid.across) * kBlockX + kStreet / 2 +
                     (lot % kLotsAcross + 0.5) * kLot;
    const double y = grid.y0() + (block / grid.across) * kBlockY + kStreet / 2 +
                     (lot / kLotsAcross + 0.5) * kLot;
    scene.surfaces.push_back({.object = "building " + std::to_string(k),
                              .group = "Building",
                              .material = {},
                              .semantic = {}});
    const double angle = random.between(-kTurn, kTurn) + (random.between(0, 1) < 0.5 ? kPi / 2 : 0);
    // In this order: compilers differ in which of two arguments they evaluate first.
    const double at_y = y + random.between(-1, 1), at_x = x + random.between(-1, 1);
    b.place(at_x, at_y, angle, static_cast<std::uint32_t>(k + 1));
    add_building(b, random, x, y);
  }
  weld(scene.mesh, scene.surface_of);
  return scene;
}

}  // namespace gnomon::scenes
