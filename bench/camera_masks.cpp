// Shadow masks of a camera, 1920 x 1080: the counter, Embree and the software OpenGL stencil
// buffer, side by side in one run, over the same scenes and lights. What is timed: bench/README.md.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>

#include <gnomon/io/load_scene.h>
#include <gnomon/raster/count_shadows.h>
#include <gnomon/raster/visible_surfaces.h>
#include <gnomon/trace/embree_masks.h>
#ifdef GNOMON_HAVE_GL
#include <gnomon/gl/context.h>
#include <gnomon/gl/renderer.h>
#endif

#include "report.h"
#include "suns.h"

namespace gnomon::bench {
namespace {

constexpr double kLift = 1e-3;  // metres, of Embree's rays
constexpr int kWidth = 1920, kHeight = 1080;

struct Options {
  std::string vienna = "scenes/vienna/vienna.city.jsonl", data = "../shared/data",
              out = "bench/results", name = "camera-masks";
  int runs = 7, threads = 2, lights = 8;
  std::string only;  // a word of the cases' names
};

struct Contender {
  std::string name;
  std::function<void(const Light&, std::vector<std::uint8_t>&)> mask;  // one byte a pixel
  std::vector<double> ms{};                                            // a light, one a run
  double differing = 0;  // share of the pixels whose mask is not ours, all lights
};

struct Case {
  std::string name;
  std::size_t triangles = 0, samples = 0, lights = 0;
  double shadowed = 0;  // share of the samples, all lights
  std::vector<Contender> contenders;
};

// On a ring round a place.
std::vector<Light> lamps(int count, const Vec3& centre, double radius) {
  std::vector<Light> out;
  for (int k = 0; k < count; ++k) {
    const double a = 2 * M_PI * (k + 0.37) / count;
    out.push_back(snapped(point(centre + radius * Vec3(std::cos(a), std::sin(a), 0))));
  }
  return out;
}

Case measure(const std::string& name, const Scene& scene, const View& view,
             const std::vector<Light>& lights, const Options& o) {
  Case c{name, scene.mesh.triangles.size(), 0, lights.size(), 0, {}};
  const Receivers receivers = visible_surfaces(scene, view, o.threads);
  const Casters casters = prepare_casters(scene);
  c.samples =
      static_cast<std::size_t>(std::count_if(receivers.triangle.begin(), receivers.triangle.end(),
                                             [](std::uint32_t t) { return t != kNoTriangle; }));
  c.contenders.push_back({"ours", [&](const Light& light, std::vector<std::uint8_t>& mask) {
                            std::uint8_t* to = mask.data();
                            mask_shadows(casters, receivers, {&light, 1}, {&to, 1}, o.threads);
                          }});
  const RayOrigins origins = ray_origins(scene, receivers, kLift, o.threads);
  std::vector<EmbreeScene> embree;
  for (const bool robust : {false, true}) {
    embree.push_back(EmbreeScene::build(scene, {.robust = robust, .threads = o.threads}).value());
  }
  for (const bool robust : {false, true}) {
    for (const int packet : {8, 16}) {
      const EmbreeScene& tree = embree[robust ? 1 : 0];
      c.contenders.push_back({fmt::format("Embree, {}-wide{}", packet, robust ? ", robust" : ""),
                              [&, packet](const Light& light, std::vector<std::uint8_t>& mask) {
                                embree_mask(tree, origins, light, packet, o.threads, mask.data());
                              }});
    }
  }
#ifdef GNOMON_HAVE_GL
  std::optional<gl::Renderer> renderer;
  if (const Result<gl::Capabilities> capabilities = gl::find_capabilities()) {
    renderer = gl::Renderer::create(capabilities.value()).value();
    renderer->add_scene(scene);
    const gl::Camera camera = gl::camera_of(view, gl::depth_range(scene, view, true));
    c.contenders.push_back({"OpenGL's stencil, picture and reading back included",
                            [&, camera](const Light& light, std::vector<std::uint8_t>& mask) {
                              const ShadowMask drawn = renderer->mask(camera, light, {}).value();
                              for (std::size_t k = 0; k < mask.size(); ++k)
                                mask[k] = drawn.state[k] == ShadowMask::kShadow ? 1 : 0;
                            }});
  }
#endif
  std::vector<std::uint8_t> ours(receivers.triangle.size()), theirs = ours;
  for (int run = 0; run <= o.runs; ++run) {  // the first one warms up, and compares
    for (Contender& k : c.contenders) {
      const bool first = &k == &c.contenders[0];
      double seconds = 0;
      for (const Light& light : lights) {
        const Watch watch;
        k.mask(light, theirs);
        seconds += watch.seconds();
        if (run > 0) continue;
        if (first) {
          c.shadowed += double(std::count(theirs.begin(), theirs.end(), 1)) /
                        double(c.samples * lights.size());
          continue;
        }
        c.contenders[0].mask(light, ours);
        std::size_t differ = 0;
        for (std::size_t i = 0; i < ours.size(); ++i) differ += ours[i] != theirs[i] ? 1 : 0;
        k.differing += double(differ) / double(ours.size() * lights.size());
      }
      if (run > 0) k.ms.push_back(1e3 * seconds / double(lights.size()));
    }
    std::fprintf(stderr, "%s: run %d of %d\n", name.c_str(), run, o.runs);
  }
  return c;
}

// Embree's fastest 8-wide one: the peer. `wide`: among all widths.
double embree_ms(const Case& c, bool wide) {
  double best = 1e300;
  for (const Contender& k : c.contenders) {
    if (k.name.starts_with("Embree") && (wide || k.name.starts_with("Embree, 8")))
      best = std::min(best, median(k.ms));
  }
  return best;
}

void run(const Options& o) {
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, const Scene& scene, const View& view,
                       const std::vector<Light>& lights) {
    if (name.find(o.only) == std::string::npos) return;
    cases.push_back(measure(name, scene, view, lights, o));
  };
  {
    LoadOptions load;
    load.crs = "EPSG:31256";
    const Scene vienna = std::move(load_scene({o.vienna}, load).value().scene);
    const double north = vienna.frame.true_north;
    const auto at = [&](double x, double y, double z) {
      return Vec3(x, y, z) - vienna.frame.origin;
    };
    // Two metres above the ground, along a street; and from the air, over the quarter's middle.
    const View street = perspective_view(at(1270, 340783, 33.9), at(1400, 340770, 38), {0, 0, 1},
                                         60 * kDegree, kWidth, kHeight);
    const View air = perspective_view(at(1010, 340440, 330), at(1260, 340770, 40), {0, 0, 1},
                                      40 * kDegree, kWidth, kHeight);
    add("Vienna from the street, suns", vienna, street, suns_of(o.lights, north));
    add("Vienna from the street, lamps", vienna, street, lamps(o.lights, at(1330, 340776, 55), 40));
    add("Vienna from the air, suns", vienna, air, suns_of(o.lights, north));
    add("Vienna from the air, lamps", vienna, air, lamps(o.lights, at(1260, 340770, 140), 150));
  }
  for (const auto& [name, file] : {std::pair("propeller", "architecture/occt/propeller.stl"),
                                   std::pair("Spot", "architecture/spot/spot_triangulated.obj")}) {
    const std::filesystem::path path = std::filesystem::path(o.data) / file;
    if (!std::filesystem::exists(path)) {
      std::fprintf(stderr, "%s is left out: %s is not there\n", name, path.c_str());
      continue;
    }
    const Scene scene = std::move(load_scene({path}, LoadOptions()).value().scene);
    Vec3 lo(1e300), hi(-1e300);
    for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
      if (scene.surfaces[scene.surface_of[t]].semantic == "Ground") continue;
      for (const std::uint32_t v : scene.mesh.triangles[t]) {
        for (int k = 0; k < 3; ++k) {
          lo[k] = std::min(lo[k], scene.mesh.positions[v][k]);
          hi[k] = std::max(hi[k], scene.mesh.positions[v][k]);
        }
      }
    }
    const Vec3 middle = (lo + hi) * 0.5, d = hi - lo;
    const double size = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    const View view = perspective_view(middle + size * Vec3(0.9, -1.1, 0.8), middle, {0, 0, 1},
                                       40 * kDegree, kWidth, kHeight);
    add(fmt::format("{} on a plane, suns", name), scene, view, suns_of(o.lights, 0));
    add(fmt::format("{} on a plane, lamps", name), scene, view,
        lamps(o.lights, middle + Vec3(0, 0, size), size));
  }

  std::string text = fmt::format(
      "# Shadow masks of a camera\n\n{}\n\n{} x {} pixels; {} threads each (OpenGL: those of its "
      "driver); medians of {} interleaved runs after one to warm up, milliseconds a light, one "
      "light at a time. Ours and Embree share the samples, found once; OpenGL draws the picture "
      "for every mask and reads it back, and its samples lie in the middle of pixels as theirs do. "
      "Against: how many times as fast ours is as Embree's faster 8-wide flag, its fastest of all, "
      "and OpenGL.\n\n"
      "| | triangles | lights | samples in shadow | ours, ms | Embree 8-wide, ms | fastest, ms | "
      "OpenGL, ms | "
      "against 8-wide | fastest | OpenGL | differ from ours: 8-wide | OpenGL |\n"
      "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
      to_text(this_machine()), kWidth, kHeight, o.threads, o.runs);
  nlohmann::ordered_json json{
      {"machine", to_json(this_machine())}, {"threads", o.threads}, {"runs", o.runs}};
  for (const Case& c : cases) {
    const double ours = median(c.contenders[0].ms), eight = embree_ms(c, false),
                 fastest = embree_ms(c, true);
    const Contender& last = c.contenders.back();
    const bool opengl = last.name.starts_with("OpenGL");
    const double drawn = opengl ? median(last.ms) : 0;
    text += fmt::format(
        "| {} | {} | {} | {:.0f} % | {:.2f} | {:.2f} | {:.2f} | {} | {:.2f} | {:.2f} | {} | {:.4f} "
        "% | {} |\n",
        c.name, c.triangles, c.lights, 100 * c.shadowed, ours, eight, fastest,
        opengl ? fmt::format("{:.1f}", drawn) : "", eight / ours, fastest / ours,
        opengl ? fmt::format("{:.1f}", drawn / ours) : "", 100 * c.contenders[1].differing,
        opengl ? fmt::format("{:.4f} %", 100 * last.differing) : "");
    nlohmann::ordered_json one{{"name", c.name},
                               {"triangles", c.triangles},
                               {"samples", c.samples},
                               {"lights", c.lights},
                               {"shadowed", c.shadowed}};
    for (const Contender& k : c.contenders)
      one["contenders"].push_back(
          {{"name", k.name}, {"ms", median(k.ms)}, {"all_ms", k.ms}, {"differing", k.differing}});
    json["cases"].push_back(one);
  }
  fmt::print("{}", text);
  write_results(o.out, o.name, text, json);
}

}  // namespace
}  // namespace gnomon::bench

int main(int argc, char** argv) {
  gnomon::bench::Options o;
  CLI::App app{"Shadow masks of a camera: the counter, Embree and OpenGL"};
  app.add_option("--vienna", o.vienna, "CityJSON file of Vienna")->capture_default_str();
  app.add_option("--data", o.data, "Folder of real models")->capture_default_str();
  app.add_option("--only", o.only, "Only the cases whose names hold this");
  app.add_option("--lights", o.lights, "Of a case")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--runs", o.runs, "Interleaved runs")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--threads", o.threads, "Of each contender")->capture_default_str();
  app.add_option("--out", o.out, "Folder of the results")->capture_default_str();
  app.add_option("--name", o.name, "Name of the results' files")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
#ifdef GNOMON_HAVE_GL
    const gnomon::Result<gnomon::gl::HeadlessContext> context =
        gnomon::gl::HeadlessContext::create();
    if (!context) std::fprintf(stderr, "OpenGL is left out: %s\n", context.error().message.c_str());
#endif
    gnomon::bench::run(o);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_camera_masks: error: %s\n", e.what());
    return 1;
  }
  return 0;
}
