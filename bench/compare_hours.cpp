// Two profiles of the same samples (profile.tif of `gnomon profile`): how far their hours in shadow
// differ, as a line of a table and as a picture of both and the difference.
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gnomon/io/colour_map.h>
#include <gnomon/io/picture.h>
#include <gnomon/io/picture_map.h>
#include <gnomon/io/png.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace gnomon;

constexpr float kNoData = -9999;
constexpr Rgb kPaper{255, 255, 255}, kInk{33, 31, 38}, kQuiet{104, 102, 112};
constexpr Rgb kEqual{246, 246, 244}, kMore{178, 24, 43}, kLess{33, 102, 172};

struct Hours {
  int width = 0, height = 0;
  double pixel = 0, x0 = 0, y1 = 0;
  std::vector<float> shadow;  // row 0 at the top
};

bool read_hours(const std::string& path, Hours& out) {
  const std::unique_ptr<GDALDataset> file(
      GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR));
  std::array<double, 6> place{};
  if (!file || file->GetRasterCount() < 1) return false;
  file->GetGeoTransform(place.data());
  out = {file->GetRasterXSize(), file->GetRasterYSize(), place[1], place[0], place[3], {}};
  out.shadow.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
  return file->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, out.width, out.height, out.shadow.data(),
                                          out.width, out.height, GDT_Float32, 0, 0,
                                          nullptr) == CE_None;
}

struct Sums {
  std::size_t samples = 0, equal = 0, within = 0;
  double sum = 0, most = 0;
  void add(double difference, double step) {
    // Hours are whole milliseconds, rounded to float when written.
    constexpr double kRounding = 1e-5;
    const double d = std::abs(difference);
    ++samples;
    equal += d <= kRounding;
    within += d <= step + kRounding;
    sum += d;
    most = std::max(most, d);
  }
  std::string row(const std::string& name) const {
    return fmt::format("| {} | {} | {} | {} | {:.6f} | {:.2f} |\n", name, samples, samples - equal,
                       samples - within, samples > 0 ? sum / static_cast<double>(samples) : 0.0,
                       most);
  }
};

Rgb mix(Rgb a, Rgb b, double t) {
  const auto channel = [&](std::uint8_t x, std::uint8_t y) {
    return static_cast<std::uint8_t>(std::lround(x + t * (y - x)));
  };
  return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
}

// -1 .. 1
Rgb difference_colour(double share) {
  const double t = std::clamp(share, -1.0, 1.0);
  return mix(kEqual, t < 0 ? kLess : kMore, std::sqrt(std::abs(t)));  // small ones visible, too
}

template <class Colour>
Picture panel(const Hours& h, int zoom, Colour colour) {
  Picture p{h.width * zoom, h.height * zoom, {}};
  p.pixels.resize(static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height));
  for (int y = 0; y < p.height; ++y) {
    for (int x = 0; x < p.width; ++x) {
      at(p, x, y) = colour(static_cast<std::size_t>(y / zoom) * static_cast<std::size_t>(h.width) +
                           static_cast<std::size_t>(x / zoom));
    }
  }
  return p;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Compares the hours in shadow of two profiles of the same samples"};
  std::string first, second, picture;
  double step = 10;
  std::vector<double> inside;
  app.add_option("A", first, "profile.tif")->required();
  app.add_option("B", second, "profile.tif with as many samples")->required();
  std::vector<std::string> name = {"A", "B"};
  app.add_option("--names", name, "Names of A and B")->expected(2);
  app.add_option("--step", step, "Minutes of a time step")->check(CLI::PositiveNumber);
  app.add_option("--inside", inside, "x0 y0 x1 y1: counted apart, in the coordinates of A")
      ->expected(4);
  app.add_option("--picture", picture, "PNG of A, B and the difference");
  CLI11_PARSE(app, argc, argv);

  GDALAllRegister();
  Hours a, b;
  if (!read_hours(first, a) || !read_hours(second, b)) return 1;
  if (a.width != b.width || a.height != b.height || std::abs(a.pixel - b.pixel) > 1e-9) {
    fmt::print(stderr, "{} and {} do not have the same samples\n", first, second);
    return 1;
  }
  Sums in, out;
  std::size_t one_sided = 0;
  double longest = 0;
  for (std::size_t k = 0; k < a.shadow.size(); ++k) {
    const bool va = a.shadow[k] != kNoData, vb = b.shadow[k] != kNoData;
    one_sided += va != vb;
    if (!va || !vb) continue;
    longest = std::max({longest, double(a.shadow[k]), double(b.shadow[k])});
    const double x =
        a.x0 + (static_cast<double>(k % static_cast<std::size_t>(a.width)) + 0.5) * a.pixel;
    const double y =
        a.y1 - (static_cast<double>(k / static_cast<std::size_t>(a.width)) + 0.5) * a.pixel;
    const bool within =
        inside.size() == 4 && x > inside[0] && x < inside[2] && y > inside[1] && y < inside[3];
    (within ? in : out).add(double(b.shadow[k]) - double(a.shadow[k]), step / 60);
  }
  const std::string pair = fmt::format("{} and {}", name[0], name[1]);
  fmt::print("{}", out.row(pair + (inside.empty() ? "" : ": ground")));
  if (!inside.empty()) fmt::print("{}", in.row(pair + ": roof"));
  if (one_sided > 0) {
    fmt::print(stderr, "{} samples have a surface in one of the two only\n", one_sided);
  }
  if (picture.empty()) return 0;

  const int zoom = std::max(1, 420 / a.width), gap = 24, head = 56, foot = 64;
  const int w = a.width * zoom, h = a.height * zoom;
  Canvas canvas(3 * w + 4 * gap, head + h + foot, kPaper);
  const auto of = [&](const Hours& x) {
    return panel(x, zoom, [&](std::size_t k) {
      return x.shadow[k] == kNoData ? kNoDataColour : hours_colour(x.shadow[k] / longest);
    });
  };
  const double scale = std::max({in.most, out.most, step / 60});
  const Picture difference = panel(a, zoom, [&](std::size_t k) {
    if (a.shadow[k] == kNoData || b.shadow[k] == kNoData) return kNoDataColour;
    return difference_colour((b.shadow[k] - a.shadow[k]) / scale);
  });
  const std::array<Picture, 3> panels{of(a), of(b), difference};
  const std::array<std::string, 3> heads{name[0], name[1],
                                         fmt::format("{} minus {}", name[1], name[0])};
  for (int k = 0; k < 3; ++k) {
    const int x = gap + k * (w + gap), bar = head + h + 14;
    canvas.image(x, head, panels[static_cast<std::size_t>(k)]);
    canvas.frame(x - 1, head - 1, w + 2, h + 2, {188, 188, 194}, 1);
    canvas.text(x, 20, heads[static_cast<std::size_t>(k)],
                {.size = 17, .colour = kInk, .bold = true});
    for (int i = 0; i < w; ++i) {
      const double t = static_cast<double>(i) / (w - 1);
      canvas.rectangle(x + i, bar, 1, 12, k < 2 ? hours_colour(t) : difference_colour(2 * t - 1));
    }
    const std::string low = k < 2 ? "0 h" : fmt::format("-{:.2g} h", scale);
    const std::string high =
        k < 2 ? fmt::format("{:.3g} h in shadow", longest) : fmt::format("+{:.2g} h", scale);
    canvas.text(x, bar + 16, low, {.size = 13, .colour = kQuiet});
    if (k == 2)
      canvas.text(x + w / 2.0, bar + 16, "equal",
                  {.size = 13, .colour = kQuiet, .align = Align::centre});
    canvas.text(x + w, bar + 16, high, {.size = 13, .colour = kQuiet, .align = Align::right});
  }
  const auto written = write_png(picture, canvas.picture());
  if (!written) {
    fmt::print(stderr, "{}\n", written.error().message);
    return 1;
  }
  return 0;
}
