#include <gnomon/shadow/cast_shadows.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <limits>
#include <mutex>

#include <gnomon/profile/clock_ranks.h>
#include <gnomon/raster/add_in_shadow.h>
#include <gnomon/raster/first_and_last_lit.h>

namespace gnomon {
namespace {

std::size_t index(const Receivers& r, int column, int row) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(r.view.width) +
         static_cast<std::size_t>(column);
}

// Hands finished counts, row by row of a part of the picture, to sink(light, counts, how many,
// index of the first sample).
template <class RowSink>
void for_each_row(const Casters& casters, const Receivers& receivers, std::span<const Light> lights,
                  const ShadowOptions& options, RowSink sink) {
  std::mutex progress_mutex;
  std::uint64_t done = 0;
  const std::uint64_t total = receivers.triangle.size() * lights.size();
  const CountStats stats = mask_shadows(
      casters, receivers, lights,
      [&](const MaskRect& part) {
        for (int row = 0; row < part.rows; ++row) {
          sink(static_cast<std::size_t>(part.light),
               part.mask + static_cast<std::ptrdiff_t>(row) * part.stride, part.columns,
               index(receivers, part.first_column, part.first_row + row));
        }
        if (options.progress) {
          const std::lock_guard lock(progress_mutex);
          done += static_cast<std::uint64_t>(part.rows) * static_cast<std::uint64_t>(part.columns);
          options.progress(static_cast<double>(done) / static_cast<double>(total));
        }
      },
      options.threads);
  if (options.stats != nullptr) *options.stats = stats;
}

constexpr std::uint32_t kCoarseTickMs = 1000;

std::uint32_t tick_for(std::span<const TimeSample> up) {
  std::uint64_t total = 0;  // milliseconds
  for (const TimeSample& s : up) total += s.weight_ms;
  return total <= std::numeric_limits<std::uint32_t>::max() ? 1 : kCoarseTickMs;
}

}  // namespace

ShadowMask cast_shadows(const Casters& casters, const Receivers& receivers, const Light& light,
                        const ShadowOptions& options) {
  ShadowMask mask{receivers.view.width, receivers.view.height, {}};
  const std::vector<std::uint32_t> shaded =
      count_shaded(casters, receivers, std::span(&light, 1), options);
  mask.state.resize(shaded.size());
  for (std::size_t k = 0; k < shaded.size(); ++k) {
    mask.state[k] = receivers.triangle[k] == kNoTriangle ? ShadowMask::kNoSample
                    : shaded[k] != 0                     ? ShadowMask::kShadow
                                                         : ShadowMask::kLit;
  }
  return mask;
}

ShadowMask cast_shadows(const Scene& scene, const Light& light, const View& view) {
  return cast_shadows(prepare_casters(scene), visible_surfaces(scene, view), light);
}

std::vector<std::uint32_t> count_shaded(const Casters& casters, const Receivers& receivers,
                                        std::span<const Light> lights,
                                        const ShadowOptions& options) {
  std::vector<std::uint32_t> sums(receivers.triangle.size(), 0);
  for_each_row(casters, receivers, lights, options,
               [&](std::size_t, const std::uint8_t* mask, int length, std::size_t first) {
                 add_in_shadow(mask, length, 1, sums.data() + first);
               });
  return sums;
}

Profile shadow_profile(const Casters& casters, const Receivers& receivers,
                       std::span<const TimeSample> samples, const ShadowOptions& options) {
  const std::size_t n = receivers.triangle.size();
  Profile p;
  p.width = receivers.view.width;
  p.height = receivers.view.height;
  std::vector<TimeSample> up;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(up),
               [](const TimeSample& s) { return s.up; });
  p.tick_ms = tick_for(up);
  std::vector<Light> lights;
  std::vector<std::uint32_t> weights;  // ticks
  std::vector<std::int32_t> begins, ends;
  std::uint64_t daylight = 0;
  for (const TimeSample& s : up) {
    lights.push_back(s.light);
    weights.push_back(p.tick_ms == 1 ? s.weight_ms
                                     : s.weight_ms / p.tick_ms +
                                           (s.weight_ms % p.tick_ms >= p.tick_ms / 2 ? 1 : 0));
    daylight += weights.back();
    begins.push_back(s.clock_begin_ms);
    ends.push_back(s.clock_end_ms);
  }
  assert(daylight <= std::numeric_limits<std::uint32_t>::max());
  p.daylight_ticks = static_cast<std::uint32_t>(daylight);
  p.shadow_ticks.assign(n, 0);
  if (options.first_and_last) {
    ClockRanks from = rank_clock_times(begins, SharedRank::kEarliest);
    ClockRanks to = rank_clock_times(ends, SharedRank::kLatest);
    p.first_lit.assign(n, kNeverLit);
    p.last_lit.assign(n, 0);
    for_each_row(casters, receivers, lights, options,
                 [&](std::size_t light, const std::uint8_t* mask, int length, std::size_t first) {
                   add_in_shadow(mask, length, weights[light], p.shadow_ticks.data() + first);
                   keep_first_and_last_lit(mask, length, from.ranks[light], to.ranks[light],
                                           p.first_lit.data() + first, p.last_lit.data() + first);
                 });
    p.lit_from_ms = std::move(from.times);
    p.lit_to_ms = std::move(to.times);
  } else {
    for_each_row(casters, receivers, lights, options,
                 [&](std::size_t light, const std::uint8_t* mask, int length, std::size_t first) {
                   add_in_shadow(mask, length, weights[light], p.shadow_ticks.data() + first);
                 });
  }
  p.valid.resize(n);
  std::transform(
      receivers.triangle.begin(), receivers.triangle.end(), p.valid.begin(),
      [](std::uint32_t t) { return static_cast<std::uint8_t>(t != kNoTriangle ? 1 : 0); });
  return p;
}

Profile shadow_profile(const Casters& casters, const Receivers& receivers, const Samples& samples,
                       const ShadowOptions& options) {
  Profile p = shadow_profile(casters, receivers, std::span(samples.midpoints), options);
  p.days = static_cast<int>(samples.dates.size());
  return p;
}

Result<Profile> shadow_profile(const Scene& scene, const View& view, const StudyTimes& times,
                               const ShadowOptions& options) {
  if (!scene.frame.place) {
    return Error{
        "the scene has no place on Earth: give a coordinate reference system or a site (latitude, "
        "longitude)"};
  }
  Result<Samples> samples = study_samples(times, *scene.frame.place, scene.frame.true_north);
  if (!samples) return samples.error();
  return shadow_profile(prepare_casters(scene), visible_surfaces(scene, view, options.threads),
                        samples.value(), options);
}

}  // namespace gnomon
