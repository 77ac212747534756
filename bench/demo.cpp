// One command at full resolution against ray casting alone: the whole program (start, reading,
// view, suns, all its files) against the masks that Embree traces over the same samples and suns,
// its set-up not counted. The demo's 96 suns of a day, or a year's hours.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gnomon/io/load_scene.h>
#include <gnomon/raster/visible_surfaces.h>
#include <gnomon/trace/embree_masks.h>

#include "report.h"

namespace gnomon::bench {
namespace {

constexpr double kLift = 1e-3;  // metres, of Embree's rays

struct Options {
  std::string gnomon = "build/release/bin/gnomon", model = "scenes/vienna/vienna.city.jsonl";
  std::string out = "bench/results", name = "demo";
  std::string date = "2024-09-18", hours = "--from 09:00 --to 17:00", every = "5min";
  double pixel = 0.25;
  int runs = 3, threads = 2;
  std::size_t traced = 100;  // suns at most that rays are traced for; more are extrapolated
};

Vec4 vec(const nlohmann::json& j) { return {j[0], j[1], j[2], j[3]}; }

int run(const Options& o) {
  const auto folder = std::filesystem::temp_directory_path() / "gnomon-bench-demo";
  const std::string study = fmt::format("--date {} {} --tz Europe/Vienna --pixel {} --every {}",
                                        o.date, o.hours, o.pixel, o.every);
  const std::string command =
      fmt::format("\"{}\" profile \"{}\" --crs EPSG:31256 {} --threads {} --quiet -o \"{}\"",
                  o.gnomon, o.model, study, o.threads, folder.string());
  std::vector<double> whole, rays[2];
  const auto run_program = [&] {
    const Watch watch;
    if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
    return watch.seconds();
  };
  run_program();  // warms up, and tells the view and the suns
  const nlohmann::json summary = nlohmann::json::parse(std::ifstream(folder / "summary.json"));
  const nlohmann::json& d = summary["view"]["definition"];
  View view{vec(d["eye"]),  vec(d["origin"]),         vec(d["right"]),
            vec(d["down"]), summary["view"]["width"], summary["view"]["height"]};
  std::vector<Light> suns;
  for (const auto& s : summary["samples"]) {
    if (s["above_horizon"])
      suns.push_back({s["direction"][0], s["direction"][1], s["direction"][2], 0.0});
  }
  if (suns.empty()) throw std::runtime_error("no sun is above the horizon: " + study);
  // Evenly spread over the year, and so over the heights of the sun.
  std::vector<Light> traced;
  const std::size_t rays_of = std::min(suns.size(), o.traced);
  for (std::size_t k = 0; k < rays_of; ++k)
    traced.push_back(suns[(2 * k + 1) * suns.size() / (2 * rays_of)]);
  const double all_of_traced = double(suns.size()) / double(traced.size());
  LoadOptions load;
  load.crs = "EPSG:31256";
  const LoadedScene loaded = load_scene({o.model}, load).value();
  const Receivers receivers = visible_surfaces(loaded.scene, view, o.threads);
  const RayOrigins origins = ray_origins(loaded.scene, receivers, kLift, o.threads);
  const EmbreeScene embree =
      EmbreeScene::build(loaded.scene, {.robust = false, .threads = o.threads}).value();
  std::vector<std::uint8_t> mask(receivers.triangle.size());
  const int packets[2] = {8, 16};
  for (int k = 0; k < o.runs; ++k) {
    whole.push_back(run_program());
    for (int p = 0; p < 2; ++p) {
      const Watch watch;
      for (const Light& sun : traced)
        embree_mask(embree, origins, sun, packets[p], o.threads, mask.data());
      rays[p].push_back(watch.seconds() * all_of_traced);
    }
    std::fprintf(stderr, "run %d of %d\n", k + 1, o.runs);
  }
  const nlohmann::json timings =
      nlohmann::json::parse(std::ifstream(folder / "summary.json"))["timings"];
  std::filesystem::remove_all(folder);

  std::string stages;
  for (const auto& [stage, ms] : timings.items())
    stages += fmt::format("| {} | {:.0f} |\n", stage, ms.get<double>());
  const double ours = median(whole);
  const std::string markdown = fmt::format(
      "# A whole command against ray casting alone\n\n{}\n\n`gnomon profile` of Vienna, `{}`: {} x "
      "{} samples, {} suns, {} "
      "threads each; medians of {} interleaved runs. Embree: not robust (its faster flag), set-up "
      "not counted{}.\n\n"
      "| | seconds | share of it that the command takes |\n|---|--:|--:|\n"
      "| the command, reading and all its files included | {:.2f} | |\n"
      "| {} masks by Embree, 8-wide | {:.2f} | {:.3f} |\n| {} masks by Embree, 16-wide | {:.2f} | "
      "{:.3f} |\n\n"
      "Where the command's time goes (last run):\n\n| stage | ms |\n|---|--:|\n{}",
      to_text(this_machine()), study, view.width, view.height, suns.size(), o.threads, o.runs,
      traced.size() < suns.size()
          ? fmt::format("; extrapolated from the masks of {} suns, evenly spread over all",
                        traced.size())
          : "",
      ours, suns.size(), median(rays[0]), ours / median(rays[0]), suns.size(), median(rays[1]),
      ours / median(rays[1]), stages);
  fmt::print("{}", markdown);
  write_results(o.out, o.name, markdown,
                {{"machine", to_json(this_machine())},
                 {"study", study},
                 {"suns", suns.size()},
                 {"suns_traced", traced.size()},
                 {"width", view.width},
                 {"height", view.height},
                 {"demo_s", whole},
                 {"embree_8_s", rays[0]},
                 {"embree_16_s", rays[1]},
                 {"timings_ms", timings}});
  return 0;
}

}  // namespace
}  // namespace gnomon::bench

int main(int argc, char** argv) {
  gnomon::bench::Options o;
  CLI::App app{"A whole command against ray casting alone: the demo's, or a year"};
  app.add_option("--gnomon", o.gnomon, "The program")->capture_default_str();
  app.add_option("--model", o.model, "Vienna")->capture_default_str();
  app.add_option("--date", o.date, "Date or range")->capture_default_str();
  app.add_option("--hours", o.hours, "Options of the hours, or empty: from sunrise to sunset")
      ->capture_default_str();
  app.add_option("--every", o.every, "Step")->capture_default_str();
  app.add_option("--pixel", o.pixel, "Metres")->capture_default_str();
  app.add_option("--traced", o.traced, "Suns at most that rays are traced for")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--runs", o.runs, "Interleaved runs")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--threads", o.threads, "Of each contender")->capture_default_str();
  app.add_option("--out", o.out, "Folder of the results")->capture_default_str();
  app.add_option("--name", o.name, "Name of the results' files")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    return gnomon::bench::run(o);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_demo: %s\n", e.what());
    return 1;
  }
}
