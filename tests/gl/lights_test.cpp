// Several lights.
#include "gl_test.h"

namespace gnomon::gl {
namespace {

std::vector<LightSource> three_lamps() {
  std::vector<LightSource> lights(3);
  lights[0].light = {12, -9, 15, 1};
  lights[0].colour = {0.5, 0.1, 0.1};
  lights[1].light = {-14, -6, 9, 1};
  lights[1].colour = {0.1, 0.5, 0.1};
  lights[2].light = {0.2, 0.5, 0.4, 0};
  lights[2].colour = {0.1, 0.1, 0.5};
  return lights;
}

Image picture(Renderer& renderer, const Camera& camera, const std::vector<LightSource>& lights,
              const Method& method) {
  FrameOptions options;
  options.method = method;
  return renderer.render(camera, lights, options).value();
}

// The largest difference of a colour over the picture.
int largest_difference(const Image& a, const Image& b) {
  int most = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    if (i % 4 != 3) most = std::max(most, std::abs(int(a.rgba[i]) - int(b.rgba[i])));
  }
  return most;
}

TEST(Lights, EachAddsItsPartByEveryMask) {
  const Scene scene = test::scene_of(boxes_on_ground());
  Stage stage = stage_of(scene);
  const View view = aerial();
  const Camera camera = camera_of(view, depth_range(scene, view, true));
  const std::vector<LightSource> lights = three_lamps();
  const Image all = picture(stage.renderer, camera, lights, {});

  // What each adds alone, summed.
  FrameOptions dark;
  const Image none = stage.renderer.render(camera, {}, dark).value();
  std::vector<int> sum(all.rgba.size());
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = none.rgba[i];
  for (const LightSource& light : lights) {
    Method m;
    m.shadows = Shadows::lights;
    const Image one = picture(stage.renderer, camera, {light}, m);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += int(one.rgba[i]) - int(none.rgba[i]);
  }
  int most = 0, lit = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (i % 4 == 3) continue;
    most = std::max(most, std::abs(std::min(sum[i], 255) - int(all.rgba[i])));
    lit += all.rgba[i] > none.rgba[i] ? 1 : 0;
  }
  EXPECT_LE(most, 1);
  EXPECT_GT(lit, int(sum.size()) / 4);

  // Lit comes out as 254/255 of an alpha or screen mask: a level for each light.
  for (const MaskIn mask : {MaskIn::alpha, MaskIn::screen}) {
    Method m;
    m.mask = mask;
    EXPECT_LE(largest_difference(picture(stage.renderer, camera, lights, m), all), 3)
        << name_of(mask);
  }
}

TEST(Lights, RadiusEndsALightAndLeavesOutCastersBeyond) {
  const Scene scene = test::scene_of(boxes_on_ground());
  const View view = aerial();
  for (const Api api : {Api::opengl, Api::opengl_es}) {
    Stage stage = stage_of(scene, api);
    const Camera camera = camera_of(view, depth_range(scene, view, true));
    LightSource lamp = three_lamps()[0];
    lamp.light = {5, -4, 5, 1};
    lamp.radius = 9;
    for (const Shadows shadows : {Shadows::lights, Shadows::ambient}) {
      Method m;
      m.shadows = shadows;
      const Image small = picture(stage.renderer, camera, {lamp}, m);
      const Image none = stage.renderer.render(camera, {}, {}).value();
      int lit = 0;
      for (std::size_t i = 0; i < small.rgba.size(); i += 4) lit += small.rgba[i] > none.rgba[i];
      EXPECT_GT(lit, 100);
      EXPECT_LT(lit, int(small.rgba.size() / 4) / 2);
      // A box beyond the radius throws no volume, and taking it away changes nothing.
      FrameOptions options;
      options.method = m;
      FrameStats stats;
      (void)stage.renderer.render(camera, std::span(&lamp, 1), options, &stats).value();
      lamp.radius = 1000;
      FrameStats far;
      (void)stage.renderer.render(camera, std::span(&lamp, 1), options, &far).value();
      lamp.radius = 9;
      EXPECT_LT(stats.z_pass_volumes + stats.z_fail_volumes,
                far.z_pass_volumes + far.z_fail_volumes);
    }
  }
}

// Everitt and Kilgard 2002, 3.3: a face that is stored twice must not get a light twice. The first
// light is drawn over what is there, so the second one shows it.
TEST(Lights, AreAddedOnceToFacesOfOneDepthByIncrementing) {
  TriMesh mesh;
  test::add_ground(mesh, 20);
  const Scene once = test::scene_of(mesh);
  test::add_ground(mesh, 20);
  const Scene twice = test::scene_of(mesh);
  const View view = aerial();
  const Camera camera = camera_of(view, depth_range(once, view, true));
  const std::vector<LightSource> lights{three_lamps()[0], three_lamps()[1]};
  Stage single = stage_of(once);
  const Image right = picture(single.renderer, camera, lights, {});
  Stage doubled = stage_of(twice);
  EXPECT_EQ(largest_difference(picture(doubled.renderer, camera, lights, {}), right), 0);
  Method keep;
  keep.keep_double_blending = true;
  EXPECT_GT(largest_difference(picture(doubled.renderer, camera, lights, keep), right), 20);
}

TEST(Lights, ShineTheSameOnAScaledInstance) {
  const Scene large = test::scene_of(boxes_on_ground());
  Scene small = large;
  for (Vec3& p : small.mesh.positions) p /= 4;
  const View view = aerial();
  const Camera camera = camera_of(view, depth_range(large, view, true));
  const std::vector<LightSource> lights{three_lamps()[0]};
  const Image right = [&] {
    Stage stage = stage_of(large);
    return picture(stage.renderer, camera, lights, {});
  }();
  const HeadlessContext context = HeadlessContext::create(Api::opengl).value();
  Renderer scaled = Renderer::create(find_capabilities().value()).value();
  scaled.add_instance(scaled.add_mesh(small.mesh), glm::dmat4(glm::dmat3(4.0)));
  EXPECT_LE(largest_difference(picture(scaled, camera, lights, {}), right), 1);
}

TEST(Lights, ManyDimOnesAddUpToABrightOne) {
  const Scene scene = test::scene_of(boxes_on_ground());
  const View view = aerial(64, 48);
  const Camera camera = camera_of(view, depth_range(scene, view, true));
  constexpr int kLights = 200;
  std::vector<LightSource> one{three_lamps()[0]}, many(kLights, one[0]);
  for (LightSource& light : many) light.colour /= double(kLights);
  for (const Api api : {Api::opengl, Api::opengl_es}) {
    Stage stage = stage_of(scene, api);
    for (const int samples : {1, 4}) {
      if (stage.renderer.capabilities().max_samples < samples) continue;
      for (const MaskIn mask : {MaskIn::stencil, MaskIn::alpha, MaskIn::screen}) {
        Method m;
        m.mask = mask;
        m.samples = samples;
        FrameOptions options;
        options.method = m;
        const Result<Image> bright = stage.renderer.render(camera, one, options);
        if (!bright) continue;  // refused: not convex
        EXPECT_LE(largest_difference(picture(stage.renderer, camera, many, m), bright.value()), 2)
            << name_of(mask) << ", " << samples << " samples";
      }
    }
  }
  Stage poor = stage_of(scene, Api::opengl, {"float-colour"});
  const Result<Image> refused = poor.renderer.render(camera, many, {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("fewer lights"), std::string::npos);
}

// An elevation whose lower edge is below the ground.
TEST(Lights, LampsShineInParallelViewsThatReachBelowTheGround) {
  const Scene scene = test::scene_of(boxes_on_ground());
  Stage stage = stage_of(scene);
  const View view = orthographic_view({25, -35, 2}, {0, 0, 2}, {0, 0, 1}, 20, 160, 120);
  const Camera camera = camera_of(view, depth_range(scene, view, false));
  const Light lamp(12, -9, 15, 1);
  FrameStats stats;
  const Result<ShadowMask> mask = stage.renderer.mask(camera, lamp, {}, &stats);
  ASSERT_TRUE(mask) << mask.error().message;
  EXPECT_EQ(stats.method.reach, Reach::bounded);
  EXPECT_LE(compare(mask.value(), exact_mask(scene, lamp, view)).pixels, 19);
}

// Half floats hold 14 shadows over each other, bytes any number of convex casters' ones.
TEST(Lights, FiveTakeAsManyShadowsOverEachOtherAsFour) {
  TriMesh mesh;
  test::add_box(mesh, {-20, -20, -1}, {20, 20, 0});
  for (int k = 0; k < 18; ++k) test::add_box(mesh, {-2, -2, 2 + 0.5 * k}, {2, 2, 2.2 + 0.5 * k});
  Stage stage = stage_of(test::scene_of(std::move(mesh)));
  const Camera camera = camera_of(aerial(160, 120), {.near_plane = 1});
  for (const int n : {4, 5}) {
    std::vector<LightSource> lights;
    for (int k = 0; k < n; ++k) {
      LightSource sun;
      sun.light = Light(0.1 * k, 0.05, 1, 0);
      sun.colour = Vec3(0.1);
      lights.push_back(sun);
    }
    Method alpha;
    alpha.mask = MaskIn::alpha;
    EXPECT_LE(largest_difference(picture(stage.renderer, camera, lights, alpha),
                                 picture(stage.renderer, camera, lights, {})),
              n);
  }
}

// Bilinear filtering reads texels beyond what receives; they are lit, not unknown.
TEST(Lights, LowMasksOfALitRectangleAreLitUpToItsRim) {
  TriMesh mesh;
  test::add_quad(mesh, {-5, 0, -4}, {5, 0, -4}, {5, 0, 4}, {-5, 0, 4});
  Stage stage = stage_of(test::scene_of(std::move(mesh)));
  LightSource sun;
  sun.light = Light(0.1, -1, 0.2, 0);
  for (const int width : {160, 161, 97}) {
    for (const double scale : {0.5, 0.25, 0.125}) {
      const View view = perspective_view({0, -20, 0}, {0, 0, 0}, {0, 0, 1}, 0.8, width, width - 41);
      const Camera camera = camera_of(view, {.near_plane = 1});
      Method low;
      low.mask_scale = scale;
      EXPECT_LE(largest_difference(picture(stage.renderer, camera, {sun}, low),
                                   picture(stage.renderer, camera, {sun}, {})),
                1)
          << width << ", " << scale;
    }
  }
}

}  // namespace
}  // namespace gnomon::gl
