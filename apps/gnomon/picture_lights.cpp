#include "picture_lights.h"

#include <algorithm>
#include <cmath>

namespace gnomon::app {
namespace {

constexpr std::size_t kPictureInstants = 33;
constexpr double kGoldenRatio = 0.61803398874989485;  // its fraction

}  // namespace

std::vector<Light> picture_lights(const Samples& samples) {
  std::vector<std::vector<Light>> days(samples.dates.size());
  for (const TimeSample& s : samples.instants) {
    if (s.up) days[s.day].push_back(s.light);
  }
  days.erase(std::remove_if(days.begin(), days.end(), [](const auto& d) { return d.empty(); }),
             days.end());
  std::vector<Light> out;
  if (days.size() == 1) {
    const std::vector<Light>& up = days[0];
    if (up.size() <= kPictureInstants) return up;
    for (std::size_t k = 0; k < kPictureInstants; ++k) {
      out.push_back(up[k * (up.size() - 1) / (kPictureInstants - 1)]);
    }
    return out;
  }
  for (std::size_t k = 0; !days.empty() && k < kPictureInstants; ++k) {
    const std::vector<Light>& up = days[k * days.size() / kPictureInstants];
    const double part = std::fmod(static_cast<double>(k) * kGoldenRatio, 1.0);
    out.push_back(up[static_cast<std::size_t>(part * static_cast<double>(up.size()))]);
  }
  return out;
}

double middle_azimuth(const Samples& s) {
  Vec4 sum(0.0), highest(0.0);
  for (const TimeSample& t : s.midpoints) {
    if (!t.up) continue;
    sum += t.light;
    if (t.light.z > highest.z) highest = t.light;
  }
  // On a long day in summer the low suns of morning and evening, on the pole's side, can outweigh
  // those around noon: a camera there would look at walls in shade.
  const bool behind = sum.x * highest.x + sum.y * highest.y < 0;
  return behind ? std::atan2(highest.x, highest.y) : std::atan2(sum.x, sum.y);
}

}  // namespace gnomon::app
