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
  bool first_and_last = false;  // shadow_profile: keep the first and last sun too, 4 bytes a sample
};

ShadowMask cast_shadows(const Casters& casters, const Receivers& receivers, const Light& light,
                        const ShadowOptions& options = {});
ShadowMask cast_shadows(const Scene& scene, const Light& light, const View& view);

// For each sample, the number of lights that do not reach it. Row-major; 0 where there is no
// sample.
std::vector<std::uint32_t> count_shaded(const Casters& casters, const Receivers& receivers,
                                        std::span<const Light> lights,
                                        const ShadowOptions& options = {});

// Time in shadow over the samples in time of one day; those with the sun down (up = false)
// contribute nothing.
//
// A tick is a millisecond. Where the daylight of all samples is 2^32 ms (49.7 days) or more, it is
// a second: each step's length is rounded to whole seconds, and the daylight is the sum of the
// rounded lengths, so that shadow and sun still add up to it exactly; an hour is then wrong by at
// most half a second for each step in it that is not of whole seconds. Precondition: less than 2^32
// s (136 years) of daylight.
Profile shadow_profile(const Casters& casters, const Receivers& receivers,
                       std::span<const TimeSample> samples, const ShadowOptions& options = {});

// The same over all days of a study: hours are the mean per day over samples.dates.
Profile shadow_profile(const Casters& casters, const Receivers& receivers, const Samples& samples,
                       const ShadowOptions& options = {});

// The same from "what a user says"; errors as study_samples(); the scene needs a place.
Result<Profile> shadow_profile(const Scene& scene, const View& view, const StudyTimes& times,
                               const ShadowOptions& options = {});

}  // namespace gnomon
