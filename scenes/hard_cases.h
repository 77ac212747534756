// Placements of eye, light and casters that shadow volumes are known to fail at, each in a small
// scene; and a flight through volumes. Shared by tests and pictures.
// Based on: Everitt and Kilgard, Practical and Robust Stenciled Shadow Volumes, 2002 (Figures 1-3).
#pragma once

#include <string>
#include <vector>

#include <gnomon/core/vec.h>
#include <gnomon/scene/scene.h>
#include <gnomon/view/view.h>

namespace gnomon::scenes {

struct HardCase {
  std::string name;      // "light-in-cage": words and hyphens, unique
  std::string sentence;  // what is hard about it
  Scene scene;
  Light light{0, 0, 1, 0};
  View view;
  double near_plane = 0;  // metres; cuts nothing that is seen; 0: as gl::depth_range() chooses
  // z-pass, counting from the near plane, would shade or light large parts wrongly.
  bool z_pass_fails = false;
};

// All cases, in one fixed order; equal on every machine but for the last digits of sines. Metres.
// Preconditions: width, height > 0 (pixels of the views; 4 : 3 shows them as they were made for).
std::vector<HardCase> hard_cases(int width, int height);

// A camera flies for kFlightFrames frames on a closed course around a lamp, between pillars and
// towers, under a bridge and through a frame: through lit air and through volumes. It stays at
// least kFlightRoom metres from every surface, so a near plane up to half of that cuts nothing
// seen.
inline constexpr int kFlightFrames = 300;
inline constexpr double kFlightRoom = 0.5;
struct Flight {
  Scene scene;
  Light light{0, 0, 1, 0};  // w = 1
  std::vector<View> views;  // kFlightFrames
};
Flight flight(int width, int height);

}  // namespace gnomon::scenes
