// Table 1 of Roettger, Irion and Ertl, Shadow Volumes Revisited, 2002: passes of the scene and
// rectangles over the window, as the renderer counts them; and the pictures behind the numbers.
#include <algorithm>
#include <cstdlib>

#include <scenes/paper_scenes.h>

#include "gl_test.h"

namespace gnomon::gl {
namespace {

struct Cell {
  MaskIn mask;
  Shadows shadows;
  Arithmetic arithmetic;
  int passes, rectangles;
};

// The maximum variant's rectangles are the numbers in brackets; it is there for attenuated shadows.
constexpr Cell kTable1[] = {
    {MaskIn::alpha, Shadows::black, Arithmetic::doubling, 1, 4},
    {MaskIn::alpha, Shadows::ambient, Arithmetic::doubling, 2, 4},
    {MaskIn::alpha, Shadows::attenuated, Arithmetic::doubling, 1, 4},
    {MaskIn::alpha, Shadows::attenuated, Arithmetic::maximum, 1, 2},
    {MaskIn::screen, Shadows::black, Arithmetic::doubling, 2, 3},
    {MaskIn::screen, Shadows::ambient, Arithmetic::doubling, 3, 3},
    {MaskIn::screen, Shadows::attenuated, Arithmetic::doubling, 2, 3},
    {MaskIn::screen, Shadows::attenuated, Arithmetic::maximum, 2, 1},
};

FrameOptions options_of(MaskIn mask, Shadows shadows, Arithmetic arithmetic) {
  FrameOptions o;
  o.method.mask = mask;
  o.method.shadows = shadows;
  o.method.arithmetic = arithmetic;
  return o;
}

LightSource lamp_at(double phase) {
  const scenes::Lamp lamp = scenes::lamp_on_its_round(phase);
  return {point(lamp.at), lamp.colour, {1, 0, 0}, 0};
}

int largest_difference(const Image& a, const Image& b) {
  int most = a.rgba.size() == b.rgba.size() ? 0 : 256;
  for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); ++i) {
    if (i % 4 == 3) continue;  // alpha holds masks
    most = std::max(most, std::abs(int(a.rgba[i]) - int(b.rgba[i])));
  }
  return most;
}

TEST(Table1, PassesAndRectanglesOfEveryCellAreThePapers) {
  const scenes::PaperScene s = scenes::convex_bodies();
  const View view = scenes::view_of(s, 160, 120);
  const Camera camera = camera_of(view, depth_range(s.scene, view, true));
  for (const Api api : {Api::opengl, Api::opengl_es}) {
    Stage stage = stage_of(s.scene, api);
    for (const Cell& cell : kTable1) {
      const LightSource light = lamp_at(0.3);
      const Result<FrameStats> stats = stage.renderer.draw(
          camera, {&light, 1}, options_of(cell.mask, cell.shadows, cell.arithmetic));
      ASSERT_TRUE(stats) << stats.error().message;
      EXPECT_EQ(stats.value().method.float_bits, 0) << "convex bodies take 8 bits";
      EXPECT_EQ(stats.value().passes, cell.passes) << describe(stats.value().method);
      EXPECT_EQ(stats.value().rectangles, cell.rectangles) << describe(stats.value().method);
    }
  }
}

TEST(Table1, TheMaximumVariantHasNoBlackOrAmbientCell) {
  const scenes::PaperScene s = scenes::convex_bodies();
  const View view = scenes::view_of(s, 16, 12);
  const Camera camera = camera_of(view, depth_range(s.scene, view, true));
  Stage stage = stage_of(s.scene);
  const LightSource light = lamp_at(0);
  for (const Shadows shadows : {Shadows::black, Shadows::ambient}) {
    const Result<FrameStats> drawn = stage.renderer.draw(
        camera, {&light, 1}, options_of(MaskIn::alpha, shadows, Arithmetic::maximum));
    ASSERT_FALSE(drawn);
    EXPECT_NE(drawn.error().message.find("Table 1"), std::string::npos);
  }
}

// Pixels of which a colour differs by more than `rounding`.
int count_farther_apart(const Image& a, const Image& b, int rounding) {
  int n = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    bool apart = false;
    for (std::size_t k = i; k < i + 3; ++k)
      apart |= std::abs(int(a.rgba[k]) - int(b.rgba[k])) > rounding;
    n += apart ? 1 : 0;
  }
  return n;
}

// Lit is 254/255 in a doubled mask, one half is 127/255 or 128/255, and the product is rounded
// once: channels of two pictures may be one step of 255 apart, in no pixel more.
TEST(Table1, AlphaScreenAndStencilPaintTheSamePictureButForRounding) {
  constexpr int kRounding = 1;
  const scenes::PaperScene s = scenes::convex_bodies();
  const View view = scenes::view_of(s, 320, 240);
  const Camera camera = camera_of(view, depth_range(s.scene, view, true));
  for (const Api api : {Api::opengl, Api::opengl_es}) {
    Stage stage = stage_of(s.scene, api);
    for (const double phase : {0.1, 0.5, 0.85}) {
      const LightSource light = lamp_at(phase);
      for (const Cell& cell : kTable1) {
        const Image stencil =
            stage.renderer
                .render(camera, {&light, 1},
                        options_of(MaskIn::stencil, cell.shadows, Arithmetic::doubling))
                .value();
        const Image ours =
            stage.renderer
                .render(camera, {&light, 1}, options_of(cell.mask, cell.shadows, cell.arithmetic))
                .value();
        EXPECT_EQ(count_farther_apart(ours, stencil, kRounding), 0)
            << name_of(cell.mask) << ", " << name_of(cell.shadows) << ", "
            << name_of(cell.arithmetic) << ", phase " << phase;
        FrameOptions none = options_of(MaskIn::stencil, Shadows::none, Arithmetic::doubling);
        const Image unshadowed = stage.renderer.render(camera, {&light, 1}, none).value();
        EXPECT_GT(largest_difference(ours, unshadowed), 50) << "there are shadows";
      }
    }
  }
}

TEST(Table1, WithoutShadowsTheSceneIsDrawnOncePerLight) {
  const scenes::PaperScene s = scenes::convex_bodies();
  const View view = scenes::view_of(s, 160, 120);
  const Camera camera = camera_of(view, depth_range(s.scene, view, true));
  Stage stage = stage_of(s.scene);
  const std::vector<LightSource> lights{lamp_at(0.1), lamp_at(0.4), lamp_at(0.7)};
  for (const std::size_t n : {1u, 3u}) {
    const FrameStats stats =
        stage.renderer
            .draw(camera, {lights.data(), n},
                  options_of(MaskIn::stencil, Shadows::none, Arithmetic::doubling))
            .value();
    EXPECT_EQ(stats.passes, int(n));
    EXPECT_EQ(stats.rectangles + stats.other_rectangles + stats.volume_draws, 0);
  }
}

}  // namespace
}  // namespace gnomon::gl
