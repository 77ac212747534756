#include "model_options.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <string>

#include <fmt/format.h>

#include "commands.h"
#include "progress.h"
#include "time_options.h"

namespace gnomon::app {
namespace {

// "house.glb=48.2,16.37" -> "house.glb" and "48.2,16.37"; without a file, the first is empty. Files
// may have the sign in their names, so the last one counts; but PROJ strings (+proj=...) and WKT
// hold signs of their own.
struct ForFile {
  std::string file, value;
};
ForFile split(const std::string& text) {
  const std::size_t quote = text.find('"'), plus = text.find("=+");
  const std::size_t sign = plus != std::string::npos ? plus : text.rfind('=', quote);
  if (sign == std::string::npos || sign == 0 || text[0] == '+' || text.find("://") < sign) {
    return {"", text};
  }
  return {text.substr(0, sign), text.substr(sign + 1)};
}

double read_degrees(const std::string& text) {
  double degrees = 0;
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), degrees);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw Failure(fmt::format("--north '{}' cannot be read: write degrees, as 12.5", text));
  }
  return degrees;
}

char read_up(const std::string& text) {
  if (text != "y" && text != "z") {
    throw Failure(fmt::format("--up '{}' is not known: write y or z", text));
  }
  return text[0];
}

Site read_site(const std::string& text) {
  const auto place = parse_site(text);
  if (!place) throw Failure("--site is empty: write LAT,LON or LAT,LON,HEIGHT");
  return Site(*place, std::count(text.begin(), text.end(), ',') == 1);
}

// An option [FILE=]VALUE that may be repeated: `all` takes the value for every file, `one` for the
// files of that name.
void add_per_file(CLI::App& command, LoadOptions& load, const char* name, const char* type,
                  const char* description, std::function<void(const std::string&)> all,
                  std::function<void(FileOptions&, const std::string&)> one) {
  command
      .add_option_function<std::vector<std::string>>(
          name,
          [&load, all, one](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
              const auto [file, value] = split(text);
              if (file.empty()) {
                all(value);
                continue;
              }
              load.for_files.push_back({.file = file});
              one(load.for_files.back(), value);
            }
          },
          description)
      ->type_name(std::string("[FILE=]") + type)
      ->allow_extra_args(false)
      ->group("Model");
}

void add_placing(CLI::App& command, LoadOptions& load) {
  add_per_file(
      command, load, "--up", "y|z",
      "Up axis of files that do not say (default: the format's usual)",
      [&load](const std::string& v) { load.up = read_up(v); },
      [](FileOptions& f, const std::string& v) { f.up = read_up(v); });
  add_per_file(
      command, load, "--unit", "m|cm|mm|ft|in",
      "Unit of files that do not say (default: the format's own, m)",
      [&load](const std::string& v) { load.unit = v; },
      [](FileOptions& f, const std::string& v) { f.unit = v; });
  add_per_file(
      command, load, "--north", "DEG",
      "True north, clockwise from the model's +y: 30 turns the model 30 degrees anticlockwise "
      "(default: from the file or CRS, else 0)",
      [&load](const std::string& v) { load.north = read_degrees(v) * kDegree; },
      [](FileOptions& f, const std::string& v) { f.north = read_degrees(v) * kDegree; });
  add_per_file(
      command, load, "--crs", "CRS",
      "Coordinate reference system where the file names none, e.g. EPSG:31256",
      [&load](const std::string& v) { load.crs = v; },
      [](FileOptions& f, const std::string& v) { f.crs = v; });
  add_per_file(
      command, load, "--site", "LAT,LON[,HEIGHT]",
      "Place of a model in local coordinates: degrees (north and east positive), metres; without "
      "HEIGHT it stands on the other models' ground",
      [&load](const std::string& v) { load.site = read_site(v); },
      [](FileOptions& f, const std::string& v) { f.site = read_site(v); });
}

double read_time(const std::string& text) {
  double seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw Failure(fmt::format(
        "--time '{}' cannot be read: write seconds of an animation, as 1.5; a time of day "
        "belongs to --at, --from and --to",
        text));
  }
  return seconds;
}

void add_animation(CLI::App& command, LoadOptions& load) {
  add_per_file(
      command, load, "--time", "SECONDS",
      "Animated models stand as they do that long after the animation's start (default: at rest)",
      [&load](const std::string& v) { load.time = read_time(v); },
      [](FileOptions& f, const std::string& v) { f.time = read_time(v); });
  add_per_file(
      command, load, "--animation", "NAME",
      "Animation that --time means, by name or number from 0 (default: the first)",
      [&load](const std::string& v) { load.animation = v; },
      [](FileOptions& f, const std::string& v) { f.animation = v; });
}

void add_footprints(CLI::App& command, FootprintOptions& footprints) {
  constexpr const char* kGroup = "Footprints (GeoJSON, GeoPackage, Shapefile)";
  command.add_option("--layer", footprints.layer, "Layer to read where there are several")
      ->group(kGroup);
  command
      .add_option("--height-attribute", footprints.height,
                  "Attribute with the height above the ground in metres, in place of the usual "
                  "names (height, building:height, ...)")
      ->type_name("NAME")
      ->group(kGroup);
  command
      .add_option("--floors-attribute", footprints.floors,
                  "Attribute with the number of floors, in place of the usual names "
                  "(building:levels, ...)")
      ->type_name("NAME")
      ->group(kGroup);
  command.add_option("--floor-height", footprints.floor_height, "Metres per floor")
      ->check(positive_number())
      ->capture_default_str()
      ->group(kGroup);
  command
      .add_option("--base-attribute", footprints.base,
                  "Attribute with the height of the building's foot (default: the ground below)")
      ->type_name("NAME")
      ->group(kGroup);
}

void add_surfaces(CLI::App& command, LoadOptions& load) {
  constexpr const char* kGroup = "Surface models (GeoTIFF)";
  command
      .add_option_function<std::string>(
          "--surface",
          [&load](const std::string& v) {
            load.surface = v == "cells" ? RasterMesh::cells : RasterMesh::triangles;
          },
          "triangles between the cells' centres (default), or cells: level squares with upright "
          "walls")
      ->check(CLI::IsMember({"triangles", "cells"}))
      ->group(kGroup);
  command
      .add_option("--above-ground", load.above_ground,
                  "Rasters whose values are heights above the ground (of the other models)")
      ->type_name("GLOB")
      ->allow_extra_args(false)
      ->group(kGroup);
}

}  // namespace

void add_model_options(CLI::App& command, ModelOptions& options) {
  LoadOptions& load = options.load;
  constexpr const char* kGroup = "Model";
  command
      .add_option_function<std::vector<std::string>>(
          "MODEL",
          [&options](const std::vector<std::string>& paths) {
            options.models.assign(paths.begin(), paths.end());
          },
          "Model files (CityJSON, OBJ, IFC, glTF, STL, ..., footprints, GeoTIFF); several make one "
          "scene")
      ->required();
  command
      .add_option("--lod", load.lod, "CityJSON level of detail (default: each object's highest)")
      ->group(kGroup);
  add_placing(command, load);
  add_animation(command, load);
  command
      .add_option(
          "--ground", load.ground,
          "auto: the model's terrain, else through the buildings' ground surfaces; Z: level "
          "at that height; none")
      ->type_name("auto|Z|none")
      ->capture_default_str()
      ->group(kGroup);

  const auto add_globs = [&](const char* name, std::vector<std::string>& globs,
                             const char* description) {
    command.add_option(name, globs, description)
        ->type_name("GLOB")
        ->allow_extra_args(false)  // else MODEL... after it would count as patterns
        ->group(kGroup);
  };
  add_globs("--cast", load.cast,
            "Only surfaces whose object, group, material or semantic surface matches cast");
  add_globs("--no-cast", load.no_cast, "Surfaces that match do not cast");
  add_globs("--receive", load.receive, "Only surfaces that match receive shadow");
  add_footprints(command, options.load.footprints);
  add_surfaces(command, load);
}

LoadedScene read_models(const ModelOptions& options, bool quiet, std::optional<Bounds2> bounds) {
  const ProgressLine line(quiet);
  LoadOptions load = options.load;
  if (!load.ground_extent) load.ground_extent = bounds;
  load.progress = [&](const std::string& what) { line.show(what); };
  return take(load_scene(options.models, load));
}

std::string title_of(const ModelOptions& options) {
  std::string title;
  for (const auto& m : options.models) {
    std::string stem = m.stem().string();  // "vienna.city.json" -> "vienna"
    if (const auto dot = stem.rfind(".city"); dot != std::string::npos && dot + 5 == stem.size())
      stem.resize(dot);
    title += (title.empty() ? "" : ", ") + stem;
  }
  return title;
}

}  // namespace gnomon::app
