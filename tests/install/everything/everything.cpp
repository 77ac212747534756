// A small roof above a ground: the counter, the exact count and Embree, all from the installed
// package.
#include <cstdio>

#include "headers.h"

#ifndef GNOMON_HAVE_IO
#error "gnomon::io does not say that io is there"
#endif

int main() {
  using namespace gnomon;
  Scene scene;
  scene.mesh.positions = {{-4, -4, 0}, {4, -4, 0}, {0, 4, 0}, {-1, -1, 2}, {1, -1, 2}, {0, 1, 2}};
  scene.mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  scene.surface_of = {0, 0};
  scene.surfaces = {{}};
  const Light light = direction({0.3, 0.4, 1});
  const View view = plan_view({-4, -4, 4, 4}, 0.25, 0);
  const Receivers receivers = visible_surfaces(scene, view);

  const ShadowMask counted = cast_shadows(prepare_casters(scene), receivers, light);
  const auto exact = exact_counts(scene, receivers, light);
  const auto traced = embree_mask(EmbreeScene::build(scene, {}).value(),
                                  ray_origins(scene, receivers, 0.001), light);
  int dark = 0, wrong = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    const bool shadow = counted.state[k] == ShadowMask::kShadow;
    dark += shadow;
    wrong += shadow != (exact[k] > 0) || shadow != (traced[k] != 0);
  }
  std::printf("%d samples in shadow, %d wrong; %s\n", dark, wrong, short_crs("epsg:7415").c_str());
  return dark > 0 && wrong == 0 && short_crs("epsg:7415") == "EPSG:7415" ? 0 : 1;
}
