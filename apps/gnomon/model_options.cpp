#include "model_options.h"

#include <string>

#include "time_options.h"

namespace gnomon::app {

void add_model_options(CLI::App& command, ModelOptions& options) {
  LoadOptions& load = options.load;
  constexpr const char* kGroup = "Model";
  command
      .add_option_function<std::vector<std::string>>(
          "MODEL",
          [&options](const std::vector<std::string>& paths) {
            options.models.assign(paths.begin(), paths.end());
          },
          "Model files (CityJSON, CityJSONSeq, OBJ); several make one scene")
      ->required();
  command
      .add_option("--lod", load.lod, "CityJSON level of detail (default: each object's highest)")
      ->group(kGroup);
  command
      .add_option_function<std::string>(
          "--up", [&load](const std::string& axis) { load.up = axis[0]; },
          "Up axis of OBJ files (default: y)")
      ->check(CLI::IsMember({"y", "z"}))
      ->group(kGroup);
  command.add_option("--unit", load.unit, "Unit of OBJ files (default: m)")
      ->check(CLI::IsMember({"m", "cm", "mm", "ft", "in"}))
      ->group(kGroup);
  command
      .add_option_function<double>(
          "--north", [&load](double degrees) { load.north = degrees * kDegree; },
          "True north, clockwise from the model's +y (default: from the CRS, else 0)")
      ->type_name("DEG")
      ->group(kGroup);
  command
      .add_option("--crs", load.crs,
                  "Coordinate reference system where the file names none, e.g. EPSG:31256")
      ->group(kGroup);
  command
      .add_option_function<std::string>(
          "--site", [&load](const std::string& text) { load.site = parse_site(text); },
          "Place in degrees (north and east positive) and metres (default: from the CRS)")
      ->type_name("LAT,LON[,HEIGHT]")
      ->group(kGroup);
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
