// Shadow masks of many suns over one view: the counter and Embree, side by side in one run, over
// the same samples and suns. What is timed and what is not: bench/README.md.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include <gnomon/io/load_scene.h>
#include <gnomon/raster/count_shadows.h>
#include <gnomon/raster/visible_surfaces.h>
#include <gnomon/trace/embree_masks.h>
#include <scenes/generated_city.h>

#include "report.h"
#include "suns.h"

namespace gnomon::bench {
namespace {

constexpr double kLift = 1e-3;  // metres, of Embree's rays

struct Options {
  std::string vienna, data, out = "bench/results", name = "shadow_masks";
  std::vector<std::string> cases;  // empty: all
  int runs = 7, threads = 2, suns = 16, buildings = 10000, size = 2048;
  bool ours_alone = false;
};

constexpr const char* kCases[] = {"vienna-0.25", "vienna-0.1", "delfshaven-0.25", "city",
                                  "one-mask"};

bool chosen(const Options& o, const std::string& name) {
  return o.cases.empty() || std::find(o.cases.begin(), o.cases.end(), name) != o.cases.end();
}

struct EmbreeVariant {
  bool robust;
  int packet;
  std::string name() const {
    return fmt::format("Embree, {}-wide{}", packet, robust ? ", robust" : "");
  }
};
constexpr EmbreeVariant kVariants[] = {{false, 8}, {false, 16}, {true, 8}, {true, 16}};

using Masks = std::vector<std::vector<std::uint8_t>>;  // per sun, one byte a pixel: 1 in shadow

// The counter's masks, as Embree writes them.
void our_masks(const Casters& casters, const Receivers& receivers, const std::vector<Light>& lights,
               int threads, bool one_by_one, Masks& masks) {
  const std::size_t step = one_by_one ? 1 : lights.size();
  for (std::size_t first = 0; first < lights.size(); first += step) {
    std::vector<std::uint8_t*> to;
    for (std::size_t l = first; l < first + step; ++l) to.push_back(masks[l].data());
    mask_shadows(casters, receivers, std::span(lights).subspan(first, step), to, threads);
  }
}

std::uint64_t differences(const Masks& a, const Masks& b) {
  std::uint64_t n = 0;
  for (std::size_t l = 0; l < a.size(); ++l) {
    for (std::size_t k = 0; k < a[l].size(); ++k) n += a[l][k] != b[l][k] ? 1 : 0;
  }
  return n;
}

struct Contender {
  std::string name;
  double setup_ms = 0;        // once per scene and view
  std::vector<double> times;  // ms per sun, one value a run
  std::uint64_t differing = 0;
};

struct Case {
  std::string name;
  std::string skipped;      // why; nothing else is set then
  bool one_by_one = false;  // a call of ours for each sun
  std::size_t triangles = 0, samples = 0;
  int width = 0, height = 0, suns = 0;
  double view_ms = 0;                 // visible surfaces, used by all contenders
  std::vector<Contender> contenders;  // the first is ours
};

// `one_by_one`: ours is called for each sun by itself, as a user does who wants one mask.
Case measure(const std::string& name, const Scene& scene, const View& view, const Options& o,
             bool one_by_one = false) {
  Case c;
  c.name = name;
  c.one_by_one = one_by_one;
  c.triangles = scene.mesh.triangles.size();
  c.width = view.width;
  c.height = view.height;
  const std::vector<Light> lights = suns_of(o.suns, scene.frame.true_north);
  c.suns = static_cast<int>(lights.size());
  Watch watch;
  const Receivers receivers = visible_surfaces(scene, view, o.threads);
  c.view_ms = watch.seconds() * 1000;
  c.samples =
      static_cast<std::size_t>(std::count_if(receivers.triangle.begin(), receivers.triangle.end(),
                                             [](std::uint32_t t) { return t != kNoTriangle; }));

  watch = Watch();
  const Casters casters = prepare_casters(scene);
  c.contenders.push_back({"ours", watch.seconds() * 1000, {}, 0});
  std::vector<EmbreeScene> embree;
  RayOrigins origins;
  if (!o.ours_alone) {
    watch = Watch();
    origins = ray_origins(scene, receivers, kLift, o.threads);
    const double origins_ms = watch.seconds() * 1000;
    EmbreeScene::build(scene, {.robust = false, .threads = o.threads})
        .value();  // starts its threads
    double build_ms[2];
    for (const bool robust : {false, true}) {
      watch = Watch();
      embree.push_back(EmbreeScene::build(scene, {.robust = robust, .threads = o.threads}).value());
      build_ms[robust ? 1 : 0] = watch.seconds() * 1000;
    }
    for (const EmbreeVariant& v : kVariants)
      c.contenders.push_back({v.name(), build_ms[v.robust ? 1 : 0] + origins_ms, {}, 0});
  }

  const std::size_t pixels =
      static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
  Masks ours(lights.size(), std::vector<std::uint8_t>(pixels)), theirs = ours;
  for (int run = 0; run <= o.runs; ++run) {  // the first run warms up and is not counted
    for (std::size_t k = 0; k < c.contenders.size(); ++k) {
      watch = Watch();
      if (k == 0) {
        our_masks(casters, receivers, lights, o.threads, one_by_one, ours);
      } else {
        const EmbreeVariant& v = kVariants[k - 1];
        for (std::size_t l = 0; l < lights.size(); ++l) {
          embree_mask(embree[v.robust ? 1 : 0], origins, lights[l], v.packet, o.threads,
                      theirs[l].data());
        }
      }
      const double ms = watch.seconds() * 1000 / static_cast<double>(lights.size());
      if (run > 0) c.contenders[k].times.push_back(ms);
      if (run == 0 && k > 0) c.contenders[k].differing = differences(ours, theirs);
    }
    std::fprintf(stderr, "%s: run %d of %d\n", name.c_str(), run, o.runs);
  }
  return c;
}

// The fastest of Embree's variants.
const Contender& peer(const Case& c) {
  return *std::min_element(
      c.contenders.begin() + 1, c.contenders.end(),
      [](const Contender& a, const Contender& b) { return median(a.times) < median(b.times); });
}

std::string markdown(const std::vector<Case>& cases, const Options& o) {
  std::string text = fmt::format(
      "# Shadow masks: the counter and Embree\n\n{}\n\n{} threads each; medians of {} interleaved "
      "runs after one to warm up. Times "
      "are milliseconds per sun. \"Times ours\" compares with ours; the peer is Embree's fastest "
      "variant.\n",
      to_text(this_machine()), o.threads, o.runs);
  for (const Case& c : cases) {
    if (!c.skipped.empty()) {
      text += fmt::format("\n## {}\n\nskipped: {}\n", c.name, c.skipped);
      continue;
    }
    text += fmt::format(
        "\n## {}\n\n{} triangles, {} x {} pixels, {} samples, {} suns{}. Visible surfaces, shared "
        "by all: {:.0f} ms.\n\n"
        "| | ms per sun | fastest | slowest | times ours | set-up ms | samples that differ from "
        "ours, all suns |\n"
        "|---|--:|--:|--:|--:|--:|--:|\n",
        c.name, c.triangles, c.width, c.height, c.samples, c.suns,
        c.one_by_one ? ", each by a call of its own" : "", c.view_ms);
    const double ours = median(c.contenders[0].times);
    for (const Contender& k : c.contenders) {
      const auto [least, most] = std::minmax_element(k.times.begin(), k.times.end());
      text += fmt::format("| {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.0f} | {} |\n", k.name,
                          median(k.times), *least, *most, median(k.times) / ours, k.setup_ms,
                          &k == &c.contenders[0] ? std::string("-") : std::to_string(k.differing));
    }
    if (c.contenders.size() == 1) continue;
    text += fmt::format("\nPeer: {}; ours is {:.2f} times as fast per sun.\n", peer(c).name,
                        median(peer(c).times) / ours);
  }
  return text;
}

nlohmann::ordered_json json(const std::vector<Case>& cases, const Options& o) {
  nlohmann::ordered_json out{{"machine", to_json(this_machine())},
                             {"threads", o.threads},
                             {"runs", o.runs},
                             {"lift_m", kLift}};
  for (const Case& c : cases) {
    if (!c.skipped.empty()) {
      out["cases"].push_back({{"name", c.name}, {"skipped", c.skipped}});
      continue;
    }
    nlohmann::ordered_json one{{"name", c.name},
                               {"triangles", c.triangles},
                               {"width", c.width},
                               {"height", c.height},
                               {"samples", c.samples},
                               {"suns", c.suns},
                               {"one_by_one", c.one_by_one},
                               {"view_ms", c.view_ms}};
    if (c.contenders.size() > 1) {
      one["peer"] = peer(c).name;
      one["ratio"] = median(peer(c).times) / median(c.contenders[0].times);
    }
    for (const Contender& k : c.contenders) {
      one["contenders"].push_back({{"name", k.name},
                                   {"ms_per_sun", median(k.times)},
                                   {"all_ms_per_sun", k.times},
                                   {"setup_ms", k.setup_ms},
                                   {"differing_samples", k.differing}});
    }
    out["cases"].push_back(one);
  }
  return out;
}

Bounds2 bounds_without_ground(const Scene& scene) {
  Bounds2 b{1e300, 1e300, -1e300, -1e300};
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (scene.surfaces[scene.surface_of[t]].semantic == "Ground") continue;
    for (const std::uint32_t v : scene.mesh.triangles[t]) {
      const Vec3& p = scene.mesh.positions[v];
      b = {std::min(b.x0, p.x), std::min(b.y0, p.y), std::max(b.x1, p.x), std::max(b.y1, p.y)};
    }
  }
  return b;
}

Case skipped(const std::string& name, const std::string& why) {
  Case c;
  c.name = name;
  c.skipped = why;
  return c;
}

void run(const Options& o) {
  std::vector<Case> cases;
  const auto city_model = [&](const std::string& name, const std::string& title,
                              const std::string& file, const std::string& crs, double pixel,
                              bool one_by_one = false) {
    if (!chosen(o, name)) return;
    if (!std::filesystem::exists(file)) {
      cases.push_back(skipped(
          title, file.empty() ? "no file was named" : fmt::format("{} is not there", file)));
      return;
    }
    LoadOptions load;
    load.crs = crs;
    const Scene scene = std::move(load_scene({file}, load).value().scene);
    cases.push_back(
        measure(title, scene, plan_view(bounds_without_ground(scene), pixel, 0), o, one_by_one));
  };
  const std::string delfshaven = o.data.empty() ? "" : o.data + "/city/3-20-DELFSHAVEN.city.json";
  city_model("vienna-0.25", "Vienna at 0.25 m", o.vienna, "EPSG:31256", 0.25);
  city_model("vienna-0.1", "Vienna at 0.1 m", o.vienna, "EPSG:31256", 0.1);
  city_model("delfshaven-0.25", "Delfshaven at 0.25 m", delfshaven, "EPSG:28992", 0.25);
  if (o.buildings > 0 && chosen(o, "city")) {
    const scenes::CityOptions city{.buildings = o.buildings};
    const Scene scene = scenes::generated_city(city);
    const Bounds2 b = scenes::city_bounds(city);
    View view = plan_view(b, (b.x1 - b.x0) / o.size, 0);
    view.width = view.height = o.size;
    cases.push_back(
        measure(fmt::format("Generated city of {} buildings", o.buildings), scene, view, o));
  }
  city_model("one-mask", "One mask alone, Vienna at 0.25 m", o.vienna, "EPSG:31256", 0.25, true);
  const std::string text = markdown(cases, o);
  fmt::print("{}", text);
  write_results(o.out, o.name, text, json(cases, o));
}

}  // namespace
}  // namespace gnomon::bench

int main(int argc, char** argv) {
  gnomon::bench::Options o;
  CLI::App app{"Shadow masks of many suns over one view: the counter and Embree"};
  app.add_option("--vienna", o.vienna, "CityJSON file of Vienna; without it its cases are skipped");
  app.add_option("--data", o.data, "Folder of real models; without it Delfshaven is skipped");
  app.add_option("--case", o.cases, "Measure this one (may be repeated; default: all)")
      ->check(CLI::IsMember(std::vector<std::string>(std::begin(gnomon::bench::kCases),
                                                     std::end(gnomon::bench::kCases))));
  app.add_flag("--ours-alone", o.ours_alone, "Leave Embree out (to look for where time goes)");
  app.add_option("--buildings", o.buildings, "Of the generated city; 0 leaves it out")
      ->capture_default_str();
  app.add_option("--size", o.size, "Pixels per side of the generated city")->capture_default_str();
  app.add_option("--suns", o.suns, "Suns over the day")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--runs", o.runs, "Interleaved runs")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--threads", o.threads, "Of each contender")->capture_default_str();
  app.add_option("--out", o.out, "Folder of the results")->capture_default_str();
  app.add_option("--name", o.name, "Name of the results' files")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    gnomon::bench::run(o);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_shadow_masks: error: %s\n", e.what());
    return 1;
  }
  return 0;
}
