#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <glm/common.hpp>

#include <gnomon/core/place.h>
#include <gnomon/mesh/edge_table.h>
#include <gnomon/mesh/report.h>
#include <gnomon/mesh/weld.h>
#include <scenes/second_paper_scenes.h>

namespace gnomon::scenes {
namespace {

struct Named {
  std::string name;
  Scene scene;
  PaperCounts counts;
  double latitude;  // degrees
};

const std::vector<Named>& all_scenes() {
  static const std::vector<Named> scenes = {
      {"tower", lattice_tower(), kLatticeTower, 48.8},
      {"industry", industry_area(), kIndustryArea, 45.2},
      {"office", office_building(OfficeCasters::facade_and_concrete), kOfficeBuilding, 48.2},
      {"office, all",
       office_building(OfficeCasters::all),
       {kOfficeBuilding.triangles, kOfficeBuilding.triangles},
       48.2}};
  return scenes;
}

std::size_t casting(const Scene& s) {
  std::size_t n = 0;
  for (std::uint32_t t = 0; t < s.mesh.triangles.size(); ++t) n += casts(s, t) ? 1 : 0;
  return n;
}

const std::string& object_of(const Scene& s, std::uint32_t triangle) {
  return s.surfaces[s.surface_of[triangle]].object;
}

TEST(SecondPaperScenes, HaveThePapersNumbersOfTrianglesAndCasters) {
  for (const Named& s : all_scenes()) {
    EXPECT_EQ(s.scene.mesh.triangles.size(), s.counts.triangles) << s.name;
    EXPECT_EQ(s.scene.surface_of.size(), s.counts.triangles) << s.name;
    EXPECT_EQ(casting(s.scene), s.counts.casting) << s.name;
  }
}

TEST(SecondPaperScenes, StandWhereThePaperSays) {
  for (const Named& s : all_scenes()) {
    ASSERT_TRUE(s.scene.frame.place) << s.name;
    EXPECT_NEAR(s.scene.frame.place->latitude, s.latitude * kDegree, 1e-12) << s.name;
  }
}

TEST(SecondPaperScenes, AreWeldedWithoutTrianglesOfNoAreaOrOnOthers) {
  for (const Named& s : all_scenes()) {
    Scene again = s.scene;
    const WeldReport report = weld(again.mesh, again.surface_of);
    EXPECT_EQ(report.merged_vertices, 0u) << s.name;
    EXPECT_EQ(report.zero_area_triangles, 0u) << s.name;
    EXPECT_EQ(find_coincident(s.scene.mesh).triangles, 0u) << s.name;
    EXPECT_TRUE(s.scene.warnings.empty()) << s.name;
  }
}

// Also: no two bodies share an edge, which would make one component that is not manifold.
TEST(SecondPaperScenes, AreSolidBodiesButForNamedSheets) {
  const std::set<std::string> sheets = {"ground", "gussets", "signs", "canopies"};
  for (const Named& s : all_scenes()) {
    const MeshReport report = report_mesh(s.scene.mesh, build_edge_table(s.scene.mesh));
    for (const Component& c : report.components) {
      const std::string& object = object_of(s.scene, c.first_triangle);
      const SurfaceKind expected =
          sheets.count(object) != 0 ? SurfaceKind::open : SurfaceKind::solid;
      ASSERT_EQ(c.kind, expected) << s.name << ", " << object << ", triangle " << c.first_triangle;
    }
  }
}

TEST(SecondPaperScenes, HaveALookForEachTriangle) {
  for (const Named& s : all_scenes()) {
    const Appearance& a = s.scene.appearance;
    ASSERT_EQ(a.material_of.size(), s.scene.mesh.triangles.size()) << s.name;
    for (std::uint32_t t = 0; t < a.material_of.size(); ++t)
      ASSERT_EQ(a.materials[a.material_of[t]].name,
                s.scene.surfaces[s.scene.surface_of[t]].material);
  }
}

TEST(SecondPaperScenes, AreTheSameAtEveryCall) {
  const auto expect_equal = [](const Scene& a, const Scene& b) {
    EXPECT_EQ(a.mesh.positions, b.mesh.positions);
    EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
    EXPECT_EQ(a.surface_of, b.surface_of);
  };
  expect_equal(all_scenes()[0].scene, lattice_tower());
  expect_equal(all_scenes()[1].scene, industry_area());
  expect_equal(all_scenes()[2].scene, office_building(OfficeCasters::facade_and_concrete));
}

TEST(SecondPaperScenes, OfficeIsTheSameWhateverCasts) {
  const Scene &some = all_scenes()[2].scene, &all = all_scenes()[3].scene;
  EXPECT_EQ(some.mesh.positions, all.mesh.positions);
  EXPECT_EQ(some.mesh.triangles, all.mesh.triangles);
  std::set<std::string> of_some, of_all;
  for (std::uint32_t t = 0; t < some.mesh.triangles.size(); ++t) {
    if (casts(some, t)) of_some.insert(object_of(some, t));
    if (casts(all, t)) of_all.insert(object_of(all, t));
  }
  EXPECT_EQ(of_some, (std::set<std::string>{"concrete", "facade"}));
  EXPECT_EQ(of_all, (std::set<std::string>{"concrete", "facade", "glass", "ground", "interior"}));
}

TEST(SecondPaperScenes, TowerIsThreeHundredMetresHighAndStandsOnItsGround) {
  const Scene& s = all_scenes()[0].scene;
  double top = 0;
  Vec3 lo(1e9), hi(-1e9);
  for (std::uint32_t t = 0; t < s.mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : s.mesh.triangles[t]) {
      const Vec3& p = s.mesh.positions[v];
      if (casts(s, t)) {
        top = std::max(top, p.z);
        EXPECT_LT(std::max(std::fabs(p.x), std::fabs(p.y)), 70);
      } else {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
      }
    }
  }
  EXPECT_NEAR(top, 300, 0.01);
  EXPECT_EQ(lo.z, 0);
  EXPECT_EQ(hi.z, 0);
  EXPECT_LT(std::max(lo.x, lo.y), -100);
  EXPECT_GT(std::min(hi.x, hi.y), 100);
}

}  // namespace
}  // namespace gnomon::scenes
