#include "bench_sun_frames.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <gnomon/gl/context.h>
#include <gnomon/gl/renderer.h>

#include <bench/report.h>

#include "bench_tables.h"
#include "commands.h"

namespace gnomon::app {
namespace {

// A frame takes long: of the day's minutes so many runs, each in the middle of an equal share of
// the day. Within a run the sun moves as it does, by a minute.
constexpr std::size_t kRuns = 4;
constexpr int kMostRounds = 5;

std::vector<Light> some_of(const std::vector<Light>& suns, std::size_t frames) {
  const std::size_t minutes = std::max<std::size_t>(1, frames / kRuns);
  if (suns.size() <= kRuns * minutes) return suns;
  std::vector<Light> out;
  for (std::size_t run = 0; run < kRuns; ++run) {
    const std::size_t middle = suns.size() * (2 * run + 1) / (2 * kRuns);
    for (std::size_t k = 0; k < minutes; ++k) out.push_back(suns[middle - minutes / 2 + k]);
  }
  return out;
}

// One way to find silhouettes, with a renderer of its own.
struct Way {
  SilhouetteBy by;
  gl::Renderer renderer;
  double frame_ms = 0, volumes_ms = 0;  // means over the suns
};

// Each sun by every way in turn, round after round; a sun's times are medians of the rounds.
void measure(std::vector<Way>& ways, const gl::Camera& camera, const std::vector<Light>& suns,
             const gl::Method& method, int rounds, ProgressBar& bar, double from, double to) {
  using PerSun = std::vector<std::vector<double>>;
  std::vector<PerSun> frame(ways.size(), PerSun(suns.size())), volumes = frame;
  const auto draw = [&](Way& way, const Light& sun) {
    gl::LightSource source;
    source.light = sun;
    gl::FrameOptions options;
    options.method = method;
    options.method.silhouettes = way.by;
    const gl::FrameStats stats = take(way.renderer.draw(camera, {&source, 1}, options));
    way.renderer.finish();
    return stats;
  };
  for (Way& way : ways) {
    for (const Light& sun : {suns.front(), suns.back()}) draw(way, sun);  // compiles, builds
  }
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t k = 0; k < suns.size(); ++k) {
      for (std::size_t w = 0; w < ways.size(); ++w) {
        const bench::Watch watch;
        const gl::FrameStats stats = draw(ways[w], suns[k]);
        frame[w][k].push_back(1e3 * watch.seconds());
        volumes[w][k].push_back(stats.volumes_ms);
      }
      bar.show(from + (to - from) * (round + double(k + 1) / double(suns.size())) / rounds);
    }
  }
  for (std::size_t w = 0; w < ways.size(); ++w) {
    for (std::size_t k = 0; k < suns.size(); ++k) {
      ways[w].frame_ms += bench::median(frame[w][k]) / double(suns.size());
      ways[w].volumes_ms += bench::median(volumes[w][k]) / double(suns.size());
    }
  }
}

}  // namespace

std::string bench_sun_frames(std::span<const PaperScene> scenes, const gl::Method& method,
                             const std::string& api, int frames, int rounds, ProgressBar& bar,
                             double from, double to) {
  gl::HeadlessContext context =
      take(gl::HeadlessContext::create(api == "gles" ? gl::Api::opengl_es : gl::Api::opengl));
  const gl::Capabilities capabilities = take(gl::find_capabilities());
  rounds = std::min(rounds, kMostRounds);
  std::vector<std::string> columns{"number of triangles (casting)", "suns"};
  for (const char* of : {"frame", "of it, until volumes are with OpenGL"}) {
    columns.push_back(fmt::format("{}: brute force, ms", of));
    for (const char* way : {"dual space", "tree of edges"}) {
      columns.push_back(fmt::format("{}, ms", way));
      columns.push_back("over brute force");
    }
  }
  columns.insert(columns.end(),
                 {"*paper: brute force, ms*", "*dual space, ms*", "*over brute force*"});
  std::string table;
  const double share = (to - from) / double(scenes.size());
  for (const PaperScene& s : scenes) {
    const std::vector<Light> suns = some_of(suns_of(s.day), static_cast<std::size_t>(frames));
    const View view =
        make_camera(s.scene, s.view, light_azimuth(s.scene, suns[suns.size() / 2]), 1);
    const gl::Camera camera = gl::camera_of(view, gl::depth_range(s.scene, view, true));
    std::vector<Way> ways;
    for (const SilhouetteBy by :
         {SilhouetteBy::brute_force, SilhouetteBy::dual_space, SilhouetteBy::edge_tree}) {
      ways.push_back({by, take(gl::Renderer::create(capabilities))});
      ways.back().renderer.add_scene(s.scene);
    }
    measure(ways, camera, suns, method, rounds, bar, from, from + share);
    from += share;
    std::size_t casting = 0;
    for (std::uint32_t t = 0; t < s.scene.mesh.triangles.size(); ++t)
      casting += casts(s.scene, t) ? 1 : 0;
    std::vector<std::string> cells{fmt::format("{} ({})", s.scene.mesh.triangles.size(), casting),
                                   fmt::format("{}", suns.size())};
    for (double Way::*ms : {&Way::frame_ms, &Way::volumes_ms}) {
      for (const Way& way : ways) {
        cells.push_back(significant(way.*ms));
        if (&way != &ways[0]) cells.push_back(ratio(way.*ms, ways[0].*ms));
      }
    }
    cells.push_back(s.paper ? fmt::format("{:.3f}", s.paper->brute) : "");
    cells.push_back(s.paper ? fmt::format("{:.3f}", s.paper->dual) : "");
    cells.push_back(s.paper ? ratio(s.paper->dual, s.paper->brute) : "");
    table += row(s.name, cells);
  }
  return fmt::format(
             "\n## Whole frames: Geometry of shadows in real time, Tables 1 and 2\n\n"
             "Driver: {}.\n\n"
             "A frame is from the call of draw() to the end of glFinish(), of 640 x 480 pixels "
             "from "
             "the eye of docs/gallery.md's pictures: the sun has moved by a minute, so silhouettes "
             "and volumes are made anew, and all is drawn; {} runs of minutes in a row, each in "
             "the middle of an equal share of the paper's hours. \"Until volumes are with "
             "OpenGL\" is the part of it that ends when the volumes' indices have been handed "
             "over: silhouettes, part by part, the bound of layers, grazed triangles, lists. All "
             "ways draw sun 1, then all draw sun 2, {} times over; a sun's time is the median of "
             "its {}, a scene's the mean of its suns. Dual space is that of facets: vertices find "
             "no volumes. Faces counted {}, {} reach.\n\n",
             gl::describe(capabilities), kRuns, rounds, rounds, gl::name_of(method.count),
             gl::name_of(method.reach)) +
         header("scene", columns) + table;
}

}  // namespace gnomon::app
