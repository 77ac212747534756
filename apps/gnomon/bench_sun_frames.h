// Milliseconds for a whole frame, in the form of Tables 1 and 2 of Geometry of shadows in real
// time.
#pragma once

#include <span>
#include <string>

#include <gnomon/gl/method.h>

#include "progress.h"
#include "second_paper.h"

namespace gnomon::app {

// A section in Markdown. `api`: gl or gles; `frames`: suns of a scene, about. `bar` goes from
// `from` to `to`. Throws Failure.
std::string bench_sun_frames(std::span<const PaperScene> scenes, const gl::Method& method,
                             const std::string& api, int frames, int rounds, ProgressBar& bar,
                             double from, double to);

}  // namespace gnomon::app
