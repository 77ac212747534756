// The scenes and suns of Tables 1 and 2 of Geometry of shadows in real time, and its times.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gnomon/core/vec.h>
#include <gnomon/scene/scene.h>

#include "view_options.h"

namespace gnomon::app {

// Hours of a day: the paper's, on 18 September (Figures 5 to 7); year and longitudes are ours.
struct PaperDay {
  double latitude, longitude;  // degrees
  const char *from, *to, *zone;
};
inline constexpr const char* kPaperDate = "2024-09-18";

struct PaperTimes {
  double brute, dual;  // ms: Tables 1 and 2
};

struct PaperScene {
  std::string name;
  Scene scene;
  PaperDay day;
  ViewOptions view;                   // of a frame
  std::optional<PaperTimes> paper{};  // none: not one of the paper's
};

// `scenes`: of tower, industry, office, office-all; then `models`, files, under the sun of Vienna
// and without a ground. Prints the warnings of these. Throws Failure.
std::vector<PaperScene> second_paper_scenes(const std::vector<std::string>& scenes,
                                            const std::vector<std::filesystem::path>& models,
                                            bool quiet);

// The suns in the middle of each minute, snapped.
std::vector<Light> suns_of(const PaperDay& day);

}  // namespace gnomon::app
