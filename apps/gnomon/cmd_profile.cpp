// gnomon profile: how long is every spot in shadow.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/io/plan_picture.h>
#include <gnomon/io/view_picture.h>
#include <gnomon/io/write_geotiff.h>
#include <gnomon/shadow/cast_shadows.h>
#include <gnomon/sun/time_zone.h>

#include "commands.h"
#include "model_options.h"
#include "progress.h"
#include "staging.h"
#include "summary.h"
#include "time_options.h"
#include "view_options.h"

namespace gnomon::app {
namespace {

// view.png is drawn at this many samples per pixel along each side, for smooth edges.
constexpr int kSupersample = 2;
// view.png lays at most this many shadows over each other; more are thinned evenly, both ends kept,
// and the caption says so.
constexpr std::size_t kPictureInstants = 33;

struct Options {
  Common common;
  ModelOptions models;
  TimeOptions time;
  ViewOptions view;
  std::string output = "gnomon-out";
  std::string title, attribution;
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

// The other kind of map that an earlier run may have left would belong to other results.
void remove_other_map(const Staging& staging) {
  for (const char* map : {"plan.png", "hours.png"}) {
    const auto& names = staging.names();
    std::error_code ignored;
    if (std::find(names.begin(), names.end(), map) == names.end())
      std::filesystem::remove(staging.output() / map, ignored);
  }
}

// "18 September 2024, 09:00 - 17:00 Europe/Vienna"
std::string window_text(const StudyTimes& t, const Samples& s, const Place& place) {
  static constexpr const char* kMonths[] = {"January",   "February", "March",    "April",
                                            "May",       "June",     "July",     "August",
                                            "September", "October",  "November", "December"};
  const auto clock = [&](Instant utc) {
    return iso_text(take(utc_to_clock(t.zone, place, utc))).substr(11, 5);
  };
  const int month = std::stoi(t.date.substr(5, 2));
  const std::string end = t.to == "24:00" ? t.to : clock(s.end);
  return fmt::format("{} {} {}, {} \u2013 {} {}", std::stoi(t.date.substr(8, 2)),
                     kMonths[month - 1], t.date.substr(0, 4), clock(s.begin), end,
                     t.zone == "solar" ? "true solar time" : t.zone);
}

std::vector<Light> picture_lights(const std::vector<TimeSample>& instants) {
  std::vector<Light> up, out;
  for (const TimeSample& s : instants) {
    if (s.up) up.push_back(s.light);
  }
  if (up.size() <= kPictureInstants) return up;
  for (std::size_t k = 0; k < kPictureInstants; ++k) {
    out.push_back(up[k * (up.size() - 1) / (kPictureInstants - 1)]);
  }
  return out;
}

// Azimuth in the scene's grid of the sun in the middle of the time it is up.
double middle_azimuth(const Samples& s) {
  Vec4 sum(0.0);
  for (const TimeSample& t : s.midpoints) {
    if (t.up) sum += t.light;
  }
  return std::atan2(sum.x, sum.y);
}

void run(const Options& o) {
  Timings timings;
  Stopwatch watch(timings);
  if (o.time.times.date.empty())
    throw Failure("no date given: add --date YYYY-MM-DD, such as --date 2024-09-18");
  if (o.time.times.zone.empty()) {
    throw Failure(
        "no time zone given: add --tz Europe/Vienna (an IANA name) or --tz solar (true solar "
        "time)");
  }
  const bool camera = wants_camera(o.view);

  LoadOptions load = o.models.load;
  if (!load.ground_extent) load.ground_extent = parse_bounds(o.view.bounds);
  const LoadedScene loaded = take(load_scene(o.models.models, load));
  const Scene& scene = loaded.scene;
  if (!scene.frame.place) {
    throw Failure(
        "where on Earth is the model? Its file names no coordinate reference system: add --crs "
        "EPSG:..., or --site LAT,LON "
        "(degrees) for a model in local metres");
  }
  const Place place = *scene.frame.place;
  const Samples samples = take(study_samples(o.time.times, place, scene.frame.true_north));
  watch.stage("read");

  const View view =
      camera ? make_camera(scene, o.view, middle_azimuth(samples), 1) : make_plan(scene, o.view);
  ExactStats visibility;
  const Receivers receivers = visible_surfaces(scene, view, o.common.threads, &visibility);
  const Casters casters = prepare_casters(scene);
  watch.stage("view");
  if (!o.common.quiet && o.common.verbose > 0) {
    fmt::print(stderr, "{} triangles, {} x {} samples, {} steps\n", scene.mesh.triangles.size(),
               view.width, view.height, samples.midpoints.size());
  }

  CountStats stats;
  Profile profile;
  {
    ProgressBar bar("computing shadows", o.common.quiet);
    profile =
        shadow_profile(casters, receivers, samples,
                       {o.common.threads, [&](double share) { bar.show(share); }, &stats, true});
  }
  watch.stage("profile");
  if (profile.daylight_ticks == 0) {
    throw Failure(
        fmt::format("the sun is below the horizon at every step of {}: there is nothing to compute",
                    window_text(o.time.times, samples, place)));
  }
  Warnings warnings = scene.warnings;
  if (casters.edges.vertices.empty())
    warn(warnings, "nothing casts a shadow: check --cast and --no-cast", "");
  append(warnings, samples.warnings);
  if (std::find(profile.valid.begin(), profile.valid.end(), 1) == profile.valid.end()) {
    warn(warnings,
         "the view meets no receiver: every sample is nodata; check --bounds, --eye and --receive",
         "");
  }

  const std::string software = std::string("gnomon ") + GNOMON_VERSION;
  const std::string title = o.title.empty() ? title_of(o.models) : o.title,
                    window = window_text(o.time.times, samples, place);
  const std::string steps =
      fmt::format("{} steps of {}", samples.midpoints.size(), o.time.times.every);
  Staging staging(o.output);
  take(write_profile_geotiff(staging.path("profile.tif"), profile, view, scene.frame,
                             {{"TIFFTAG_SOFTWARE", software},
                              {"TIFFTAG_IMAGEDESCRIPTION", title + ", " + window + ", " + steps}},
                             {.threads = o.common.threads}));
  watch.stage("profile.tif");

  PlanCaption plan_caption;
  plan_caption.title = title;
  plan_caption.lines = {window, steps};
  plan_caption.software = software;
  plan_caption.attribution = o.attribution;
  const char* map_name = camera ? "hours.png" : "plan.png";
  const PlanRelief relief = camera ? PlanRelief{} : plan_relief(scene, receivers, o.common.threads);
  take(write_plan_picture(staging.path(map_name), profile, view, scene.frame, plan_caption, relief,
                          o.common.threads));
  watch.stage(map_name);

  ViewSamples picture;
  {
    ProgressBar bar("drawing the view", o.common.quiet);
    ViewOptions as_camera = o.view;
    if (!camera) {
      as_camera = ViewOptions{};
      as_camera.bounds = o.view.bounds;
    }
    const View wide = make_camera(scene, as_camera, middle_azimuth(samples), kSupersample);
    const Receivers seen = visible_surfaces(scene, wide, o.common.threads);
    const std::vector<Light> lights = picture_lights(samples.instants);
    const std::vector<std::uint32_t> shaded = count_shaded(
        casters, seen, lights, {o.common.threads, [&](double share) { bar.show(share); }, nullptr});
    picture.width = wide.width;
    picture.height = wide.height;
    picture.downsample = kSupersample;
    picture.instants = static_cast<int>(lights.size());
    picture.shadows.assign(shaded.begin(), shaded.end());
    picture.valid.resize(shaded.size());
    std::transform(
        seen.triangle.begin(), seen.triangle.end(), picture.valid.begin(),
        [](std::uint32_t t) { return static_cast<std::uint8_t>(t != kNoTriangle ? 1 : 0); });
    picture.shading = view_shading(scene, seen, o.common.threads);
  }
  ViewCaption view_caption;
  view_caption.title = title;
  view_caption.lines = {window, fmt::format("{} shadows laid over each other", picture.instants)};
  view_caption.software = software;
  view_caption.attribution = o.attribution;
  take(write_view_picture(staging.path("view.png"), picture, view_caption, o.common.threads));
  watch.stage("view.png");

  const std::filesystem::path summary_path = staging.path("summary.json");
  timings.emplace_back("total", watch.total());
  const Summary summary{o.models,
                        o.time.times,
                        loaded,
                        samples,
                        view,
                        profile,
                        stats,
                        visibility,
                        timings,
                        staging.names(),
                        o.common.threads,
                        static_cast<std::size_t>(picture.instants)};
  take(write_text_file(summary_path, summary_json(summary, warnings)));
  staging.publish();
  remove_other_map(staging);

  if (o.common.quiet) return;
  print_warnings(warnings);
  const Box box = model_box(scene);
  for (const FileReport& f : loaded.files) {
    if (!f.axes.empty()) fmt::print("{}: {}\n", f.path, f.axes);
    if (loaded.files.size() > 1) fmt::print("{}: {}\n", f.path, f.placed);
  }
  fmt::print("model: {:.1f} m east-west, {:.1f} m north-south, {:.1f} m high\n",
             box.hi.x - box.lo.x, box.hi.y - box.lo.y, box.hi.z - box.lo.z);
  fmt::print("{}\n{}; {}; the sun was up for {:.2f} h of it\n", title, window, steps,
             daylight_hours(profile));
  fmt::print("{} x {} samples over {} triangles in {:.2f} s\n", view.width, view.height,
             scene.mesh.triangles.size(), watch.total() / 1000);
  for (const std::string& name : staging.names())
    fmt::print("  {}\n", (staging.output() / name).string());
}

}  // namespace

void add_profile(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("profile", "Hours in shadow on every spot: the shadow profile");
  add_model_options(*command, options->models);
  add_time_options(*command, options->time);
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
  add_common(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace gnomon::app
