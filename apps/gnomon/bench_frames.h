// Frames a second by OpenGL, in the form of the tables of Shadow Volumes Revisited (Roettger,
// Irion, Ertl, 2002) and of Practical and Robust Stenciled Shadow Volumes (Everitt, Kilgard, 2002).
#pragma once

#include <string>
#include <vector>

#include <gnomon/gl/method.h>
#include <CLI/CLI.hpp>

#include "progress.h"

namespace gnomon::app {

struct FrameBench {
  int frames = 24, rounds = 3, threads = 0;
  std::vector<int> sizes{256, 512, 1024};
  std::vector<std::string> scenes;  // of convex, concave, figures
  gl::Method method;
  std::string api = "gl";
  std::string pictures;  // a folder; empty: none
};

// Adds --frames --size --api --pictures and those of the method.
void add_frame_options(CLI::App& command, FrameBench& options);

// A section in Markdown. `bar` goes from `from` to `to`. Throws Failure.
std::string bench_frames(const FrameBench& options, ProgressBar& bar, double from, double to);

}  // namespace gnomon::app
