// Milliseconds for a silhouette alone, in the form of Tables 1 and 2 of Geometry of shadows in real
// time. Needs no OpenGL.
#pragma once

#include <span>
#include <string>

#include "progress.h"
#include "second_paper.h"

namespace gnomon::app {

// A section in Markdown. `bar` goes from `from` to `to`. Throws Failure; also where an exact method
// finds other edges than brute force.
std::string bench_silhouettes(std::span<const PaperScene> scenes, int rounds, ProgressBar& bar,
                              double from, double to);

}  // namespace gnomon::app
