// What tests of the renderer share: contexts, scenes, comparison with the exact mask.
#pragma once

#include <gtest/gtest.h>

#include <gnomon/gl/context.h>
#include <gnomon/gl/renderer.h>
#include <gnomon/shadow/cast_shadows.h>
#include <gnomon/view/view.h>

#include "soup.h"

namespace gnomon::gl {

// A renderer in a context of its own, with one scene.
struct Stage {
  HeadlessContext context;
  Renderer renderer;
};

inline Stage stage_of(const Scene& scene, Api api = Api::opengl,
                      const std::vector<std::string>& lacking = {}) {
  HeadlessContext context = HeadlessContext::create(api).value();
  Capabilities capabilities = find_capabilities().value();
  for (const std::string& name : lacking) capabilities = without(capabilities, name).value();
  Renderer renderer = Renderer::create(capabilities).value();
  renderer.add_scene(scene);
  return {std::move(context), std::move(renderer)};
}

// A few boxes on a ground plane, some touching, one hovering, one turned, one behind another.
inline TriMesh boxes_on_ground() {
  TriMesh m;
  test::add_quad(m, {-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0});
  test::add_box(m, {-3, -2, 0}, {1, 2, 6});
  test::add_box(m, {4, 3, 0}, {7, 8, 3});
  test::add_box(m, {-9, 5, 2}, {-6, 9, 4});
  test::add_box(m, {2, -9, 0}, {3, -8, 9});
  return m;
}

inline View aerial(int width = 256, int height = 192) {
  return perspective_view({25, -30, 22}, {0, 0, 1}, {0, 0, 1}, 0.8, width, height);
}

inline ShadowMask exact_mask(const Scene& scene, const Light& light, const View& view) {
  return cast_shadows(scene, light, view);
}

struct Difference {
  int pixels = 0;   // that differ
  int far_off = 0;  // of these, with no pixel of the same state in the exact mask's 3 x 3 round it
};

inline Difference compare(const ShadowMask& ours, const ShadowMask& exact) {
  Difference d;
  if (ours.width != exact.width || ours.height != exact.height) return {-1, -1};
  const auto at = [&](int x, int y) { return exact.state[std::size_t(y) * exact.width + x]; };
  for (int y = 0; y < exact.height; ++y) {
    for (int x = 0; x < exact.width; ++x) {
      const std::uint8_t state = ours.state[std::size_t(y) * exact.width + x];
      if (state == at(x, y)) continue;
      ++d.pixels;
      bool near = false;
      for (int j = std::max(0, y - 1); j <= std::min(exact.height - 1, y + 1); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(exact.width - 1, x + 1); ++i)
          near |= at(i, j) == state;
      d.far_off += near ? 0 : 1;
    }
  }
  return d;
}

inline int count_different(const ShadowMask& a, const ShadowMask& b) {
  int n = 0;
  for (std::size_t k = 0; k < a.state.size(); ++k) n += a.state[k] != b.state[k];
  return n;
}

}  // namespace gnomon::gl
