// summary.json of `gnomon profile`: every input, every sample in time, counts, timings, warnings.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <gnomon/io/load_scene.h>
#include <gnomon/profile/profile.h>
#include <gnomon/profile/study_times.h>
#include <gnomon/raster/count_shadows.h>

#include "model_options.h"
#include "view_options.h"

namespace gnomon::app {

// Milliseconds per stage, in the order of the work.
using Timings = std::vector<std::pair<std::string, double>>;

struct Summary {
  const ModelOptions& models;
  const StudyTimes& times;
  const LoadedScene& loaded;
  const Samples& samples;
  const View& view;
  const Profile& profile;
  const CountStats& stats;
  const ExactStats& visibility;
  Timings timings;
  std::vector<std::string> outputs;   // file names
  int threads = 0;                    // asked for; 0: all
  std::size_t picture_instants = 0;   // shadows laid over each other in view.png
  std::uint64_t step_ms = 0;          // between isolines and classes of hours; 0: a camera has none
  bool shadows_reach_border = false;  // see shadow_reach.h
};

std::string summary_json(const Summary& summary, const Warnings& warnings);

}  // namespace gnomon::app
