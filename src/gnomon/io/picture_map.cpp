#include <gnomon/io/picture_map.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <gnomon/core/parallel.h>
#include <gnomon/io/colour_map.h>

namespace gnomon {
namespace {

constexpr int kFewSamplesSide = 1280;  // pixels that a small map is enlarged to at most

// How much relief and outlines may change a colour: enough to recognise roofs, too little to be
// taken for hours.
constexpr float kReliefDark = 0.28F, kReliefBright = 0.4F, kOutline = 0.55F;
constexpr Rgb kDarkInk{40, 34, 52}, kLightInk{226, 214, 226};

// What a pixel of the map shows: means over its area.
struct Cell {
  float share = 0;            // of the daylight in shadow, over its valid part; 0..1
  float valid = 0;            // 0..1
  float shade = kLevelShade;  // over its valid part
  float outline = 0;          // 0..1
};

float mix(float from, float to, float amount) { return from + (to - from) * amount; }

struct Ink {
  float r, g, b;
};
Ink ink(Rgb c) {
  return {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b)};
}
Ink mix(Ink from, Ink to, float amount) {
  return {mix(from.r, to.r, amount), mix(from.g, to.g, amount), mix(from.b, to.b, amount)};
}
std::uint8_t byte(float v) { return static_cast<std::uint8_t>(std::clamp(v, 0.0F, 255.0F) + 0.5F); }

Rgb paint(const Cell& cell, const std::array<Rgb, 256>& colours) {
  Ink c = ink(kNoDataColour);
  if (cell.valid > 0) {
    const auto index = static_cast<std::size_t>(std::clamp(cell.share, 0.0F, 1.0F) * 255.0F + 0.5F);
    Ink hours = ink(colours[index]);
    const float level = cell.shade / kLevelShade;
    if (level < 1) {
      hours = mix(hours, {0, 0, 0}, kReliefDark * (1 - level));
    } else {
      hours = mix(hours, {255, 255, 255}, kReliefBright * (level - 1));
    }
    c = mix(c, hours, cell.valid);
  }
  if (cell.outline > 0) {
    const float grey = 0.3F * c.r + 0.6F * c.g + 0.1F * c.b;
    // Dark lines on light colours, light ones in deep shadow.
    c = grey > 90 ? mix(c, ink(kDarkInk), kOutline * cell.outline)
                  : mix(c, ink(kLightInk), 0.6F * kOutline * cell.outline);
  }
  return {byte(c.r), byte(c.g), byte(c.b)};
}

bool outlined(const PlanRelief& relief, std::size_t k, std::size_t step) {
  return relief.object[k] != relief.object[k + step];
}

Picture draw_enlarged(const Profile& p, const PlanRelief& relief, const MapSize& size,
                      const std::array<Rgb, 256>& colours, int threads) {
  Picture out{size.width, size.height, {}};
  out.pixels.resize(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  const float per_tick = p.daylight_ticks > 0 ? 1.0F / static_cast<float>(p.daylight_ticks) : 0.0F;
  const int line = std::max(1, size.enlarged / 12);  // pixels
  const std::size_t width = static_cast<std::size_t>(p.width);
  parallel_for(size.height, threads, [&](int y) {
    const int row = y / size.enlarged;
    for (int x = 0; x < size.width; ++x) {
      const int column = x / size.enlarged;
      const std::size_t k =
          static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column);
      Cell cell;
      cell.valid = p.valid[k] ? 1.0F : 0.0F;
      cell.share = static_cast<float>(p.shadow_ticks[k]) * per_tick;
      if (!relief.shade.empty()) cell.shade = relief.shade[k];
      if (!relief.object.empty()) {
        const bool at_right = x % size.enlarged >= size.enlarged - line && column + 1 < p.width;
        const bool at_bottom = y % size.enlarged >= size.enlarged - line && row + 1 < p.height;
        if ((at_right && outlined(relief, k, 1)) || (at_bottom && outlined(relief, k, width)))
          cell.outline = 1;
      }
      at(out, x, y) = paint(cell, colours);
    }
  });
  return out;
}

// Area means, first down a strip of rows into one row of sums, then along it.
Picture draw_shrunk(const Profile& p, const PlanRelief& relief, const MapSize& size,
                    const std::array<Rgb, 256>& colours, int threads) {
  Picture out{size.width, size.height, {}};
  out.pixels.resize(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  const float per_tick = p.daylight_ticks > 0 ? 1.0F / static_cast<float>(p.daylight_ticks) : 0.0F;
  const double rows_each = static_cast<double>(p.height) / size.height;
  const double columns_each = static_cast<double>(p.width) / size.width;
  const std::size_t width = static_cast<std::size_t>(p.width);
  struct Sums {
    float valid = 0, share = 0, shade = 0, outline = 0;
  };
  parallel_for(size.height, threads, [&](int y) {
    std::vector<Sums> strip(width);
    const double top = y * rows_each,
                 bottom = std::min((y + 1) * rows_each, static_cast<double>(p.height));
    for (int row = static_cast<int>(top); row < p.height && row < bottom; ++row) {
      const auto weight =
          static_cast<float>(std::min(row + 1.0, bottom) - std::max<double>(row, top));
      const std::size_t begin = static_cast<std::size_t>(row) * width;
      for (std::size_t column = 0; column < width; ++column) {
        const std::size_t k = begin + column;
        const float valid = p.valid[k] ? weight : 0.0F;
        strip[column].valid += valid;
        strip[column].share += valid * static_cast<float>(p.shadow_ticks[k]);
      }
      if (!relief.shade.empty()) {
        for (std::size_t column = 0; column < width; ++column) {
          const float valid = p.valid[begin + column] ? weight : 0.0F;
          strip[column].shade += valid * relief.shade[begin + column];
        }
      }
      if (!relief.object.empty()) {
        const std::size_t down = row + 1 < p.height ? width : 0;
        for (std::size_t column = 0; column + 1 < width; ++column) {
          const std::size_t k = begin + column;
          strip[column].outline +=
              (outlined(relief, k, 1) || outlined(relief, k, down)) ? weight : 0.0F;
        }
      }
    }
    // A line is one sample thick; keep it visible where many samples share a pixel.
    const auto thicken = static_cast<float>(std::sqrt(rows_each * columns_each));
    const auto area = static_cast<float>((bottom - top) * columns_each);
    for (int x = 0; x < size.width; ++x) {
      const double left = x * columns_each,
                   right = std::min((x + 1) * columns_each, static_cast<double>(p.width));
      Sums sums;
      for (int column = static_cast<int>(left); column < p.width && column < right; ++column) {
        const auto weight =
            static_cast<float>(std::min(column + 1.0, right) - std::max<double>(column, left));
        const Sums& s = strip[static_cast<std::size_t>(column)];
        sums.valid += weight * s.valid;
        sums.share += weight * s.share;
        sums.shade += weight * s.shade;
        sums.outline += weight * s.outline;
      }
      Cell cell;
      cell.valid = std::min(1.0F, sums.valid / area);
      if (sums.valid > 0) {
        cell.share = sums.share / sums.valid * per_tick;
        if (!relief.shade.empty()) cell.shade = sums.shade / sums.valid;
      }
      cell.outline = std::min(1.0F, thicken * sums.outline / area);
      at(out, x, y) = paint(cell, colours);
    }
  });
  return out;
}

}  // namespace

MapSize map_size(int width, int height) {
  const int longest = std::max(width, height);
  if (longest > kLongestMapSide) {
    const double scale = static_cast<double>(kLongestMapSide) / longest;
    const auto shrunk = [&](int side) {
      return std::max(1, static_cast<int>(std::lround(side * scale)));
    };
    return {shrunk(width), shrunk(height), 1, scale};
  }
  const int enlarged = std::max(1, kFewSamplesSide / longest);
  return {width * enlarged, height * enlarged, enlarged, static_cast<double>(enlarged)};
}

Picture draw_hours(const Profile& profile, const PlanRelief& relief, int threads) {
  return draw_hours(profile, relief, hours_colours(), threads);
}

Picture draw_hours(const Profile& profile, const PlanRelief& relief,
                   const std::array<Rgb, 256>& colours, int threads) {
  const MapSize size = map_size(profile.width, profile.height);
  return size.scale < 1 ? draw_shrunk(profile, relief, size, colours, threads)
                        : draw_enlarged(profile, relief, size, colours, threads);
}

}  // namespace gnomon
