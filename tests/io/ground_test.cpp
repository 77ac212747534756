#include <gnomon/io/ground.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <gnomon/io/footprints.h>

namespace gnomon {
namespace {

constexpr double kMillimetre = 1e-3;

std::uint32_t add_surface(Scene& s, const std::string& object, const std::string& group,
                          const std::string& semantic) {
  Surface surface;
  surface.object = object;
  surface.group = group;
  surface.semantic = semantic;
  surface.city = true;
  if (const auto slash = object.find('/'); slash != std::string::npos) {
    surface.whole = static_cast<std::uint32_t>(slash);
  }
  s.surfaces.push_back(surface);
  return static_cast<std::uint32_t>(s.surfaces.size() - 1);
}

void add_quad(Scene& s, std::uint32_t surface, const std::array<Vec3, 4>& q) {
  const auto base = static_cast<std::uint32_t>(s.mesh.positions.size());
  s.mesh.positions.insert(s.mesh.positions.end(), q.begin(), q.end());
  s.mesh.triangles.push_back({base, base + 1, base + 2});
  s.mesh.triangles.push_back({base, base + 2, base + 3});
  s.surface_of.insert(s.surface_of.end(), 2, surface);
}

// A box over `foot` (counter-clockwise from above) whose flat roof lies `height` above its highest
// corner.
void add_box(Scene& s, const std::string& object, const std::array<Vec3, 4>& foot, double height,
             const std::string& bottom = "GroundSurface", const std::string& group = "Building") {
  double top = -1e300;
  for (const Vec3& p : foot) top = std::max(top, p.z + height);
  const auto up = [&](const Vec3& p) { return Vec3(p.x, p.y, top); };
  if (bottom != "none") {
    add_quad(s, add_surface(s, object, group, bottom), {foot[3], foot[2], foot[1], foot[0]});
  }
  add_quad(s, add_surface(s, object, group, "RoofSurface"),
           {up(foot[0]), up(foot[1]), up(foot[2]), up(foot[3])});
  const std::uint32_t wall = add_surface(s, object, group, "WallSurface");
  for (int k = 0; k < 4; ++k) {
    const Vec3 &a = foot[k], &b = foot[(k + 1) % 4];
    add_quad(s, wall, {a, b, up(b), up(a)});
  }
}

std::array<Vec3, 4> rectangle(double x0, double y0, double x1, double y1, double z) {
  return {Vec3(x0, y0, z), Vec3(x1, y0, z), Vec3(x1, y1, z), Vec3(x0, y1, z)};
}

// A rectangle w x d turned by `angle`, level at z.
std::array<Vec3, 4> turned(double x, double y, double w, double d, double angle, double z) {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto at = [&](double u, double v) { return Vec3(x + c * u - s * v, y + s * u + c * v, z); };
  return {at(0, 0), at(w, 0), at(w, d), at(0, d)};
}

GroundReport ground_of(Scene& s, const Bounds2& extent, const std::string& mode = "auto") {
  GroundOptions options;
  options.mode = mode;
  options.extent = extent;
  Result<GroundReport> r = add_ground(s, options);
  EXPECT_TRUE(r) << (r ? "" : r.error().message);
  return r ? r.value() : GroundReport{};
}

bool is_ground(const Scene& s, std::size_t t) {
  return s.surfaces[s.surface_of[t]].semantic == "Ground";
}

std::array<Vec3, 3> corners(const Scene& s, std::size_t t) {
  const Triangle& v = s.mesh.triangles[t];
  return {s.mesh.positions[v[0]], s.mesh.positions[v[1]], s.mesh.positions[v[2]]};
}

double area_from_above(const std::array<Vec3, 3>& t) {
  return 0.5 * ((t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x));
}

double ground_area(const Scene& s) {
  double sum = 0;
  for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) {
    if (!is_ground(s, t)) continue;
    const double a = area_from_above(corners(s, t));
    EXPECT_GE(a, -1e-9) << "a ground triangle that looks down";
    sum += a;
  }
  return sum;
}

// Lowest and highest ground over p (skirts included): empty where there is none.
std::optional<std::array<double, 2>> ground_at(const Scene& s, double x, double y) {
  std::optional<std::array<double, 2>> found;
  for (std::size_t k = 0; k < s.mesh.triangles.size(); ++k) {
    if (!is_ground(s, k)) continue;
    const auto t = corners(s, k);
    const double whole = area_from_above(t);
    if (whole <= 1e-9) continue;
    const Vec3 p(x, y, 0);
    const double a = area_from_above({p, t[1], t[2]}) / whole;
    const double b = area_from_above({t[0], p, t[2]}) / whole;
    const double c = 1 - a - b;
    if (a < 0 || b < 0 || c < 0) continue;
    const double z = a * t[0].z + b * t[1].z + c * t[2].z;
    if (!found) found = {z, z};
    found = {std::min((*found)[0], z), std::max((*found)[1], z)};
  }
  return found;
}

// How far the edge from a to b stands off the ground a tenth of a millimetre beside it (to its
// right), at 9 points of it, at most.
double gap_beside(const Scene& s, const Vec3& a, const Vec3& b) {
  const Vec2 d(b.x - a.x, b.y - a.y);
  const double length = std::hypot(d.x, d.y);
  double worst = 0;
  for (int k = 1; k <= 9; ++k) {
    const Vec3 p = a + (k / 10.0) * (b - a);
    const auto z = ground_at(s, p.x + 1e-4 * d.y / length, p.y - 1e-4 * d.x / length);
    if (!z) return std::numeric_limits<double>::infinity();
    worst = std::max({worst, std::abs((*z)[0] - p.z), std::abs((*z)[1] - p.z)});
  }
  return worst;
}

double area(const Bounds2& b) { return (b.x1 - b.x0) * (b.y1 - b.y0); }

// Fifteen buildings on a slope of 1 in 10, each with a level bottom, turned every which way.
struct Slope {
  Scene scene;
  std::vector<std::array<Vec3, 4>> feet;
  double footprint = 0;
};
Slope slope() {
  Slope s;
  for (int k = 0; k < 15; ++k) {
    const double x = 40.0 * (k % 5), y = 37.0 * (k / 5);
    s.feet.push_back(turned(x, y, 12 + k % 3, 9 + k % 4, 0.3 * k, 200 + 0.1 * x));
    s.footprint += (12 + k % 3) * (9 + k % 4);
    add_box(s.scene, std::to_string(k), s.feet.back(), 8);
  }
  return s;
}

TEST(Ground, StandsBuildingsOnASlopeNeitherAboveNorBelow) {
  Slope s = slope();
  const GroundReport report = ground_of(s.scene, {-100, -100, 300, 200});
  EXPECT_EQ(report.kind, "through ground surfaces");
  for (const auto& foot : s.feet) {
    for (int k = 0; k < 4; ++k) {
      EXPECT_LT(gap_beside(s.scene, foot[k], foot[(k + 1) % 4]), kMillimetre);
    }
  }
}

TEST(Ground, CoversTheExtentButForTheFootprints) {
  Slope s = slope();
  const Bounds2 extent{-150, -120, 330, 260};
  ground_of(s.scene, extent);
  EXPECT_NEAR(ground_area(s.scene) + s.footprint, area(extent), 1e-6 * area(extent));
  EXPECT_FALSE(ground_at(s.scene, s.feet[0][0].x + 6, s.feet[0][0].y + 4));  // under a building
}

TEST(Ground, TakesItsVerticesFromTheBuildingsBitByBit) {
  Slope s = slope();
  ground_of(s.scene, {-100, -100, 300, 200});
  std::set<std::array<double, 3>> ground;
  for (std::size_t t = 0; t < s.scene.mesh.triangles.size(); ++t) {
    if (!is_ground(s.scene, t)) continue;
    for (const Vec3& p : corners(s.scene, t)) ground.insert({p.x, p.y, p.z});
  }
  for (const auto& foot : s.feet) {
    for (const Vec3& p : foot) EXPECT_TRUE(ground.count({p.x, p.y, p.z}));
  }
}

TEST(Ground, StaysFlatOnAFlatSite) {
  Scene s;
  add_box(s, "a", turned(0, 0, 20, 10, 0.2, 31.25), 9);
  add_box(s, "b", turned(50, 10, 20, 10, 1.2, 31.25), 9);
  ground_of(s, {-500, -500, 500, 500});
  for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) {
    if (!is_ground(s, t)) continue;
    for (const Vec3& p : corners(s, t)) EXPECT_EQ(p.z, 31.25);
  }
}

TEST(Ground, IsLevelBeyondTheModel) {
  Slope s = slope();
  ground_of(s.scene, {-2000, -2000, 2000, 2000});
  for (const double y : {-1500.0, -400.0, 40.0, 900.0}) {
    const auto near = ground_at(s.scene, 400.1, y), far = ground_at(s.scene, 1999, y);
    ASSERT_TRUE(near && far);
    EXPECT_DOUBLE_EQ((*near)[0], (*far)[0]) << y;
    EXPECT_NEAR((*far)[0], 216, 1) << y;  // the eastern buildings' height
  }
  EXPECT_NEAR((*ground_at(s.scene, -1999, -1999))[0], 200, 1);  // the western ones'
}

TEST(Ground, ReachesAtLeastBelowTheModel) {
  Slope s = slope();
  ground_of(s.scene, {0, 0, 1, 1});
  for (const auto& foot : s.feet) EXPECT_LT(gap_beside(s.scene, foot[0], foot[1]), kMillimetre);
}

// Two houses share a party wall; the eastern one stands `step` higher.
Scene stepped_row(double step) {
  Scene s;
  add_box(s, "low", rectangle(0, 0, 10, 10, 0), 8);
  add_box(s, "high", rectangle(10, 0, 20, 10, step), 8);
  return s;
}

// Area of the upright ground triangles in the plane y = 0.
double skirt_area(const Scene& s) {
  double sum = 0;
  for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) {
    if (!is_ground(s, t)) continue;
    const auto c = corners(s, t);
    if (c[0].y != 0 || c[1].y != 0 || c[2].y != 0) continue;
    sum +=
        std::abs((c[1].x - c[0].x) * (c[2].z - c[0].z) - (c[1].z - c[0].z) * (c[2].x - c[0].x)) / 2;
  }
  return sum;
}

TEST(Ground, MeetsTheHigherOfTwoNeighboursOnASlopeAndNeverLeavesOneInTheAir) {
  Scene s = stepped_row(1);
  const Bounds2 extent{-200, -200, 200, 200};
  ground_of(s, extent);
  EXPECT_NEAR(ground_area(s) + 200, area(extent), 1e-3);
  EXPECT_LT(gap_beside(s, {10, 0, 1}, {20, 0, 1}), kMillimetre);
  EXPECT_LT(gap_beside(s, {20, 0, 1}, {20, 10, 1}), kMillimetre);
  EXPECT_LT(gap_beside(s, {0, 10, 0}, {0, 0, 0}), kMillimetre);
  EXPECT_LT(gap_beside(s, {0, 0, 0}, {10, 0, 1}), kMillimetre);  // covers a wedge of the low wall
  EXPECT_EQ(skirt_area(s), 0);
}

// Distance of the farthest corner of a ground triangle steeper than 45 degrees from (x, y); skirts
// aside.
double reach_of_steepness(const Scene& s, double x, double y) {
  double reach = 0;
  for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) {
    if (!is_ground(s, t)) continue;
    const auto c = corners(s, t);
    if (turn(c[0], c[1], c[2]) == 0) continue;
    const Vec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
    if (std::hypot(n.x, n.y) <= n.z) continue;
    for (const Vec3& p : c) reach = std::max(reach, std::hypot(p.x - x, p.y - y));
  }
  return reach;
}

TEST(Ground, EndsAStepBetweenCloseCornersWithinEightMetresHoweverFarTheNextBuildingIs) {
  // Two houses a crack of 2 cm apart, as they stand in Vienna, and others far to the south.
  Scene s;
  add_box(s, "low", rectangle(0, 0, 10, 10, 0), 8);
  add_box(s, "high", rectangle(10.02, 0, 20, 10, 1.45), 8);
  add_box(s, "far", rectangle(-20, -90, 0, -80, 1.45), 8);
  add_box(s, "farther", rectangle(20, -95, 40, -85, 0), 8);
  ground_of(s, {-200, -200, 200, 200});
  EXPECT_GT(reach_of_steepness(s, 10.01, 0), 0);  // a step is there
  // The crack itself, 10 m long, is steep as well.
  EXPECT_LT(reach_of_steepness(s, 10.01, 0), 10 + 8);
  EXPECT_LT(reach_of_steepness(s, 10.01, 10), 10 + 8);
  EXPECT_LT(gap_beside(s, {0, 0, 0}, {10, 0, 0}), kMillimetre);
  EXPECT_LT(gap_beside(s, {10.02, 0, 1.45}, {20, 0, 1.45}), kMillimetre);
}

TEST(Ground, IsOneSurfaceWithoutCracksFromTheFootprintsToTheRim) {
  Slope s = slope();
  const Bounds2 extent{-300, -300, 500, 400};
  ground_of(s.scene, extent);
  using Edge = std::array<std::array<double, 3>, 2>;
  std::set<Edge> edges;
  for (std::size_t t = 0; t < s.scene.mesh.triangles.size(); ++t) {
    if (!is_ground(s.scene, t)) continue;
    const auto c = corners(s.scene, t);
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = c[k], &b = c[(k + 1) % 3];
      EXPECT_TRUE(edges.insert({{{a.x, a.y, a.z}, {b.x, b.y, b.z}}}).second);
    }
  }
  std::set<std::array<double, 3>> feet;
  for (const auto& foot : s.feet) {
    for (const Vec3& p : foot) feet.insert({p.x, p.y, p.z});
  }
  const auto on_rim = [&](const std::array<double, 3>& p) {
    return p[0] == extent.x0 || p[0] == extent.x1 || p[1] == extent.y0 || p[1] == extent.y1;
  };
  for (const Edge& e : edges) {
    if (edges.count({e[1], e[0]})) continue;
    EXPECT_TRUE((feet.count(e[0]) && feet.count(e[1])) || (on_rim(e[0]) && on_rim(e[1])))
        << e[0][0] << " " << e[0][1];
  }
}

TEST(Ground, StaysBetweenTheHeightsOfTheBuildings) {
  Slope s = slope();
  ground_of(s.scene, {-300, -300, 500, 400});
  for (std::size_t t = 0; t < s.scene.mesh.triangles.size(); ++t) {
    if (!is_ground(s.scene, t)) continue;
    for (const Vec3& p : corners(s.scene, t)) {
      EXPECT_GE(p.z, 200);
      EXPECT_LE(p.z, 216);
    }
  }
}

TEST(Ground, PutsASkirtBelowAPartThatStartsOnAnUpperFloor) {
  Scene s = stepped_row(4);
  const Bounds2 extent{-200, -200, 200, 200};
  ground_of(s, extent);
  EXPECT_NEAR(ground_area(s) + 200, area(extent), 1e-3);
  EXPECT_LT(gap_beside(s, {0, 0, 0}, {10, 0, 0}), kMillimetre);
  EXPECT_LT(gap_beside(s, {10, 0, 0}, {20, 0, 4}), kMillimetre);
  EXPECT_DOUBLE_EQ(skirt_area(s), 20);  // half of 10 m by 4 m
}

TEST(Ground, TakesNoHeightFromATowerOnAPodium) {
  // The tower's bottom lies on the podium's roof, flush with its western and southern walls.
  Scene s;
  add_box(s, "podium", rectangle(0, 0, 40, 40, 5), 10);
  add_box(s, "tower", rectangle(0, 0, 15, 15, 15), 60);
  ground_of(s, {-100, -100, 140, 140});
  for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) {
    if (!is_ground(s, t)) continue;
    for (const Vec3& p : corners(s, t)) EXPECT_EQ(p.z, 5);
  }
}

TEST(Ground, KeepsCourtyardsAndOverlapsRight) {
  Scene s;
  // Four wings around a courtyard, overlapping at their corners; a pavilion in the courtyard.
  add_box(s, "south", rectangle(0, 0, 40, 10, 2), 8);
  add_box(s, "north", rectangle(0, 30, 40, 40, 2), 8);
  add_box(s, "west", rectangle(0, 0, 10, 40, 2), 8);
  add_box(s, "east", rectangle(30, 0, 40, 40, 2), 8);
  add_box(s, "pavilion", turned(18, 18, 4, 4, 0.5, 2.5), 3);
  const Bounds2 extent{-100, -100, 140, 140};
  ground_of(s, extent);
  EXPECT_NEAR(ground_area(s), area(extent) - (1600 - 400) - 16, 1e-6);
  ASSERT_TRUE(ground_at(s, 12, 12));
  EXPECT_FALSE(ground_at(s, 5, 20));
  EXPECT_LT(gap_beside(s, {10, 10, 2}, {10, 30, 2}), kMillimetre);
}

TEST(Ground, PassesBelowObjectsWithoutABottom) {
  Scene s;
  add_box(s, "closed", rectangle(0, 0, 10, 10, 0), 8);
  const auto open = turned(30, 0, 10, 10, 0.4, 3);
  add_box(s, "open", open, 8, "none");
  const Bounds2 extent{-100, -100, 140, 140};
  ground_of(s, extent);
  EXPECT_TRUE(s.warnings.empty());
  EXPECT_NEAR(ground_area(s), area(extent) - 100, 1e-6);
  for (int k = 0; k < 4; ++k) {
    EXPECT_LT(gap_beside(s, open[k], open[(k + 1) % 4]), kMillimetre);  // outside
    EXPECT_LT(gap_beside(s, open[(k + 1) % 4], open[k]), kMillimetre);  // inside
  }
}

TEST(Ground, FindsTheBottomOfBuildingsWithoutSemantics) {
  Scene s;
  const auto a = turned(0, 0, 20, 10, 0.2, 1), b = turned(60, 10, 20, 10, 1.2, 4);
  add_box(s, "a", a, 9, "");
  add_box(s, "b", b, 9, "");
  const Bounds2 extent{-100, -100, 200, 140};
  EXPECT_EQ(ground_of(s, extent).kind, "through ground surfaces");
  EXPECT_NEAR(ground_area(s), area(extent) - 400, 1e-6);
  EXPECT_LT(gap_beside(s, a[0], a[1]), kMillimetre);
  EXPECT_LT(gap_beside(s, b[1], b[2]), kMillimetre);
}

TEST(Ground, LetsPartsAndBalconiesStandOnTheirBuilding) {
  Scene s;
  add_box(s, "house/base", rectangle(0, 0, 20, 20, 0), 8, "GroundSurface", "BuildingPart");
  add_box(s, "house/attic", rectangle(5, 5, 15, 15, 8), 4, "none", "BuildingPart");
  add_box(s, "house/balcony", rectangle(20, 5, 22, 9, 4), 1, "", "BuildingInstallation");
  add_box(s, "bridge", rectangle(40, 0, 80, 9, 6), 1, "GroundSurface", "Bridge");
  const Bounds2 extent{-100, -100, 200, 140};
  ground_of(s, extent);
  EXPECT_NEAR(ground_area(s), area(extent) - 400, 1e-6);
  EXPECT_DOUBLE_EQ((*ground_at(s, 21, 7))[1], 0);
  EXPECT_DOUBLE_EQ((*ground_at(s, 60, 4))[1], 0);
}

TEST(Ground, IsLevelAtTheLowestPointOfAModelWithoutObjects) {
  Scene s;
  add_box(s, "walls", rectangle(0, 0, 10, 10, 2), 8, "", "");
  add_box(s, "roof", rectangle(-1, -1, 11, 11, 10), 1, "", "");
  const Bounds2 extent{-50, -50, 60, 60};
  const GroundReport report = ground_of(s, extent);
  EXPECT_EQ(report.kind, "level");
  EXPECT_NEAR(ground_area(s), area(extent) - 100, 1e-9);
  EXPECT_DOUBLE_EQ((*ground_at(s, 20, 20))[0], 2);
}

TEST(Ground, DoesNotRiseToTheUpperFloorsOfADesignBesideCityObjects) {
  Scene s;
  add_box(s, "house", rectangle(0, 0, 10, 10, 0), 10);
  // Nodes of a glTF: a tower, and a slab on top of it.
  add_box(s, "tower", rectangle(30, 0, 40, 10, 0), 40, "", "mesh");
  add_box(s, "slab", rectangle(28, -2, 42, 12, 40), 1, "", "mesh");
  for (Surface& surface : s.surfaces) {
    surface.file = surface.object == "house" ? 0 : 1;
    surface.city = surface.file == 0;
  }
  const std::size_t model = s.mesh.positions.size();
  ASSERT_TRUE(add_ground(s, {"auto", {-50, -50, 90, 60}}));
  ASSERT_GT(s.mesh.positions.size(), model);
  for (std::size_t k = model; k < s.mesh.positions.size(); ++k) EXPECT_EQ(s.mesh.positions[k].z, 0);
}

TEST(Ground, OfALargeLevelCityIsARectangle) {
  Scene s;
  for (int k = 0; k < 10001; ++k) {
    const double x = 20 * (k % 100), y = 20 * (k / 100);
    add_box(s, std::to_string(k), rectangle(x, y, x + 10, y + 10, 3), 10);
  }
  const GroundReport report = ground_of(s, {-50, -50, 2100, 2100});
  EXPECT_EQ(report.kind, "level");
  EXPECT_EQ(report.triangles, 2u);
  EXPECT_EQ(s.mesh.positions.back().z, 3);
}

TEST(Ground, FollowsTheEdgesOfHousesInAGridOfWhichOneHasACellar) {
  Scene s;  // GEOS cannot join the holes of such a grid as it stands
  for (int k = 0; k < 100; ++k) {
    const double x = 500 + 25 * (k % 10), y = 25 * (k / 10);
    add_box(s, std::to_string(k), rectangle(x, y, x + 10, y + 10, 0), 9);
  }
  add_box(s, "cellar",
          {Vec3(587.269, 78.005, -2), Vec3(597.269, 78.0045, -2), Vec3(597.2695, 88.0045, -2),
           Vec3(587.2695, 88.005, -2)},
          10);
  const Bounds2 extent{400, -100, 900, 400};
  ground_of(s, extent);
  EXPECT_TRUE(s.warnings.empty()) << s.warnings[0].first;
  std::set<std::pair<std::array<double, 2>, std::array<double, 2>>> edges;
  for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) {
    if (!is_made_ground(s.surfaces[s.surface_of[t]])) continue;
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = s.mesh.positions[s.mesh.triangles[t][k]],
                 &b = s.mesh.positions[s.mesh.triangles[t][(k + 1) % 3]];
      edges.insert({{a.x, a.y}, {b.x, b.y}});
    }
  }
  for (int k = 0; k < 100; ++k) {
    const double x = 500 + 25 * (k % 10), y = 25 * (k / 10);
    if (k == 13) continue;                                 // the cellar reaches into it
    EXPECT_TRUE(edges.count({{x + 10, y}, {x, y}})) << k;  // the ground lies outside
  }
}

TEST(Ground, KeepsObjectsOfTheSameNameInTwoFilesApart) {
  Scene s;
  add_box(s, "1", rectangle(0, 0, 10, 10, 0), 10);
  add_box(s, "1", rectangle(30, 0, 40, 10, 0), 10, "none");
  for (std::size_t k = 3; k < s.surfaces.size(); ++k) s.surfaces[k].file = 1;
  const Footprints feet = find_footprints(s);
  EXPECT_EQ(feet.closed.size(), 2u);
  EXPECT_EQ(feet.open.size(), 4u);
}

TEST(Ground, LeavesTheModelsTerrainAlone) {
  Scene s;
  add_box(s, "a", rectangle(0, 0, 10, 10, 0), 8);
  add_quad(s, add_surface(s, "hill", "TINRelief", ""), rectangle(-50, -50, 50, 50, 0));
  const std::size_t before = s.mesh.triangles.size();
  const GroundReport report = ground_of(s, {-50, -50, 50, 50});
  EXPECT_EQ(report.kind, "model terrain");
  EXPECT_EQ(report.triangles, 0u);
  EXPECT_EQ(s.mesh.triangles.size(), before);
}

TEST(Ground, IsAPlaneAtTheHeightGivenInTheModelsCrs) {
  Scene s;
  s.frame.origin = {1000, 2000, 30};
  add_box(s, "a", rectangle(0, 0, 10, 10, 0), 8);
  const GroundReport report = ground_of(s, {-50, -50, 5, 5}, "28.5");
  EXPECT_EQ(report.kind, "level");
  EXPECT_EQ(report.triangles, 2u);
  EXPECT_DOUBLE_EQ(ground_area(s), 60 * 60);
  EXPECT_DOUBLE_EQ((*ground_at(s, 9, 9))[0], -1.5);
}

TEST(Ground, IsNothingWhenNoneIsWanted) {
  Scene s;
  add_box(s, "a", rectangle(0, 0, 10, 10, 0), 8);
  const std::size_t before = s.mesh.triangles.size();
  EXPECT_EQ(ground_of(s, {-50, -50, 50, 50}, "none").kind, "none");
  EXPECT_EQ(s.mesh.triangles.size(), before);
}

TEST(Ground, RefusesAModeItDoesNotKnow) {
  for (const char* mode : {"flat", "", "3m", "nan"}) {
    Scene s;
    add_box(s, "a", rectangle(0, 0, 10, 10, 0), 8);
    GroundOptions options;
    options.mode = mode;
    const Result<GroundReport> r = add_ground(s, options);
    ASSERT_FALSE(r) << mode;
    EXPECT_NE(r.error().message.find("auto, none or a height"), std::string::npos);
  }
}

}  // namespace
}  // namespace gnomon
