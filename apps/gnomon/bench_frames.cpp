#include "bench_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include <time.h>

#include <fmt/format.h>
#include <gnomon/gl/context.h>
#include <gnomon/gl/renderer.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/io/png.h>

#include <bench/report.h>
#include <scenes/paper_scenes.h>

#include "bench_tables.h"
#include "commands.h"
#include "render_options.h"

namespace gnomon::app {
namespace {

// One way to draw the animation, with a renderer of its own: framebuffers and volumes are kept from
// frame to frame.
struct Way {
  std::string name;
  gl::FrameOptions options;
  gl::Renderer renderer;
  int lights = 1;
  gl::FrameStats stats{};  // of the last frame
  // Per frame of the animation, the median of the rounds: by the clock, and of all processors.
  std::vector<double> seconds{}, processor_seconds{};
};

std::vector<gl::LightSource> lights_of(const std::vector<scenes::Lamp>& lamps) {
  std::vector<gl::LightSource> out;
  for (const scenes::Lamp& lamp : lamps) out.push_back({point(lamp.at), lamp.colour, {1, 0, 0}, 0});
  return out;
}

// Of all threads of the program, a software driver's among them.
double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

using Lamps = std::vector<scenes::Lamp> (*)(int count, double phase);

// Frame i of each way in turn, then frame i + 1: what else the machine does meets all alike.
void measure(std::vector<Way>& ways, const gl::Camera& camera, Lamps lamps, const FrameBench& o,
             ProgressBar& bar, double from, double to) {
  using PerFrame = std::vector<std::vector<double>>;
  std::vector<PerFrame> seconds(ways.size(), PerFrame(std::size_t(o.frames))), processor = seconds;
  const auto draw = [&](Way& way, double phase) {
    way.stats = take(way.renderer.draw(camera, lights_of(lamps(way.lights, phase)), way.options));
    way.renderer.finish();
  };
  for (Way& way : ways) {
    for (const double phase : {0.0, 0.5}) draw(way, phase);  // compiles shaders, makes framebuffers
  }
  const double steps = double(o.rounds) * o.frames;
  for (int round = 0; round < o.rounds; ++round) {
    for (int i = 0; i < o.frames; ++i) {
      for (std::size_t w = 0; w < ways.size(); ++w) {
        const double before = processor_seconds();
        const bench::Watch watch;
        draw(ways[w], double(i) / o.frames);
        seconds[w][std::size_t(i)].push_back(watch.seconds());
        processor[w][std::size_t(i)].push_back(processor_seconds() - before);
      }
      bar.show(from + (to - from) * (round * o.frames + i + 1) / steps);
    }
  }
  for (std::size_t w = 0; w < ways.size(); ++w) {
    for (const std::vector<double>& of_frame : seconds[w])
      ways[w].seconds.push_back(bench::median(of_frame));
    for (const std::vector<double>& of_frame : processor[w])
      ways[w].processor_seconds.push_back(bench::median(of_frame));
  }
}

// Frames a second over the whole animation, and where it is slowest.
double mean_rate(const Way& way) {
  double sum = 0;
  for (const double s : way.seconds) sum += s;
  return double(way.seconds.size()) / sum;
}
double least_rate(const Way& way) {
  return 1 / *std::max_element(way.seconds.begin(), way.seconds.end());
}

std::string rate(double frames_per_second) {
  return fmt::format("{:.{}f}", frames_per_second, frames_per_second < 99.95 ? 1 : 0);
}

void write_picture(const FrameBench& o, const std::string& name, Way& way, const gl::Camera& camera,
                   Lamps lamps) {
  const auto slowest = std::max_element(way.seconds.begin(), way.seconds.end());
  const double phase = double(slowest - way.seconds.begin()) / double(way.seconds.size());
  const gl::Image image =
      take(way.renderer.render(camera, lights_of(lamps(way.lights, phase)), way.options));
  take(write_png(std::filesystem::path(o.pictures) / (name + ".png"),
                 picture_of_rgba(image.width, image.height, image.rgba), o.threads));
}

// --- Table 2 of Roettger, Irion and Ertl, Shadow Volumes Revisited, 2002 ----------------------

// A column of the table; `paper`: frames a second at 256, 512 and 1024 pixels squared, 0: not
// given.
struct Column {
  std::string name;
  gl::Method method;
  std::array<double, 3> paper{};
  bool only_largest = false;
};
constexpr std::array<int, 3> kPaperSizes{256, 512, 1024};

std::vector<Column> table_2(const gl::Method& base) {
  const auto method = [&](gl::MaskIn mask, double scale = 1) {
    gl::Method m = base;
    m.mask = mask;
    m.mask_scale = scale;
    m.shadows = gl::Shadows::attenuated;
    return m;
  };
  gl::Method culled = method(gl::MaskIn::stencil);
  culled.passes = gl::StencilPasses::culled;
  gl::Method none = method(gl::MaskIn::stencil);
  none.shadows = gl::Shadows::none;
  return {{"screen buffer", method(gl::MaskIn::screen), {40.8, 29.9, 9.3}},
          {"alpha buffer", method(gl::MaskIn::alpha), {42.4, 33.6, 10.2}},
          {"stencil buffer", culled, {42.4, 29.1, 8.9}},
          {"stencil, two-sided", method(gl::MaskIn::stencil), {}},
          {"half res.", method(gl::MaskIn::alpha, 0.5), {39.1, 30.5, 15.7}},
          {"quarter res.", method(gl::MaskIn::alpha, 0.25), {0, 0, 23.6}, true},
          {"no shadows", none, {90.4, 89.2, 44.6}}};
}

std::vector<scenes::Lamp> one_lamp(int, double phase) { return {scenes::lamp_on_its_round(phase)}; }

const Way& way_named(const std::vector<Way>& ways, const std::string& name) {
  return *std::find_if(ways.begin(), ways.end(), [&](const Way& w) { return w.name == name; });
}

std::string what_a_frame_is(const std::vector<Way>& ways) {
  std::string text =
      "\nWhat a frame of each is (draws: of the animation's last; processor time: of all "
      "threads, which is all work where the driver is software):\n\n" +
      header("column", {"passes", "rectangles", "other rectangles", "volumes", "draws of volumes",
                        "mask", "processor ms, mean", "most"});
  for (const Way& way : ways) {
    const gl::FrameStats& s = way.stats;
    const gl::Method& m = s.method;
    double sum = 0, most = 0;
    for (const double seconds : way.processor_seconds) {
      sum += seconds;
      most = std::max(most, seconds);
    }
    text += row(way.name, {fmt::format("{}", s.passes), fmt::format("{}", s.rectangles),
                           fmt::format("{}", s.other_rectangles),
                           fmt::format("{}", s.z_pass_volumes + s.z_fail_volumes),
                           fmt::format("{}", s.volume_draws),
                           m.shadows == gl::Shadows::none  ? "none"
                           : m.mask == gl::MaskIn::stencil ? "8-bit stencil"
                           : m.float_bits > 0 ? fmt::format("{}-bit floats", m.float_bits)
                                              : "8 bits a channel",
                           fmt::format("{:.1f}", 1000 * sum / double(way.processor_seconds.size())),
                           fmt::format("{:.1f}", 1000 * most)});
  }
  return text;
}

std::string bench_table_2(const scenes::PaperScene& s, const FrameBench& o, ProgressBar& bar,
                          const gl::Capabilities& capabilities, double from, double to) {
  std::string text =
      fmt::format("\n### {}: {} ({} triangles)\n", s.name, s.what, s.scene.mesh.triangles.size());
  const std::vector<Column> columns = table_2(o.method);
  std::vector<std::string> names;
  for (const Column& c : columns) names.push_back(c.name);
  std::string table = "\n" + header("window, frames a second", names), statements, frames;
  double pixels = 0, done = 0;
  for (const int size : o.sizes) pixels += double(size) * size;
  for (const int size : o.sizes) {
    const View view = scenes::view_of(s, size, size);
    const gl::Camera camera = gl::camera_of(view, gl::depth_range(s.scene, view, true));
    const bool largest = size == *std::max_element(o.sizes.begin(), o.sizes.end());
    std::vector<Way> ways;
    for (const Column& c : columns) {
      if (c.only_largest && !largest) continue;
      Way way{c.name, {}, take(gl::Renderer::create(capabilities))};
      way.options.method = c.method;
      way.renderer.add_scene(s.scene);
      ways.push_back(std::move(way));
    }
    const double share = double(size) * size / pixels;
    measure(ways, camera, one_lamp, o, bar, from + (to - from) * done,
            from + (to - from) * (done + share));
    done += share;
    if (!o.pictures.empty()) {
      for (Way& way : ways)
        write_picture(o, fmt::format("{}-{}-{}", s.name, size, way.name), way, camera, one_lamp);
    }

    const auto size_at = std::find(kPaperSizes.begin(), kPaperSizes.end(), size);
    const Way& none = way_named(ways, "no shadows");
    std::vector<std::string> mean, least, mean_ratio, least_ratio, paper, paper_ratio;
    for (const Column& c : columns) {
      const auto at =
          std::find_if(ways.begin(), ways.end(), [&](const Way& w) { return w.name == c.name; });
      const bool there = at != ways.end();
      mean.push_back(there ? rate(mean_rate(*at)) : "");
      least.push_back(there ? rate(least_rate(*at)) : "");
      mean_ratio.push_back(there ? fmt::format("{:.2f}", mean_rate(*at) / mean_rate(none)) : "");
      least_ratio.push_back(there ? fmt::format("{:.2f}", least_rate(*at) / least_rate(none)) : "");
      if (size_at == kPaperSizes.end()) continue;
      const std::size_t k = std::size_t(size_at - kPaperSizes.begin());
      const double given = c.paper[k], unshadowed = columns.back().paper[k];
      paper.push_back(given > 0 ? rate(given) : "");
      paper_ratio.push_back(given > 0 ? fmt::format("{:.2f}", given / unshadowed) : "");
    }
    table += row(fmt::format("**{0} x {0}**, mean", size), mean);
    table += row("minimum", least);
    table += row("mean over that without shadows", mean_ratio);
    table += row("minimum over that without shadows", least_ratio);
    if (!paper.empty()) {
      table += row("*paper, mean*", paper);
      table += row("*paper, mean over that without shadows*", paper_ratio);
    }

    const Way& alpha = way_named(ways, "alpha buffer");
    const Way& stencil = way_named(ways, "stencil buffer");
    const Way& half = way_named(ways, "half res.");
    const auto times = [](double a, double b) { return fmt::format("{:.2f}", a / b); };
    statements += row(
        fmt::format("{0} x {0}", size),
        {times(mean_rate(alpha), mean_rate(stencil)), times(least_rate(alpha), least_rate(stencil)),
         times(mean_rate(half), mean_rate(alpha)), times(least_rate(half), least_rate(alpha)),
         size_at == kPaperSizes.end()
             ? ""
             : times(columns[1].paper[std::size_t(size_at - kPaperSizes.begin())],
                     columns[2].paper[std::size_t(size_at - kPaperSizes.begin())]),
         size_at == kPaperSizes.end()
             ? ""
             : times(columns[4].paper[std::size_t(size_at - kPaperSizes.begin())],
                     columns[1].paper[std::size_t(size_at - kPaperSizes.begin())])});
    if (largest) frames = what_a_frame_is(ways);
  }
  text +=
      table +
      "\nThe paper's statements, as quotients of frames a second: alpha is slightly faster than "
      "stencil; half resolution improves the minimum \"by an approximate factor of four\".\n\n" +
      header("window", {"alpha / stencil, mean", "minimum", "half / alpha, mean", "minimum",
                        "*paper: alpha / stencil, mean*", "*half / alpha, mean*"}) +
      statements + frames;
  return text;
}

// --- Figure 4 of Everitt and Kilgard, Practical and Robust Stenciled Shadow Volumes, 2002 -----

std::string bench_figure_4(const scenes::PaperScene& s, const FrameBench& o, ProgressBar& bar,
                           const gl::Capabilities& capabilities, double from, double to) {
  constexpr int kWidth = 640, kHeight = 480;
  struct Lights {
    int count;
    double paper;  // frames a second
    const char* paper_says;
  };
  constexpr std::array<Lights, 3> kLights{{{1, 80, "80+"}, {3, 34, "34"}, {12, 8, "8"}}};
  const View view = scenes::view_of(s, kWidth, kHeight);
  const gl::Camera camera = gl::camera_of(view, gl::depth_range(s.scene, view, true));
  std::vector<Way> ways;
  for (const Lights& l : kLights) {
    for (const gl::Shadows shadows : {gl::Shadows::lights, gl::Shadows::none}) {
      Way way{
          fmt::format("{} lights{}", l.count, shadows == gl::Shadows::none ? ", no shadows" : ""),
          {},
          take(gl::Renderer::create(capabilities)),
          l.count};
      way.options.method = o.method;
      way.options.method.mask = gl::MaskIn::stencil;
      way.options.method.shadows = shadows;
      way.renderer.add_scene(s.scene);
      ways.push_back(std::move(way));
    }
  }
  measure(ways, camera, scenes::lamps_of_the_room, o, bar, from, to);
  if (!o.pictures.empty()) {
    for (Way& way : ways)
      write_picture(o, s.name + "-" + way.name, way, camera, scenes::lamps_of_the_room);
  }
  std::string text = fmt::format("\n### {}: {} ({} triangles), {} x {} pixels, stencil\n\n", s.name,
                                 s.what, s.scene.mesh.triangles.size(), kWidth, kHeight);
  text += header("lights", {"mean", "minimum", "no shadows, mean", "mean over that without shadows",
                            "mean over that by 1 light", "*paper*", "*paper over its 1 light*"});
  for (std::size_t i = 0; i < kLights.size(); ++i) {
    const Way &with = ways[2 * i], &without = ways[2 * i + 1];
    text += row(fmt::format("{}", kLights[i].count),
                {rate(mean_rate(with)), rate(least_rate(with)), rate(mean_rate(without)),
                 fmt::format("{:.2f}", mean_rate(with) / mean_rate(without)),
                 fmt::format("{:.2f}", mean_rate(with) / mean_rate(ways[0])), kLights[i].paper_says,
                 i == 0 ? "1" : fmt::format("under {:.2f}", kLights[i].paper / kLights[0].paper)});
  }
  return text + what_a_frame_is(ways);
}

}  // namespace

void add_frame_options(CLI::App& command, FrameBench& o) {
  o.method.reach = gl::Reach::infinite;  // as the papers have it
  command
      .add_option("--frames", o.frames,
                  "Frames of the animation; of the second paper's scenes, suns")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command.add_option("--size", o.sizes, "Only these window sizes of the first paper's table")
      ->check(CLI::Range(16, 16384))
      ->default_str("256 512 1024");
  add_method_options(command, o.method);
  command.add_option("--api", o.api, "gl (OpenGL 3.3) or gles (OpenGL ES 3.0)")
      ->check(CLI::IsMember({"gl", "gles"}))
      ->capture_default_str();
  command.add_option("--pictures", o.pictures,
                     "A folder for a picture of the slowest frame of each cell");
}

std::string bench_frames(const FrameBench& o, ProgressBar& bar, double from, double to) {
  gl::HeadlessContext context =
      take(gl::HeadlessContext::create(o.api == "gles" ? gl::Api::opengl_es : gl::Api::opengl));
  const gl::Capabilities capabilities = take(gl::find_capabilities());
  if (!o.pictures.empty()) take(make_output_folder(o.pictures));
  std::string text = fmt::format(
      "\n## Frames a second\n\n"
      "Driver: {}.\n\n"
      "A frame is from the call of draw() to the end of glFinish(): the lamp has moved, so "
      "silhouettes and volumes are found anew, then all is drawn; the picture is not read back. "
      "An animation is one round of the lamp in {} frames; all columns draw frame 1, then all "
      "draw frame 2, and so on, {} times over. A frame's time is the median of its {}; the mean is "
      "the number of frames over the sum of their times, the minimum that of the slowest frame.\n\n"
      "Shadows are attenuated (one lamp) or light by light (several); masks by {}, faces counted "
      "{}, {} reach; \"stencil buffer\" draws volumes twice, once for what counts up and once for "
      "what "
      "counts down, as the paper did (but without culling: docs/renderer.md), \"two-sided\" once, "
      "alpha and screen once by one blending function for both; half and quarter are of the alpha "
      "buffer. Paper: GeForce2 MX, AMD 800 MHz "
      "(Roettger, Irion, Ertl, Table 2); GeForce4 Ti 4600 (Everitt, Kilgard, Figure 4). The "
      "papers' "
      "scenes are not published; scenes/paper_scenes.h says what is known of them and what stands "
      "in for them.\n",
      gl::describe(capabilities), o.frames, o.rounds, o.rounds, gl::name_of(o.method.arithmetic),
      gl::name_of(o.method.count), gl::name_of(o.method.reach));
  const double share = (to - from) / double(o.scenes.size());
  for (std::size_t i = 0; i < o.scenes.size(); ++i) {
    const std::string& name = o.scenes[i];
    const double begin = from + share * double(i), end = begin + share;
    if (name == "figures") {
      text += bench_figure_4(scenes::figures_in_a_room(), o, bar, capabilities, begin, end);
    } else {
      text += bench_table_2(name == "convex" ? scenes::convex_bodies() : scenes::concave_bodies(),
                            o, bar, capabilities, begin, end);
    }
  }
  return text;
}

}  // namespace gnomon::app
