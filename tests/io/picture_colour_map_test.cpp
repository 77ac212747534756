#include <gnomon/io/colour_map.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace gnomon {
namespace {

struct Lab {
  double l, a, b;
};

// sRGB to CIELAB under D65 (IEC 61966-2-1, CIE 15), written apart from the library's way back.
Lab lab(Rgb c) {
  const auto linear = [](int v) {
    const double s = v / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  };
  const auto f = [](double t) {
    return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
  };
  const double r = linear(c.r), g = linear(c.g), b = linear(c.b);
  const double x = f((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047);
  const double y = f(0.2126729 * r + 0.7151522 * g + 0.0721750 * b);
  const double z = f((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.08883);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

TEST(ColourMap, FallsInLightnessAtEveryStep) {
  const auto& colours = hours_colours();
  for (std::size_t k = 1; k < colours.size(); ++k) {
    ASSERT_LT(lab(colours[k]).l, lab(colours[k - 1]).l) << k;
  }
}

TEST(ColourMap, IsEvenInLightness) {
  const auto& colours = hours_colours();
  for (std::size_t k = 0; k < colours.size(); ++k) {
    const double even = 96 + (14.0 - 96.0) * static_cast<double>(k) / 255;
    EXPECT_NEAR(lab(colours[k]).l, even, 0.5) << k << ": out of the sRGB gamut?";
  }
}

TEST(ColourMap, ChangesColourAboutEvenly) {
  const auto& colours = hours_colours();
  double least = 1e9, most = 0;
  for (std::size_t k = 8; k < colours.size(); k += 8) {  // 8 steps: rounding to bytes averages out
    const Lab p = lab(colours[k - 8]), q = lab(colours[k]);
    const double distance = std::hypot(p.l - q.l, p.a - q.a, p.b - q.b);
    least = std::min(least, distance);
    most = std::max(most, distance);
  }
  EXPECT_LT(most / least, 3.0);
}

TEST(ColourMap, GivesEveryHourItsOwnColour) {
  std::set<std::array<int, 3>> different;
  for (const Rgb c : hours_colours()) different.insert({c.r, c.g, c.b});
  EXPECT_EQ(different.size(), 256U);
}

TEST(ColourMap, ClampsWhatIsBeyondItsEnds) {
  EXPECT_EQ(hours_colour(-1), hours_colours().front());
  EXPECT_EQ(hours_colour(2), hours_colours().back());
}

}  // namespace
}  // namespace gnomon
