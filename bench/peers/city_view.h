// The view and the lamp that every contender draws the box city with (scenes/box_city.h): model
// coordinates in metres, right-handed, z up.
#pragma once

#include <cmath>

#include <gnomon/core/place.h>
#include <gnomon/core/vec.h>
#include <scenes/box_city.h>

namespace gnomon::bench {

// Looks down at 35 degrees; the whole ground is in a square picture.
struct CityCamera {
  Vec3 eye{-225, -650, 460}, target{25, -50, 0}, up{0, 0, 1};
  double fov = 40 * kDegree;                  // vertical and, of a square picture, horizontal
  double near_plane = 100, far_plane = 5000;  // of renderers that have such planes
};

// Twice as high as the tallest box can be, over the crossing in the middle of the city: shadows at
// the city's edge are up to as long as they are far from the lamp.
constexpr double kLampHeight = 2 * scenes::kBoxTallest;
inline const Vec3 kLamp{0, 0, kLampHeight};

// The moving lamp circles at that height, once in kLampFrames frames; frame 0 is east of the
// middle.
constexpr double kLampCircle = 30;  // radius, metres
constexpr int kLampFrames = 100;
inline Vec3 moving_lamp(int frame) {
  const double turn = 2 * kPi * frame / kLampFrames;
  return {kLampCircle * std::cos(turn), kLampCircle * std::sin(turn), kLampHeight};
}

// Light as the lamp sheds it does not fade with distance; this part of it reaches shadows, too.
constexpr double kAmbient = 0.35;

}  // namespace gnomon::bench
