#include <gnomon/io/view_picture.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include <gnomon/core/parallel.h>
#include <gnomon/io/png.h>

namespace gnomon {
namespace {

constexpr Rgb kPaper{255, 255, 255};
constexpr Rgb kInk{33, 31, 38};
constexpr Rgb kQuiet{104, 102, 112};
constexpr Rgb kHairline{188, 188, 194};
constexpr Rgb kLegendGround{232, 227, 217};

// What all shadows together leave, linear light; bluish, because only the sky lights it.
constexpr LightLeft kSkyAlone{0.105F, 0.115F, 0.155F};
constexpr LightLeft kZenith{0.50F, 0.63F, 0.78F}, kHorizon{0.90F, 0.92F, 0.93F};  // linear light
constexpr float kEdgeLeft = 0.42F;  // light that a crease line leaves

// sRGB to linear light and back (IEC 61966-2-1).
std::array<float, 256> make_linear() {
  std::array<float, 256> table{};
  for (std::size_t k = 0; k < 256; ++k) {
    const double v = static_cast<double>(k) / 255;
    table[k] = static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
  }
  return table;
}
constexpr std::size_t kGammaSteps = 4096;  // finer than a step of 8-bit sRGB everywhere above black
std::array<std::uint8_t, kGammaSteps + 1> make_gamma() {
  std::array<std::uint8_t, kGammaSteps + 1> table{};
  for (std::size_t k = 0; k <= kGammaSteps; ++k) {
    const double v = static_cast<double>(k) / kGammaSteps;
    const double s = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    table[k] = static_cast<std::uint8_t>(std::lround(255 * s));
  }
  return table;
}
float linear(std::uint8_t v) {
  static const std::array<float, 256> table = make_linear();
  return table[v];
}
std::uint8_t gamma(float v) {
  static const std::array<std::uint8_t, kGammaSteps + 1> table = make_gamma();
  return table[static_cast<std::size_t>(std::clamp(v, 0.0F, 1.0F) * kGammaSteps + 0.5F)];
}
Rgb encode(const LightLeft& c) { return {gamma(c.r), gamma(c.g), gamma(c.b)}; }

LightLeft times(Rgb colour, const LightLeft& left, float shade) {
  return {linear(colour.r) * left.r * shade, linear(colour.g) * left.g * shade,
          linear(colour.b) * left.b * shade};
}

LightLeft sky(double down) {  // 0 at the top of the picture, 1 at its bottom
  const auto t = static_cast<float>(std::sqrt(std::clamp(down * 1.6, 0.0, 1.0)));
  return {kZenith.r + (kHorizon.r - kZenith.r) * t, kZenith.g + (kHorizon.g - kZenith.g) * t,
          kZenith.b + (kHorizon.b - kZenith.b) * t};
}

Picture draw_model(const ViewSamples& s, int threads) {
  const int f = s.downsample;
  Picture out{s.width / f, s.height / f, {}};
  out.pixels.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
  std::vector<LightLeft> left(static_cast<std::size_t>(s.instants) + 1);
  for (int n = 0; n <= s.instants; ++n)
    left[static_cast<std::size_t>(n)] = light_left(n, s.instants);
  const float share = 1.0F / static_cast<float>(f * f);
  parallel_for(out.height, threads, [&](int y) {
    const LightLeft behind = sky(static_cast<double>(y) / out.height);
    for (int x = 0; x < out.width; ++x) {
      LightLeft sum{0, 0, 0};
      for (int j = 0; j < f; ++j) {
        const std::size_t row =
            static_cast<std::size_t>(y * f + j) * static_cast<std::size_t>(s.width);
        for (int i = 0; i < f; ++i) {
          const std::size_t k = row + static_cast<std::size_t>(x * f + i);
          LightLeft c = behind;
          if (s.valid[k]) {
            const std::size_t n = std::min<std::size_t>(s.shadows[k], left.size() - 1);
            // Shade is a share of lightness as seen: squared, near enough, it is linear light.
            c = times(s.shading.colour[k], left[n], s.shading.shade[k] * s.shading.shade[k]);
          }
          const float line = !s.shading.edge.empty() && s.shading.edge[k] ? kEdgeLeft : 1.0F;
          sum.r += line * c.r;
          sum.g += line * c.g;
          sum.b += line * c.b;
        }
      }
      at(out, x, y) = encode({sum.r * share, sum.g * share, sum.b * share});
    }
  });
  return out;
}

// Steps of darkness from 0 to all shadows; x, y upper left; width in all.
void draw_darkness(Canvas& canvas, double x, double y, double width, int instants, double em) {
  constexpr int kMostFields = 25;  // more are narrower than their borders
  const int fields = std::min(instants + 1, kMostFields);
  const double height = std::round(1.3 * em);
  canvas.text(x, y, instants == 1 ? "Shadow" : "Shadows over each other",
              {.size = 0.85 * em, .colour = kInk, .bold = true});
  y = std::round(y + 1.6 * em);
  double previous = x;
  for (int k = 0; k < fields; ++k) {
    const double next = std::round(x + width * (k + 1) / fields);
    const int shadows =
        fields > 1 ? static_cast<int>(std::lround(static_cast<double>(k) * instants / (fields - 1)))
                   : 0;
    canvas.rectangle(previous, y, next - previous, height,
                     encode(times(kLegendGround, light_left(shadows, instants), 1)));
    previous = next;
  }
  canvas.frame(x, y, width, height, kHairline, 1);
  const TextStyle label{.size = 0.8 * em, .colour = kQuiet};
  TextStyle last = label;
  last.align = Align::right;
  canvas.text(x, y + height + 0.15 * em, instants == 1 ? "lit" : "none", label);
  canvas.text(x + width, y + height + 0.15 * em,
              instants == 1 ? "in shadow" : fmt::format("all {}", instants), last);
}

}  // namespace

LightLeft light_left(int shadows, int instants) {
  if (instants <= 0) return {};
  const float t = static_cast<float>(shadows) / static_cast<float>(instants);
  return {std::pow(kSkyAlone.r, t), std::pow(kSkyAlone.g, t), std::pow(kSkyAlone.b, t)};
}

Picture draw_view(const ViewSamples& s, const ViewCaption& caption, int threads) {
  [[maybe_unused]] const std::size_t samples =
      static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height);
  assert(s.downsample > 0 && s.width >= s.downsample && s.height >= s.downsample);
  assert(s.width % s.downsample == 0 && s.height % s.downsample == 0);
  assert(s.shadows.size() == samples && s.valid.size() == samples);
  assert(s.shading.shade.size() == samples && s.shading.colour.size() == samples);
  assert(s.shading.edge.empty() || s.shading.edge.size() == samples);

  const Picture model = draw_model(s, threads);
  const double em = std::clamp(model.width / 72.0, 12.0, 24.0);
  const double margin = std::round(1.6 * em), legend = std::round(15 * em);
  constexpr double kNarrowest = 26,
                   kBeside = 44;  // em: of the strip, and to have the legend beside the text
  const double width = std::max<double>(model.width, std::round(kNarrowest * em));
  const bool beside = width >= kBeside * em;
  const double words = width - 2 * margin - (beside ? legend + 2 * em : 0);
  const TextStyle title{.size = 1.3 * em, .colour = kInk, .bold = true, .wrap = words};
  const TextStyle line{.size = em, .colour = kQuiet, .wrap = words};
  const TextStyle small{.size = 0.8 * em, .colour = kQuiet, .wrap = words};
  std::string foot = caption.software;
  if (!caption.attribution.empty())
    foot += (foot.empty() ? "" : "  \u00b7  ") + ("model: " + caption.attribution);

  const Canvas ruler(1, 1, kPaper);
  double text_height = 0;
  if (!caption.title.empty()) text_height += ruler.measure(caption.title, title).height + 0.15 * em;
  for (const std::string& each : caption.lines)
    text_height += ruler.measure(each, line).height + 0.1 * em;
  if (!foot.empty()) text_height += 0.35 * em + ruler.measure(foot, small).height;
  const double legend_height = 4.3 * em;
  const double strip = std::round(2 * 1.2 * em + (beside ? std::max(text_height, legend_height)
                                                         : text_height + em + legend_height));

  Canvas canvas(static_cast<int>(width), model.height + static_cast<int>(strip), kPaper);
  canvas.image((static_cast<int>(width) - model.width) / 2, 0, model);
  canvas.line({0, model.height + 0.5}, {width, model.height + 0.5}, kHairline, 1);
  double y = model.height + 1.2 * em;
  const double top = y;
  if (!caption.title.empty()) y += canvas.text(margin, y, caption.title, title).height + 0.15 * em;
  for (const std::string& each : caption.lines)
    y += canvas.text(margin, y, each, line).height + 0.1 * em;
  if (!foot.empty()) y += 0.35 * em + canvas.text(margin, y + 0.35 * em, foot, small).height;
  if (beside) {
    draw_darkness(canvas, width - margin - legend, top, legend, s.instants, em);
  } else {
    draw_darkness(canvas, margin, y + em, std::min(legend, width - 2 * margin), s.instants, em);
  }
  return canvas.picture();
}

Result<FileWritten> write_view_picture(const std::filesystem::path& path,
                                       const ViewSamples& samples, const ViewCaption& caption,
                                       int threads) {
  return write_png(path, draw_view(samples, caption, threads), threads);
}

}  // namespace gnomon
