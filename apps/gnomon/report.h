// report.html of `gnomon profile`: what a run knows, gathered for io/write_report.h.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gnomon/io/write_report.h>
#include <gnomon/io/write_summary_csv.h>
#include <gnomon/profile/profile.h>
#include <gnomon/profile/study_times.h>

#include "model_options.h"
#include "time_options.h"
#include "view_options.h"

namespace gnomon::app {

// One --date: what its section shows.
struct StudyResults {
  const StudyTimes& times;
  const Samples& samples;
  const Profile& profile;
  std::string window, steps;         // study_text.h
  double sample_area = 0;            // square metres; 0 for a camera
  std::uint64_t step_ms = 0;         // between classes of hours
  std::vector<ObjectHours> objects;  // empty for a camera
  std::filesystem::path map, view;   // pictures
  std::string overlaid;              // study_text.h, of `view`
  bool at_border = false;            // see shadow_reach.h
  const LoadedScene& loaded;
  std::string ground;  // --ground as given
};

// Of a range, the sun path and the steps of its first, middle and last date.
ReportSection report_section(const StudyResults& results);

// The options that were given, and when and how the study looks, in words.
// `chosen`: the view; `origin`: the scene's.
ReportFacts report_inputs(const ModelOptions& models, const TimeOptions& time,
                          const ViewOptions& view, const std::string& isolines, const View& chosen,
                          const Vec3& origin);

Report make_report(const LoadedScene& loaded, ReportFacts inputs, const std::string& title,
                   const std::string& zone, const std::string& software,
                   const std::string& attribution, std::vector<ReportSection> sections,
                   const Warnings& warnings);

}  // namespace gnomon::app
