// gnomon bench: how long this machine takes, in the form of the papers' own tables.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <gnomon/io/atomic_file.h>

#include <bench/report.h>

#include "bench_silhouettes.h"
#include "commands.h"
#include "progress.h"
#include "second_paper.h"
#ifdef GNOMON_HAVE_GL
#include <gnomon/gl/context.h>

#include "bench_frames.h"
#include "bench_sun_frames.h"
#endif

namespace gnomon::app {
namespace {

#ifdef GNOMON_HAVE_GL
constexpr bool kHaveFrames = true;
#else
constexpr bool kHaveFrames = false;
#endif

const std::vector<std::string> kFrameScenes{"convex", "concave", "figures"};
const std::vector<std::string> kSilhouetteScenes{"tower", "industry", "office", "office-all"};
constexpr const char* kViennaFile = "scenes/vienna/vienna.city.jsonl";

struct Options {
  Common common;
  int rounds = 3;
  std::vector<std::string> scenes;  // empty: all there are
  std::vector<std::filesystem::path> models;
  std::string output;
  bool alone = false;  // silhouettes without whole frames
#ifdef GNOMON_HAVE_GL
  FrameBench frames;
#endif
};

std::vector<std::string> all_scenes() {
  std::vector<std::string> out;
  if (kHaveFrames) out = kFrameScenes;
  out.insert(out.end(), kSilhouetteScenes.begin(), kSilhouetteScenes.end());
  out.push_back("vienna");
  return out;
}

std::vector<std::string> chosen(const std::vector<std::string>& scenes,
                                const std::vector<std::string>& of) {
  std::vector<std::string> out;
  for (const std::string& s : scenes) {
    if (std::find(of.begin(), of.end(), s) != of.end()) out.push_back(s);
  }
  return out;
}

void run(const Options& o) {
  const std::vector<std::string> scenes = o.scenes.empty() ? all_scenes() : o.scenes;
  const std::vector<std::string> frame_scenes = chosen(scenes, kFrameScenes);
  const std::vector<std::string> silhouette_scenes = chosen(scenes, kSilhouetteScenes);
  std::vector<std::filesystem::path> models = o.models;
  if (!chosen(scenes, {"vienna"}).empty()) {
    std::error_code unknown;
    if (std::filesystem::exists(kViennaFile, unknown)) {
      models.insert(models.begin(), kViennaFile);
    } else if (!o.scenes.empty()) {
      throw Failure(fmt::format(
          "{} is not there: run the command in the source tree's folder, or give the file by "
          "--model instead of --scene vienna",
          kViennaFile));
    } else {
      Warnings left_out;
      warn(left_out,
           "the scene vienna is left out, whose file is not there; --model FILE gives it "
           "from elsewhere",
           kViennaFile);
      print_warnings(left_out);
    }
  }
  const bool frames = !frame_scenes.empty(), edges = !silhouette_scenes.empty() || !models.empty();
#ifdef GNOMON_HAVE_GL
  if (!frames && o.frames.method.silhouettes != SilhouetteBy::automatic) {
    throw Failure(
        "--silhouettes: the second paper's scenes are measured by every way there is; leave it "
        "out, or add --scene convex, concave or figures, whose silhouettes it chooses");
  }
  if (edges && !o.alone) {
    const auto context =
        gl::HeadlessContext::create(o.frames.api == "gles" ? gl::Api::opengl_es : gl::Api::opengl);
    if (!context) {
      throw Failure(context.error().message +
                    " With --alone, the second paper's scenes are measured without OpenGL.");
    }
  }
#endif
  if (!o.output.empty()) take(AtomicFile::create(o.output));  // can it be written?
  // Read before anything is measured: errors come at once.
  const std::vector<PaperScene> paper_scenes =
      second_paper_scenes(silhouette_scenes, models, o.common.quiet);
  std::string text = fmt::format("# The papers' tables, here\n\nMachine: {}.\n",
                                 bench::to_text(bench::this_machine()));
  {
    ProgressBar bar("bench paper", o.common.quiet);
    const bool sun_frames = kHaveFrames && edges && !o.alone;
    const double whole = frames ? (sun_frames ? 0.5 : 0.8) : 0, alone = sun_frames ? 0.2 : 1;
#ifdef GNOMON_HAVE_GL
    if (frames) {
      FrameBench b = o.frames;
      b.rounds = o.rounds;
      b.threads = o.common.threads;
      b.scenes = frame_scenes;
      text += bench_frames(b, bar, 0, edges ? whole : 1);
    }
#endif
    const double middle = whole + (1 - whole) * alone;
    if (edges) text += bench_silhouettes(paper_scenes, o.rounds, bar, whole, middle);
#ifdef GNOMON_HAVE_GL
    if (sun_frames) {
      text += bench_sun_frames(paper_scenes, o.frames.method, o.frames.api, o.frames.frames,
                               o.rounds, bar, middle, 1);
    }
#endif
  }
  if (o.output.empty()) {
    fmt::print("{}", text);
    return;
  }
  const FileWritten written = take(write_text_file(o.output, text));
  if (!o.common.quiet) fmt::print("  {}\n", written.path.string());
}

}  // namespace

void add_bench(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  Options& o = *options;
  CLI::App* bench = app.add_subcommand("bench", "How long this machine takes");
  bench->require_subcommand(1);
  CLI::App* command = bench->add_subcommand(
      "paper", kHaveFrames ? "Frames a second by OpenGL, and milliseconds for a silhouette, in the "
                             "form of the papers' own tables"
                           : "Milliseconds for a silhouette, in the form of a paper's own tables "
                             "(no frames a second: built without OpenGL)");
  const std::string frames =
                        "convex, concave (first paper, frames a second), figures (third paper)",
                    edges =
                        "tower, industry, office, office-all, vienna (second paper: "
                        "silhouettes alone and, by OpenGL, whole frames)";
  command
      ->add_option("--scene", o.scenes,
                   "Only these scenes: " + (kHaveFrames ? frames + ", " + edges : edges))
      ->check(CLI::IsMember(all_scenes()))
      ->default_str("all");
  command->add_option("--model", o.models,
                      "Files of models whose silhouettes are measured, too, under the sun of "
                      "Vienna, without a ground");
  command
      ->add_option("--rounds", o.rounds,
                   kHaveFrames ? "Times that each frame and each silhouette is measured"
                               : "Times that each silhouette is measured")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag(
      "--alone", o.alone,
      "Of the second paper's scenes only the silhouettes alone, which need no OpenGL");
#ifdef GNOMON_HAVE_GL
  add_frame_options(*command, o.frames);
#endif
  command->add_option("-o,--output", o.output, "The Markdown file (default: standard output)");
  add_common(*command, o.common);
  command->callback([options] { run(*options); });
}

}  // namespace gnomon::app
