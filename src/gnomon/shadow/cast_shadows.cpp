#include <gnomon/shadow/cast_shadows.h>

#include <algorithm>
#include <mutex>

#include <gnomon/raster/add_where_positive.h>

namespace gnomon {
namespace {

std::size_t index(const Receivers& r, int row) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(r.view.width);
}

// Adds weights[light] to sums[sample] wherever the light does not reach the sample.
void add_up(const Casters& casters, const Receivers& receivers, std::span<const Light> lights,
            std::span<const std::uint32_t> weights, std::vector<std::uint32_t>& sums,
            const ShadowOptions& options) {
  sums.assign(receivers.triangle.size(), 0);
  std::mutex progress_mutex;
  std::uint64_t done = 0;
  const std::uint64_t total = static_cast<std::uint64_t>(receivers.view.height) * lights.size();
  const CountStats stats = count_shadows(
      casters, receivers, lights,
      [&](const CountBand& band) {
        for (int row = 0; row < band.rows; ++row) {
          add_where_positive(band.counts + static_cast<std::ptrdiff_t>(row) * band.stride,
                             band.width, weights[static_cast<std::size_t>(band.light)],
                             sums.data() + index(receivers, band.first_row + row));
        }
        if (options.progress) {
          const std::lock_guard lock(progress_mutex);
          done += static_cast<std::uint64_t>(band.rows);
          options.progress(static_cast<double>(done) / static_cast<double>(total));
        }
      },
      options.threads);
  if (options.stats != nullptr) *options.stats = stats;
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
  std::vector<std::uint32_t> sums;
  const std::vector<std::uint32_t> ones(lights.size(), 1);
  add_up(casters, receivers, lights, ones, sums, options);
  return sums;
}

Profile shadow_profile(const Casters& casters, const Receivers& receivers,
                       std::span<const TimeSample> samples, const ShadowOptions& options) {
  Profile p;
  p.width = receivers.view.width;
  p.height = receivers.view.height;
  std::vector<Light> lights;
  std::vector<std::uint32_t> weights;
  for (const TimeSample& s : samples) {
    if (!s.up) continue;
    lights.push_back(s.light);
    weights.push_back(s.weight_ms);
    p.daylight_ms += s.weight_ms;
  }
  add_up(casters, receivers, lights, weights, p.shadow_ms, options);
  p.valid.resize(receivers.triangle.size());
  std::transform(
      receivers.triangle.begin(), receivers.triangle.end(), p.valid.begin(),
      [](std::uint32_t t) { return static_cast<std::uint8_t>(t != kNoTriangle ? 1 : 0); });
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
                        samples.value().midpoints, options);
}

}  // namespace gnomon
