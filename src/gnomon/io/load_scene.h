// Model files -> one Scene: read, placed, triangulated, welded, with its ground.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gnomon/core/place.h>
#include <gnomon/core/result.h>
#include <gnomon/io/ground.h>
#include <gnomon/scene/scene.h>

namespace gnomon {

struct LoadOptions {
  std::string lod = {};   // CityJSON level of detail to take; empty: per object the highest it has
  char up = 0;            // 'y' or 'z': up axis of formats that do not say (OBJ); 0: y for OBJ
  std::string unit = {};  // "m", "mm", "cm", "ft", "in" of formats that do not say; empty: m
  std::optional<double> north =
      {};                // radians clockwise from the scene's +y to true north; overrides the CRS
  std::string crs = {};  // where the file does not say (a file's own CRS that differs is an error)
  std::optional<Place> site =
      {};                       // where there is no CRS; overrides the place (not the coordinates)
  std::string ground = "auto";  // see GroundOptions::mode
  std::optional<Bounds2> ground_extent = {};  // model CRS coordinates; empty: the model's box and 3
                                              // times its height around it
  std::vector<std::string> cast = {}, no_cast = {}, receive = {};  // globs, see scene/select.h
};

// What was read, per file, for inspect and summary.json.
struct FileReport {
  std::string path, format;       // "CityJSON 2.0", "CityJSONSeq 1.1", "OBJ"
  std::string crs;                // as short_crs; empty where the file has none
  std::vector<std::string> lods;  // found in the file
  std::string lod_used;           // one, or "highest of each object"
  std::size_t objects = 0;        // that carry geometry
  std::size_t surfaces = 0;       // polygons taken
  std::size_t triangles = 0;      // before welding
  std::size_t stored_twice =
      0;  // polygons that the same object holds a second time at the same LoD; counted once
};

struct LoadedScene {
  Scene scene;
  std::vector<FileReport> files;
  GroundReport ground;
  std::size_t zero_area_triangles = 0;
};

// Errors name file and element. Nothing at all to cast a shadow is an error.
Result<LoadedScene> load_scene(const std::vector<std::filesystem::path>& models,
                               const LoadOptions& options);

}  // namespace gnomon
