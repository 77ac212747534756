#include "second_paper.h"

#include <gnomon/core/exact.h>
#include <gnomon/profile/study_times.h>

#include <scenes/second_paper_scenes.h>

#include "commands.h"
#include "model_options.h"

namespace gnomon::app {
namespace {

constexpr PaperDay kVienna{48.2, 16.4, "9:00", "17:00", "Europe/Vienna"};
constexpr const char* kSize = "640x480";

// The pictures' eyes: scripts/gallery.
ViewOptions from(const char* eye, const char* target, double fov_deg) {
  ViewOptions view;
  view.eye = eye;
  view.target = target;
  view.fov_deg = fov_deg;
  view.size = kSize;
  return view;
}

PaperScene scene_of(const std::string& word) {
  using scenes::OfficeCasters;
  if (word == "tower") {
    return {"Eiffel Tower (ours: `lattice_tower`)",
            scenes::lattice_tower(),
            {48.8, 2.3, "10:00", "14:00", "Europe/Paris"},
            from("-600,-260,220", "-10,60,120", 40),
            PaperTimes{4.584, 4.236}};
  }
  if (word == "industry") {
    return {"Industry Area (ours: `industry_area`)",
            scenes::industry_area(),
            {45.2, 9.2, "12:00", "15:00", "Europe/Rome"},
            from("-190,300,170", "-5,-10,0", 35),
            PaperTimes{7.299, 5.799}};
  }
  const ViewOptions office = from("-290,-90,150", "-5,45,35", 33);
  if (word == "office") {
    return {"Uniqua Building (ours: `office_building`)",
            scenes::office_building(OfficeCasters::facade_and_concrete), kVienna, office,
            PaperTimes{44.486, 39.331}};
  }
  return {"Uniqua Building, all casting", scenes::office_building(OfficeCasters::all), kVienna,
          office, PaperTimes{58.666, 48.872}};
}

PaperScene scene_of_file(const std::filesystem::path& file, bool quiet) {
  ModelOptions model;
  model.models = {file};
  model.load.ground = "none";
  ViewOptions view;
  view.size = kSize;
  PaperScene out{title_of(model), read_models(model, quiet).scene, kVienna, view};
  print_warnings(out.scene.warnings);
  return out;
}

}  // namespace

std::vector<PaperScene> second_paper_scenes(const std::vector<std::string>& scenes,
                                            const std::vector<std::filesystem::path>& models,
                                            bool quiet) {
  std::vector<PaperScene> out;
  for (const std::string& word : scenes) out.push_back(scene_of(word));
  for (const std::filesystem::path& file : models) out.push_back(scene_of_file(file, quiet));
  return out;
}

std::vector<Light> suns_of(const PaperDay& day) {
  const Samples samples = take(study_samples({kPaperDate, day.from, day.to, "1min", day.zone},
                                             {day.latitude * kDegree, day.longitude * kDegree}, 0));
  std::vector<Light> out;
  for (const TimeSample& s : samples.midpoints) {
    if (s.up) out.push_back(snapped(s.light));
  }
  return out;
}

}  // namespace gnomon::app
