#include <assimp/importerdesc.h>
#include <assimp/scene.h>

#include <assimp/DefaultIOSystem.h>
#include <assimp/config.h>
#include <fmt/format.h>
#include <gnomon/io/assimp_formats.h>
#include <gnomon/io/assimp_model.h>
#include <gnomon/io/assimp_scene.h>
#include <gnomon/io/choose_animation.h>
#include <gnomon/io/collada_links.h>
#include <gnomon/io/digits.h>
#include <gnomon/io/gltf.h>
#include <gnomon/io/key_frames.h>
#include <gnomon/io/mesh_text.h>
#include <gnomon/io/off.h>
#include <gnomon/io/ply.h>
#include <gnomon/io/read_text.h>
#include <gnomon/io/stl.h>
#include <gnomon/io/tried_apart.h>
#include <assimp/Importer.hpp>

#include <cmath>
#include <cstring>
#include <set>
#include <string_view>
#include <utility>

namespace gnomon {
namespace {

// Opens the model itself and nothing else, whatever the file refers to.
class OneFile : public Assimp::DefaultIOSystem {
 public:
  explicit OneFile(std::string path) : path_(std::move(path)) {}
  bool Exists(const char* file) const override {
    return path_ == file && Assimp::DefaultIOSystem::Exists(file);
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return path_ == file && mode[0] == 'r' ? Assimp::DefaultIOSystem::Open(file, mode) : nullptr;
  }

 private:
  std::string path_;
};

// One sentence's end: without trailing space and full stop.
std::string reason(std::string_view text) {
  const std::size_t last = text.find_last_not_of(" \t\r\n.");
  if (last == std::string_view::npos) return "no reason is given";
  return in_quotes(text.substr(0, last + 1), 300);
}

Error cannot_read(const std::string& path, const MeshFormat& format, std::string_view why) {
  return Error{
      fmt::format("{}: cannot be read as {}: {}; check that the file is whole and of this format, "
                  "or export it again.",
                  path, format.name, reason(why))};
}

// A file that an importer would not take for empty.
bool says_there_is_nothing(std::string_view why) {
  return why.find("no faces") != std::string_view::npos ||
         why.find("no meshes") != std::string_view::npos;
}

std::optional<double> number(const aiMetadata* data, const char* key) {
  if (!data) return {};
  std::int32_t whole = 0;
  double d = 0;
  float f = 0;
  if (data->Get(key, whole)) return double(whole);
  if (data->Get(key, d)) return d;
  if (data->Get(key, f)) return double(f);
  return {};
}

// An axis of the file: 0, 1 or 2 and a sign, as FBX states it.
std::optional<Vec3> fbx_axis(const aiMetadata* data, const std::string& name) {
  const auto axis = number(data, name.c_str()), sign = number(data, (name + "Sign").c_str());
  if (!axis || !sign || !(*axis == 0 || *axis == 1 || *axis == 2)) return {};
  Vec3 v(0);
  v[static_cast<int>(*axis)] = *sign < 0 ? -1 : 1;
  return v;
}

// Assimp leaves it to us to apply these. Files that do not say have FBX's own: y up, centimetres.
void apply_fbx_settings(const aiScene& scene, SceneAxes& axes, double& unit) {
  const auto up = fbx_axis(scene.mMetaData, "UpAxis"),
             front = fbx_axis(scene.mMetaData, "FrontAxis"),
             right = fbx_axis(scene.mMetaData, "CoordAxis");
  if (up && front && right && (*up + *front + *right) * (*up + *front + *right) == Vec3(1)) {
    axes = {*right, -*front, *up};  // the front looks at who stands before it, so to the south
  }
  const auto centimetres = number(scene.mMetaData, "UnitScaleFactor");
  if (centimetres && std::isfinite(*centimetres) && *centimetres > 0) unit = *centimetres * 0.01;
}

void warn_of_unused(Warnings& warnings, const std::string& path, const MeshFormat& format, char up,
                    double metres_per_unit) {
  if (up != 0 && format.up == UpAxis::kStated) {
    warn(warnings, "--up was not used: the file or its format says it.", path);
  }
  if (metres_per_unit != 0 && format.unit_stated) {
    warn(warnings, "--unit was not used: the file or its format says it.", path);
  }
}

void set_properties(Assimp::Importer& importer, bool appearance) {
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_TEXTURES, appearance);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_MD3_HANDLE_MULTIPART, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_MD5_NO_ANIM_AUTOLOAD, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_SMD_LOAD_ANIMATION_LIST, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_IFC_SKIP_SPACE_REPRESENTATIONS, true);
}

// Frames of the formats whose other frames Assimp passes over without a word.
std::uint32_t frames_of(const MeshFormat& format, std::string_view bytes) {
  const std::string_view name = format.name;
  const std::size_t at = name == "MD2" ? 40 : name == "MD3" ? 76 : bytes.size();
  std::uint32_t frames = 1;
  if (at + sizeof frames <= bytes.size()) std::memcpy(&frames, bytes.data() + at, sizeof frames);
  return frames;
}

// Metres per unit of the numbers in a Collada or IFC text; Assimp does not tell, so that it is only
// looked for to put a size to a warning: <unit meter="0.01">,
// IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,...).
double text_unit(const MeshFormat& format, std::string_view text) {
  if (format.reader == MeshReader::kDae) {
    constexpr std::string_view kMeter = "meter=\"";
    const std::size_t unit = text.find("<unit"), end = text.find('>', unit);
    if (unit == std::string_view::npos || end == std::string_view::npos) return 1;
    const std::size_t at = text.substr(0, end).find(kMeter, unit);
    if (at == std::string_view::npos) return 1;
    const std::string_view rest = text.substr(at + kMeter.size());
    const double metres = real_number(rest.substr(0, rest.find('"'))).value_or(1);
    return std::isfinite(metres) && metres > 0 ? metres : 1;
  }
  const std::size_t unit = text.find(".LENGTHUNIT.,");
  if (unit == std::string_view::npos) return 1;
  const std::string_view prefix = text.substr(unit + 13);
  return prefix.starts_with(".MILLI.") ? 0.001 : prefix.starts_with(".CENTI.") ? 0.01 : 1.0;
}

// metres_per_unit: of the text's numbers.
void warn_of_lost_digits(Model& model, const MeshFormat& format, std::string_view text,
                         double metres_per_unit) {
  const DigitLoss loss = format.reader == MeshReader::kDae   ? lost_digits_of_collada(text)
                         : format.reader == MeshReader::kIfc ? lost_digits_of_ifc(text)
                                                             : DigitLoss{};
  if (loss.largest * metres_per_unit <= kNoticeableLoss) return;
  warn(model.warnings,
       fmt::format("The file's coordinates carry more digits than the single precision of their "
                   "reader keeps; the largest loss is {:.2g} m.",
                   loss.largest * metres_per_unit),
       model.report.path, loss.numbers);
}

// Limits of a trial: far above what whole files took (a 4 MB IFC: 0.2 s), so that only those that
// never end or grow without bound reach them.
constexpr std::uint64_t kTrialSeconds = 20, kBytesPerSecond = 100'000;
constexpr std::uint64_t kTrialBytes = std::uint64_t{1} << 30, kBytesPerByte = 1000;

const aiScene* import(Assimp::Importer& importer, const std::string& path, bool appearance) {
  set_properties(importer, appearance);
  importer.SetIOHandler(new OneFile(path));  // the importer's own from here on
  return importer.ReadFile(path, 0);
}

std::string failure_of(const Assimp::Importer& importer) {
  const std::string text = importer.GetErrorString();
  return text.empty() ? "no reason is given" : text;
}

Result<Model> read_with_assimp(const std::string& path, std::string_view bytes,
                               const MeshFormat& format, char up, double metres_per_unit,
                               const ReadOptions& options) {
  const std::string problem = tried_apart(
      [&] {
        Assimp::Importer trial;
        return import(trial, path, options.appearance) ? std::string() : failure_of(trial);
      },
      {kTrialSeconds + bytes.size() / kBytesPerSecond, kTrialBytes + bytes.size() * kBytesPerByte});
  if (!problem.empty() && !says_there_is_nothing(problem))
    return cannot_read(path, format, problem);
  Assimp::Importer importer;
  const aiScene* scene = problem.empty() ? import(importer, path, options.appearance) : nullptr;

  ModelBuilder builder;
  Model& model = builder.model;
  model.report.path = path;
  model.report.format = format.name;
  if (!scene) return std::move(model);
  const aiImporterDesc* by = importer.GetImporterInfo(
      static_cast<std::size_t>(importer.GetPropertyInteger("importerIndex")));
  if (!by || !std::string_view(by->mName).starts_with(format.importer)) {
    return cannot_read(path, format,
                       fmt::format("it looks like a file for the {}", by ? by->mName : "?"));
  }

  SceneAxes axes;
  double unit = format.unit;
  if (format.reader == MeshReader::kFbx) apply_fbx_settings(*scene, axes, unit);
  if (format.up == UpAxis::kZTurned && up == 'y') {
    axes = {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}};  // the file's x, y, z are Assimp's x, -z, y
  } else if ((format.up == UpAxis::kZ && up != 'y') || (format.up == UpAxis::kY && up == 'z')) {
    axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  }
  if (!format.unit_stated && metres_per_unit != 0) unit = metres_per_unit;
  model.scale = Vec3(unit, unit, unit);
  warn_of_unused(model.warnings, path, format, up, metres_per_unit);
  std::optional<KeyFrames> frames_of_file;
  if (std::string_view(format.name) == "MD2" && frames_of(format, bytes) > 1 &&
      asks_for_animation(options)) {
    auto read = read_md2_frames(bytes, path);
    if (!read) return read.error();
    frames_of_file = std::move(read).value();
  }
  if (auto error = add_assimp_scene(builder, *scene, axes, format.reader == MeshReader::kIfc,
                                    options, frames_of_file ? &*frames_of_file : nullptr)) {
    return *error;
  }
  const std::uint32_t frames = frames_of(format, bytes);
  if (frames > 1 && !frames_of_file) {
    warn(model.warnings,
         std::string_view(format.name) == "MD2"
             ? "Frames after the first were left out; --time SECONDS takes others."
             : "Frames after the first were left out.",
         path, frames - 1);
  }
  if (format.reader == MeshReader::kDae) {
    const BrokenLinks broken = broken_links_of_collada(bytes);
    warn(model.warnings,
         "Instances of what is not in the file were left out; export the model again, whole and in "
         "one file.",
         fmt::format("{}: {}", path, broken.first), broken.count);
  }
  warn_of_lost_digits(model, format, bytes, text_unit(format, bytes));
  std::set<std::string_view> objects;
  for (const Surface& s : model.surfaces) objects.insert(s.object);
  model.report.objects = objects.size();
  model.report.surfaces = model.polygons.size();
  return std::move(model);
}

}  // namespace

bool is_assimp_file(const std::filesystem::path& path) { return mesh_format(path) != nullptr; }

Result<Model> read_assimp(const std::filesystem::path& path, char up, double metres_per_unit,
                          const ReadOptions& options) {
  const std::string name = path.string();
  const MeshFormat* format = mesh_format(path);
  if (!format) {
    return Error{fmt::format("{}: files with the ending {} are not read as meshes.", name,
                             in_quotes(path.extension().string()))};
  }
  auto text = read_text(path);
  if (!text) return text.error();
  const double unit = metres_per_unit != 0 ? metres_per_unit : format->unit;
  const char file_up = up != 0 ? up : format->up == UpAxis::kY ? 'y' : 'z';
  switch (format->reader) {
    case MeshReader::kGltf: {
      auto model = read_gltf(text.value(), name, options);
      if (model) warn_of_unused(model.value().warnings, name, *format, up, metres_per_unit);
      return model;
    }
    case MeshReader::kStl:
      return read_stl(text.value(), name, file_up, unit);
    case MeshReader::kPly:
      return read_ply(text.value(), name, file_up, unit);
    case MeshReader::kOff:
      return read_off(text.value(), name, file_up, unit);
    default:
      return read_with_assimp(name, text.value(), *format, up, metres_per_unit, options);
  }
}

}  // namespace gnomon
