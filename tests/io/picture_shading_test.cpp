#include <gnomon/io/picture_shading.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gnomon {
namespace {

// Ground at 0, and upon its middle a house with walls to the south and a roof that falls to the
// south (part of "house").
struct Small {
  Scene scene;
  Receivers plan;
};

void add(Scene& s, const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t surface) {
  const auto first = static_cast<std::uint32_t>(s.mesh.positions.size());
  s.mesh.positions.insert(s.mesh.positions.end(), {a, b, c});
  s.mesh.triangles.push_back({first, first + 1, first + 2});
  s.surface_of.push_back(surface);
}

Surface surface(const char* object, const char* group, const char* semantic) {
  Surface s;
  s.object = object;
  s.group = group;
  s.semantic = semantic;
  return s;
}

Small small() {
  Small out;
  Scene& s = out.scene;
  s.surfaces = {surface("Ground", "Ground", "Ground"), surface("house", "Building", "WallSurface"),
                surface("house/1", "BuildingPart", "RoofSurface")};
  s.surfaces[2].whole = 5;
  add(s, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 0);  // 0: level
  add(s, {1, 1, 1}, {2, 1, 1}, {1, 2, 2}, 2);  // 1: roof that falls to the south, 45 degrees
  add(s, {1, 1, 0}, {2, 1, 0}, {1, 1, 1}, 1);  // 2: south wall
  add(s, {0, 4, 0}, {4, 0, 0}, {4, 4, 0}, 0);  // 3: level
  add(s, {1, 2, 2}, {1, 3, 1}, {2, 3, 1},
      2);  // 4: roof that falls to the north, wound downwards or not
  View& v = out.plan.view;
  v.eye = {0, 0, 1, 0};
  v.origin = {0, 1, 0, 1};
  v.right = {1, 0, 0, 0};
  v.down = {0, -1, 0, 0};
  v.width = 5;
  v.height = 1;
  out.plan.triangle = {0, 3, 1, 4, kNoTriangle};
  out.plan.nearness.assign(5, 0.0F);
  out.plan.nearness[4] = -std::numeric_limits<float>::infinity();
  return out;
}

TEST(PlanRelief, LeavesLevelGroundAndDarkensSlopesAwayFromTheNorthWest) {
  const Small s = small();
  const PlanRelief relief = plan_relief(s.scene, s.plan);
  EXPECT_EQ(relief.shade[0], kLevelShade);
  EXPECT_EQ(relief.shade[1], kLevelShade);
  EXPECT_LT(relief.shade[2], kLevelShade) << "falls to the south";
  EXPECT_GT(relief.shade[3], kLevelShade) << "falls to the north";
  EXPECT_EQ(relief.shade[4], kLevelShade) << "no sample";
}

TEST(PlanRelief, DoesNotDependOnTheWinding) {
  Small s = small();
  const PlanRelief before = plan_relief(s.scene, s.plan);
  for (Triangle& t : s.scene.mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_EQ(plan_relief(s.scene, s.plan).shade, before.shade);
}

TEST(PlanRelief, CountsPartsWithTheirParent) {
  Small s = small();
  s.plan.triangle = {0, 3, 1, 2, kNoTriangle};
  const PlanRelief relief = plan_relief(s.scene, s.plan);
  EXPECT_EQ(relief.object[0], relief.object[1]);
  EXPECT_NE(relief.object[1], relief.object[2]);
  EXPECT_EQ(relief.object[2], relief.object[3]) << "wall of house, roof of house/1";
  EXPECT_EQ(relief.object[4], kNoObject);
}

TEST(ViewShading, DrawsEdgesAtCreasesOutlinesAndTheSkyOnly) {
  const Small s = small();
  const ViewShading shading = view_shading(s.scene, s.plan);
  EXPECT_EQ(shading.edge[0], 0) << "two triangles of the same ground";
  EXPECT_EQ(shading.edge[1], 1) << "ground to house";
  EXPECT_EQ(shading.edge[2], 1) << "ridge";
  EXPECT_EQ(shading.edge[3], 1) << "house to sky";
}

TEST(ViewShading, TellsGroundRoofsAndWallsApart) {
  Small s = small();
  s.plan.triangle = {0, 1, 2, 2, kNoTriangle};
  const ViewShading shading = view_shading(s.scene, s.plan);
  EXPECT_NE(shading.colour[0], shading.colour[1]);
  EXPECT_NE(shading.colour[1], shading.colour[2]);
  EXPECT_NE(shading.colour[0], shading.colour[2]);
  for (int k = 0; k < 4; ++k) {
    EXPECT_GT(shading.shade[static_cast<std::size_t>(k)], 0.4F);
    EXPECT_LE(shading.shade[static_cast<std::size_t>(k)], 1.0F);
  }
  EXPECT_EQ(shading.shade[4], 0.0F);
}

}  // namespace
}  // namespace gnomon
