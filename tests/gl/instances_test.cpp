// Many casters, as one mesh and as instances; several samples a pixel.
#include <glm/gtc/matrix_transform.hpp>

#include <gnomon/gl/mask_bounds.h>
#include <gnomon/shadow/compare_masks.h>

#include "gl_test.h"

namespace gnomon::gl {
namespace {

constexpr int kAcross = 50;  // boxes; 2500 in all

glm::dmat4 place_of(int k) {
  const int i = k % kAcross, j = k / kAcross;
  const double size = 1 + (k * 7 % 11) * 0.125;
  glm::dmat4 m = glm::translate(glm::dmat4(1.0), Vec3(4.0 * i, 4.0 * j, 0));
  m = glm::rotate(m, 0.37 * (k % 5), Vec3(0, 0, 1));
  return glm::scale(m, Vec3(size));
}

TriMesh unit_box() {
  TriMesh m;
  test::add_box(m, {-0.5, -0.5, 0.25}, {0.5, 0.5, 1.75});
  return m;
}

TriMesh ground() {
  TriMesh m;
  test::add_quad(m, {-20, -20, 0}, {4.0 * kAcross + 20, -20, 0},
                 {4.0 * kAcross + 20, 4.0 * kAcross + 20, 0}, {-20, 4.0 * kAcross + 20, 0});
  return m;
}

TEST(Instances, ThousandsOfThemPaintTheMaskOfOneMesh) {
  const TriMesh box = unit_box();
  TriMesh whole = ground();
  for (int k = 0; k < kAcross * kAcross; ++k) {
    const auto first = static_cast<std::uint32_t>(whole.positions.size());
    for (const Vec3& p : box.positions) whole.positions.push_back(Vec3(place_of(k) * point(p)));
    for (const Triangle& t : box.triangles)
      whole.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  const Scene scene = test::scene_of(std::move(whole));
  const View view = perspective_view({-40, -50, 70}, {112, 112, 0}, {0, 0, 1}, 0.7, 160, 120);
  // Grazes none of their walls, or sides over their edges would be moved away a little
  // (volume_draws.cpp).
  const Light light(0.5, 0.32, 0.6, 0);
  const Casters casters = prepare_casters(scene);
  const ExactView exact_view_of = exact_view(scene, casters, view);
  const ExactAnswers exact = exact_answers(exact_view_of, light);
  const Camera camera = camera_of(view, depth_range(scene, view, true));

  const auto check = [&](Stage& stage, const std::string& what) {
    for (const MaskIn mask : {MaskIn::stencil, MaskIn::alpha}) {
      for (const Count count : {Count::automatic, Count::z_fail}) {
        Method m;
        m.mask = mask;
        m.count = count;
        const MaskBound b = bound_of(m);
        const MaskDifference d = compare_masks(exact, stage.renderer.mask(camera, light, m).value(),
                                               {camera.clip}, {b.edge, b.steps, b.pixels});
        EXPECT_LE(double(d.differ), b.share * double(d.samples)) << what << describe(m);
        EXPECT_EQ(d.unexplained, 0u) << what << describe(m);
      }
    }
  };
  {
    Stage one = stage_of(scene);
    check(one, "one mesh: ");
  }
  Stage many = stage_of(test::scene_of(ground()));
  const MeshId mesh = many.renderer.add_mesh(test::scene_of(unit_box()).mesh);
  for (int k = 0; k < kAcross * kAcross; ++k) many.renderer.add_instance(mesh, place_of(k));
  check(many, "instances: ");
}

// The share of 9 x 9 exact samples of each pixel that are lit; -1: some have no surface.
std::vector<double> lit_share(const Scene& scene, const View& view, const Light& light) {
  constexpr int k = 9;
  View finer = view;
  finer.right /= k;
  finer.down /= k;
  finer.width *= k;
  finer.height *= k;
  const ShadowMask mask = cast_shadows(scene, light, finer);
  std::vector<double> out(std::size_t(view.width) * view.height);
  for (int row = 0; row < finer.height; ++row) {
    for (int column = 0; column < finer.width; ++column) {
      double& share = out[std::size_t(row / k) * view.width + column / k];
      const std::uint8_t state = mask.state[std::size_t(row) * finer.width + column];
      if (state == ShadowMask::kNoSample) share = -1;
      if (share >= 0 && state == ShadowMask::kLit) share += 1.0 / (k * k);
    }
  }
  return out;
}

// With n samples a pixel a mask's state says which are more, lit or shaded. Samples lie anywhere in
// the pixel: of a straight edge through it they see the larger part of the pixel's area where that
// is above 3/4, since of the usual patterns no half plane of that area misses more than half.
TEST(Multisampling, MaskIsTheLargerPartOfThePixel) {
  TriMesh m;  // closed and convex: alpha and screen masks have several samples of no others
  test::add_box(m, {-20, -20, -1}, {20, 20, 0});
  test::add_box(m, {-3, -2, 0.5}, {1, 2, 6});
  test::add_box(m, {4, 3, 0.5}, {7, 8, 3});
  test::add_box(m, {-9, 5, 2}, {-6, 9, 4});
  const Scene scene = test::scene_of(std::move(m));
  const View view = aerial(128, 96);
  for (const Light light : {Light(5, -4, 15, 1), Light(0.4, -0.31, 0.5, 0)}) {
    const std::vector<double> share = lit_share(scene, view, light);
    Stage stage = stage_of(scene);
    const Camera camera = camera_of(view, depth_range(scene, view, true));
    for (const MaskIn in : {MaskIn::stencil, MaskIn::alpha, MaskIn::screen}) {
      Method method;
      method.mask = in;
      method.samples = 4;
      const ShadowMask mask = stage.renderer.mask(camera, light, method).value();
      int wrong = 0, edges = 0;
      for (std::size_t k = 0; k < share.size(); ++k) {
        if (share[k] < 0) continue;
        edges += share[k] > 0.01 && share[k] < 0.99 ? 1 : 0;
        wrong += (share[k] > 0.75 && mask.state[k] != ShadowMask::kLit) ||
                         (share[k] < 0.25 && mask.state[k] != ShadowMask::kShadow)
                     ? 1
                     : 0;
      }
      EXPECT_GT(edges, 50);
      // Corners and slivers in a pixel are no half planes.
      EXPECT_LE(wrong, edges / 20) << describe(method);
    }
  }
}

}  // namespace
}  // namespace gnomon::gl
