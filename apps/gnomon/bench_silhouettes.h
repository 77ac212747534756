// Milliseconds for a silhouette, in the form of Tables 1 and 2 of Geometry of shadows in real time.
// Needs no OpenGL.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "progress.h"

namespace gnomon::app {

struct SilhouetteBench {
  int rounds = 3;
  std::vector<std::string> scenes;            // of tower, industry, office, office-all
  std::vector<std::filesystem::path> models;  // files, after these
  bool quiet = false;
};

// A section in Markdown. `bar` goes from `from` to `to`. Throws Failure; also where an exact method
// finds other edges than brute force.
std::string bench_silhouettes(const SilhouetteBench& options, ProgressBar& bar, double from,
                              double to);

}  // namespace gnomon::app
