// The two sentences users say: the shadow of one light, and how long each sample is in shadow.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <gnomon/profile/profile.h>
#include <gnomon/profile/study_times.h>
#include <gnomon/raster/count_shadows.h>
#include <gnomon/raster/visible_surfaces.h>
#include <gnomon/view/shadow_mask.h>

namespace gnomon {

// Called with the share of the work done, 0..1, from any thread, one call at a time, never
// decreasing.
using Progress = std::function<void(double)>;

struct ShadowOptions {
  int threads = 0;  // 0: all
  Progress progress = {};
  CountStats* stats = nullptr;
};

ShadowMask cast_shadows(const Casters& casters, const Receivers& receivers, const Light& light,
                        const ShadowOptions& options = {});
ShadowMask cast_shadows(const Scene& scene, const Light& light, const View& view);

// For each sample, the number of lights that do not reach it. Row-major; 0 where there is no
// sample.
std::vector<std::uint32_t> count_shaded(const Casters& casters, const Receivers& receivers,
                                        std::span<const Light> lights,
                                        const ShadowOptions& options = {});

// Milliseconds in shadow over the samples in time; those with the sun down (up = false) contribute
// nothing.
Profile shadow_profile(const Casters& casters, const Receivers& receivers,
                       std::span<const TimeSample> samples, const ShadowOptions& options = {});

// The same from "what a user says"; errors as study_samples(); the scene needs a place.
Result<Profile> shadow_profile(const Scene& scene, const View& view, const StudyTimes& times,
                               const ShadowOptions& options = {});

}  // namespace gnomon
