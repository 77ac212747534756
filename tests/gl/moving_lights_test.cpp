// Lights that move from frame to frame: what is kept of the last one must not show.
#include <cmath>
#include <optional>

#include "gl_test.h"

namespace gnomon::gl {
namespace {

// Many small boxes in rows, so that no bound of layers comes for nothing, and soup.
Scene crowd() {
  TriMesh m;
  test::add_quad(m, {-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0});
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) {
      const Vec3 lo(1.7 * i - 8, 1.9 * j - 8, 0.1 * ((i * 7 + j * 3) % 5));
      test::add_box(m, lo, lo + Vec3(0.9, 0.7, 0.5 + 0.3 * ((i + 2 * j) % 4)));
    }
  }
  const std::size_t before = m.positions.size();
  test::add_soup(m, 60, 3, 0, 8);
  for (std::size_t v = before; v < m.positions.size(); ++v) m.positions[v].z += 5;
  return test::scene_of(m);
}

Light light_at(int frame) {
  if (frame % 16 == 15) return point({6.0 - 0.4 * frame, -5, 14});
  const double a = 0.9 + 0.01 * frame;
  return {std::cos(a), std::sin(a), 0.6, 0};
}

// By every method, over more lights than the automatic one waits for, against a renderer that has
// never seen another light.
TEST(MovingLights, MasksAreThoseOfARendererThatKnowsNoOtherLight) {
  const Scene scene = crowd();
  const View view = aerial(160, 120);
  const Camera camera = camera_of(view, depth_range(scene, view, true));
  constexpr SilhouetteBy kAll[] = {SilhouetteBy::automatic, SilhouetteBy::brute_force,
                                   SilhouetteBy::dual_space, SilhouetteBy::edge_tree};
  for (const Count count : {Count::automatic, Count::z_fail, Count::mixed}) {
    std::vector<Stage> stages;
    stages.reserve(4);
    for (int k = 0; k < 4; ++k) stages.push_back(stage_of(scene));
    for (int frame = 0; frame < int(kLightsBeforeTree) + 8; ++frame) {
      const bool look = frame < 4 || frame % 16 == 15 || frame >= int(kLightsBeforeTree) - 1;
      std::optional<ShadowMask> expected;
      if (look) {
        Stage fresh = stage_of(scene);
        Method m;
        m.count = count;
        m.silhouettes = SilhouetteBy::brute_force;
        expected = fresh.renderer.mask(camera, light_at(frame), m).value();
      }
      for (int k = 0; k < 4; ++k) {
        stages[std::size_t(k)].context.make_current();
        Method m;
        m.count = count;
        m.silhouettes = kAll[k];
        const ShadowMask mask =
            stages[std::size_t(k)].renderer.mask(camera, light_at(frame), m).value();
        if (expected) {
          EXPECT_EQ(count_different(mask, *expected), 0)
              << name_of(kAll[k]) << ", " << name_of(count) << ", frame " << frame;
        }
      }
    }
  }
}

// A corner of a box is moved onto its neighbour: two triangles have no area from then on, and the
// silhouette runs over the edges of one.
TEST(MovingVertices, TrianglesThatLoseTheirAreaTearNoVolumeOpen) {
  TriMesh m;
  test::add_quad(m, {-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0});
  test::add_box(m, {-3, -3, 1}, {3, 3, 7});
  const Scene before = test::scene_of(m);
  TriMesh moved = before.mesh;
  std::size_t corner = 0, neighbour = 0;
  for (std::size_t v = 0; v < moved.positions.size(); ++v) {
    if (moved.positions[v] == Vec3(3, 3, 7)) corner = v;
    if (moved.positions[v] == Vec3(3, 3, 1)) neighbour = v;
  }
  moved.positions[corner] = moved.positions[neighbour];
  const Scene after = test::scene_of(moved);  // welded
  ASSERT_EQ(after.mesh.triangles.size(), moved.triangles.size() - 2);
  Stage stage = stage_of(Scene{});
  const MeshId id = stage.renderer.add_mesh(before.mesh);
  stage.renderer.add_instance(id);
  stage.renderer.update_mesh(id, moved.positions);
  const View view = aerial(160, 120);
  const Camera camera = camera_of(view, depth_range(before, view, true));
  for (const SilhouetteBy by :
       {SilhouetteBy::brute_force, SilhouetteBy::dual_space, SilhouetteBy::edge_tree}) {
    for (const double x : {-0.7, -0.3, 0.4}) {
      for (const double y : {-0.6, 0.1, 0.5}) {
        const Light light = direction({x, y, 1});
        Method method;
        method.silhouettes = by;
        const ShadowMask mask = stage.renderer.mask(camera, light, method).value();
        EXPECT_EQ(compare(mask, exact_mask(after, light, view)).far_off, 0)
            << name_of(by) << ", sun " << x << ", " << y;
      }
    }
  }
}

TEST(MovingLights, StatsSayWhichVolumesWereKept) {
  const Scene scene = crowd();
  const View view = aerial(64, 48);
  const Camera camera = camera_of(view, depth_range(scene, view, true));
  Stage stage = stage_of(scene);
  TriMesh box;
  test::add_box(box, {0, 0, 9}, {1, 1, 10});
  const InstanceId other = stage.renderer.add_instance(stage.renderer.add_mesh(box));
  LightSource sun;
  sun.light = light_at(0);
  const auto draw = [&] { return stage.renderer.draw(camera, {&sun, 1}, {}).value(); };
  FrameStats s = draw();
  EXPECT_EQ(s.rebuilt, 2);
  EXPECT_EQ(s.kept, 0);
  s = draw();
  EXPECT_EQ(s.rebuilt, 0);
  EXPECT_EQ(s.kept, 2);
  glm::dmat4 moved(1.0);
  moved[3] = {2, 0, 0, 1};
  stage.renderer.move_instance(other, moved);
  s = draw();  // a sun's direction is the same in the moved box's coordinates
  EXPECT_EQ(s.rebuilt, 0);
  EXPECT_EQ(s.kept, 2);
  moved = {{0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0}, {2, 0, 0, 1}};  // a quarter turn
  stage.renderer.move_instance(other, moved);
  s = draw();
  EXPECT_EQ(s.rebuilt, 1);
  EXPECT_EQ(s.kept, 1);
  sun.light = light_at(1);
  s = draw();
  EXPECT_EQ(s.rebuilt, 2);
  EXPECT_GT(s.volumes_ms, 0);
  EXPECT_EQ(s.kept, 0);
  FrameOptions look;  // at what was made: it is counted once
  look.overlay.silhouettes = true;
  s = stage.renderer.draw(camera, {&sun, 1}, look).value();
  EXPECT_EQ(s.rebuilt, 0);
  EXPECT_EQ(s.kept, 2);
}

}  // namespace
}  // namespace gnomon::gl
