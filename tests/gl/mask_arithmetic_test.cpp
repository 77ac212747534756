// The arithmetic of masks without a stencil (Roettger, Irion and Ertl, Shadow Volumes Revisited,
// 2002, 4.2 to 4.4), run through: what the blending units make of every order of volumes that hold
// a pixel and volumes that lie before it (z-fail: behind it).
#include <utility>

#include "gl_test.h"

namespace gnomon::gl {
namespace {

// What a volume is to a pixel: it holds it, and counts once; or the ray to it crosses the volume,
// which counts in and out again.
enum class Step : std::uint8_t { holds, crosses };
using Order = std::vector<Step>;

constexpr double kBoxes = 100;  // height of the lowest, metres: over all rays to the pixels
const Light kAbove(0, 0, 1, 0);

// A scene in strips of 1 m along x, one for each order, over a floor that only receives. The sample
// of a strip lies at y = 0 on the floor, its volumes are boxes above, drawn in the mesh's order, by
// light from the zenith. The view comes in at 45 degrees: a box above y = 0 holds the sample; one
// above y = -d is crossed before the sample, one above y = d behind it.
struct Strips {
  TriMesh mesh;
  int count = 0;
  std::vector<Order> orders;

  // A box over strips first .. last that is step k of their orders.
  void add(int first, int last, Step step, int k, bool behind) {
    const double d = step == Step::holds ? 0.0 : (behind ? 1.0 : -1.0) * (1.5 + k);
    const double z = kBoxes + 2.0 * k;
    test::add_box(mesh, {first + 0.25, d - 0.25, z}, {last + 0.75, d + 0.25, z + 1});
  }
  // All orders of n steps. Strips that share their first steps are neighbours and share a box.
  void add_all(int n, bool behind) {
    for (int k = 0; k < n; ++k) {
      const int width = 1 << (n - 1 - k);
      for (int i = 0; i < 2 << k; ++i) {
        const int first = count + i * width;
        add(first, first + width - 1, i % 2 == 0 ? Step::holds : Step::crosses, k, behind);
      }
    }
    for (int i = 0; i < 1 << n; ++i) {
      Order order;
      for (int k = 0; k < n; ++k)
        order.push_back((i >> (n - 1 - k)) % 2 == 0 ? Step::holds : Step::crosses);
      orders.push_back(std::move(order));
    }
    count += 1 << n;
  }
  void add_one(Order order, bool behind) {
    for (int k = 0; k < int(order.size()); ++k) add(count, count, order[std::size_t(k)], k, behind);
    orders.push_back(std::move(order));
    ++count;
  }
};

Scene over_a_floor(const TriMesh& boxes, double width) {
  Scene s;
  s.mesh = boxes;
  s.surfaces.resize(2);
  s.surface_of.assign(boxes.triangles.size(), 1);
  test::add_quad(s.mesh, {-1, -100, 0}, {width + 1, -100, 0}, {width + 1, 100, 0}, {-1, 100, 0});
  s.surface_of.resize(s.mesh.triangles.size(), 0);
  s.surfaces[0].casts = false;
  weld(s.mesh, s.surface_of);
  return s;
}

// Three rows of pixels of 1 m; the samples are the middle one's.
View along_the_strips(int count) {
  const double middle = count / 2.0;
  return orthographic_view({middle, -500, 500}, {middle, 0, 0}, {0, 0, 1}, 3.0, count, 3);
}

Strips every_order(bool behind) {
  Strips strips;
  for (int n = 1; n <= 10; ++n) strips.add_all(n, behind);
  // And far more than eight bits have halves.
  constexpr int kMany = 40;
  const Order hold(kMany, Step::holds), cross(kMany, Step::crosses);
  Order first_hold(hold), last_holds(cross), turns, every_third;
  first_hold.resize(kMany / 2);
  first_hold.resize(kMany, Step::crosses);
  last_holds.back() = Step::holds;
  for (int k = 0; k < kMany; ++k) {
    turns.push_back(k % 2 == 0 ? Step::holds : Step::crosses);
    every_third.push_back(k % 3 == 0 ? Step::holds : Step::crosses);
  }
  for (const Order& order : {hold, cross, first_hold, last_holds, turns, every_third})
    strips.add_one(order, behind);
  return strips;
}

std::string words(const Order& order) {
  std::string out;
  for (const Step step : order) out += step == Step::holds ? 'h' : 'c';
  return out;
}

TEST(MaskArithmetic, EightBitsAreRightForEveryOrderOfTenVolumesAndForFortyOnTopOfEachOther) {
  for (const bool behind : {false, true}) {
    const Strips strips = every_order(behind);
    const Scene scene = over_a_floor(strips.mesh, strips.count);
    const View view = along_the_strips(strips.count);
    for (const Api api : {Api::opengl, Api::opengl_es}) {
      Stage stage = stage_of(scene, api);
      const Camera camera = camera_of(view, depth_range(scene, view, false));
      for (const MaskIn in : {MaskIn::alpha, MaskIn::screen}) {
        for (const Arithmetic arithmetic : {Arithmetic::doubling, Arithmetic::maximum}) {
          Method m;
          m.mask = in;
          m.arithmetic = arithmetic;
          m.shadows = Shadows::attenuated;
          m.reach = Reach::infinite;  // beyond the floor, where z-fail counts
          m.count = behind ? Count::z_fail : Count::z_pass;
          FrameStats stats;
          const Result<ShadowMask> mask = stage.renderer.mask(camera, kAbove, m, &stats);
          ASSERT_TRUE(mask) << mask.error().message;
          ASSERT_EQ(stats.method.float_bits, 0);
          int wrong = 0;
          for (int i = 0; i < strips.count; ++i) {
            const Order& order = strips.orders[std::size_t(i)];
            const bool held = std::find(order.begin(), order.end(), Step::holds) != order.end();
            const std::uint8_t state = mask.value().state[std::size_t(strips.count + i)];
            if (state == (held ? ShadowMask::kShadow : ShadowMask::kLit)) continue;
            if (++wrong <= 3)
              ADD_FAILURE() << words(order) << " is " << int(state) << " by "
                            << describe(stats.method);
          }
          EXPECT_EQ(wrong, 0);
        }
      }
    }
  }
}

// A comb seen from above: a spine along y, and teeth that all reach over the sample's strip. It is
// one closed body that a ray enters once per tooth.
TriMesh comb(int teeth) {
  TriMesh m;
  const int rows = 2 * teeth - 1;
  const auto there = [&](int i, int j) {
    return j >= 0 && j < rows && (i == 1 || (i == 0 && j % 2 == 0));
  };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < 2; ++i) {
      if (!there(i, j)) continue;
      const double x0 = i, x1 = i + 1, y1 = -1.5 - j, y0 = y1 - 1;
      const double z0 = kBoxes + 20, z1 = z0 + 1;
      test::add_quad(m, {x0, y0, z1}, {x1, y0, z1}, {x1, y1, z1}, {x0, y1, z1});
      test::add_quad(m, {x0, y1, z0}, {x1, y1, z0}, {x1, y0, z0}, {x0, y0, z0});
      if (!there(i - 1, j))
        test::add_quad(m, {x0, y1, z0}, {x0, y0, z0}, {x0, y0, z1}, {x0, y1, z1});
      if (!there(i + 1, j))
        test::add_quad(m, {x1, y0, z0}, {x1, y1, z0}, {x1, y1, z1}, {x1, y0, z1});
      if (!there(i, j + 1))
        test::add_quad(m, {x0, y0, z0}, {x1, y0, z0}, {x1, y0, z1}, {x0, y0, z1});
      if (!there(i, j - 1))
        test::add_quad(m, {x1, y1, z0}, {x0, y1, z0}, {x0, y1, z1}, {x1, y1, z1});
    }
  }
  return m;
}

// The sample at (0.5, 0, 0) is in the shadow of a box, drawn first, and seen through a comb's
// teeth.
Scene shaded_behind_a_comb(int teeth) {
  TriMesh mesh;
  test::add_box(mesh, {0.25, -0.25, kBoxes}, {0.75, 0.25, kBoxes + 1});
  const TriMesh c = comb(teeth);
  const auto k = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), c.positions.begin(), c.positions.end());
  for (const Triangle& t : c.triangles) mesh.triangles.push_back({t[0] + k, t[1] + k, t[2] + k});
  return over_a_floor(mesh, 2);
}

Method in_alpha(MaskIn in, Arithmetic arithmetic) {
  Method m;
  m.mask = in;
  m.arithmetic = arithmetic;
  m.count = Count::z_pass;
  m.reach = Reach::infinite;
  return m;
}

// Of two teeth, in eight bits: 1/2, doubled to 1, doubled and clamped to 1, halved to 1/2, halved
// to 1/4, which is lit. The paper does not name this limit of its clamp.
TEST(MaskArithmetic, AConcaveCasterOverAShadowKeepsItInFloats) {
  for (const int teeth : {2, 3, 10}) {
    const Scene scene = shaded_behind_a_comb(teeth);
    const View view = along_the_strips(2);
    const ShadowMask exact = exact_mask(scene, kAbove, view);
    ASSERT_EQ(exact.state[2], ShadowMask::kShadow);
    for (const Api api : {Api::opengl, Api::opengl_es}) {
      for (const bool half_floats : {false, true}) {
        Stage stage = half_floats ? stage_of(scene, api, {"float-blend"}) : stage_of(scene, api);
        const Camera camera = camera_of(view, depth_range(scene, view, false));
        for (const MaskIn in : {MaskIn::alpha, MaskIn::screen}) {
          for (const Arithmetic arithmetic : {Arithmetic::doubling, Arithmetic::maximum}) {
            FrameStats stats;
            const Result<ShadowMask> mask =
                stage.renderer.mask(camera, kAbove, in_alpha(in, arithmetic), &stats);
            ASSERT_TRUE(mask) << mask.error().message;
            EXPECT_EQ(mask.value().state[2], ShadowMask::kShadow)
                << teeth << " teeth, " << describe(stats.method);
            EXPECT_GE(stats.method.float_bits, 16);
          }
        }
      }
    }
  }
}

TEST(MaskArithmetic, AConcaveCasterIsRefusedWithoutFloats) {
  const Scene scene = shaded_behind_a_comb(2);
  const View view = along_the_strips(2);
  Stage stage = stage_of(scene, Api::opengl, {"float-colour"});
  const Camera camera = camera_of(view, depth_range(scene, view, false));
  for (const MaskIn in : {MaskIn::alpha, MaskIn::screen}) {
    const Result<ShadowMask> mask =
        stage.renderer.mask(camera, kAbove, in_alpha(in, Arithmetic::doubling));
    ASSERT_FALSE(mask);
    EXPECT_NE(mask.error().message.find("--method stencil"), std::string::npos);
  }
}

TEST(MaskArithmetic, MoreShadowsOverEachOtherThanHalfFloatsCountAreRefused) {
  TriMesh mesh;
  for (int k = 0; k <= 20; ++k) test::add_ground(mesh, k == 0 ? 20 : 2, k);
  const Scene scene = test::scene_of(std::move(mesh));
  const View view = aerial();
  const Camera camera = camera_of(view, depth_range(scene, view, true));
  Stage stage = stage_of(scene, Api::opengl, {"float-blend"});
  const Result<ShadowMask> mask = stage.renderer.mask(
      camera, Light(0.2, 0.1, 9, 0), in_alpha(MaskIn::alpha, Arithmetic::doubling));
  ASSERT_FALSE(mask);
  EXPECT_NE(mask.error().message.find("--method stencil"), std::string::npos);
}

TEST(MaskArithmetic, MoreTeethThanHalfFloatsCountAreRefusedOrRight) {
  const Scene scene = shaded_behind_a_comb(20);
  const View view = along_the_strips(2);
  const Camera camera = camera_of(view, depth_range(scene, view, false));
  const Method doubling = in_alpha(MaskIn::alpha, Arithmetic::doubling);
  const Method maximum = in_alpha(MaskIn::alpha, Arithmetic::maximum);
  {
    Stage halves = stage_of(scene, Api::opengl, {"float-blend"});
    const Result<ShadowMask> doubled = halves.renderer.mask(camera, kAbove, doubling);
    EXPECT_TRUE(!doubled || doubled.value().state[2] == ShadowMask::kShadow);
    // Halves go down to numbers that a driver may keep or take for 0, which is found.
    const Result<ShadowMask> halved = halves.renderer.mask(camera, kAbove, maximum);
    EXPECT_TRUE(!halved || halved.value().state[2] == ShadowMask::kShadow);
  }
  Stage floats = stage_of(scene);
  for (const Method& m : {doubling, maximum})
    EXPECT_EQ(floats.renderer.mask(camera, kAbove, m).value().state[2], ShadowMask::kShadow);
}

TEST(MaskArithmetic, PicturesThatTheSceneDoesNotFillAreDrawnInFloatsToo) {
  const Scene scene = test::scene_of(boxes_on_ground());
  Stage stage = stage_of(scene);
  const View view = aerial();
  const Camera camera = camera_of(view, depth_range(scene, view, true));
  const LightSource source{Light(5, -4, 15, 1)};
  for (const MaskIn in : {MaskIn::alpha, MaskIn::screen}) {
    FrameOptions options;
    options.method.mask = in;
    FrameStats stats;
    const Result<Image> image = stage.renderer.render(camera, {&source, 1}, options, &stats);
    EXPECT_TRUE(image) << image.error().message;
    EXPECT_GT(stats.method.float_bits, 0);
  }
}

// A view along a row of walls enters more volumes than eight bits hold, but no point is in more
// than a few: saturating counts are lost, wrapping ones are not, and groups are not needed.
TEST(Stencil, ThatSaturatesIsCountedAgainAsOneThatWrapsWhereLayersAreFew) {
  TriMesh m;
  test::add_ground(m, 400);
  for (int k = 0; k < 300; ++k) test::add_box(m, {-5, 1.0 * k, 3}, {5, 1.0 * k + 0.5, 4});
  const Scene scene = test::scene_of(std::move(m));
  const View view = perspective_view({0.1, -20, 2.5}, {0, 300, 1}, {0, 0, 1}, 0.5, 64, 48);
  const Camera camera = camera_of(view, depth_range(scene, view, true));
  Stage stage = stage_of(scene);
  const ShadowMask wrapped = stage.renderer.mask(camera, kAbove, {}).value();
  Method saturating;
  saturating.passes = StencilPasses::culled;
  saturating.ops = StencilOps::saturate;
  saturating.volumes = VolumesOf::polygon;
  FrameStats stats;
  EXPECT_EQ(
      count_different(stage.renderer.mask(camera, kAbove, saturating, &stats).value(), wrapped), 0);
  EXPECT_EQ(stats.stencil_groups, 1);
}

}  // namespace
}  // namespace gnomon::gl
