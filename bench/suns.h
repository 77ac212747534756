// The suns that the benchmarks of masks share.
#pragma once

#include <vector>

#include <fmt/format.h>

#include <gnomon/profile/study_times.h>

namespace gnomon::bench {

// 18 September over Vienna, 9:00 to 17:00, cut into equal steps of whole seconds: the lights at
// their midpoints. Precondition: count > 0.
inline std::vector<Light> suns_of(int count, double true_north) {
  const StudyTimes times{"2024-09-18", "09:00", "17:00", fmt::format("{}s", 8 * 3600 / count),
                         "Europe/Vienna"};
  const Place vienna{48.2 * kDegree, 16.37 * kDegree, 171};
  std::vector<Light> lights;
  const Samples samples = study_samples(times, vienna, true_north).value();
  for (const TimeSample& s : samples.midpoints) {
    if (s.up && static_cast<int>(lights.size()) < count) lights.push_back(s.light);
  }
  return lights;
}

}  // namespace gnomon::bench
