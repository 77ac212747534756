// gnomon profile: how long is every spot in shadow.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/io/isolines.h>
#include <gnomon/io/plan_picture.h>
#include <gnomon/io/view_picture.h>
#include <gnomon/io/write_geotiff.h>
#include <gnomon/io/write_summary_csv.h>
#include <gnomon/profile/study_dates.h>
#include <gnomon/shadow/cast_shadows.h>

#include "commands.h"
#include "model_options.h"
#include "picture_lights.h"
#include "place_text.h"
#include "progress.h"
#include "report.h"
#include "shadow_reach.h"
#include "staging.h"
#include "study_text.h"
#include "summary.h"
#include "time_options.h"
#include "view_options.h"

namespace gnomon::app {
namespace {

// view.png is drawn at this many samples per pixel along each side, for smooth edges.
constexpr int kSupersample = 2;

struct Options {
  Common common;
  ModelOptions models;
  TimeOptions time;
  ViewOptions view;
  std::string output = "gnomon-out";
  std::string title, attribution;
  std::string isolines;  // step, "30min"; empty: chosen
};

class Stopwatch {
 public:
  explicit Stopwatch(Timings& timings) : timings_(timings) {}
  void stage(const char* name) {
    const Clock::time_point now = Clock::now();
    timings_.emplace_back(name, milliseconds(now - last_));
    last_ = now;
  }
  double total() const { return milliseconds(Clock::now() - begin_); }

 private:
  using Clock = std::chrono::steady_clock;
  static double milliseconds(Clock::duration d) {
    return std::chrono::duration<double, std::milli>(d).count();
  }
  Timings& timings_;
  Clock::time_point begin_ = Clock::now(), last_ = begin_;
};

// What an earlier run of another kind of view may have left would belong to other results.
void remove_other_kind(Staging& staging, const std::string& folder) {
  for (const char* result : {"plan.png", "hours.png", "isolines.geojson", "isolines.gpkg",
                             "summary.csv", "objects.csv"}) {
    const auto& names = staging.names();
    const std::string name = folder + result;
    if (std::find(names.begin(), names.end(), name) == names.end()) staging.obsolete(name);
  }
}

// What all studies of a run share.
struct Prepared {
  const LoadedScene& loaded;
  const View& view;
  const Receivers& receivers;
  const Casters& casters;
  const ExactStats& visibility;
  double camera_azimuth;  // automatic cameras look from that side
  std::string title, software;
};

// One entry of --date.
struct Study {
  StudyTimes times;
  Samples samples;
  std::string folder;  // of its results inside the output folder: "2024-03-21/", or empty
  std::string window, steps;
};

// Between isolines and classes of hours.
std::uint64_t isoline_step(const Options& o, const Profile& profile) {
  if (o.isolines.empty() || o.isolines == "none")
    return static_cast<std::uint64_t>(std::llround(tick_hours(daylight_hours(profile)) * 3.6e6));
  return static_cast<std::uint64_t>(read_step(o.isolines)->count());
}

void check_isoline_step(const std::string& text) {
  const auto step = read_step(text);
  if (!step || *step < std::chrono::minutes(1)) {
    throw Failure(
        "the step '" + text +
        "' of --isolines cannot be used: write whole numbers with units, as 1h, 30min or 1h30min, "
        "at least 1min, or none");
  }
}

Profile compute(const Options& o, const Prepared& all, const Study& study, CountStats& stats) {
  ProgressBar bar("computing shadows", o.common.quiet);
  const ShadowOptions options{o.common.threads, [&](double share) { bar.show(share); }, &stats,
                              true};
  Profile profile = shadow_profile(all.casters, all.receivers, study.samples, options);
  if (profile.daylight_ticks == 0) {
    throw Failure(
        fmt::format("the sun is below the horizon at every step of {}: there is nothing to compute",
                    study.window));
  }
  return profile;
}

ViewSamples overlay(const Options& o, const Prepared& all, const Study& study) {
  const Scene& scene = all.loaded.scene;
  ProgressBar bar("drawing the view", o.common.quiet);
  ViewOptions as_camera = o.view;
  if (!wants_camera(o.view)) {
    as_camera = ViewOptions{};
    as_camera.bounds = o.view.bounds;
  }
  const View wide = make_camera(scene, as_camera, all.camera_azimuth, kSupersample);
  // The picture beside a map shows the whole model, also what does not receive (--receive).
  Scene whole;
  if (!wants_camera(o.view)) {
    whole = scene;
    for (Surface& s : whole.surfaces) s.receives = true;
  }
  const Scene& shown = wants_camera(o.view) ? scene : whole;
  const Receivers seen = visible_surfaces(shown, wide, o.common.threads);
  const std::vector<Light> lights = picture_lights(study.samples);
  const std::vector<std::uint32_t> shaded =
      count_shaded(all.casters, seen, lights,
                   {o.common.threads, [&](double share) { bar.show(share); }, nullptr});
  ViewSamples picture;
  picture.width = wide.width;
  picture.height = wide.height;
  picture.downsample = kSupersample;
  picture.instants = static_cast<int>(lights.size());
  picture.shadows.assign(shaded.begin(), shaded.end());
  picture.valid.resize(shaded.size());
  std::transform(
      seen.triangle.begin(), seen.triangle.end(), picture.valid.begin(),
      [](std::uint32_t t) { return static_cast<std::uint8_t>(t != kNoTriangle ? 1 : 0); });
  picture.shading = view_shading(shown, seen, o.common.threads);
  return picture;
}

// isolines and tables: what has a place on the map. Returns the objects of the tables.
std::vector<ObjectHours> write_map_data(const Options& o, const Prepared& all, const Study& study,
                                        const Profile& profile, std::uint64_t step_ms,
                                        Staging& staging, Stopwatch& watch) {
  const int threads = o.common.threads;
  const Scene& scene = all.loaded.scene;
  const auto path = [&](const char* name) { return staging.path(study.folder + name); };
  if (o.isolines != "none") {
    const std::vector<Isoline> lines = find_isolines(profile, all.view, step_ms, threads);
    take(write_isolines_geojson(path("isolines.geojson"), lines, profile.days, scene.frame));
    take(write_isolines_gpkg(path("isolines.gpkg"), lines, profile.days, scene.frame));
    watch.stage("isolines");
  }
  std::vector<ObjectHours> objects = hours_by_object(profile, all.receivers, scene, step_ms);
  take(write_summary_csv(path("summary.csv"), profile, all.view, objects, step_ms));
  take(write_objects_csv(path("objects.csv"), profile, all.view, objects));
  watch.stage("summary.csv");
  return objects;
}

// What a study leaves for the end of the run.
struct StudyDone {
  Warnings warnings;  // of the study alone
  ReportSection section;
};

// Computes one study and stages its results. `timings`: of what came before.
StudyDone run_study(const Options& o, const Prepared& all, const Study& study, Timings timings,
                    Staging& staging) {
  Stopwatch watch(timings);
  const Scene& scene = all.loaded.scene;
  const bool camera = wants_camera(o.view);
  const int threads = o.common.threads;
  const auto path = [&](const char* name) { return staging.path(study.folder + name); };

  CountStats stats;
  const Profile profile = compute(o, all, study, stats);
  watch.stage("profile");
  Warnings warnings = study.samples.warnings;
  const bool at_border = !camera && shadow_at_border(scene, all.receivers, [&](std::size_t k) {
    return profile.shadow_ticks[k] > 0;
  });
  if (std::find(profile.valid.begin(), profile.valid.end(), 1) == profile.valid.end()) {
    warn(warnings,
         "the view meets no receiver: every sample is nodata; check --bounds, --eye and --receive",
         "");
  }

  const std::string all_text = all.title + ", " + study.window + ", " + study.steps;
  take(write_profile_geotiff(path("profile.tif"), profile, all.view, scene.frame,
                             {{"TIFFTAG_SOFTWARE", all.software},
                              {"TIFFTAG_IMAGEDESCRIPTION", all_text},
                              {"DATE", study.times.date},
                              {"TIME_ZONE", study.times.zone}},
                             {.threads = threads}));
  watch.stage("profile.tif");

  PlanCaption plan_caption;
  plan_caption.title = all.title;
  plan_caption.lines = {study.window, study.steps};
  plan_caption.software = all.software;
  plan_caption.attribution = o.attribution;
  plan_caption.without_sample = without_sample(scene);
  const char* map_name = camera ? "hours.png" : "plan.png";
  const PlanRelief relief = camera ? PlanRelief{} : plan_relief(scene, all.receivers, threads);
  const std::filesystem::path map_path = path(map_name);
  take(write_plan_picture(map_path, profile, all.view, scene.frame, plan_caption, relief, threads));
  watch.stage(map_name);

  const std::uint64_t step_ms = isoline_step(o, profile);
  std::vector<ObjectHours> objects;
  if (!camera) objects = write_map_data(o, all, study, profile, step_ms, staging, watch);

  const ViewSamples picture = overlay(o, all, study);
  ViewCaption view_caption;
  view_caption.title = all.title;
  view_caption.lines = {study.window, overlay_text(study.samples, picture.instants)};
  view_caption.software = all.software;
  view_caption.attribution = o.attribution;
  const std::filesystem::path view_path = path("view.png");
  take(write_view_picture(view_path, picture, view_caption, threads));
  watch.stage("view.png");

  const std::filesystem::path summary_path = path("summary.json");
  std::vector<std::string> outputs;
  for (const std::string& name : staging.names()) {
    if (name.starts_with(study.folder)) outputs.push_back(name.substr(study.folder.size()));
  }
  double total = 0;
  for (const auto& stage : timings) total += stage.second;
  timings.emplace_back("total", total);
  const Summary summary{o.models,
                        study.times,
                        all.loaded,
                        study.samples,
                        all.view,
                        profile,
                        stats,
                        all.visibility,
                        timings,
                        outputs,
                        threads,
                        static_cast<std::size_t>(picture.instants),
                        camera ? 0 : step_ms,
                        at_border};
  Warnings every = scene.warnings;
  append(every, warnings);
  take(write_text_file(summary_path, summary_json(summary, every)));
  if (!o.common.quiet) {
    fmt::print("{}\n{}; {}; the sun was up for {:.2f} h {}\n", all.title, study.window, study.steps,
               daylight_hours(profile), profile.days > 1 ? "a day" : "of it");
    if (at_border) fmt::print("{}\n", kShadowAtBorder);
  }
  const double area = camera ? 0 : all.view.right.x * all.view.right.x;
  return {warnings, report_section({study.times, study.samples, profile, study.window, study.steps,
                                    area, step_ms, std::move(objects), map_path, view_path,
                                    overlay_text(study.samples, picture.instants), at_border,
                                    all.loaded, o.models.load.ground})};
}

// One for each --date. Everything that can be refused is, before the model is read.
std::vector<StudyTimes> study_times(const Options& o) {
  if (o.time.dates.empty())
    throw Failure("no date given: add --date YYYY-MM-DD, such as --date 2024-09-18");
  if (o.time.times.zone.empty()) {
    throw Failure(
        "no time zone given: add --tz Europe/Vienna (an IANA name) or --tz solar (true solar "
        "time)");
  }
  if (!o.isolines.empty() && o.isolines != "none") check_isoline_step(o.isolines);
  std::vector<StudyTimes> all;
  for (const std::string& date : o.time.dates) {
    take(study_dates(date));
    for (const StudyTimes& t : all) {
      if (t.date == date) throw Failure("--date " + date + " is given twice: leave one out");
    }
    all.push_back(o.time.times);
    all.back().date = date;
  }
  return all;
}

// Of all studies together, so that their maps are of the same frame.
std::optional<ShadowReach> reach_of(const std::vector<Study>& studies) {
  std::vector<Light> suns;
  for (const Study& s : studies) {
    for (const TimeSample& t : s.samples.midpoints) {
      if (t.up) suns.push_back(t.light);
    }
  }
  return shadow_reach(suns);
}

void run(const Options& o) {
  Timings timings;
  Stopwatch watch(timings);
  const std::vector<StudyTimes> times = study_times(o);
  const bool camera = wants_camera(o.view);

  LoadedScene loaded = read_models(o.models, o.common.quiet, parse_bounds(o.view.bounds));
  Scene& scene = loaded.scene;
  if (!scene.frame.place) {
    throw Failure(
        o.models.models.front().string() +
        ": where on Earth is the model? Its file names no coordinate reference system: add --crs "
        "EPSG:..., or --site LAT,LON "
        "(degrees) for a model in local metres");
  }
  const Place place = *scene.frame.place;
  std::vector<Study> studies;
  for (const StudyTimes& t : times) {
    Study study{t, take(study_samples(t, place, scene.frame.true_north)), "", "", ""};
    if (times.size() > 1) study.folder = folder_name(t.date) + "/";
    study.window = window_text(t, study.samples, place);
    study.steps = steps_text(t, study.samples);
    studies.push_back(std::move(study));
  }
  check_place(scene.warnings, place, o.time.times.zone);
  watch.stage("read");

  const double azimuth = middle_azimuth(studies.front().samples);
  const View view =
      camera ? make_camera(scene, o.view, azimuth, 1) : make_plan(scene, o.view, reach_of(studies));
  ExactStats visibility;
  const Receivers receivers = visible_surfaces(scene, view, o.common.threads, &visibility);
  const Casters casters = prepare_casters(scene);
  if (casters.edges.vertices.empty())
    warn(scene.warnings, "nothing casts a shadow: check --cast and --no-cast", "");
  watch.stage("view");
  if (!o.common.quiet && o.common.verbose > 0) {
    std::size_t steps = 0;
    for (const Study& s : studies) steps += s.samples.midpoints.size();
    fmt::print(stderr, "{} triangles, {} x {} samples, {} steps\n", scene.mesh.triangles.size(),
               view.width, view.height, steps);
  }

  const Prepared all{loaded,
                     view,
                     receivers,
                     casters,
                     visibility,
                     azimuth,
                     o.title.empty() ? title_of(o.models) : o.title,
                     std::string("gnomon ") + GNOMON_VERSION};
  Warnings warnings = scene.warnings;
  Staging staging(o.output);
  if (!o.common.quiet) fmt::print("{}\n", place_line(loaded));
  std::vector<ReportSection> sections;
  for (const Study& study : studies) {
    StudyDone done = run_study(o, all, study, timings, staging);
    append(warnings, done.warnings);
    sections.push_back(std::move(done.section));
  }
  take(write_report(
      staging.path("report.html"),
      make_report(loaded,
                  report_inputs(o.models, o.time, o.view, o.isolines, view, scene.frame.origin),
                  all.title, o.time.times.zone, all.software, o.attribution, std::move(sections),
                  warnings)));
  for (const Study& study : studies) remove_other_kind(staging, study.folder);
  staging.publish();

  if (o.common.quiet) return;
  print_warnings(warnings);
  const Box box = model_box(scene);
  for (const FileReport& f : loaded.files) {
    if (!f.axes.empty()) fmt::print("{}: {}\n", f.path, f.axes);
    if (loaded.files.size() > 1) fmt::print("{}: {}\n", f.path, f.placed);
  }
  fmt::print("model: {:.1f} m east-west, {:.1f} m north-south, {:.1f} m high\n",
             box.hi.x - box.lo.x, box.hi.y - box.lo.y, box.hi.z - box.lo.z);
  fmt::print("{} x {} samples over {} triangles in {:.2f} s\n", view.width, view.height,
             scene.mesh.triangles.size(), watch.total() / 1000);
  for (const std::string& name : staging.names())
    fmt::print("  {}\n", (staging.output() / name).string());
  fmt::print("Open {} in a browser.\n", (staging.output() / "report.html").string());
}

}  // namespace

void add_profile(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("profile", "Hours in shadow on every spot: the shadow profile");
  add_model_options(*command, options->models);
  add_time_options(*command, options->time, Dates::kSeveral);
  add_view_options(*command, options->view);
  command->add_option("-o,--output", options->output, "Folder for the results")
      ->capture_default_str()
      ->group("Output");
  command
      ->add_option("--title", options->title,
                   "Title of the pictures (default: names of the models)")
      ->group("Output");
  command
      ->add_option("--attribution", options->attribution,
                   "Whom the pictures name as the model's source")
      ->group("Output");
  command
      ->add_option("--isolines", options->isolines,
                   "Hours of shadow between isolines, and between the classes of summary.csv: 1h, "
                   "30min, 1h30min; none: no isolines (default: as in the map's legend)")
      ->group("Output");
  add_common(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace gnomon::app
