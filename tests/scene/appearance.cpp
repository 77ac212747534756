#include <gnomon/scene/appearance.h>
#include <gtest/gtest.h>

namespace gnomon {
namespace {

Appearance of_three_triangles() {
  Appearance a;
  a.materials.resize(2);
  a.material_of = {0, kNoMaterial, 1};
  for (int t = 0; t < 3; ++t) a.uv.push_back({glm::vec2(t, 0), glm::vec2(t, 1), glm::vec2(t, 2)});
  return a;
}

TEST(Appearance, KeptTrianglesTakeAllThatIsTheirs) {
  Appearance a = of_three_triangles();
  keep_triangles(a, {2, 0});
  EXPECT_EQ(a.material_of, (std::vector<std::uint32_t>{1, 0}));
  ASSERT_EQ(a.uv.size(), 2u);
  EXPECT_EQ(a.uv[0][1], glm::vec2(2, 1));
  EXPECT_EQ(a.uv[1][2], glm::vec2(0, 2));
  EXPECT_TRUE(a.normals.empty());
  EXPECT_EQ(a.materials.size(), 2u);
}

TEST(Appearance, WhatIsMadeLaterHasNoMaterial) {
  Appearance a = of_three_triangles();
  fill_up(a, 5);
  EXPECT_EQ(a.material_of,
            (std::vector<std::uint32_t>{0, kNoMaterial, 1, kNoMaterial, kNoMaterial}));
  EXPECT_EQ(a.uv.size(), 5u);
  EXPECT_TRUE(a.normals.empty());
  Appearance unasked;
  fill_up(unasked, 5);
  keep_triangles(unasked, {4, 3});
  EXPECT_TRUE(unasked.material_of.empty());
}

}  // namespace
}  // namespace gnomon
