// The ground of real cities: buildings neither float nor is there ground inside them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <gnomon/io/footprints.h>
#include <gnomon/io/load_scene.h>

namespace gnomon {
namespace {

using Corners = std::array<Vec3, 3>;

double area_from_above(const Corners& t) {
  return 0.5 * ((t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x));
}

// Triangles by the cells of a grid of 20 m that their boxes meet.
class Map {
 public:
  explicit Map(std::vector<Corners> triangles) : triangles_(std::move(triangles)) {
    for (std::size_t k = 0; k < triangles_.size(); ++k) {
      const Corners& t = triangles_[k];
      const auto [x0, x1] = std::minmax({t[0].x, t[1].x, t[2].x});
      const auto [y0, y1] = std::minmax({t[0].y, t[1].y, t[2].y});
      for (int x = cell(x0); x <= cell(x1); ++x) {
        for (int y = cell(y0); y <= cell(y1); ++y) cells_[{x, y}].push_back(k);
      }
    }
  }
  // Heights of the triangles over (x, y).
  std::vector<double> at(double x, double y) const {
    std::vector<double> heights;
    const auto found = cells_.find({cell(x), cell(y)});
    if (found == cells_.end()) return heights;
    for (const std::size_t k : found->second) {
      const Corners& t = triangles_[k];
      const double whole = area_from_above(t);
      if (whole == 0) continue;
      const Vec3 p(x, y, 0);
      const double a = area_from_above({p, t[1], t[2]}) / whole;
      const double b = area_from_above({t[0], p, t[2]}) / whole;
      if (a < 0 || b < 0 || a + b > 1) continue;
      heights.push_back(a * t[0].z + b * t[1].z + (1 - a - b) * t[2].z);
    }
    return heights;
  }

 private:
  static int cell(double c) { return static_cast<int>(std::floor(c / 20)); }
  std::vector<Corners> triangles_;
  std::map<std::pair<int, int>, std::vector<std::size_t>> cells_;
};

struct Stand {
  std::size_t samples = 0;   // points just outside of a footprint's edge
  std::size_t floating = 0;  // of these, more than a millimetre above the ground
  std::size_t skirted = 0;   // of the floating ones, those with a skirt that closes the gap
  std::size_t covered = 0;   // more than a millimetre below the ground: next to a higher neighbour
  std::size_t gaps = 0;      // points of the extent with neither ground nor footprint
  std::size_t overlaps = 0;  // points of the extent with both
  double longest_steep = 0;  // longest side of a ground triangle steeper than 45 degrees that is
                             // neither upright nor in a crack between buildings (metres)
};

constexpr double kMillimetre = 1e-3;
// Points "just outside" lie so far from the edge (metres): the ground may be steep there.
constexpr double kBeside = 1e-7;
// A crack between two buildings narrower than this is not looked into (metres).
constexpr double kCrack = 0.01;

// How the buildings of a model stand on the ground made for it.
Stand stand_of(const std::filesystem::path& path) {
  LoadOptions options;
  options.ground = "none";
  Result<LoadedScene> loaded = load_scene({path}, options);
  EXPECT_TRUE(loaded) << (loaded ? "" : loaded.error().message);
  if (!loaded) return {};
  Scene scene = std::move(loaded).value().scene;
  const Footprints feet = find_footprints(scene);
  const std::size_t before = scene.mesh.triangles.size();
  GroundOptions ground_options;
  ground_options.extent = {-1000, -1000, 1000, 1000};
  const Result<GroundReport> ground = add_ground(scene, ground_options);
  EXPECT_TRUE(ground) << (ground ? "" : ground.error().message);
  EXPECT_TRUE(ground && ground.value().kind == "through ground surfaces");

  Stand stand;
  std::vector<Corners> flat, upright;
  for (std::size_t t = before; t < scene.mesh.triangles.size(); ++t) {
    const Triangle& v = scene.mesh.triangles[t];
    const Corners c = {scene.mesh.positions[v[0]], scene.mesh.positions[v[1]],
                       scene.mesh.positions[v[2]]};
    const int up = turn(c[0], c[1], c[2]);
    EXPECT_GE(up, 0) << "a ground triangle that looks down";
    (up > 0 ? flat : upright).push_back(c);
    double side = 0;
    for (int k = 0; k < 3; ++k) {
      side = std::max(side, std::hypot(c[k].x - c[(k + 1) % 3].x, c[k].y - c[(k + 1) % 3].y));
    }
    const Vec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
    if (std::hypot(n.x, n.y) > n.z && n.z > kCrack * side) {
      stand.longest_steep = std::max(stand.longest_steep, side);
    }
  }
  const Map map(flat), closed(feet.closed);

  for (double x = -999.3; x < 1000; x += 7.1) {
    for (double y = -999.1; y < 1000; y += 6.7) {
      const bool on_ground = !map.at(x, y).empty(), inside = !closed.at(x, y).empty();
      stand.gaps += !on_ground && !inside;
      stand.overlaps += on_ground && inside;
    }
  }

  for (const Corners& t : feet.closed) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = t[k], &b = t[(k + 1) % 3];
      const double length = std::hypot(b.x - a.x, b.y - a.y);
      if (length < kCrack) continue;
      const Vec2 right((b.y - a.y) / length, -(b.x - a.x) / length);
      for (const double s : {-0.75, -0.5, -0.25, 0.25, 0.5, 0.75}) {
        // Outside is where the ground is; edges between two triangles of a footprint have none on
        // either side.
        const Vec2 out = s < 0 ? -right : right;
        const Vec3 p = a + std::abs(s) * (b - a);
        const auto heights = map.at(p.x + kBeside * out.x, p.y + kBeside * out.y);
        if (heights.empty()) continue;
        if (!closed.at(p.x + kCrack * out.x, p.y + kCrack * out.y).empty()) continue;
        ++stand.samples;
        const double z = *std::max_element(heights.begin(), heights.end());
        stand.covered += z > p.z + kMillimetre;
        if (z >= p.z - kMillimetre) continue;
        // A lower footprint may end here as well, as a podium's below a tower: that one is on the
        // ground.
        const auto inside = closed.at(p.x - kBeside * out.x, p.y - kBeside * out.y);
        if (!inside.empty() &&
            *std::min_element(inside.begin(), inside.end()) < p.z - kMillimetre) {
          continue;
        }
        ++stand.floating;
        const auto in_plane = [&](const Vec3& q) {
          return std::abs((q.x - a.x) * right.x + (q.y - a.y) * right.y) < 1e-5;
        };
        stand.skirted += std::any_of(upright.begin(), upright.end(), [&](const Corners& w) {
          return in_plane(w[0]) && in_plane(w[1]) && in_plane(w[2]);
        });
      }
    }
  }
  return stand;
}

std::filesystem::path city(const std::string& name) {
  return std::filesystem::path(GNOMON_DATA) / "city" / name;
}

TEST(GroundOfCities, HoldsViennasBuildingsOnTheirSlope) {
  const Stand s = stand_of(std::filesystem::path(GNOMON_SCENES) / "vienna" / "vienna.city.jsonl");
  EXPECT_GT(s.samples, 10000u);
  EXPECT_EQ(s.floating, s.skirted);
  EXPECT_LT(s.floating, s.samples / 100);      // parts more than a storey above their neighbour
  EXPECT_LT(s.covered, s.samples * 15 / 100);  // next to a higher neighbour
  EXPECT_EQ(s.gaps, 0u);
  EXPECT_EQ(s.overlaps, 0u);
  EXPECT_LT(s.longest_steep, 12);  // without rings around the footprints: 65 m
  RecordProperty("samples", static_cast<int>(s.samples));
  RecordProperty("covered", static_cast<int>(s.covered));
  RecordProperty("floating", static_cast<int>(s.floating));
}

TEST(GroundOfCities, HoldsOtherCitiesBuildings) {
  if (!std::filesystem::exists(city("3-20-DELFSHAVEN.city.json"))) {
    GTEST_SKIP() << "skipped: the larger models are not there";
  }
  for (const char* name : {"3-20-DELFSHAVEN.city.json", "denhaag_random_5.city.jsonl",
                           "multi_lod.json", "tile_901_trimmed.jsonl", "zurich_subset_lod2.json"}) {
    const Stand s = stand_of(city(name));
    EXPECT_GT(s.samples, 100u) << name;
    EXPECT_EQ(s.floating, 0u) << name;
    EXPECT_LT(s.covered, s.samples * 25 / 100) << name;
    EXPECT_EQ(s.gaps, 0u) << name;
    EXPECT_EQ(s.overlaps, 0u) << name;
  }
}

}  // namespace
}  // namespace gnomon
