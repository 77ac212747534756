// gnomon convert: the scene as Gnomon sees it, for other programs.
#include <algorithm>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <gnomon/core/lower_case.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/io/write_gltf.h>
#include <gnomon/io/write_obj.h>

#include "commands.h"
#include "model_options.h"
#include "signals.h"

namespace gnomon::app {
namespace {

// Vertices of a glTF that are off by more are worth a warning: surveyed models have millimetres.
constexpr double kVisibleRounding = 0.001;  // metres

struct Options {
  Common common;
  ModelOptions models;
  std::string output;
};

std::string lower_extension(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

void check_output(const Options& o) {
  const std::string extension = lower_extension(o.output);
  if (extension != ".glb" && extension != ".gltf" && extension != ".obj") {
    throw Failure(fmt::format(
        "{}: the format is not known; give -o a name that ends in .glb, .gltf or .obj", o.output));
  }
  for (const auto& model : o.models.models) {
    std::error_code ignored;
    if (std::filesystem::equivalent(model, o.output, ignored)) {
      throw Failure(fmt::format(
          "{} would be overwritten by what was read from it: give -o another name", o.output));
    }
  }
}

void run(const Options& o) {
  check_output(o);
  const LoadedScene loaded = read_models(o.models, o.common.quiet);
  const Scene& scene = loaded.scene;
  const std::string software = std::string("gnomon ") + GNOMON_VERSION;
  Warnings warnings = scene.warnings;
  std::vector<FileWritten> files;
  std::size_t objects = 0;
  double rounding = 0;
  const std::string extension = lower_extension(o.output);
  const std::filesystem::path output = o.output;
  set_unfinished({{temporary_of(output),
                   temporary_of(std::filesystem::path(output).replace_extension(".mtl"))},
                  {}});
  if (extension == ".obj") {
    const ObjWritten written = take(write_obj(o.output, scene, software));
    files = {written.obj, written.mtl};
    objects = written.objects;
    rounding = written.largest_rounding;
    append(warnings, written.warnings);
  } else {
    const GltfForm form = extension == ".glb" ? GltfForm::binary : GltfForm::embedded;
    const GltfWritten written = take(write_gltf(o.output, scene, form, software));
    files = {written.file};
    objects = written.objects;
    rounding = written.largest_rounding;
    if (rounding > kVisibleRounding) {
      warn(warnings,
           "glTF's single precision moves vertices of this scene by more than a millimetre; "
           "an .obj keeps them",
           fmt::format("by up to {:.3g} m", rounding));
    }
  }
  note_published();
  if (o.common.quiet) return;
  print_warnings(warnings);
  const Frame& f = scene.frame;
  fmt::print("{} triangles, {} vertices, {} objects; ground: {}\n", scene.mesh.triangles.size(),
             scene.mesh.positions.size(), objects, loaded.ground.kind);
  if (extension == ".obj") {
    fmt::print("coordinates of {}, z up, metres; rounded by at most {:.3g} m\n",
               f.crs.empty() ? "the model (no CRS)" : f.crs, rounding);
    fmt::print("read it with: --up z --ground none{}\n",
               f.crs.empty() ? std::string() : " --crs " + f.crs);
  } else {
    fmt::print(
        "y up, metres from the origin {}, {}, {} ({}); rounded to single precision by at most "
        "{:.3g} m\n",
        f.origin.x, f.origin.y, f.origin.z, f.crs.empty() ? "no CRS" : f.crs, rounding);
    fmt::print("read it with: --ground none{}\n",
               f.place ? fmt::format(" --site={:.9f},{:.9f},{:.3f} --north={:.6f}",
                                     f.place->latitude / kDegree, f.place->longitude / kDegree,
                                     f.place->height, f.true_north / kDegree)
                       : std::string());
  }
  for (const FileWritten& file : files)
    fmt::print("  {}  {:.1f} kB\n", file.path.string(), static_cast<double>(file.bytes) / 1000);
}

}  // namespace

void add_convert(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("convert",
                         "The scene as Gnomon sees it, as glTF or OBJ: look at what was "
                         "read");
  add_model_options(*command, options->models);
  command->add_option("-o,--output", options->output, "File to write: .glb, .gltf or .obj")
      ->required()
      ->group("Output");
  add_common(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace gnomon::app
