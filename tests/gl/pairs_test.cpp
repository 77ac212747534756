// Combinations of choices, so many that every two come together in one, over small scenes that are
// hard in different ways.
#include <gnomon/gl/mask_bounds.h>
#include <gnomon/gl/method_pairs.h>
#include <gnomon/shadow/compare_masks.h>
#ifdef GNOMON_HAVE_IO
#include <gnomon/io/load_scene.h>
#endif

#include <map>
#include <tuple>

#include "gl_test.h"

namespace gnomon::gl {
namespace {

struct Tried {
  int drawn = 0;
  MaskDifference difference;
};

// Draws the combinations under each light and holds them to their bounds.
Tried try_pairs(const Scene& scene, const View& view, const std::vector<Light>& lights,
                Api api = Api::opengl, const std::vector<std::string>& lacking = {}) {
  Stage stage = stage_of(scene, api, lacking);
  const Casters casters = prepare_casters(scene);
  const ExactView exact_view_of = exact_view(scene, casters, view);
  const Camera clamped = camera_of(view, depth_range(scene, view, false));
  const Camera infinite =
      is_parallel(view) ? clamped : camera_of(view, depth_range(scene, view, true));
  Tried tried;
  for (const Light& light : lights) {
    const ExactAnswers exact = exact_answers(exact_view_of, light);
    Situation known;
    known.parallel_view = is_parallel(view);
    known.directional_light = light.w == 0;
    known.infinite_view = !known.parallel_view;
    MethodPairs pairs(known, stage.renderer.capabilities(), false);
    std::map<std::tuple<FarPlane, Reach, Primitives>, ShadowMask> stencil;
    while (const std::optional<Method> m = pairs.next()) {
      const Camera& camera = m->far_plane == FarPlane::clamp ? clamped : infinite;
      const Result<ShadowMask> mask = stage.renderer.mask(camera, light, *m);
      if (!mask) {
        EXPECT_TRUE(pairs.refused(mask.error().message) ||
                    mask.error().message.find("More shadows") == 0)
            << describe(*m) << ": " << mask.error().message;
        continue;
      }
      pairs.drawn();
      ++tried.drawn;
      const MaskBound b = bound_of(*m);
      const MaskDifference d =
          compare_masks(exact, mask.value(), {camera.clip}, {b.edge, b.steps, b.pixels});
      EXPECT_LE(double(d.differ), b.share * double(d.samples) + 2) << describe(*m);
      EXPECT_TRUE(b.unexplained || d.unexplained == 0) << describe(*m) << ": " << d.unexplained;
      tried.difference += d;
      if (!b.same_as_stencil) continue;
      auto& first = stencil[{m->far_plane, m->reach, m->primitives}];
      if (first.state.empty()) {
        Method base;
        base.far_plane = m->far_plane;
        base.reach = m->reach;
        base.primitives = m->primitives;
        first = stage.renderer.mask(camera, light, base).value();
      }
      EXPECT_EQ(differing_pixels(exact, mask.value(), first), 0u) << describe(*m);
    }
  }
  return tried;
}

View small_aerial() { return aerial(128, 96); }
View small_axonometry() {
  return orthographic_view({25, -30, 22}, {0, 0, 1}, {0, 0, 1}, 30, 128, 96);
}

const std::vector<Light> kLights{Light(5, -4, 15, 1), Light(0.4, -0.31, 0.5, 0)};

TEST(Pairs, KeepTheirBoundsOverBoxes) {
  const Scene scene = test::scene_of(boxes_on_ground());
  EXPECT_GT(try_pairs(scene, small_aerial(), kLights).drawn, 80);
  EXPECT_GT(try_pairs(scene, small_axonometry(), kLights).drawn, 50);
}

// A low sun's shadows end in an upright plane, across x or y, whose matrix has a zero where that of
// a point at infinity has one.
TEST(Reach, BoundedByAnUprightPlaneIsExact) {
  const Scene scene = test::scene_of(boxes_on_ground());
  Stage stage = stage_of(scene);
  const View view = aerial();
  const Camera camera = camera_of(view, depth_range(scene, view, true));
  Method m;
  m.reach = Reach::bounded;
  for (const Light& light : {Light(0.9, -0.3, 0.2, 0), Light(-0.9, 0.25, 0.2, 0),
                             Light(0.3, -0.9, 0.2, 0), Light(0.25, 0.9, 0.2, 0)}) {
    const Result<ShadowMask> mask = stage.renderer.mask(camera, light, m);
    if (!mask) continue;  // the near plane lies behind such a plane
    EXPECT_LE(compare(mask.value(), exact_mask(scene, light, view)).pixels, 10) << light.x;
  }
}

// One box on the ground, seen from above: of the six sides below its outline two lie under the
// ground, and so does half of the two under its upright edges.
TEST(Reach, SidesBeyondTheReceiversAreLeftOutWhereZPassCounts) {
  TriMesh mesh;
  test::add_ground(mesh, 40);
  test::add_box(mesh, {-1, -1, 0}, {1, 1, 3});
  const Scene scene = test::scene_of(std::move(mesh));
  Stage stage = stage_of(scene);
  const View view = aerial();
  const Camera camera = camera_of(view, depth_range(scene, view, true));
  const Light lamp(-9, 8, 12, 1);
  const auto triangles = [&](Count count, Reach reach) {
    Method m;
    m.count = count;
    m.reach = reach;
    FrameStats stats;
    const ShadowMask mask = stage.renderer.mask(camera, lamp, m, &stats).value();
    EXPECT_LE(compare(mask, exact_mask(scene, lamp, view)).pixels, 4) << describe(m);
    return stats.volume_triangles;
  };
  // Triangles: under the box's outline and the ground's; of the lit faces of both.
  constexpr long long box = 12, ground = 8, caps = 6 + 2;
  EXPECT_EQ(triangles(Count::z_pass, Reach::infinite), box + ground + caps);
  EXPECT_EQ(triangles(Count::z_pass, Reach::bounded), box / 2 + caps);
  EXPECT_EQ(triangles(Count::z_fail, Reach::bounded), box + ground + 2 * caps);
}

// A lamp lower than the roofs: no plane ends the volumes, which would cover half of the picture.
TEST(Scissor, CutsVolumesToWhatTheyShadeAndLeavesOutThoseThatShadeNothingSeen) {
  TriMesh mesh;
  test::add_ground(mesh, 40);
  test::add_box(mesh, {-30, 20, 0}, {-29, 21, 9});
  for (int k = 0; k < 10; ++k) {
    const double x = 3.0 * k - 15;
    test::add_box(mesh, {x, 5, 0}, {x + 1, 6, 1 + k % 3});
    test::add_box(mesh, {x, -8, 0}, {x + 1, -7, 2});
  }
  const Scene scene = test::scene_of(std::move(mesh));
  const Light lamp(0.3, 0.2, 5, 1);
  const View view = perspective_view({-4, -16, 9}, {-4, -4, 0}, {0, 0, 1}, 0.7, 160, 120);
  Stage stage = stage_of(scene);
  const Camera camera = camera_of(view, depth_range(scene, view, true));
  const ShadowMask exact = exact_mask(scene, lamp, view);
  ASSERT_GT(std::count(exact.state.begin(), exact.state.end(), ShadowMask::kShadow), 100);
  for (const MaskIn mask : {MaskIn::stencil, MaskIn::alpha, MaskIn::screen}) {
    for (const Count count : {Count::automatic, Count::z_fail, Count::mixed}) {
      Method m;
      m.mask = mask;
      m.count = count;
      m.reach = Reach::infinite;
      FrameStats stats;
      const ShadowMask drawn = stage.renderer.mask(camera, lamp, m, &stats).value();
      EXPECT_LE(compare(drawn, exact).pixels, 4) << describe(m);
      EXPECT_GT(stats.scissored_volumes, 3) << describe(m);
      EXPECT_GE(stats.culled_volumes, 3) << describe(m);
    }
  }
}

// The bounding plane may lie on the eye's side of the near plane: a dark cap in it lies before all
// that is seen, and with depth clamp nothing cuts it away.
TEST(Reach, DarkCapsBeforeTheNearPlaneCountNothing) {
  TriMesh mesh;
  test::add_ground(mesh, 20);
  test::add_box(mesh, {2, -3, 0}, {4, 3, 5});
  test::add_box(mesh, {-6, -2, 8}, {0, 2, 10});
  const Scene scene = test::scene_of(std::move(mesh));
  Stage stage = stage_of(scene);
  for (const bool parallel : {false, true}) {
    for (const Light& sun : {Light(-1, -0.3, -0.2, 0), Light(-1, 0.2, 0.1, 0)}) {
      const Vec3 eye(30, 2, 2), target(0, 0, 3), up(0, 0, 1);
      const View view = parallel ? orthographic_view(eye, target, up, 40, 240, 180)
                                 : perspective_view(eye, target, up, 0.8, 240, 180);
      const Camera camera = camera_of(view, depth_range(scene, view, !parallel));
      Method m;
      m.far_plane = FarPlane::clamp;
      for (const Count count : {Count::automatic, Count::z_fail}) {
        m.count = count;
        const Result<ShadowMask> mask = stage.renderer.mask(camera, sun, m);
        ASSERT_TRUE(mask) << mask.error().message;
        EXPECT_LE(compare(mask.value(), exact_mask(scene, sun, view)).pixels, 10)
            << parallel << " " << sun.z << ": " << describe(m);
      }
    }
  }
}

// A box before the near plane of a parallel view: its cap there must not cancel another's shadow.
TEST(NearPlane, OfAParallelViewMayLieBehindACaster) {
  TriMesh seen;
  test::add_ground(seen, 20);
  test::add_box(seen, {2, -3, 0}, {4, 3, 5});
  TriMesh all = seen;
  test::add_box(all, {-6, -2, 50}, {0, 2, 52});
  const Scene scene = test::scene_of(std::move(seen));
  const View view = orthographic_view({0, -0.5, 60}, {0, 0, 0}, {0, 1, 0}, 20, 160, 120);
  const Light sun(1, 0, 0.5, 0);
  const Camera camera = camera_of(view, depth_range(scene, view, false));
  const ShadowMask exact = exact_mask(scene, sun, view);
  Stage stage = stage_of(test::scene_of(std::move(all)));
  for (const Count count : {Count::automatic, Count::z_pass, Count::z_fail, Count::mixed}) {
    for (const Reach reach : {Reach::infinite, Reach::bounded}) {
      Method m;
      m.count = count;
      m.reach = reach;
      const Result<ShadowMask> mask = stage.renderer.mask(camera, sun, m);
      if (!mask) continue;
      EXPECT_LE(compare(mask.value(), exact).pixels, 4) << describe(m);
    }
  }
}

// A plate shades the eye but not the near rectangle: its side passes between them.
TEST(NearPlane, SidesBeforeItAreNotCountedWithDepthClamp) {
  TriMesh m;
  test::add_ground(m, 40);
  test::add_box(m, {-0.5, -2, 8}, {0.5, 2, 8.5});
  test::add_box(m, {8, -3, 3}, {12, 3, 4});
  const Scene scene = test::scene_of(std::move(m));
  const View view = perspective_view({0, 0, 5}, {10, 0, 1}, {0, 0, 1}, 0.8, 64, 48);
  const Camera camera = camera_of(view, {1.0, 100.0});
  const Light sun(0, 0, 1, 0);
  const ShadowMask exact = exact_mask(scene, sun, view);
  ASSERT_GT(std::count(exact.state.begin(), exact.state.end(), ShadowMask::kShadow), 100);
  Stage stage = stage_of(scene);
  for (const MaskIn mask : {MaskIn::stencil, MaskIn::alpha, MaskIn::screen}) {
    for (const Count count : {Count::automatic, Count::z_fail, Count::near_cap, Count::zp_plus}) {
      Method method;
      method.mask = mask;
      method.count = count;
      method.far_plane = FarPlane::clamp;
      EXPECT_LE(compare(stage.renderer.mask(camera, sun, method).value(), exact).pixels, 10)
          << describe(method);
    }
  }
}

// A plate's shadow whose edges run through pixel centres in plan: whole rows are ties, on whichever
// side they are drawn. A quarter of a pixel aside there are none.
TEST(Edges, SamplesOnThemAreToldApart) {
  for (const double aside : {0.0, 0.25}) {
    TriMesh m;
    test::add_ground(m, 40);
    test::add_quad(m, {-9.5 + aside, -8.5 + aside, 4}, {8.5 + aside, -8.5 + aside, 4},
                   {8.5 + aside, 9.5 + aside, 4}, {-9.5 + aside, 9.5 + aside, 4});
    const Scene scene = test::scene_of(std::move(m));
    const Casters casters = prepare_casters(scene);
    const View view = plan_view({-32, -32, 32, 32}, 1, 0);
    const ExactView samples = exact_view(scene, casters, view);
    const ExactAnswers exact = exact_answers(samples, Light(1, 1, 1, 0));
    ShadowMask other = exact.mask;  // every row and column of the edges the other way
    std::uint64_t flipped = 0;
    for (std::size_t k = 65; k + 65 < other.state.size(); ++k) {
      const auto& s = exact.mask.state;
      if (s[k] != s[k + 1] || s[k] != s[k + 64]) {
        other.state[k] = s[k] == ShadowMask::kLit ? ShadowMask::kShadow : ShadowMask::kLit;
        ++flipped;
      }
    }
    ASSERT_GT(flipped, 20u);
    EXPECT_EQ(differing_on_edges(exact, other) > 0, aside == 0);
    Stage stage = stage_of(scene);
    const Camera camera = camera_of(view, depth_range(scene, view, false));
    const ShadowMask drawn = stage.renderer.mask(camera, Light(1, 1, 1, 0), {}).value();
    EXPECT_EQ(differing_on_edges(exact, drawn), differing_pixels(exact, drawn, exact.mask));
    EXPECT_TRUE(aside == 0 || differing_pixels(exact, drawn, exact.mask) == 0);
  }
}

// A plate shades the ground from x = -10 to 10, and below it the shadow of an upright wall begins a
// thousandth of a pixel from the pixel centres of one row: its side is seen edge-on, and may be
// counted there at any depth, but not in the next row.
TEST(Explanations, OfSidesSeenEdgeOnHoldOnlyWhereTheyPass) {
  TriMesh m;
  test::add_ground(m, 40);
  test::add_quad(m, {10, -8, 10}, {30, -8, 10}, {30, 8, 10}, {10, 8, 10});
  test::add_quad(m, {4, 0.501, 1}, {4, 3.6, 1}, {4, 3.6, 3}, {4, 0.501, 3});
  const Scene scene = test::scene_of(std::move(m));
  const Casters casters = prepare_casters(scene);
  const View view = plan_view({-32, -32, 32, 32}, 1, 0);
  const ExactView samples = exact_view(scene, casters, view);
  const ExactAnswers exact = exact_answers(samples, Light(1, 0, 0.5, 0));
  const Camera camera = camera_of(view, depth_range(scene, view, false));
  const MaskBound b = bound_of({});
  const auto made_lit = [&](int x, int y) {  // the pixel whose lower left corner is there
    ShadowMask drawn = exact.mask;
    std::uint8_t& state = drawn.state[std::size_t(31 - y) * 64 + std::size_t(x + 32)];
    EXPECT_EQ(state, ShadowMask::kShadow);
    state = ShadowMask::kLit;
    return compare_masks(exact, drawn, {camera.clip}, {b.edge, b.steps, b.pixels});
  };
  EXPECT_EQ(made_lit(-2, 0).in_depth, 1u);
  EXPECT_EQ(made_lit(-2, -1).unexplained, 1u);  // a row farther
  EXPECT_EQ(made_lit(-2, 1).unexplained, 1u);   // in both shadows
  EXPECT_EQ(made_lit(6, 0).unexplained, 1u);    // before the wall, where no side begins
}

// 340 layers, each `rise` above the one before.
void add_folded_strip(TriMesh& m, double rise) {
  constexpr int kFolds = 340;  // modulo 128 more than half of it: a group that holds all is lit
  const auto first = static_cast<std::uint32_t>(m.positions.size());
  for (int k = 0; k <= kFolds; ++k) {
    const double x = k % 2 == 0 ? -3 : 3;
    m.positions.insert(m.positions.end(), {Vec3(x, -3, 8 + rise * k), Vec3(x, 3, 8 + rise * k)});
  }
  for (std::uint32_t k = 0; k < kFolds; ++k) {
    const std::uint32_t a = first + 2 * k;
    m.triangles.insert(m.triangles.end(), {{a, a + 1, a + 2}, {a + 2, a + 1, a + 3}});
  }
}

// Ground of 32 x 32 metres, `fine` x `fine` cells a square metre, two triangles each.
TriMesh rolling_ground(int fine) {
  TriMesh m;
  const int cells = 32 * fine;
  const auto height = [&](int i, int j) {
    return 0.4 * std::sin(i * 1.1 / fine) * std::cos(j * 0.9 / fine);
  };
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i)
      m.positions.push_back(Vec3(double(i) / fine - 16, double(j) / fine - 16, height(i, j)));
  const auto n = static_cast<std::uint32_t>(cells);
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, c = a + n + 1;
      m.triangles.insert(m.triangles.end(), {{a, a + 1, c}, {c, a + 1, c + 1}});
    }
  }
  return m;
}

// A low sun over rolling ground, whose sides make small angles with what they fall on: where it
// grazes one small triangle, the shadows elsewhere must stay where they are.
TEST(Grazing, MovesNoSidesButThoseOfWhatIsGrazed) {
  TriMesh m = rolling_ground(1);
  const Light sun(1, 0.5, 0.0625, 0);
  const auto first = static_cast<std::uint32_t>(m.positions.size());
  const Vec3 corner(-14, 14, 1);
  m.positions.insert(m.positions.end(),
                     {corner, corner + 0.5 * Vec3(sun), corner + Vec3(0, 0, 0.5)});
  m.triangles.push_back({first, first + 1, first + 2});
  const Scene scene = test::scene_of(std::move(m));
  const View view = aerial(160, 120);
  Stage stage = stage_of(scene);
  const Camera camera = camera_of(view, depth_range(scene, view, true));
  for (const Primitives primitives : {Primitives::quads, Primitives::fans}) {
    Method method;
    method.primitives = primitives;
    EXPECT_LE(
        compare(stage.renderer.mask(camera, sun, method).value(), exact_mask(scene, sun, view))
            .pixels,
        3);
  }
}

// Prisms of a flat ground with trees, far smaller than pixels, in groups: a side that two of them
// share, and that lies in one group's prism before a sample by rounding, must cancel with the other
// group's.
TEST(Groups, OfPolygonsAreTheMaskOfTheWhole) {
  TriMesh ground = rolling_ground(4);
  for (std::size_t k = 0; k < ground.positions.size(); ++k) {  // flat, with trees
    const bool tree = k % 11 < 4 && k / 129 % 7 < 3;
    ground.positions[k].z = tree ? 3 + 0.37 * double(k % 13) : 0;
  }
  add_folded_strip(ground, 0.0005);  // so many layers that they must be counted in groups
  const Scene scene = test::scene_of(std::move(ground));

  const View view = plan_view({-16, -16, 16, 16}, 0.5, 0);
  Stage stage = stage_of(scene);
  const Camera camera = camera_of(view, depth_range(scene, view, false));
  const Light sun(0.955, -0.292, 0.0523, 0);
  Method m;
  m.reach = Reach::infinite;
  m.passes = StencilPasses::culled;
  m.count = Count::z_fail;
  const ShadowMask whole = stage.renderer.mask(camera, sun, m).value();
  m.volumes = VolumesOf::polygon;
  m.ops = StencilOps::saturate;
  FrameStats stats;
  const ShadowMask grouped = stage.renderer.mask(camera, sun, m, &stats).value();
  EXPECT_GT(stats.stencil_groups, 1);
  EXPECT_EQ(count_different(grouped, whole), 0);
}

// A wall that leans back a little under an eave, which shades it: the side over the edge between
// them runs just behind the wall.
TEST(Grazing, WallThatLeansBackUnderAnEaveIsInItsShadow) {
  for (const int bits : {11, 12, 13, 14, 15}) {
    const double lean = std::exp2(-bits - 0.5);  // sine of the angle to the light
    TriMesh m;
    test::add_ground(m, 30);
    test::add_quad(m, {0, -5, 0}, {0, 5, 0}, {-8 * lean, 5, 8}, {-8 * lean, -5, 8});
    test::add_quad(m, {-8 * lean, -5, 8}, {-8 * lean, 5, 8}, {2, 5, 9}, {2, -5, 9});
    const Scene scene = test::scene_of(std::move(m));
    const View view = perspective_view({20, -9, 5}, {0, 0, 4}, {0, 0, 1}, 0.8, 160, 120);
    Stage stage = stage_of(scene);
    const Camera camera = camera_of(view, {0.25, 200});
    const Light sun(0, 0, 1, 0);
    EXPECT_LE(
        compare(stage.renderer.mask(camera, sun, {}).value(), exact_mask(scene, sun, view)).pixels,
        8)
        << bits;
  }
}

// A folded strip above the eye: one lit region, of more layers than eight bits count.
TEST(Mixed, CountsARegionOfMoreLayersThanTheStencilHolds) {
  TriMesh m;
  test::add_ground(m, 40);
  add_folded_strip(m, 0.01);
  const Scene scene = test::scene_of(std::move(m));
  const View view = perspective_view({-2, 0, 4}, {10, 0, 0}, {0, 0, 1}, 1.2, 64, 48);
  const Camera camera = camera_of(view, depth_range(scene, view, true));
  const Light sun(0.03, 0.02, 1, 0);
  const ShadowMask exact = exact_mask(scene, sun, view);
  ASSERT_GT(std::count(exact.state.begin(), exact.state.end(), ShadowMask::kShadow), 100);
  Stage stage = stage_of(scene);
  for (const Count count : {Count::mixed, Count::automatic}) {
    for (const StencilPasses passes : {StencilPasses::two_sided, StencilPasses::culled}) {
      Method method;
      method.count = count;
      method.passes = passes;
      method.ops = passes == StencilPasses::culled ? StencilOps::saturate : StencilOps::wrap;
      EXPECT_LE(compare(stage.renderer.mask(camera, sun, method).value(), exact).pixels, 5)
          << describe(method);
    }
  }
}

TEST(Pairs, KeepTheirBoundsOnOpenGlEs) {
  const Scene scene = test::scene_of(boxes_on_ground());
  EXPECT_GT(try_pairs(scene, small_aerial(), kLights, Api::opengl_es).drawn, 80);
}

TEST(Pairs, KeepTheirBoundsOverASoup) {
  TriMesh m;
  test::add_ground(m, 20);
  test::add_soup(m, 40, 8, 0, 7);
  try_pairs(test::scene_of(std::move(m)), small_aerial(), kLights);
}

TEST(Pairs, KeepTheirBoundsOverOpenNonManifoldAndInsideOutCasters) {
  TriMesh m;
  test::add_ground(m, 20);
  test::add_quad(m, {-6, 0, 1}, {0, 0, 1}, {0, 3, 5}, {-6, 3, 5});  // three sheets on one edge
  test::add_quad(m, {-6, 0, 1}, {0, 0, 1}, {0, -3, 4}, {-6, -3, 4});
  test::add_quad(m, {-6, 0, 1}, {0, 0, 1}, {0, 0, 6}, {-6, 0, 6});
  TriMesh box;
  test::add_box(box, {3, 1, 1}, {8, 5, 4});
  for (Triangle& t : box.triangles) {  // inside out
    std::swap(t[1], t[2]);
    for (std::uint32_t& v : t) v += static_cast<std::uint32_t>(m.positions.size());
  }
  box.triangles.pop_back();  // and open
  m.positions.insert(m.positions.end(), box.positions.begin(), box.positions.end());
  m.triangles.insert(m.triangles.end(), box.triangles.begin(), box.triangles.end());
  const Scene scene = test::scene_of(std::move(m));
  try_pairs(scene, small_aerial(), kLights);
  try_pairs(scene, small_axonometry(), {kLights[1]});
}

TEST(Pairs, KeepTheirBoundsWithoutWhatOpenGlEsMayLack) {
  TriMesh m = boxes_on_ground();
  test::add_soup(m, 12, 6, 0, 3);
  const Scene scene = test::scene_of(std::move(m));
  for (const std::vector<std::string>& lacking : std::vector<std::vector<std::string>>{
           {"depth-clamp"}, {"float-blend"}, {"float-colour", "depth-clamp", "multisampling"}}) {
    EXPECT_GT(try_pairs(scene, small_aerial(), {kLights[0]}, Api::opengl_es, lacking).drawn, 20);
  }
}

#ifdef GNOMON_HAVE_IO
// The buildings within `half` metres of the middle.
Scene vienna(double half) {
  LoadOptions options;
  options.crs = "EPSG:31256";
  Scene scene =
      load_scene({std::string(GNOMON_SCENES) + "/vienna/vienna.city.jsonl"}, options).value().scene;
  Vec3 middle(0);
  for (const Vec3& p : scene.mesh.positions)
    middle += p / static_cast<double>(scene.mesh.positions.size());
  TriMesh part;
  part.positions = scene.mesh.positions;
  for (Vec3& p : part.positions) p -= middle;
  for (const Triangle& t : scene.mesh.triangles) {
    const Vec3& p = part.positions[t[0]];
    if (std::fabs(p.x) < half && std::fabs(p.y) < half) part.triangles.push_back(t);
  }
  return test::scene_of(std::move(part));
}

TEST(Pairs, KeepTheirBoundsOverAPartOfVienna) {
  const Scene scene = vienna(45);
  ASSERT_GT(scene.mesh.triangles.size(), 200u);
  const View view = perspective_view({80, -90, 70}, {0, 0, 0}, {0, 0, 1}, 0.8, 128, 96);
  try_pairs(scene, view, {Light(0.4, -0.31, 0.5, 0)});
}
#endif

}  // namespace
}  // namespace gnomon::gl
