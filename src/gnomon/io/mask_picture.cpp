#include <gnomon/io/mask_picture.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <vector>

#include <gnomon/io/picture_map.h>
#include <gnomon/io/png.h>

namespace gnomon {
namespace {

std::array<Rgb, 256> mask_colours() {
  std::array<Rgb, 256> colours;
  for (std::size_t k = 0; k < colours.size(); ++k) {
    const auto between = [&](std::uint8_t lit, std::uint8_t shadow) {
      const double share = static_cast<double>(k) / 255;
      return static_cast<std::uint8_t>(std::lround(lit + (shadow - lit) * share));
    };
    colours[k] = {between(kLitColour.r, kShadowColour.r), between(kLitColour.g, kShadowColour.g),
                  between(kLitColour.b, kShadowColour.b)};
  }
  return colours;
}

}  // namespace

Picture draw_mask(const ShadowMask& mask, const PlanRelief& relief, int threads) {
  // A mask is a profile of one moment: all of its daylight in shadow, or none.
  Profile moment;
  moment.width = mask.width;
  moment.height = mask.height;
  moment.daylight_ticks = 1;
  moment.shadow_ticks.resize(mask.state.size());
  moment.valid.resize(mask.state.size());
  for (std::size_t k = 0; k < mask.state.size(); ++k) {
    moment.valid[k] = mask.state[k] != ShadowMask::kNoSample;
    moment.shadow_ticks[k] = mask.state[k] == ShadowMask::kShadow ? 1 : 0;
  }
  return draw_hours(moment, relief, mask_colours(), threads);
}

Result<FileWritten> write_mask_picture(const std::filesystem::path& path, const ShadowMask& mask,
                                       const View& view, const Frame& frame,
                                       const PlanCaption& caption, const PlanRelief& relief,
                                       int threads) {
  assert(mask.width == view.width && mask.height == view.height);
  std::vector<Swatch> legend{{kLitColour, "lit"}, {kShadowColour, "in shadow"}};
  if (std::find(mask.state.begin(), mask.state.end(), ShadowMask::kNoSample) != mask.state.end()) {
    legend.push_back({kNoDataColour, caption.without_sample});
  }
  const Picture map = draw_mask(mask, relief, threads);
  return write_png(path, draw_map_page(map, "Shadow", legend, view, frame, caption), threads);
}

}  // namespace gnomon
