// gnomon render: a picture by OpenGL, by any method of the papers.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <gnomon/gl/context.h>
#include <gnomon/gl/mask_bounds.h>
#include <gnomon/gl/renderer.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/io/png.h>
#include <gnomon/shadow/cast_shadows.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "model_options.h"
#include "render_options.h"
#include "view_options.h"

namespace gnomon::app {
namespace {

struct Options {
  Common common;
  ModelOptions models;
  RenderLights lights;
  ViewOptions view;
  gl::FrameOptions frame;
  std::string api = "gl";
  std::vector<std::string> lacking;
  std::vector<std::string> show;
  std::string observer, observer_target;
  std::string output = "gnomon.png";
  std::string summary;  // empty: none
  double near_plane = 0;
  bool check = false;
  bool samples_given = false;
};

Picture picture_of(const gl::Image& image) {
  return picture_of_rgba(image.width, image.height, image.rgba);
}

Picture picture_of(const ShadowMask& mask) {
  Picture out;
  out.width = mask.width;
  out.height = mask.height;
  out.pixels.reserve(mask.state.size());
  for (const std::uint8_t state : mask.state) {
    const std::uint8_t grey = state == ShadowMask::kLit      ? 255
                              : state == ShadowMask::kShadow ? 0
                                                             : 128;
    out.pixels.push_back({grey, grey, grey});
  }
  return out;
}

// Options that would have no effect.
void check_options(const Options& o) {
  const auto shows = [&](const char* what) {
    return std::find(o.show.begin(), o.show.end(), what) != o.show.end();
  };
  if (shows("mask") && (o.show.size() > 1 || !o.observer.empty())) {
    throw Failure(
        "--show mask is the first light's mask alone: leave out what else is to be shown, and "
        "--observer");
  }
  if (shows("clip-space") && !o.observer.empty())
    throw Failure("--show clip-space has an observer of its own: leave out --observer");
  if (shows("clip-space") && o.frame.method.count != gl::Count::automatic &&
      o.frame.method.count != gl::Count::near_cap) {
    throw Failure(
        "--show clip-space counts from the near plane: leave out --count, or take near-cap");
  }
  if (shows("clipped") && o.observer.empty())
    throw Failure("--show clipped is what an observer sees: add --observer X,Y,Z");
  if (!o.observer_target.empty() && o.observer.empty())
    throw Failure("--observer-target is where an observer looks: add --observer X,Y,Z");
  if (std::filesystem::path(o.output).extension() != ".png")
    throw Failure(
        fmt::format("pictures are written as PNG: let the file '{}' end in .png", o.output));
}

// What makes a picture all dark, or empty. `light`: the first one, of which the mask is.
void warn_of_nothing(Warnings& to, const gl::FrameStats& stats, const ShadowMask& mask,
                     const Scene& scene, const gl::LightSource& light) {
  constexpr std::ptrdiff_t kHardlyAny = 1000;  // of so many samples one: rounding lets some through
  constexpr double kFarAway = 100;             // of the model's diagonal
  const auto count = [&](std::uint8_t state) {
    return std::count(mask.state.begin(), mask.state.end(), state);
  };
  const auto lit = count(ShadowMask::kLit), shaded = count(ShadowMask::kShadow);
  Vec3 lo = scene.mesh.positions.front(), hi = lo;
  for (const Vec3& p : scene.mesh.positions) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  const bool lamp = light.light.w != 0;
  const Vec3 at = lamp ? Vec3(light.light) / light.light.w : Vec3(light.light);
  const double away = lamp ? glm::distance(at, glm::clamp(at, lo, hi)) : 0;
  if (lit + shaded == 0) {
    warn(to, "nothing of the model is in the picture; see --eye, --target and --near", "");
  } else if (light.radius > 0 && away > light.radius) {
    warn(to,
         fmt::format("the first light ends {:.4g} m from it (radius=), and the model begins {:.4g} "
                     "m away",
                     light.radius, away),
         "");
  } else if (away > kFarAway * glm::distance(lo, hi)) {
    warn(to,
         fmt::format("the first light lies {:.0f} km from the model: --light takes the model's own "
                     "coordinates",
                     away / 1000),
         "");
  } else if (lit * kHardlyAny < lit + shaded) {
    warn(to,
         lamp ? "the first light reaches nothing in the picture: is it inside a body or below the "
                "ground?"
              : "the sun reaches nothing in the picture: is the eye inside a body or below "
                "the ground?",
         "");
  }
  if (stats.moved_lights > 0) {
    warn(to,
         "a lamp touches the model; it was moved beside it by about 1/8000 of the largest "
         "coordinate",
         "");
  }
}

std::string counted(long long n, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

std::string volumes_of(const gl::FrameStats& s) {
  std::string text =
      fmt::format("{} counted z-pass, {} z-fail", s.z_pass_volumes, s.z_fail_volumes);
  if (s.polygon_volumes > 0) text += fmt::format("; {} of a single polygon", s.polygon_volumes);
  if (s.scissored_volumes > 0)
    text += fmt::format("; {} cut to where they can shade", s.scissored_volumes);
  if (s.culled_volumes > 0)
    text += fmt::format("; {} left out, they shade nothing seen", s.culled_volumes);
  return text;
}

// What --summary writes: how the picture was drawn, with the counters of the cache of volumes.
std::string summary_of(const Options& o, const gl::FrameStats& s, const Scene& scene,
                       std::size_t lights, double ms) {
  nlohmann::ordered_json json;
  json["program"] = "gnomon";
  json["version"] = GNOMON_VERSION;
  json["picture"] = o.output;
  json["triangles"] = scene.mesh.triangles.size();
  json["lights"] = lights;
  json["method"] = gl::describe(s.method);
  json["silhouettes_by"] = gl::name_of(s.method.silhouettes);
  json["volumes"] = {{"z_pass", s.z_pass_volumes},       {"z_fail", s.z_fail_volumes},
                     {"of_polygons", s.polygon_volumes}, {"triangles", s.volume_triangles},
                     {"scissored", s.scissored_volumes}, {"culled", s.culled_volumes}};
  json["volume_cache"] = {{"casters_made_anew", s.rebuilt},
                          {"casters_kept", s.kept},
                          {"silhouettes_by_tree", s.by_tree}};
  json["passes"] = s.passes;
  json["timings_ms"] = {{"volumes", s.volumes_ms}, {"first_frame", ms}};
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string drawing_of(const gl::FrameStats& s) {
  std::string text = counted(s.passes, "pass of the scene", "passes of the scene");
  if (s.rectangles > 0)
    text += ", " + counted(s.rectangles, "rectangle", "rectangles") + " to make the mask";
  if (s.method.samples > 1)
    text += fmt::format(", {} samples a pixel asked for (OpenGL may take more)", s.method.samples);
  return text;
}

void run(const Options& o) {
  check_options(o);
  gl::HeadlessContext context =
      take(gl::HeadlessContext::create(o.api == "gles" ? gl::Api::opengl_es : gl::Api::opengl));
  gl::Capabilities capabilities = take(gl::find_capabilities());
  for (const std::string& name : o.lacking) capabilities = take(gl::without(capabilities, name));
  if (o.common.verbose > 0) fmt::print("{}\n", gl::describe(capabilities));

  ModelOptions models = o.models;
  models.load.appearance = true;
  const LoadedScene loaded = read_models(models, o.common.quiet);
  const Scene& scene = loaded.scene;
  const ChosenLights lights = choose_lights(o.lights, scene);
  const View view = make_camera(scene, o.view, light_azimuth(scene, lights.first.light), 1);
  const bool infinite = !is_parallel(view) && o.frame.method.far_plane != gl::FarPlane::clamp;
  gl::DepthRange range = gl::depth_range(scene, view, infinite);
  if (o.near_plane > 0) range.near_plane = o.near_plane;
  if (!(range.near_plane < range.far_plane)) {
    throw Failure(fmt::format("--near {:g} lies beyond all that is seen (up to {:.4g} m away)",
                              o.near_plane, range.far_plane));
  }
  const gl::Camera first = gl::camera_of(view, range);

  gl::Renderer renderer = take(gl::Renderer::create(capabilities));
  renderer.add_scene(scene);
  gl::FrameStats stats;
  const auto begin = std::chrono::steady_clock::now();
  Picture picture;
  gl::FrameOptions options = o.frame;
  // Masks in the stencil are as fine as the picture's samples; others would need floats, or one
  // sample a pixel.
  constexpr int kSamples = 4;
  if (!o.samples_given && options.method.mask == gl::MaskIn::stencil &&
      options.method.mask_scale == 1 && capabilities.max_samples >= kSamples) {
    options.method.samples = kSamples;
  }
  const auto shows = [&](const char* what) {
    return std::find(o.show.begin(), o.show.end(), what) != o.show.end();
  };
  options.overlay.volumes = shows("volumes");
  options.overlay.silhouettes = shows("silhouettes");
  options.overlay.edges = shows("wireframe");
  options.overlay.lights = shows("lights");
  options.overlay.counts = shows("counts");
  gl::Camera camera = first;
  if (!o.observer.empty()) {
    ViewOptions second = o.view;
    second.eye = o.observer;
    second.target = o.observer_target;
    second.ortho_height = 0;
    const View from = make_camera(scene, second, 0, 1);
    camera = gl::camera_of(from, gl::depth_range(scene, from, infinite));
    options.overlay.frustum = first;
    if (shows("clipped")) camera.keep_inside = first.clip;
  } else if (shows("clip-space")) {
    // From the left, above and behind the eye's side of the cube.
    const View from =
        perspective_view({-2.2, 1.7, 4.4}, {0, -0.1, 0}, {0, 1, 0}, 0.62, view.width, view.height);
    camera = gl::clip_space_camera(first, from, {0.5});
    options.overlay.frustum = first;
    options.method.count = gl::Count::near_cap;
    options.method.reach = gl::Reach::infinite;
  }
  if (shows("mask")) {
    picture =
        picture_of(take(renderer.mask(first, lights.lights.front().light, o.frame.method, &stats)));
  } else {
    picture = picture_of(take(renderer.render(camera, lights.lights, options, &stats)));
  }
  const double ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  take(write_png(o.output, picture, o.common.threads));
  if (!o.summary.empty()) {
    take(write_text_file(o.summary, summary_of(o, stats, scene, lights.lights.size(), ms)));
  }

  Warnings warnings = scene.warnings;
  append(warnings, lights.warnings);
  const Light& light = lights.lights.front().light;
  if (!o.common.quiet) {
    const Result<ShadowMask> mask = renderer.mask(first, light, {});
    if (mask) warn_of_nothing(warnings, stats, mask.value(), scene, lights.lights.front());
  }
  if (o.check) {
    gl::FrameStats checked;
    const ShadowMask ours = take(renderer.mask(first, light, o.frame.method, &checked));
    const ShadowMask exact = cast_shadows(scene, light, view);
    const bool cut = o.near_plane > 0;
    std::size_t differ = 0, not_seen = 0;
    for (std::size_t k = 0; k < exact.state.size(); ++k) {
      if (ours.state[k] == exact.state[k]) continue;
      const bool one_only =
          ours.state[k] == ShadowMask::kNoSample || exact.state[k] == ShadowMask::kNoSample;
      ++(cut && one_only ? not_seen : differ);
    }
    fmt::print(
        "{} of {} pixels differ from the exact mask ({:.4f} %; by this method {:g} % may: "
        "gnomon methods)\n",
        differ, exact.state.size(), 100.0 * double(differ) / double(exact.state.size()),
        100 * gl::bound_of(checked.method).share);
    if (cut) {
      fmt::print(
          "  {} more have a sample in one of the two only: --near cuts the picture, the exact "
          "mask is of the whole model\n",
          not_seen);
    }
  }
  if (o.common.quiet) return;
  print_warnings(warnings);
  fmt::print("{}, {} x {} pixels, {} triangles, {}\n", title_of(o.models), view.width, view.height,
             scene.mesh.triangles.size(), lights.first.words);
  fmt::print("{}\n", gl::describe(stats.method));
  fmt::print("shadow volumes: {}; made in {:.3g} ms\n", volumes_of(stats), stats.volumes_ms);
  fmt::print("drawing: {}, first frame {:.0f} ms\n", drawing_of(stats), ms);
  fmt::print("  {}\n", o.output);
  if (!o.summary.empty()) fmt::print("  {}\n", o.summary);
}

}  // namespace

void add_render(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  Options& o = *options;
  o.view.size = "1280x800";
  CLI::App* command =
      app.add_subcommand("render", "A picture by OpenGL, by any shadow method of the papers");
  add_model_options(*command, o.models);
  add_render_lights(*command, o.lights);
  add_camera_options(*command, o.view);
  add_method_options(*command, o.frame.method);
  command->add_option("--near", o.near_plane, "Near plane in metres (default: chosen)")
      ->check(positive_number())
      ->group("View");
  command->add_option("--api", o.api, "gl (OpenGL 3.3) or gles (OpenGL ES 3.0)")
      ->check(CLI::IsMember({"gl", "gles"}))
      ->capture_default_str()
      ->group("OpenGL");
  command
      ->add_option(
          "--without", o.lacking,
          "Do as if OpenGL lacked it: depth-clamp, depth-bounds, float-blend, float-colour, "
          "multisampling")
      ->group("OpenGL");
  command->add_flag("--check", o.check, "Compare the mask of the first light with the exact one")
      ->group("Output");
  const std::vector<std::string> shows = {"picture",     "mask",       "volumes",
                                          "silhouettes", "counts",     "lights",
                                          "wireframe",   "clip-space", "clipped"};
  command
      ->add_option(
          "--show", o.show,
          "What to draw, separated by commas: picture; over it volumes (yellow), silhouettes "
          "(pink), lights (yellow points), wireframe (lines for surfaces), counts (of the "
          "first light: how many volumes hold a sample, blue to red), clip-space (the scene "
          "in the camera's clip space), clipped (with --observer: nothing outside the "
          "camera's frustum); or mask alone (of the first light: white where lit, black in "
          "shadow, grey where nothing is)")
      ->delimiter(',')
      ->check(CLI::IsMember(shows))
      ->group("Output");
  command
      ->add_option("--observer", o.observer,
                   "X,Y,Z: a second camera there shows the scene and the first one's frustum")
      ->group("View");
  command->add_option("--observer-target", o.observer_target, "X,Y,Z that it looks at")
      ->group("View");
  command->add_option("-o,--output", o.output, "The PNG file")
      ->capture_default_str()
      ->group("Output");
  command
      ->add_option(
          "--summary", o.summary,
          "A JSON file of how it was drawn: method, volumes, which of them were kept, times")
      ->group("Output");
  add_common(*command, o.common);
  CLI::Option* samples = command->get_option("--samples");
  samples->default_str("4 where the method can");
  command->callback([options, samples] {
    options->samples_given = samples->count() > 0;
    run(*options);
  });
}

}  // namespace gnomon::app
