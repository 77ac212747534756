// The hard cases of scenes/hard_cases.h: every way of counting, in every kind of mask, in both
// APIs, against the exact mask.
#include <chrono>
#include <cstdlib>

#include <glm/geometric.hpp>

#include <scenes/hard_cases.h>

#include "gl_test.h"

namespace gnomon::gl {
namespace {

constexpr int kWidth = 240, kHeight = 180;

const std::vector<scenes::HardCase>& cases() {
  static const std::vector<scenes::HardCase> all = scenes::hard_cases(kWidth, kHeight);
  return all;
}

Camera camera_of_case(const scenes::HardCase& c, bool infinite = true) {
  DepthRange range = depth_range(c.scene, c.view, infinite);
  if (c.near_plane > 0) range.near_plane = c.near_plane;
  return camera_of(c.view, range);
}

class HardCases : public testing::TestWithParam<std::size_t> {
 protected:
  const scenes::HardCase& hard() const { return cases()[GetParam()]; }
};

// Pixels that differ from the exact mask with no sample of the same state in the exact scene within
// a pixel of their centre, at kFiner samples a pixel each way. What is thinner than a pixel (a sliver
// of light between two casters) has its edges there, but no pixel that shows both states.
constexpr int kFiner = 5;  // odd: pixel centres are samples

int far_from_edges(const ShadowMask& mask, const ShadowMask& exact, const scenes::HardCase& c) {
  View finer = c.view;
  finer.right /= kFiner;
  finer.down /= kFiner;
  finer.width *= kFiner;
  finer.height *= kFiner;
  const ShadowMask samples = exact_mask(c.scene, c.light, finer);
  int n = 0;
  for (int y = 0; y < exact.height; ++y) {
    for (int x = 0; x < exact.width; ++x) {
      const std::uint8_t state = mask.state[std::size_t(y) * exact.width + x];
      if (state == exact.state[std::size_t(y) * exact.width + x]) continue;
      bool near = false;
      for (int j = -kFiner; j <= kFiner; ++j) {
        for (int i = -kFiner; i <= kFiner; ++i) {
          const int u = x * kFiner + kFiner / 2 + i, v = y * kFiner + kFiner / 2 + j;
          near |= u >= 0 && v >= 0 && u < samples.width && v < samples.height &&
                  samples.state[std::size_t(v) * samples.width + u] == state;
        }
      }
      n += near ? 0 : 1;
      if (!near) std::printf("pixel %d %d is %d\n", x, y, state);
    }
  }
  return n;
}

// How a mask differs from the exact one; far from edges is looked at closely where compare() says
// so.
Difference difference(const ShadowMask& mask, const ShadowMask& exact, const scenes::HardCase& c) {
  Difference d = compare(mask, exact);
  if (d.far_off > 0 && d.pixels < 100) d.far_off = far_from_edges(mask, exact, c);
  return d;
}

void expect_exact(const Difference& d, const ShadowMask& exact, const std::string& what) {
  EXPECT_LE(d.pixels, int(exact.state.size() / 1000)) << what;
  EXPECT_EQ(d.far_off, 0) << what;
}

TEST_P(HardCases, AreTheExactMaskByEveryMethod) {
  const scenes::HardCase& c = hard();
  SCOPED_TRACE(c.name + ": " + c.sentence);
  const ShadowMask exact = exact_mask(c.scene, c.light, c.view);
  const Camera camera = camera_of_case(c);
  ShadowMask first;
  for (const Api api : {Api::opengl, Api::opengl_es}) {
    Stage stage = stage_of(c.scene, api);
    for (const Count count : {Count::automatic, Count::z_fail, Count::mixed, Count::near_cap,
                              Count::zp_plus, Count::z_pass}) {
      for (const MaskIn in : {MaskIn::stencil, MaskIn::alpha, MaskIn::screen}) {
        Method m;
        m.mask = in;
        m.count = count;
        const std::string what = (api == Api::opengl ? "OpenGL, " : "OpenGL ES, ") + describe(m);
        const Result<ShadowMask> mask = stage.renderer.mask(camera, c.light, m);
        if (!mask) {
          std::printf("%-34s refused: %s: %s\n", c.name.c_str(), what.c_str(),
                      mask.error().message.substr(0, 70).c_str());
          continue;
        }
        if (first.state.empty()) first = mask.value();
        const Difference d = difference(mask.value(), exact, c);
        const int n = count_different(mask.value(), first);
        if (d.pixels > 0 || n > 0)
          std::printf("%-34s %s: differ %d far %d from first %d\n", c.name.c_str(), what.c_str(),
                      d.pixels, d.far_off, n);
        expect_exact(d, exact, what);
      }
    }
  }
}

std::string test_name(const testing::TestParamInfo<std::size_t>& of) {
  std::string name = cases()[of.param].name;
  for (char& letter : name) letter = letter == '-' ? '_' : letter;
  return name;
}

INSTANTIATE_TEST_SUITE_P(Scene, HardCases, testing::Range(std::size_t(0), cases().size()),
                         test_name);

}  // namespace
}  // namespace gnomon::gl
