#include "report.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/report_tables.h>

#include "shadow_reach.h"
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

std::string file_name(const std::filesystem::path& path) { return path.filename().string(); }

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : ", ") + w;
  return text;
}

std::string site_text(const Site& site) {
  return latitude_text(site.place.latitude) + ", " + longitude_text(site.place.longitude) +
         (site.on_ground ? std::string() : fmt::format(", height {:g} m", site.place.height));
}

std::string north_degrees(double radians) {
  return fmt::format("{:.10g}\u00b0 clockwise of the model's +y", radians / kDegree);
}

// "up z, site 48.20580 N, 16.34900 E": what one file was told; empty: nothing.
std::string told_text(const FileOptions& f) {
  std::vector<std::string> words;
  if (f.up != 0) words.push_back(std::string("up ") + f.up);
  if (!f.unit.empty()) words.push_back("unit " + f.unit);
  if (f.north) words.push_back("true north " + north_degrees(*f.north));
  if (!f.crs.empty()) words.push_back("CRS " + f.crs);
  if (f.site) words.push_back("site " + site_text(*f.site));
  return joined(words);
}

// Options of the models that are not as they are without being given.
void add_model_facts(ReportFacts& facts, const ModelOptions& o) {
  const LoadOptions& l = o.load;
  const auto add = [&](const char* name, const std::string& text) {
    if (!text.empty()) facts.emplace_back(name, text);
  };
  std::vector<std::string> names;
  for (const auto& m : o.models) names.push_back(file_name(m));
  add("Models", joined(names));
  add("All files",
      told_text({.up = l.up, .unit = l.unit, .north = l.north, .crs = l.crs, .site = l.site}));
  // One line for each file, whatever the number of options that name it.
  for (std::size_t k = 0; k < l.for_files.size(); ++k) {
    const std::string& file = l.for_files[k].file;
    const auto same = [&](const FileOptions& f) { return f.file == file; };
    if (std::any_of(l.for_files.begin(), l.for_files.begin() + static_cast<std::ptrdiff_t>(k),
                    same)) {
      continue;
    }
    std::vector<std::string> words;
    for (const FileOptions& f : l.for_files) {
      if (same(f)) words.push_back(told_text(f));
    }
    add(file_name(file).c_str(), joined(words));
  }
  add("Level of detail", l.lod);
  add("Ground", l.ground);
  add("Cast only", joined(l.cast));
  add("Do not cast", joined(l.no_cast));
  add("Receive only", joined(l.receive));
  if (l.surface == RasterMesh::cells) add("Raster surfaces", "level cells with upright walls");
  add("Rasters with heights above the ground", joined(l.above_ground));
  const FootprintOptions& f = l.footprints;
  add("Footprints: layer", f.layer);
  add("Footprints: attribute of the height", f.height);
  add("Footprints: attribute of the floors", f.floors);
  add("Footprints: attribute of the foot's height", f.base);
  if (f.floor_height != FootprintOptions().floor_height)
    add("Footprints: height of a floor", fmt::format("{:g} m", f.floor_height));
}

// Where the ground comes from, a fact that results rest on.
std::string ground_text(const LoadedScene& loaded, const std::string& mode) {
  const std::string& kind = loaded.ground.kind;
  if (kind == "model terrain") return "the model's own terrain";
  if (kind == "none") return "none was wanted (--ground none)";
  if (mode != "auto") return "level at " + mode + " m, as given with --ground";
  if (kind == "level") return "no terrain was given; the ground was made level";
  return "no terrain was given; the ground was made through the feet of the buildings";
}

// How good the hours are, which only steps decide.
std::string precision_text(const std::string& every) {
  const auto step = read_step(every);
  std::string text = "hours at a spot are right to about one step";
  if (step) text += " (" + duration_text(static_cast<double>(step->count())) + ")";
  for (const char* finer : {"15min", "5min", "1min"}) {
    if (step && *step > *read_step(finer)) return text + "; --every " + finer + " is finer";
  }
  return text;
}

}  // namespace

ReportSection report_section(const StudyResults& r) {
  ReportSection out;
  out.title = r.window;
  out.facts = {{"Window", r.window}, {"Steps", r.steps}};
  out.results = hours_facts(r.profile);
  out.results.emplace_back("Precision", precision_text(r.times.every));
  out.results.emplace_back("Ground", ground_text(r.loaded, r.ground));
  out.tables.push_back(hours_table(r.profile, r.sample_area, r.step_ms));
  if (r.at_border) out.tables.back().note += std::string(" ") + kShadowAtBorder;
  if (r.objects.size() > 2) {
    out.later_tables.push_back(objects_table(r.profile, r.sample_area, r.objects));
  }
  const std::string mean =
      r.profile.days > 1 ? fmt::format(", mean per day over {} days", r.profile.days) : "";
  out.pictures = {{r.map, "Hours in shadow" + mean + ".", "Map of the hours in shadow"},
                  {r.view, r.overlaid + ".", "The model with the shadows of the steps"}};
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

ReportFacts report_inputs(const ModelOptions& models, const TimeOptions& time,
                          const ViewOptions& view, const std::string& isolines, const View& chosen,
                          const Vec3& origin) {
  ReportFacts facts;
  add_model_facts(facts, models);
  const StudyTimes& t = time.times;
  facts.emplace_back("Dates", joined(time.dates));
  facts.emplace_back("From", t.from.empty() ? "sunrise" : t.from);
  facts.emplace_back("To", t.to.empty() ? "sunset" : t.to);
  facts.emplace_back("Step", t.every);
  facts.emplace_back("Clock", t.zone == "solar" ? "true solar time" : t.zone);
  if (wants_camera(view)) {
    facts.emplace_back("View", "camera, " + view.size + " pixels");
    facts.emplace_back("Eye", view.eye.empty() ? "chosen" : view.eye);
    facts.emplace_back("Target", view.target.empty() ? "the model's middle" : view.target);
    if (view.ortho_height > 0) {
      facts.emplace_back("Parallel view", fmt::format("{:g} m high", view.ortho_height));
    } else {
      facts.emplace_back("Field of view", fmt::format("{:g}\u00b0", view.fov_deg));
    }
    return facts;
  }
  facts.emplace_back("View", "plan");
  // As --bounds takes it: another run over the same samples is one that can be compared.
  const double pixel = chosen.right.x;
  const double west = chosen.origin.x + origin.x, north = chosen.origin.y + origin.y;
  facts.emplace_back("Pixel", fmt::format("{:g} m{}", pixel, view.pixel > 0 ? "" : ", chosen"));
  facts.emplace_back(
      "Bounds",
      fmt::format("{:.10g},{:.10g},{:.10g},{:.10g}{}", west, north - pixel * chosen.height,
                  west + pixel * chosen.width, north, view.bounds.empty() ? ", chosen" : ""));
  facts.emplace_back("Isolines every", isolines.empty() ? "as in the map's legend" : isolines);
  return facts;
}

Report make_report(const LoadedScene& loaded, ReportFacts inputs, const std::string& title,
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
  out.inputs = std::move(inputs);
  // Where a file lies is nobody's business who reads the report; summary.json has the whole path.
  std::vector<FileReport> files = loaded.files;
  for (FileReport& f : files) f.path = file_name(f.path);
  out.input_tables = {files_table(files)};
  ReportTable placing;
  placing.title = "Placing";
  placing.header = {"File", "Axes", "Placed"};
  for (const FileReport& f : files) placing.rows.push_back({f.path, f.axes, f.placed});
  placing.note =
      fmt::format("Place from {}; true north from {}.", loaded.place_by, loaded.north_by);
  out.input_tables.push_back(std::move(placing));
  out.warnings = warnings;
  return out;
}

}  // namespace gnomon::app
