#include "report.h"

#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/report_tables.h>

#include "study_text.h"

namespace gnomon::app {
namespace {

// The steps of one date, with its window.
SunPathDay sun_day(const StudyResults& r, std::size_t day) {
  SunPathDay out;
  for (const TimeSample& s : r.samples.midpoints) {
    if (s.day == day) out.steps.push_back(s);
  }
  if (out.steps.empty()) return out;
  const auto half = [](const TimeSample& s) { return std::chrono::milliseconds(s.weight_ms / 2); };
  out.begin = out.steps.front().utc - half(out.steps.front());
  out.end = out.steps.back().utc + half(out.steps.back());
  out.label = r.samples.dates[day];
  return out;
}

std::vector<std::size_t> shown_days(const Samples& samples) {
  const std::size_t n = samples.dates.size();
  if (n <= 3) {
    std::vector<std::size_t> all;
    for (std::size_t k = 0; k < n; ++k) all.push_back(k);
    return all;
  }
  return {0, n / 2, n - 1};
}

std::string text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  std::string text;
  if (value.is_array()) {
    for (const Json& v : value) text += (text.empty() ? "" : ", ") + text_of(v);
    return text;
  }
  if (value.is_object()) {
    for (const auto& [key, v] : value.items()) {
      if (!v.is_null()) text += (text.empty() ? "" : ", ") + key + " " + text_of(v);
    }
    return text;
  }
  return value.dump();
}

}  // namespace

ReportSection report_section(const StudyResults& r) {
  ReportSection out;
  out.title = r.window;
  out.facts = {{"Window", r.window}, {"Steps", r.steps}};
  out.results = hours_facts(r.profile);
  out.tables.push_back(hours_table(r.profile, r.sample_area, r.step_ms));
  if (r.objects.size() > 2) {
    out.later_tables.push_back(objects_table(r.profile, r.sample_area, r.objects));
  }
  const std::string mean =
      r.profile.days > 1 ? fmt::format(", mean per day over {} days", r.profile.days) : "";
  out.pictures = {{r.map, "Hours in shadow" + mean + ".", "Map of the hours in shadow"},
                  {r.view, fmt::format("{} shadows laid over each other on the model.", r.overlaid),
                   "The model with the shadows of the steps"}};
  for (const std::size_t day : shown_days(r.samples)) {
    SunPathDay sun = sun_day(r, day);
    if (sun.steps.empty()) continue;
    out.steps.insert(out.steps.end(), sun.steps.begin(), sun.steps.end());
    out.sun_days.push_back(std::move(sun));
  }
  if (r.samples.dates.size() > 3) {
    out.facts.emplace_back("Shown below", "sun path and steps of the first, middle and last date");
  }
  return out;
}

Report make_report(const LoadedScene& loaded, const Json& inputs, const std::string& title,
                   const std::string& zone, const std::string& software,
                   const std::string& attribution, std::vector<ReportSection> sections,
                   const Warnings& warnings) {
  Report out;
  out.title = title;
  for (const ReportSection& s : sections)
    out.subtitle += (out.subtitle.empty() ? "" : "; ") + s.title;
  out.software = software;
  out.attribution = attribution;
  const Frame& frame = loaded.scene.frame;
  out.place = *frame.place;
  out.true_north = frame.true_north;
  if (!frame.crs.empty()) {
    const auto at = locate(frame.crs, frame.origin);
    out.crs = at && short_crs(frame.crs).size() < 40
                  ? fmt::format("{} ({})", short_crs(frame.crs), at.value().name)
              : at ? at.value().name
                   : frame.crs;
  }
  out.zone = zone;
  out.sections = std::move(sections);
  for (const auto& [key, value] : inputs.items()) {
    const std::string text = value.is_null() ? std::string() : text_of(value);
    if (!text.empty()) out.inputs.emplace_back(key, text);
  }
  out.input_tables = {files_table(loaded.files)};
  ReportTable placing;
  placing.title = "Placing";
  placing.header = {"File", "Axes", "Placed"};
  for (const FileReport& f : loaded.files) placing.rows.push_back({f.path, f.axes, f.placed});
  placing.note = fmt::format("Place from {}; true north from {}; ground: {}.", loaded.place_by,
                             loaded.north_by, loaded.ground.kind);
  out.input_tables.push_back(std::move(placing));
  out.warnings = warnings;
  return out;
}

}  // namespace gnomon::app
