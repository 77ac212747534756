// gnomon shadow: the shadow of one instant, or of one light.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/io/mask_picture.h>
#include <gnomon/io/outlines.h>
#include <gnomon/io/view_picture.h>
#include <gnomon/io/write_mask.h>
#include <gnomon/shadow/cast_shadows.h>
#include <gnomon/sun/time_zone.h>
#include <glm/geometric.hpp>

#include "commands.h"
#include "light_options.h"
#include "model_options.h"
#include "place_text.h"
#include "progress.h"
#include "shadow_reach.h"
#include "staging.h"
#include "summary_parts.h"
#include "view_options.h"

namespace gnomon::app {
namespace {

// The camera's picture is drawn at this many samples per pixel along each side, for smooth edges.
constexpr int kSupersample = 2;

struct Options {
  Common common;
  ModelOptions models;
  LightOptions light;
  ViewOptions view;
  std::string output = "gnomon-shadow";
  std::string title, attribution;
};

struct Counts {
  std::size_t lit = 0, shadow = 0, nodata = 0;
};

Counts count(const ShadowMask& mask) {
  Counts out;
  for (const std::uint8_t state : mask.state) {
    if (state == ShadowMask::kLit) ++out.lit;
    if (state == ShadowMask::kShadow) ++out.shadow;
    if (state == ShadowMask::kNoSample) ++out.nodata;
  }
  return out;
}

std::string counted(std::size_t n, const char* what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

double degrees(double radians) { return std::round(radians / kDegree * 1e9) / 1e9; }

// "sun 213.1234 degrees from north, 38.5678 degrees high"
std::string sun_text(const ChosenLight& light) {
  return fmt::format("sun {:.2f}\u00b0 from north, {:.2f}\u00b0 high", light.azimuth / kDegree,
                     light.altitude / kDegree);
}

Json light_json(const ChosenLight& light, const Vec3& origin) {
  const Light& l = light.light;
  Json out;
  if (light.kind == LightKind::point) {
    out = {{"kind", "point"}, {"position", {l.x + origin.x, l.y + origin.y, l.z + origin.z}}};
  } else {
    out = {{"kind", light.kind == LightKind::instant ? "instant" : "sun"},
           {"utc", light.kind == LightKind::instant ? Json(iso_text(light.utc)) : Json()},
           {"azimuth_deg", degrees(light.azimuth)},
           {"altitude_deg", degrees(light.altitude)}};
    if (light.kind == LightKind::instant) {
      out["altitude_geometric_deg"] = degrees(light.altitude_geometric);
    }
    out["direction"] = {l.x, l.y, l.z};
  }
  out["homogeneous"] = {l.x, l.y, l.z, l.w};
  return out;
}

std::vector<OutlineProperty> outline_properties(const ChosenLight& light, const Vec3& origin) {
  if (light.kind == LightKind::point) {
    return {{"light_x", light.light.x + origin.x},
            {"light_y", light.light.y + origin.y},
            {"light_z", light.light.z + origin.z}};
  }
  return {{"instant", light.kind == LightKind::instant ? iso_text(light.utc) : std::string()},
          {"sun_azimuth_deg", degrees(light.azimuth)},
          {"sun_altitude_deg", degrees(light.altitude)}};
}

// What the camera sees, at kSupersample times the picture's size.
void write_camera_picture(const std::filesystem::path& path, const Options& o, const Scene& scene,
                          const Casters& casters, const ChosenLight& light, double azimuth,
                          const std::string& title) {
  const View fine = make_camera(scene, o.view, azimuth, kSupersample);
  const Receivers seen = visible_surfaces(scene, fine, o.common.threads);
  const ShadowMask mask = cast_shadows(casters, seen, light.light, {.threads = o.common.threads});
  ViewSamples picture;
  picture.width = fine.width;
  picture.height = fine.height;
  picture.downsample = kSupersample;
  picture.instants = 1;
  picture.shadows.resize(mask.state.size());
  picture.valid.resize(mask.state.size());
  for (std::size_t k = 0; k < mask.state.size(); ++k) {
    picture.valid[k] = mask.state[k] != ShadowMask::kNoSample;
    picture.shadows[k] = mask.state[k] == ShadowMask::kShadow ? 1 : 0;
  }
  picture.shading = view_shading(scene, seen, o.common.threads);
  ViewCaption caption;
  caption.title = title;
  caption.lines = {light.words};
  if (light.kind != LightKind::point) caption.lines.push_back(sun_text(light));
  caption.software = std::string("gnomon ") + GNOMON_VERSION;
  caption.attribution = o.attribution;
  take(write_view_picture(path, picture, caption, o.common.threads));
}

// The outlines of an earlier plan would belong to another shadow.
void remove_old_outlines(Staging& staging) {
  for (const char* name : {"outlines.geojson", "outlines.gpkg"}) {
    const auto& names = staging.names();
    if (std::find(names.begin(), names.end(), name) == names.end()) staging.obsolete(name);
  }
}

void run(const Options& o) {
  const auto begin = std::chrono::steady_clock::now();
  check_light_options(o.light);
  const bool camera = wants_camera(o.view);
  const LoadedScene loaded = read_models(o.models, o.common.quiet, parse_bounds(o.view.bounds));
  const Scene& scene = loaded.scene;
  const ChosenLight light = choose_light(o.light, scene);
  const double azimuth = light_azimuth(scene, light.light);
  const View view = camera
                        ? make_camera(scene, o.view, azimuth, 1)
                        : make_plan(scene, o.view,
                                    light.kind == LightKind::instant ? shadow_reach({light.light})
                                                                     : std::nullopt);

  const Receivers receivers = visible_surfaces(scene, view, o.common.threads);
  const Casters casters = prepare_casters(scene);
  ShadowMask mask;
  {
    ProgressBar bar("computing the shadow", o.common.quiet);
    mask = cast_shadows(casters, receivers, light.light,
                        {o.common.threads, [&](double share) { bar.show(share); }, nullptr});
  }
  const Counts counts = count(mask);
  const bool at_border = !camera && shadow_at_border(scene, receivers, [&](std::size_t k) {
    return mask.state[k] == ShadowMask::kShadow;
  });
  const double pixel = camera ? 0.0 : view.right.x;
  const double pixel_area = pixel * pixel;

  Warnings warnings = scene.warnings;
  append(warnings, light.warnings);
  if (light.kind == LightKind::instant) check_place(warnings, *scene.frame.place, o.light.zone);
  if (casters.edges.vertices.empty())
    warn(warnings, "nothing casts a shadow: check --cast and --no-cast", "");
  if (counts.lit + counts.shadow == 0) {
    warn(warnings,
         "the view meets no receiver: every sample is nodata; check --bounds, --eye and --receive",
         "");
  }

  const std::string software = std::string("gnomon ") + GNOMON_VERSION;
  const std::string title = o.title.empty() ? title_of(o.models) : o.title;
  Staging staging(o.output);
  if (camera) {
    write_camera_picture(staging.path("mask.png"), o, scene, casters, light, azimuth, title);
  } else {
    PlanCaption caption;
    caption.title = title;
    caption.lines = {light.words};
    if (light.kind != LightKind::point) caption.lines.push_back(sun_text(light));
    caption.software = software;
    if (light.kind != LightKind::instant) caption.sun.clear();
    caption.attribution = o.attribution;
    caption.without_sample = without_sample(scene);
    take(write_mask_picture(staging.path("mask.png"), mask, view, scene.frame, caption,
                            plan_relief(scene, receivers, o.common.threads), o.common.threads));
  }
  take(write_mask_geotiff(
      staging.path("mask.tif"), mask, view, scene.frame,
      {{"TIFFTAG_SOFTWARE", software}, {"TIFFTAG_IMAGEDESCRIPTION", title + ", " + light.words}},
      o.common.threads));
  std::size_t outlines = 0;
  if (!camera) {
    const std::vector<Outline> shapes = take(shadow_outlines(mask, view, scene.frame));
    const auto properties = outline_properties(light, scene.frame.origin);
    outlines = shapes.size();
    take(write_outlines(staging.path("outlines.geojson"), OutlineFormat::geojson, shapes,
                        pixel_area, view, scene.frame, properties));
    take(write_outlines(staging.path("outlines.gpkg"), OutlineFormat::geopackage, shapes,
                        pixel_area, view, scene.frame, properties));
  }

  const std::filesystem::path summary_path = staging.path("summary.json");
  const double total =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  Json json;
  json["program"] = "gnomon";
  json["version"] = GNOMON_VERSION;
  json["command"] = "shadow";
  json["conventions"] =
      "azimuth_deg: from true north, clockwise; altitude_deg: of the sun's centre with refraction "
      "(the one shadows use); direction: [x east, y north, z up in the model's CRS, towards the "
      "sun]; position: in the model's CRS; homogeneous: scene coordinates (CRS minus origin)";
  json["inputs"] = model_inputs_json(o.models);
  json["inputs"]["date"] = text_or_null(o.light.date);
  json["inputs"]["at"] = text_or_null(o.light.at);
  json["inputs"]["tz"] = text_or_null(o.light.zone);
  json["inputs"]["light"] = text_or_null(o.light.light);
  json["inputs"]["threads"] = o.common.threads == 0 ? Json() : Json(o.common.threads);
  json["scene"] = scene_json(loaded);
  json["view"] = view_json(view, scene.frame.origin);
  json["light"] = light_json(light, scene.frame.origin);
  json["result"] = {{"samples", counts.lit + counts.shadow},
                    {"lit", counts.lit},
                    {"shadow", counts.shadow},
                    {"nodata", counts.nodata}};
  if (!camera) {
    json["result"]["lit_m2"] = static_cast<double>(counts.lit) * pixel_area;
    json["result"]["shadow_m2"] = static_cast<double>(counts.shadow) * pixel_area;
    json["result"]["outlines"] = outlines;
    json["result"]["shadows_reach_border"] = at_border;
  }
  json["timings"] = {{"total", std::round(total * 1000) / 1000}};
  json["warnings"] = warnings_json(warnings);
  json["outputs"] = staging.names();
  // File names need not be UTF-8; JSON must be.
  take(write_text_file(summary_path,
                       json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"));
  remove_old_outlines(staging);
  staging.publish();

  if (o.common.quiet) return;
  print_warnings(warnings);
  if (const std::string place = place_line(loaded); !place.empty()) fmt::print("{}\n", place);
  fmt::print("{}\n{}", title, light.words);
  if (light.kind != LightKind::point) fmt::print("; {}", sun_text(light));
  const double samples = static_cast<double>(std::max<std::size_t>(1, counts.lit + counts.shadow));
  fmt::print("\n{} of {} samples in shadow ({:.1f} %)", counts.shadow, counts.lit + counts.shadow,
             100 * static_cast<double>(counts.shadow) / samples);
  if (!camera) {
    fmt::print(": {:.10g} m\u00b2 in {}, seen from above",
               static_cast<double>(counts.shadow) * pixel_area, counted(outlines, "outline"));
    if (at_border) fmt::print("\n{}", kShadowAtBorder);
  }
  fmt::print("\n{} x {} samples over {} triangles in {:.2f} s\n", view.width, view.height,
             scene.mesh.triangles.size(), total / 1000);
  for (const std::string& name : staging.names())
    fmt::print("  {}\n", (staging.output() / name).string());
}

}  // namespace

void add_shadow(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("shadow", "The shadow of one instant, or of one light");
  add_model_options(*command, options->models);
  add_light_options(*command, options->light);
  add_view_options(*command, options->view);
  command->add_option("-o,--output", options->output, "Folder for the results")
      ->capture_default_str()
      ->group("Output");
  command
      ->add_option("--title", options->title, "Title of the picture (default: names of the models)")
      ->group("Output");
  command
      ->add_option("--attribution", options->attribution,
                   "Whom the picture names as the model's source")
      ->group("Output");
  add_common(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace gnomon::app
