// Sides that clipping, culling or another order of operations would give other corners: masks are
// the same pixels however faces are chosen, counted and extruded.
#include <random>

#include "gl_test.h"

namespace gnomon::gl {
namespace {

// The whole plan of a few kilometres, a metre a sample or so.
View plan(const Vec3& first, double pixel, int size) {
  View v;
  v.eye = Vec4(0, 0, 1, 0);
  v.origin = point(first);
  v.right = direction(Vec3(pixel, 0, 0));
  v.down = direction(Vec3(0, -pixel, 0));
  v.width = v.height = size;
  return v;
}

// Of scenes/footprints/quarter.geojson: half a wall that the eye sees nearly edge-on, and the
// ground. The side below the wall, which is clipped where it runs to infinity, is a sliver that
// faces one way before its corners are rounded to pixels and the other way afterwards.
TEST(ClippedSides, AreCountedTheSameByFacingAndByTwoSidedStencils) {
  TriMesh m;
  m.positions = {{-40.266467551817186, 41.532642661593854, -24},
                 {-42.267330627772026, 41.497408600524068, -8},
                 {-40.266467551817186, 41.532642661593854, -8},
                 {-343.0415531740291, -334.68946276605129, -24},
                 {-53.721676737768576, -46.689462766051292, -24},
                 {-54.601592802326195, 3.2863953243941069, -24}};
  m.triangles = {{0, 1, 2}, {3, 4, 5}};
  const Scene scene = test::scene_of(std::move(m));
  View view;
  view.eye = point(Vec3(-77.198596163420007, -100.01307597843697, 83.088911210215883));
  view.origin = direction(Vec3(0.30216950802999598, 1.1480358422726507, -0.15997799030564691));
  view.right = direction(Vec3(0.0028756326870641416, -0.0022366032010498874, 0));
  view.down =
      direction(Vec3(-0.0012291420168834995, -0.0015803254502787857, -0.0030435897560924757));
  view.width = view.height = 256;
  Stage stage = stage_of(scene);
  const Light sun(0, 0, 1, 0);
  for (const FarPlane far : {FarPlane::infinite, FarPlane::clamp}) {
    DepthRange range;
    range.near_plane = 87.476995349612594;
    if (far == FarPlane::clamp) range.far_plane = 569.79618027419338;
    const Camera camera = camera_of(view, range);
    Method m0;
    m0.count = Count::z_fail;
    m0.reach = Reach::infinite;
    m0.far_plane = far;
    const ShadowMask two_sided = stage.renderer.mask(camera, sun, m0).value();
    for (const MaskIn in : {MaskIn::stencil, MaskIn::alpha, MaskIn::screen}) {
      Method m1 = m0;
      m1.mask = in;
      m1.passes = in == MaskIn::stencil ? StencilPasses::culled : StencilPasses::two_sided;
      EXPECT_EQ(count_different(stage.renderer.mask(camera, sun, m1).value(), two_sided), 0)
          << describe(m1);
    }
  }
}

// Of city/multi_lod.json: a wall and what its shadow falls on.
TEST(Extrusion, ByCpuShaderAndBlendingIsTheSameToTheBit) {
  TriMesh m;
  m.positions = {{-129.47807899999222, -212.74000999999697, 1.7300000000000004},
                 {-129.47807899999222, -212.74000999999697, -4.298},
                 {-128.03407899999223, -216.56200999999697, -4.298},
                 {-96.790141471050219, 265.26655322815401, -4.7820239427604667},
                 {-102.92611544512465, 273.27847408792911, -4.7760961657962175},
                 {-101.86558811127533, 263.82061102198452, -4.7849415992815478},
                 {-125.30865202711009, -208.01631105554648, -4.2858060549859829},
                 {-124.93545031170568, -199.02405213580784, -4.2415083950908921},
                 {-130.51065202711007, -209.92331105554646, -4.2766197716868417},
                 {262.28292100000783, 287.43599000000302, -3.4667370548323579},
                 {295.95692100000781, 321.10999000000299, -3.4667370548323579},
                 {262.28292100000783, 321.10999000000299, -3.4667370548323579},
                 {-262.60007899999221, -287.52700999999701, -4.2077556364106092},
                 {-296.27407899999218, -321.20100999999698, -4.2077556364106092},
                 {-262.60007899999221, -321.20100999999698, -4.2077556364106092}};
  for (std::uint32_t t = 0; t < 5; ++t) m.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  const Scene scene = test::scene_of(std::move(m));
  const View view = plan({-288.88822899999218, 288.68414000000303, 0.097500000000000142},
                         3.6091206250000001, 160);
  const Camera camera = camera_of(view, {-6.042296874999999, 6.042296874999999});
  Stage stage = stage_of(scene);
  const Light sun(-0.1590644159616105, -0.68898368019481548, 0.70710678118654746, 0);
  Method shader;
  shader.reach = Reach::bounded;
  shader.count = Count::z_fail;
  const ShadowMask by_shader = stage.renderer.mask(camera, sun, shader).value();
  for (const Extrusion e : {Extrusion::cpu, Extrusion::blend}) {
    Method other = shader;
    other.extrusion = e;
    EXPECT_EQ(count_different(stage.renderer.mask(camera, sun, other).value(), by_shader), 0)
        << name_of(e);
  }
}

TriMesh turned_boxes(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double a, double b) {
    return a + (b - a) * double(random()) / double(std::mt19937::max());
  };
  TriMesh m;
  test::add_ground(m, 60);
  for (int i = 0; i < 40; ++i) {
    const Vec3 at(between(-30, 30), between(-30, 30), 0);
    const Vec3 half(between(0.3, 5), between(0.3, 5), between(0.5, 12));
    const double c = std::cos(double(i)), s = std::sin(double(i));
    const std::size_t first = m.positions.size();
    test::add_box(m, {-half.x, -half.y, 0}, half);
    for (std::size_t k = first; k < m.positions.size(); ++k) {
      const Vec3 p = m.positions[k];
      m.positions[k] = at + Vec3(p.x * c - p.y * s, p.x * s + p.y * c, p.z);
    }
  }
  return m;
}

// With depth clamp z-pass and z-fail draw the same sides, which the far plane cuts for neither.
TEST(ClippedSides, AreTheSameForZPassAndZFailWithDepthClamp) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Scene scene = test::scene_of(turned_boxes(seed));
    Stage stage = stage_of(scene);
    const View views[] = {
        perspective_view({40, -25, 14}, {0, 0, 0}, {0, 0, 1}, 1.0, 480, 360),
        perspective_view({-12, 50, 30}, {0, 0, 0}, {0, 0, 1}, 0.7, 480, 360),
        orthographic_view({10, -30, 8}, {0, 0, 0}, {0, 0, 1}, 70, 480, 360),
        plan({-40, 40, 0}, 0.2, 400),
    };
    for (const View& view : views) {
      const Camera camera = camera_of(view, depth_range(scene, view, false));
      for (const Light& light :
           {Light(0.955, -0.292, 0.0523, 0), Light(-0.4, -0.7, 0.2, 0), Light(-9, 14, 25, 1)}) {
        if (is_parallel(view) && light.w != 0) continue;  // z-fail is refused where none bounds it
        Method m;
        m.far_plane = FarPlane::clamp;
        const ShadowMask z_pass = stage.renderer.mask(camera, light, m).value();
        m.count = Count::z_fail;
        const ShadowMask z_fail = stage.renderer.mask(camera, light, m).value();
        EXPECT_EQ(count_different(z_pass, z_fail), 0) << seed << ", light " << light.x;
      }
    }
  }
}

// A wall on the lowest ground: z-pass does not draw the side below its foot, so z-fail must not
// lose it where its upper edge is rounded before the ground.
TEST(SidesBeyondReceivers, AreBehindEverythingWhateverTheRounding) {
  TriMesh m;
  m.positions = {{-60, -60, 0},
                 {60, 60, 0},
                 {-60, 60, 0},
                 {-23.02955896234548, -27.799822489242601, 0},
                 {-25.834387811678855, -18.23523866423173, 0},
                 {-25.834387811678855, -18.23523866423173, 7.1444606251473441}};
  m.triangles = {{0, 1, 2}, {3, 4, 5}};
  const Scene scene = test::scene_of(std::move(m));
  View view;
  view.eye = direction(Vec3(0.624108456329874, 0.751274370102467, 0.21465194050994083));
  view.origin = point(Vec3(8.4621958727306712, -13.8219829898066, 13.993434730725058));
  view.right = direction(Vec3(-0.061226068224171135, 0.050862519003973566, 0));
  view.down = direction(Vec3(0.010917738403426669, 0.013142294354112362, -0.077741304059583655));
  view.width = 480;
  view.height = 360;
  const Camera camera = camera_of(view, {-88.200868027094771, 84.00275674390744});
  const Light sun(0.41700998075469364, 0.29799490408731444, 0.59640440692594365, 0);
  Stage stage = stage_of(scene);
  for (const MaskIn in : {MaskIn::stencil, MaskIn::alpha}) {
    Method method;
    method.mask = in;
    method.reach = Reach::bounded;
    const ShadowMask z_pass = stage.renderer.mask(camera, sun, method).value();
    method.count = Count::z_fail;
    EXPECT_EQ(count_different(stage.renderer.mask(camera, sun, method).value(), z_pass), 0)
        << name_of(in);
  }
}

// A near plane amid a street, a far plane amid the boxes behind: surfaces are cut there, and so are
// their light caps, which z-fail counts. With the far plane at infinity nothing but the near plane
// cuts, and all is cut alike.
TEST(CutSurfaces, AreNotDarkenedByTheirOwnCapsUnderDepthClamp) {
  TriMesh m;
  test::add_ground(m, 60);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> at(-40, 40), size(1, 6);
  for (int k = 0; k < 60; ++k) {
    const Vec3 lo(at(random), at(random), 0);
    test::add_box(m, lo, lo + Vec3(size(random), size(random), 2 * size(random)));
  }
  const Scene scene = test::scene_of(std::move(m));
  Stage stage = stage_of(scene);
  const View view = perspective_view({-50, -45, 3}, {0, 0, 4}, {0, 0, 1}, 1.0, 320, 240);
  const Camera endless = camera_of(view, {6.0});
  int cut = 0;
  for (const double far_plane : {400.0, 60.0}) {
    const Camera camera = camera_of(view, {6.0, far_plane});
    for (const Light& light :
         {Light(-1, 0.3, 1.2, 0), Light(0.9, 0.5, 0.4, 0), Light(-45, -41, 9, 1)}) {
      for (const MaskIn in : {MaskIn::stencil, MaskIn::alpha}) {
        Method usual;
        usual.mask = in;
        const ShadowMask expected = stage.renderer.mask(endless, light, usual).value();
        for (const auto& [count, reach] :
             {std::pair(Count::automatic, Reach::automatic),
              std::pair(Count::z_fail, Reach::automatic), std::pair(Count::z_fail, Reach::infinite),
              std::pair(Count::mixed, Reach::infinite)}) {
          Method method = usual;
          method.count = count;
          method.reach = reach;
          const ShadowMask drawn = stage.renderer.mask(camera, light, method).value();
          int differ = 0;
          for (std::size_t k = 0; k < drawn.state.size(); ++k) {
            if (drawn.state[k] == ShadowMask::kNoSample) {
              cut += expected.state[k] != ShadowMask::kNoSample;
            } else {
              differ += drawn.state[k] != expected.state[k];
            }
          }
          EXPECT_EQ(differ, 0) << far_plane << ", light " << light.x << ": " << describe(method);
        }
      }
    }
  }
  EXPECT_GT(cut, 1000);
}

int shaded(const ShadowMask& mask) {
  return static_cast<int>(std::count(mask.state.begin(), mask.state.end(), ShadowMask::kShadow));
}

// The near plane cuts lit ground along a row of pixel centres.
TEST(CutSurfaces, StayLitInTheRowWhereTheNearPlaneCutsThem) {
  TriMesh m;
  test::add_ground(m, 60);
  Stage stage = stage_of(test::scene_of(std::move(m)));
  const View view = orthographic_view({0, -20, 8}, {0, 0, 0}, {0, 0, 1}, 30, 160, 120);
  for (const Count count : {Count::automatic, Count::z_fail}) {
    Method method;
    method.count = count;
    method.reach = Reach::bounded;
    const Camera camera = camera_of(view, {6.563, 206.563});
    EXPECT_EQ(shaded(stage.renderer.mask(camera, Light(.3, .2, 1, 0), method).value()), 0);
  }
}

// The far plane cuts ground that a lit wall hides: its caps are counted once on either side.
TEST(CutSurfaces, ThatAreHiddenDarkenNothingAlongTheFarPlane) {
  TriMesh m;
  test::add_quad(m, {-30, 10, -20}, {30, 10, -20}, {30, 10, 20}, {-30, 10, 20});
  test::add_quad(m, {-40, 11, -3}, {40, 11, -3}, {40, 90, -3}, {-40, 90, -3});
  Stage stage = stage_of(test::scene_of(std::move(m)));
  Method method;
  method.count = Count::z_fail;
  for (const double z : {1.75, 2.555, 2.0}) {
    const View view = perspective_view({0, -2, z}, {0, 10, z}, {0, 0, 1}, 0.9, 320, 240);
    const Camera camera = camera_of(view, {1.0, 40});
    EXPECT_EQ(shaded(stage.renderer.mask(camera, Light(-.3, -1, .4, 0), method).value()), 0) << z;
  }
}

}  // namespace
}  // namespace gnomon::gl
