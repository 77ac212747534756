// gnomon verify-gl: masks of the renderer, by every method that goes together, against each other
// and against the exact mask.
#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <tuple>

#include <fmt/format.h>
#include <gnomon/gl/context.h>
#include <gnomon/gl/mask_bounds.h>
#include <gnomon/gl/method_pairs.h>
#include <gnomon/gl/renderer.h>
#include <gnomon/shadow/compare_masks.h>
#include <gnomon/trace/verification_cases.h>

#include "commands.h"
#include "model_options.h"
#include "verify_lights.h"

namespace gnomon::app {
namespace {

struct Options {
  Common common;
  ModelOptions model;
  int suns = 4, points = 3, size = 256;
  std::vector<std::string> lights;
  std::vector<std::string> views = {"plan", "camera", "shadow"};
  std::string api = "gl";
  std::vector<std::string> lacking;
  bool all = false;
  std::string only;
  int polygons = 5000;
  int most = 0;  // combinations a picture; 0: as many as it takes
};

// Sums over all pictures of the methods that share a bound.
struct Row {
  gl::MaskBound bound;
  int pictures = 0, broken = 0;
  MaskDifference difference;
  double most = 0;             // share of a picture that differs
  std::uint64_t on_edges = 0;  // of pictures of which more differ than the share
  std::uint64_t other_than_stencil = 0;
};

struct Totals {
  std::map<std::string, Row> rows;
  std::map<std::string, int> refused;  // by reason
  int combinations = 0;
  std::vector<std::string> broken;  // descriptions
};

struct Stage {
  const Options& o;
  const Scene& scene;
  gl::Renderer& renderer;
};

// Both far planes: at infinity where the view can have it there, and clamped.
struct Cameras {
  std::optional<gl::Camera> infinite;
  gl::Camera clamped;
  const gl::Camera& of(const gl::Method& m) const {
    return m.far_plane == gl::FarPlane::clamp || !infinite ? clamped : *infinite;
  }
};

std::string words_of(const gl::Method& m) {
  return gl::describe(m) + (m.mask_scale < 1 ? fmt::format(", mask scale {}", m.mask_scale) : "");
}

// One picture's answer, into its row.
void note(Totals& totals, const std::string& where, const gl::Method& m, const ExactAnswers& exact,
          const ShadowMask& drawn, const MaskDifference& d, std::uint64_t other) {
  const gl::MaskBound bound = gl::bound_of(m);
  Row& row = totals.rows[std::string(bound.of)];
  row.bound = bound;
  ++row.pictures;
  row.difference += d;
  row.other_than_stencil += other;
  const double samples = double(d.samples), share = double(d.differ) / samples;
  row.most = std::max(row.most, share);
  std::uint64_t on_edges = 0;
  bool too_many = share > bound.share;
  if (too_many && bound.near_edges > 0) {
    too_many = double(d.differ) > bound.near_edges * double(samples_near_edges(exact, bound.edge));
  } else if (too_many) {
    on_edges = differing_on_edges(exact, drawn);
    too_many = double(d.differ - on_edges) / samples > bound.share;
  }
  row.on_edges += on_edges;
  const bool broken =
      too_many || (d.unexplained > 0 && !bound.unexplained) || (other > 0 && bound.same_as_stencil);
  if (!broken) return;
  ++row.broken;
  std::string text = fmt::format(
      "{}: {}: {} of {} differ, {} at an edge, {} on it, {} in depth, {} unexplained; {} other "
      "than the stencil",
      where, words_of(m), d.differ, d.samples, d.at_edge, on_edges, d.in_depth, d.unexplained,
      other);
  for (const MaskDifference::Unexplained& u : d.first_unexplained) {
    text += fmt::format("; pixel {} of triangle {}, exact count {}", u.pixel, u.triangle, u.count);
    text += u.times > 0 ? fmt::format(", {} times the rounding", u.times) : ", no rounding";
  }
  totals.broken.push_back(text);
}

void verify_light(const Stage& stage, const std::string& where, const Cameras& cameras,
                  const ExactAnswers& exact, Totals& totals) {
  gl::Situation known;
  const View& view = exact.view->samples.view;
  known.parallel_view = is_parallel(view);
  known.directional_light = exact.light.w == 0;
  known.infinite_view = cameras.infinite.has_value();
  // One mask of the stencil for each geometry, which the others must equal: camera, reach, and how
  // sides are sent (strips split them along the other diagonal).
  using Geometry = std::tuple<const gl::Camera*, gl::Reach, gl::Primitives>;
  std::map<Geometry, std::pair<ShadowMask, MaskDifference>> stencil;
  gl::MethodPairs pairs(known, stage.renderer.capabilities(), stage.o.all);
  const auto compare = [&](const gl::Method& m, const ShadowMask& mask) {
    const gl::MaskBound b = gl::bound_of(m);
    return compare_masks(exact, mask, {cameras.of(m).clip}, {b.edge, b.steps, b.pixels});
  };
  for (int drawn_here = 0; stage.o.most == 0 || drawn_here < stage.o.most;) {
    const std::optional<gl::Method> next = pairs.next();
    if (!next) break;
    const gl::Method& m = *next;
    if (words_of(m).find(stage.o.only) == std::string::npos) {
      pairs.skipped();
      continue;
    }
    if (m.volumes == gl::VolumesOf::polygon && m.mask != gl::MaskIn::stencil &&
        int(stage.scene.mesh.triangles.size()) > stage.o.polygons) {
      pairs.skipped();
      continue;
    }
    const gl::Camera& camera = cameras.of(m);
    const auto begin = std::chrono::steady_clock::now();
    const Result<ShadowMask> drawn = stage.renderer.mask(camera, exact.light, m);
    if (stage.o.common.verbose > 1) {
      fmt::print(stderr, "  {:6.0f} ms {}{}\n",
                 std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
                     .count(),
                 words_of(m), drawn ? "" : ": " + drawn.error().message);
    }
    if (!drawn) {
      if (!pairs.refused(drawn.error().message)) ++totals.refused[drawn.error().message];
      continue;
    }
    pairs.drawn();
    ++drawn_here;
    ++totals.combinations;
    const Geometry same{&camera, m.reach, m.primitives};
    if (!stencil.contains(same) && !gl::bound_of(m).same_as_stencil) {
      note(totals, where, m, exact, drawn.value(), compare(m, drawn.value()), 0);
      continue;
    }
    if (!stencil.contains(same)) {
      gl::Method base;
      base.far_plane = m.far_plane;
      base.reach = m.reach;
      base.primitives = m.primitives;
      const Result<ShadowMask> usual = stage.renderer.mask(camera, exact.light, base);
      if (!usual) ++totals.refused[usual.error().message];
      // Where the usual way is refused, the first that is not stands for it.
      const ShadowMask& first = usual ? usual.value() : drawn.value();
      const MaskDifference d = compare(base, first);
      if (usual) note(totals, where, base, exact, first, d, 0);
      stencil[same] = {first, d};
    }
    const auto& [mask, difference] = stencil[same];
    const std::uint64_t other = differing_pixels(exact, drawn.value(), mask);
    const bool equal = other == 0 && gl::bound_of(m).same_as_stencil;
    note(totals, where, m, exact, drawn.value(), equal ? difference : compare(m, drawn.value()),
         other);
  }
}

std::vector<NamedView> views_of(const Options& o, const Oracle& oracle,
                                const std::vector<NamedLight>& lights) {
  std::vector<NamedView> views;
  for (const std::string& name : o.views) {
    if (name == "plan") views.push_back(whole_plan(*oracle.scene, o.size));
    if (name == "camera") views.push_back(aerial_camera(*oracle.scene, o.size));
    if (name != "shadow") continue;
    for (const NamedLight& light : lights) {
      const std::optional<NamedView> view = shaded_camera(oracle, light.light, o.size);
      if (!view) continue;
      views.push_back(*view);
      break;
    }
  }
  return views;
}

void print_table(const std::string& model, std::size_t triangles, const Totals& totals) {
  fmt::print(
      "| model | triangles | methods | pictures | samples | differ | most in a picture | at an "
      "edge "
      "| on it | in depth | unexplained | other than the stencil | edge-on | of these differ | "
      "bounds "
      "broken "
      "|\n|---|--:|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const auto& [name, row] : totals.rows) {
    const MaskDifference& d = row.difference;
    fmt::print(
        "| {} | {} | {} | {} | {} | {} | {:.3f} % | {} | {} | {} | {} | {} | {} | {} | {} |\n",
        model, triangles, name, row.pictures, d.samples, d.differ, 100 * row.most, d.at_edge,
        row.on_edges, d.in_depth, d.unexplained, row.other_than_stencil, d.edge_on,
        d.edge_on_differ, row.broken);
  }
}

void run(const Options& o) {
  gl::HeadlessContext context =
      take(gl::HeadlessContext::create(o.api == "gles" ? gl::Api::opengl_es : gl::Api::opengl));
  gl::Capabilities capabilities = take(gl::find_capabilities());
  for (const std::string& name : o.lacking) capabilities = take(gl::without(capabilities, name));
  const LoadedScene loaded = read_models(o.model, o.common.quiet);
  const Scene& scene = loaded.scene;
  if (!o.common.quiet) print_warnings(scene.warnings);
  const Oracle oracle = build_oracle(scene);
  const Casters casters = prepare_casters(scene);
  std::vector<NamedLight> lights;
  if (o.lights.empty()) {
    lights = choose_suns(scene, o.suns);
    for (const NamedLight& point : choose_points(oracle, o.points)) lights.push_back(point);
  }
  for (const std::string& text : o.lights) lights.push_back(parse_light(text));
  if (lights.empty()) throw Failure("no lights: give --suns, --points or --light");

  gl::Renderer renderer = take(gl::Renderer::create(capabilities));
  renderer.add_scene(scene);
  const Stage stage{o, scene, renderer};
  Totals totals;
  for (const NamedView& view : views_of(o, oracle, lights)) {
    const ExactView exact = exact_view(scene, casters, view.view, o.common.threads);
    Cameras cameras;
    cameras.clamped = gl::camera_of(view.view, gl::depth_range(scene, view.view, false));
    if (!is_parallel(view.view))
      cameras.infinite = gl::camera_of(view.view, gl::depth_range(scene, view.view, true));
    for (const NamedLight& light : lights) {
      if (o.common.verbose > 0) fmt::print(stderr, "{}, {}\n", view.name, light.name);
      verify_light(stage, view.name + ", " + light.name, cameras,
                   exact_answers(exact, light.light, o.common.threads), totals);
    }
  }
  const std::string model = title_of(o.model);
  if (!o.common.quiet) {
    fmt::print("OpenGL: {}\n", gl::describe(capabilities));
    print_table(model, scene.mesh.triangles.size(), totals);
    for (const auto& [reason, n] : totals.refused)
      fmt::print("\nRefused {} times: {}\n", n, reason);
  }
  constexpr std::size_t kDescribed = 20;  // pictures that break a bound
  for (std::size_t k = 0; k < std::min(kDescribed, totals.broken.size()); ++k)
    fmt::print(stderr, "gnomon: {}\n", totals.broken[k]);
  if (!totals.broken.empty()) {
    throw Failure(fmt::format("{} of {} masks of {} break their bounds", totals.broken.size(),
                              totals.combinations, model));
  }
}

}  // namespace

void add_verify_gl(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  Options& o = *options;
  CLI::App* command = app.add_subcommand(
      "verify-gl", "Compare OpenGL's masks, by all methods, with each other and the exact mask");
  add_model_options(*command, o.model);
  command->add_option("--suns", o.suns, "Number of suns, chosen automatically")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_option("--points", o.points, "Number of point lights, chosen automatically")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_option("--light", o.lights,
                      "Instead of these: X,Y,Z[,sun|point], towards a sun or the place of a lamp, "
                      "in scene coordinates");
  command->add_option("--size", o.size, "Samples per side of each view")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command
      ->add_option("--views", o.views,
                   "Any of plan, camera (outside), shadow (a camera inside a shadow)")
      ->delimiter(',')
      ->check(CLI::IsMember({"plan", "camera", "shadow"}));
  command->add_flag("--all", o.all,
                    "Every combination of choices that is supported (default: so many that every "
                    "two choices come together in one)");
  command->add_option("--only", o.only,
                      "Only methods whose words have these among them, such as \"alpha, zfail\"");
  command
      ->add_option("--polygons", o.polygons,
                   "Models of more triangles are not drawn polygon by polygon in alpha and screen")
      ->capture_default_str();
  command
      ->add_option("--most", o.most,
                   "At most so many combinations a view and light, those first that have the most "
                   "new pairs of choices (0: all that it takes)")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  command->add_option("--api", o.api, "gl (OpenGL 3.3) or gles (OpenGL ES 3.0)")
      ->check(CLI::IsMember({"gl", "gles"}))
      ->capture_default_str();
  command->add_option("--without", o.lacking, "Do as if OpenGL lacked it (see gnomon render)");
  add_common(*command, o.common);
  command->callback([options] { run(*options); });
}

}  // namespace gnomon::app
