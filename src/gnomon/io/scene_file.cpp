#include <fmt/format.h>
#include <gnomon/core/nearest_names.h>
#include <gnomon/io/assimp_formats.h>
#include <gnomon/io/assimp_model.h>
#include <gnomon/io/cityjson.h>
#include <gnomon/io/footprint_file.h>
#include <gnomon/io/ifc_place.h>
#include <gnomon/io/obj.h>
#include <gnomon/io/raster_grid.h>
#include <gnomon/io/read_text.h>
#include <gnomon/io/scene_file.h>
#include <gnomon/scene/select.h>

#include <cmath>
#include <set>
#include <utility>

namespace gnomon {
namespace {

// Enough to see what a file is: the first members of a JSON file, the comments that an OBJ begins
// with.
constexpr std::size_t kStart = 65536;

std::optional<double> metres_per(const std::string& unit) {
  if (unit.empty() || unit == "m") return 1.0;
  if (unit == "cm") return 0.01;
  if (unit == "mm") return 0.001;
  if (unit == "ft") return 0.3048;
  if (unit == "in") return 0.0254;
  return std::nullopt;
}

// The name itself goes before the pattern: a file may be called "house [1].glb".
bool names(const std::string& glob, const std::filesystem::path& path) {
  if (std::filesystem::path(glob).lexically_normal() == path.lexically_normal()) return true;
  if (glob == path.filename().string()) return true;
  return glob_matches(glob, path.filename().string()) || glob_matches(glob, path.string());
}

std::optional<Error> check_told(const FileOptions& told) {
  if (told.up != 0 && told.up != 'y' && told.up != 'z') return Error{"--up must be y or z."};
  if (!metres_per(told.unit)) {
    return Error{
        fmt::format("--unit {} is not known; use m, cm, mm, ft or in.", in_quotes(told.unit))};
  }
  if (told.north && !std::isfinite(*told.north)) {
    return Error{"--north must be a finite number of degrees."};
  }
  if (told.time && !(*told.time >= 0 && std::isfinite(*told.time))) {
    return Error{fmt::format("--time {} must be a number of seconds from 0 on.", *told.time)};
  }
  return std::nullopt;
}

std::optional<Error> check_glob(const std::string& glob,
                                const std::vector<std::filesystem::path>& paths,
                                std::string_view option) {
  std::vector<std::string> file_names;
  for (const auto& path : paths) {
    if (names(glob, path)) return std::nullopt;
    file_names.push_back(path.filename().string());
  }
  return Error{fmt::format("{} {}: no model file has this name; the nearest are {}.", option,
                           in_quotes(glob, 200),
                           nearest_names(glob, {file_names.begin(), file_names.end()}))};
}

void tell(SceneFile& file, const FileOptions& more) {
  FileOptions& told = file.told;
  if (more.up != 0) told.up = more.up, file.axes_of_its_own = true;
  if (!more.unit.empty()) told.unit = more.unit, file.axes_of_its_own = true;
  if (more.north) told.north = more.north, file.north_of_its_own = true;
  if (more.site) told.site = more.site, file.site_of_its_own = true;
  if (!more.crs.empty()) told.crs = more.crs, file.crs_of_its_own = true;
  if (more.time) told.time = more.time, file.time_of_its_own = true;
  if (!more.animation.empty()) told.animation = more.animation, file.time_of_its_own = true;
}

// For people: the up axis and the unit, and who says so.
std::string axes_of(const FileOptions& told, char usual_up, std::string_view usual_unit) {
  const char other = usual_up == 'y' ? 'z' : 'y';
  const std::string up =
      told.up == 0 ? fmt::format("{} (assumed; --up {} if the model lies)", usual_up, other)
                   : std::string(1, told.up) + " (--up)";
  const std::string unit = told.unit.empty()
                               ? fmt::format("{} (assumed; --unit says otherwise)", usual_unit)
                               : told.unit + " (--unit)";
  return fmt::format("{} up, unit {}", up, unit);
}

std::string mesh_axes(const std::filesystem::path& path, const FileOptions& told) {
  const MeshFormat* format = mesh_format(path);
  if (format && format->reader == MeshReader::kGltf) {
    return "y up, metres, -z is north (glTF's convention)";
  }
  if (!format || (format->up == UpAxis::kStated && format->unit_stated)) {
    return "up axis and unit as the file or its format says";
  }
  return axes_of(told, format->up == UpAxis::kY ? 'y' : 'z', format->unit == 0.001 ? "mm" : "m");
}

}  // namespace

Result<std::vector<SceneFile>> scene_files(const std::vector<std::filesystem::path>& paths,
                                           const LoadOptions& options) {
  FileOptions common{"",          options.up,   options.unit, options.north,
                     options.crs, options.site, options.time, options.animation};
  if (auto error = check_told(common)) return *error;
  for (const FileOptions& more : options.for_files) {
    if (auto error = check_told(more)) return *error;
    if (auto error = check_glob(more.file, paths, "an option for")) return *error;
  }
  std::vector<SceneFile> files;
  for (const auto& path : paths) {
    const auto start = read_start(path, kStart);
    if (!start) return start.error();
    const auto format = format_of(path, start.value());
    if (!format) {
      return Error{fmt::format("{}: the format is not known; Gnomon reads {}.", path.string(),
                               kFormatsRead)};
    }
    SceneFile& file = files.emplace_back();
    file.path = path;
    file.format = *format;
    file.told = common;
    for (const FileOptions& more : options.for_files) {
      if (names(more.file, path)) tell(file, more);
    }
    for (const std::string& glob : options.above_ground) {
      if (*format == FileFormat::raster && names(glob, path)) file.above_ground = true;
    }
  }
  for (const std::string& glob : options.above_ground) {
    std::vector<std::filesystem::path> rasters;
    for (const SceneFile& f : files) {
      if (f.format == FileFormat::raster) rasters.push_back(f.path);
    }
    if (rasters.empty()) {
      return Error{fmt::format("--above-ground {}: none of the models is a raster; leave it out.",
                               in_quotes(glob, 200))};
    }
    if (auto error = check_glob(glob, rasters, "--above-ground")) return *error;
  }
  return files;
}

AxesKnown axes_known(const SceneFile& file) {
  AxesKnown known;
  if (is_georeferenced(file.format)) return {true, true, 'z'};
  if (file.format == FileFormat::obj) {
    known.usual_up = 'y';
  } else if (const MeshFormat* format = mesh_format(file.path)) {
    known.up = format->up == UpAxis::kStated || format->reader == MeshReader::kGltf;
    known.unit = format->unit_stated || format->reader == MeshReader::kGltf;
    known.usual_up = format->up == UpAxis::kY ? 'y' : 'z';
  }
  known.up = known.up || file.told.up != 0;
  return known;
}

Result<std::string> crs_named_by(const SceneFile& file, const LoadOptions& options) {
  return file.format == FileFormat::raster
             ? crs_of_raster_file(file.path)
             : crs_of_footprint_file(file.path, options.footprints.layer);
}

Result<Model> read_model(const SceneFile& file, const LoadOptions& options,
                         const std::string& target_crs, const GroundAt& ground) {
  const FileOptions& told = file.told;
  const std::string name = file.path.string();
  const double unit = *metres_per(told.unit);
  const ReadOptions more{options.appearance, told.time, told.animation};
  switch (file.format) {
    case FileFormat::raster: {
      RasterOptions raster;
      raster.mesh = options.surface;
      raster.above_ground = file.above_ground;
      return read_surface_raster(file.path, raster, target_crs, told.crs, ground);
    }
    case FileFormat::footprints:
      return read_footprints(file.path, options.footprints, target_crs, told.crs, ground);
    case FileFormat::assimp: {
      auto model = read_assimp(file.path, told.up, told.unit.empty() ? 0.0 : unit, more);
      if (model) model.value().report.axes = mesh_axes(file.path, told);
      return model;
    }
    case FileFormat::ifc: {
      const auto text = read_text(file.path);
      if (!text) return text.error();
      const auto place = read_ifc_place(text.value(), name);
      if (!place) return place.error();
      auto model = read_assimp(file.path, told.up, told.unit.empty() ? 0.0 : unit, more);
      if (model) {
        place_ifc(model.value(), place.value());
        model.value().report.axes = mesh_axes(file.path, told);
      }
      return model;
    }
    case FileFormat::obj: {
      const auto text = read_text(file.path);
      if (!text) return text.error();
      auto model = read_obj(text.value(), name, told.up != 0 ? told.up : 'y', unit, more);
      if (model) model.value().report.axes = axes_of(told, 'y', "m");
      return model;
    }
    case FileFormat::city_json: {
      const auto text = read_text(file.path);
      if (!text) return text.error();
      return read_cityjson(text.value(), name, options.lod, more);
    }
  }
  return Error{name + ": the format is not known."};
}

}  // namespace gnomon
