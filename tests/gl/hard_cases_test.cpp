// The hard cases of scenes/hard_cases.h: every way of counting, in every kind of mask, in both
// APIs, against the exact mask.
#include <chrono>
#include <cstdlib>

#include <glm/geometric.hpp>

#include <gnomon/raster/visible_surfaces.h>
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

// The exact scene at kFiner samples a pixel each way, made when it is needed: where a mask differs,
// a pixel is near an edge if within a pixel of its centre there is a sample of the same state, or
// of another face. (What is thinner than a pixel has no pixel that shows both of its sides, and
// many a shadow ends where its receiver does.)
class Edges {
 public:
  explicit Edges(const scenes::HardCase& c) : case_(c) {}

  int far_from_edges(const ShadowMask& mask, const ShadowMask& exact) {
    int n = 0;
    for (int y = 0; y < exact.height; ++y) {
      for (int x = 0; x < exact.width; ++x) {
        const std::uint8_t state = mask.state[std::size_t(y) * exact.width + x];
        if (state != exact.state[std::size_t(y) * exact.width + x] && !near(x, y, state)) ++n;
      }
    }
    return n;
  }

 private:
  static constexpr int kFiner = 5;  // odd: pixel centres are samples

  bool near(int x, int y, std::uint8_t state) {
    if (samples_.state.empty()) {
      View finer = case_.view;
      finer.right /= kFiner;
      finer.down /= kFiner;
      finer.width *= kFiner;
      finer.height *= kFiner;
      samples_ = exact_mask(case_.scene, case_.light, finer);
      seen_ = visible_surfaces(case_.scene, finer).triangle;
    }
    const auto at = [&](int u, int v) { return std::size_t(v) * samples_.width + u; };
    const int u0 = x * kFiner + kFiner / 2, v0 = y * kFiner + kFiner / 2;
    for (int v = std::max(0, v0 - kFiner); v <= std::min(samples_.height - 1, v0 + kFiner); ++v) {
      for (int u = std::max(0, u0 - kFiner); u <= std::min(samples_.width - 1, u0 + kFiner); ++u) {
        if (samples_.state[at(u, v)] == state) return true;
        if (!same_face(seen_[at(u, v)], seen_[at(u0, v0)])) return true;
      }
    }
    return false;
  }

  bool same_face(std::uint32_t s, std::uint32_t t) const {
    if (s == t) return true;
    if (s == kNoTriangle || t == kNoTriangle) return false;
    const auto normal = [&](std::uint32_t k) {
      const Triangle& v = case_.scene.mesh.triangles[k];
      const std::vector<Vec3>& p = case_.scene.mesh.positions;
      return glm::normalize(glm::cross(p[v[1]] - p[v[0]], p[v[2]] - p[v[0]]));
    };
    return case_.scene.surface_of[s] == case_.scene.surface_of[t] &&
           glm::dot(normal(s), normal(t)) > 0.999999;
  }

  const scenes::HardCase& case_;
  ShadowMask samples_;
  std::vector<std::uint32_t> seen_;
};

// How a mask differs from the exact one; where compare() finds something far off, it is looked at
// closely.
Difference difference(const ShadowMask& mask, const ShadowMask& exact, Edges& edges) {
  Difference d = compare(mask, exact);
  if (d.far_off > 0 && d.pixels < 100) d.far_off = edges.far_from_edges(mask, exact);
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
  Edges edges(c);
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
        const Difference d = difference(mask.value(), exact, edges);
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
