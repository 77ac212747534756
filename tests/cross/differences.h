// The counter and the exact count over the lights and views of `gnomon verify`.
#pragma once

#include <gnomon/raster/count_shadows.h>
#include <gnomon/raster/visible_surfaces.h>
#include <gnomon/trace/verification_cases.h>

#include <span>
#include <vector>

namespace gnomon::test {

inline std::vector<std::int32_t> counted(const Casters& casters, const Receivers& r,
                                         const Light& light) {
  std::vector<std::int32_t> counts(r.triangle.size(), 0);
  std::int32_t* const to = counts.data();
  count_shadows(casters, r, std::span(&light, 1), std::span(&to, 1));
  return counts;
}

// Number of samples whose counts differ, over the lights and views that `gnomon verify` chooses.
inline std::size_t differences(const Scene& scene, int size, int suns, int points) {
  const Casters casters = prepare_casters(scene);
  const Oracle oracle = build_oracle(scene);
  std::vector<NamedLight> lights = choose_suns(scene, suns);
  for (const NamedLight& p : choose_points(oracle, points)) lights.push_back(p);
  std::vector<NamedView> views = {whole_plan(scene, size), aerial_camera(scene, size)};
  for (const NamedLight& l : lights) {
    if (const auto inside = shaded_camera(oracle, l.light, size)) {
      views.push_back(*inside);
      break;
    }
  }
  std::size_t different = 0;
  for (const NamedView& v : views) {
    const Receivers r = visible_surfaces(scene, v.view);
    for (const NamedLight& l : lights) {
      const auto ours = counted(casters, r, l.light);
      const auto exact = exact_counts(oracle, r, l.light);
      for (std::size_t k = 0; k < ours.size(); ++k) different += ours[k] != exact[k] ? 1 : 0;
    }
  }
  return different;
}

}  // namespace gnomon::test
