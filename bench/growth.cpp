// How the counter's time grows: with triangles, pixels, steps and threads. One row a point; the
// plot is made of the JSON by scripts/plot-growth.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

#include <gnomon/io/load_scene.h>
#include <gnomon/raster/count_shadows.h>
#include <gnomon/raster/visible_surfaces.h>
#include <scenes/generated_city.h>

#include "report.h"
#include "suns.h"

namespace gnomon::bench {
namespace {

struct Options {
  std::string vienna = "scenes/vienna/vienna.city.jsonl", out = "bench/results", name = "growth";
  int runs = 3, threads = 2;
  std::size_t most_triangles = 10'000'000, most_pixels = 64'000'000;
};

struct Point {
  std::string series;
  double x;  // triangles, pixels, steps or threads
  std::size_t triangles, pixels;
  int suns, threads;
  double ms_per_sun, set_up_ms;  // set-up: of the casters, once for all suns, and of the view
};

// All suns over one view, samples in shadow summed over all suns, from counts (a profile sums
// masks). Median of runs.
Point measure(const std::string& series, double x, const Scene& scene, const View& view, int suns,
              int threads, int runs) {
  const std::vector<Light> lights = suns_of(suns, scene.frame.true_north);
  Watch watch;
  const Receivers receivers = visible_surfaces(scene, view, threads);
  const Casters casters = prepare_casters(scene);
  const double set_up_ms = 1e3 * watch.seconds();
  std::vector<std::uint32_t> shadowed(receivers.triangle.size());
  std::vector<double> seconds;
  for (int run = 0; run <= runs; ++run) {  // the first one warms up
    std::fill(shadowed.begin(), shadowed.end(), 0);
    watch = Watch();
    count_shadows(
        casters, receivers, lights,
        [&](const CountRect& part) {
          for (int row = 0; row < part.rows; ++row) {
            const std::int32_t* from = part.counts + static_cast<std::ptrdiff_t>(row) * part.stride;
            std::uint32_t* to = shadowed.data() +
                                static_cast<std::ptrdiff_t>(part.first_row + row) * view.width +
                                part.first_column;
            for (int k = 0; k < part.columns; ++k) to[k] += from[k] > 0 ? 1 : 0;
          }
        },
        threads);
    if (run > 0) seconds.push_back(watch.seconds());
  }
  const double ms = 1e3 * median(seconds) / static_cast<double>(lights.size());
  std::fprintf(stderr, "%s %.4g: %.3f ms a sun\n", series.c_str(), x, ms);
  return {series,
          x,
          scene.mesh.triangles.size(),
          receivers.triangle.size(),
          static_cast<int>(lights.size()),
          threads,
          ms,
          set_up_ms};
}

View square(const Bounds2& b, int side) {
  View view = plan_view(b, (b.x1 - b.x0) / side, 0);
  view.width = view.height = side;
  return view;
}

// The most that this program ever held, GB; 0 where the system does not say.
double peak_gb() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    double kb = 0;
    if (word == "VmHWM:" && status >> kb) return kb / 1e6;
  }
  return 0;
}

void run(const Options& o) {
  std::vector<Point> points;
  double largest_gb = 0;
  {
    LoadOptions load;
    load.crs = "EPSG:31256";
    const Scene vienna = std::move(load_scene({o.vienna}, load).value().scene);
    Bounds2 b{1e300, 1e300, -1e300, -1e300};
    for (const Vec3& p : vienna.mesh.positions)
      b = {std::min(b.x0, p.x), std::min(b.y0, p.y), std::max(b.x1, p.x), std::max(b.y1, p.y)};
    const double middle = (b.x0 + b.x1) / 2, across = (b.y0 + b.y1) / 2;
    b = {middle - 256, across - 256, middle + 256, across + 256};  // the quarter, and little else
    for (const int side : {512, 1024, 2048, 4096, 8192}) {
      const std::size_t pixels = std::size_t(side) * std::size_t(side);
      if (pixels > o.most_pixels * 11 / 10) continue;
      points.push_back(
          measure("pixels", double(pixels), vienna, square(b, side), 16, o.threads, o.runs));
    }
    for (const int suns : {1, 2, 5, 10, 20, 50, 100, 200, 500, 1000})
      points.push_back(measure("steps", suns, vienna, square(b, 1024), suns, o.threads, o.runs));
    for (int threads = 1; threads <= this_machine().cores; ++threads)
      points.push_back(measure("threads", threads, vienna, square(b, 2048), 16, threads, o.runs));
  }
  for (const std::size_t triangles :
       {10'000u, 30'000u, 100'000u, 300'000u, 1'000'000u, 3'000'000u, 10'000'000u}) {
    if (triangles > o.most_triangles) continue;
    scenes::CityOptions city;
    city.triangles = triangles;
    const Scene scene = scenes::generated_city(city);
    points.push_back(measure("triangles", double(scene.mesh.triangles.size()), scene,
                             square(scenes::city_bounds(city), 2048), 8, o.threads, o.runs));
    largest_gb = peak_gb();
  }

  std::string text = fmt::format(
      "# How the counter's time grows\n\n{}\n\nPlans; medians of {} runs after one to warm up, {} "
      "threads but "
      "where threads are varied. Pixels, steps and threads: Vienna's quarter, 512 m across. "
      "Triangles: the "
      "generated city, always 2048 x 2048. Set-up: visible surfaces and the casters' edges, once "
      "for all suns. "
      "With the largest city the program held {:.2f} GB at most.\n\n"
      "| varied | | triangles | pixels | suns | threads | ms a sun | set-up, ms |\n"
      "|---|--:|--:|--:|--:|--:|--:|--:|\n",
      to_text(this_machine()), o.runs, o.threads, largest_gb);
  nlohmann::ordered_json json{{"machine", to_json(this_machine())}, {"peak_gb", largest_gb}};
  for (const Point& p : points) {
    text += fmt::format("| {} | {:.0f} | {} | {} | {} | {} | {:.3f} | {:.0f} |\n", p.series, p.x,
                        p.triangles, p.pixels, p.suns, p.threads, p.ms_per_sun, p.set_up_ms);
    json["points"].push_back({{"series", p.series},
                              {"x", p.x},
                              {"triangles", p.triangles},
                              {"pixels", p.pixels},
                              {"suns", p.suns},
                              {"threads", p.threads},
                              {"ms_per_sun", p.ms_per_sun},
                              {"set_up_ms", p.set_up_ms}});
  }
  fmt::print("{}", text);
  write_results(o.out, o.name, text, json);
}

}  // namespace
}  // namespace gnomon::bench

int main(int argc, char** argv) {
  gnomon::bench::Options o;
  CLI::App app{"How the counter's time grows with triangles, pixels, steps and threads"};
  app.add_option("--vienna", o.vienna, "CityJSON file of Vienna")->capture_default_str();
  app.add_option("--most-triangles", o.most_triangles, "Leave out larger cities")
      ->capture_default_str();
  app.add_option("--most-pixels", o.most_pixels, "Leave out larger pictures")
      ->capture_default_str();
  app.add_option("--runs", o.runs, "Runs of each point")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--threads", o.threads, "Threads")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app.add_option("--out", o.out, "Folder of the results")->capture_default_str();
  app.add_option("--name", o.name, "Name of the results' files")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    gnomon::bench::run(o);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_growth: error: %s\n", e.what());
    return 1;
  }
  return 0;
}
