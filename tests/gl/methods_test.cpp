// Every method paints the same mask, and it is the exact one.
#include "gl_test.h"

namespace gnomon::gl {
namespace {

struct Case {
  std::string name;
  Method method;
};

std::vector<Case> full_resolution_methods() {
  std::vector<Case> out;
  for (const MaskIn mask : {MaskIn::stencil, MaskIn::alpha, MaskIn::screen}) {
    for (const Count count : {Count::z_pass, Count::z_fail, Count::automatic}) {
      for (const VolumesOf volumes : {VolumesOf::automatic, VolumesOf::polygon}) {
        for (const Extrusion extrusion : {Extrusion::cpu, Extrusion::shader, Extrusion::blend}) {
          for (const bool second : {false, true}) {
            Method m;
            m.mask = mask;
            m.count = count;
            m.volumes = volumes;
            m.extrusion = extrusion;
            if (mask == MaskIn::stencil) {
              m.passes = second ? StencilPasses::culled : StencilPasses::two_sided;
              m.ops = second ? StencilOps::saturate : StencilOps::wrap;
            } else {
              m.arithmetic = second ? Arithmetic::maximum : Arithmetic::doubling;
            }
            out.push_back({describe(m), m});
          }
        }
      }
    }
  }
  return out;
}

TEST(Methods, AllGiveTheSameMaskAndItIsTheExactOneButForEdges) {
  const Scene scene = test::scene_of(boxes_on_ground());
  const View view = aerial();
  for (const Api api : {Api::opengl, Api::opengl_es}) {
    Stage stage = stage_of(scene, api);
    const Camera camera = camera_of(view, depth_range(scene, view, true));
    for (const Light light : {Light(5, -4, 15, 1), Light(0.4, -0.3, 0.5, 0)}) {
      const ShadowMask exact = exact_mask(scene, light, view);
      const ShadowMask first = stage.renderer.mask(camera, light, {}).value();
      const Difference d = compare(first, exact);
      EXPECT_LE(d.pixels, int(exact.state.size() / 1000));
      EXPECT_EQ(d.far_off, 0);
      for (const Case& c : full_resolution_methods()) {
        const Result<ShadowMask> mask = stage.renderer.mask(camera, light, c.method);
        ASSERT_TRUE(mask) << c.name << ": " << mask.error().message;
        EXPECT_EQ(count_different(mask.value(), first), 0) << c.name;
      }
    }
  }
}

}  // namespace
}  // namespace gnomon::gl
