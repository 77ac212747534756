#include <gnomon/trace/verification_cases.h>

#include <gtest/gtest.h>

#include <gnomon/trace/oracle_predicates.h>

#include "small_scenes.h"

namespace gnomon {
namespace {

using namespace test;

// Three towers with slanted roofs on a ground.
Scene towers() {
  Scene s = empty_scene();
  add_ground(s, 40, 0, kBoth);
  for (int k = 0; k < 3; ++k) {
    const Vec3 at(-20 + 15 * k, -10 + 8 * k, 0);
    add_box(s, at, at + Vec3(6, 5, 10 + 4 * k));
    add_quad(s, at + Vec3(0, 0, 10 + 4 * k), Vec3(6, 0, 3), Vec3(0, 5, 0));
  }
  return finished(std::move(s));
}

TEST(VerificationCases, PutTheShadedCamerasEyeInTheShadow) {
  const Scene s = towers();
  const Oracle oracle = build_oracle(s);
  const Light light(1, 0.2, 0.5, 0);
  const std::optional<NamedView> view = shaded_camera(oracle, light, 32);
  ASSERT_TRUE(view);
  EXPECT_GT(casters_before_eye(oracle, view->view, light), 0);
  EXPECT_EQ(casters_before_eye(oracle, aerial_camera(s, 32).view, light), 0);
}

TEST(VerificationCases, HaveNoShadedCameraWithoutShadow) {
  Scene s = empty_scene();
  add_ground(s, 40, 0, kBoth);
  s = finished(std::move(s));
  EXPECT_FALSE(shaded_camera(build_oracle(s), Light(1, 0, 1, 0), 32));
}

TEST(VerificationCases, HaveASunInATrianglesPlaneAndALightAtAVertex) {
  const Scene s = towers();
  const auto tied = [&](const Light& light) {
    ExactStats stats;
    for (std::uint32_t t = 0; t < s.mesh.triangles.size(); ++t)
      oracle::light_side_of(oracle::points_of(s.mesh, t), light, stats);
    return stats.ties;
  };
  const std::vector<NamedLight> suns = choose_suns(s, 8),
                                points = choose_points(build_oracle(s), 4);
  ASSERT_EQ(suns.size(), 8u);
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(suns[4].name, "sun in a triangle's plane");
  EXPECT_GT(tied(suns[4].light), 0u);
  EXPECT_EQ(points[3].name, "point at a vertex");
  EXPECT_GE(tied(points[3].light), 3u);
  for (const NamedLight& sun : suns) EXPECT_GT(sun.light.z, 0) << sun.name;
  EXPECT_EQ(choose_suns(s, 20).size(), 20u);
}

TEST(VerificationCases, ShowEveryTowerFromAboveAndFromOutside) {
  const Scene s = towers();
  for (const View& view : {whole_plan(s, 48).view, aerial_camera(s, 48).view}) {
    const Receivers r = see(s, view);
    ASSERT_EQ(r.triangle.size(), 48u * 48u);
    int seen[3] = {0, 0, 0};
    for (const std::uint32_t t : r.triangle) {
      if (t == kNoTriangle) continue;
      const Vec3 p = oracle::points_of(s.mesh, t)[0];
      for (int k = 0; k < 3; ++k) {
        const double x = -20 + 15 * k, y = -10 + 8 * k;
        if (p.z > 0 && p.x >= x && p.x <= x + 6 && p.y >= y && p.y <= y + 5) ++seen[k];
      }
    }
    for (const int n : seen) EXPECT_GT(n, 0);
  }
}

}  // namespace
}  // namespace gnomon
