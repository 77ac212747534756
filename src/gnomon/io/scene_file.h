// One file of a scene: what kind it is, what the user says of it, and its model once it is read.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/io/file_format.h>
#include <gnomon/io/load_scene.h>
#include <gnomon/io/model.h>

namespace gnomon {

struct SceneFile {
  std::filesystem::path path;
  FileFormat format = FileFormat::obj;
  FileOptions told;              // LoadOptions and the for_files that match
  std::string named_crs;         // the CRS that the file names itself; empty: none
  bool site_of_its_own = false;  // told.site, told.north or told.crs come from for_files
  bool north_of_its_own = false;
  bool crs_of_its_own = false;
  bool axes_of_its_own = false;  // told.up, told.unit
  bool time_of_its_own = false;  // told.time, told.animation
  bool above_ground = false;     // a raster of heights above the ground
  std::optional<Model> model;
};

// The files with their formats and what is told of them. Errors: a file that is not there or of no
// known format, a glob of for_files or above_ground that matches no file (names the nearest), a
// unit that is not known.
Result<std::vector<SceneFile>> scene_files(const std::vector<std::filesystem::path>& paths,
                                           const LoadOptions& options);

// What the file or its format says of its axes itself.
struct AxesKnown {
  bool up = false, unit = false;
  char usual_up = 'z';  // where it says nothing
};
AxesKnown axes_known(const SceneFile& file);

// The CRS that a raster or footprints name themselves, without reading more than the header; empty:
// none. Precondition: the format is one of these.
Result<std::string> crs_named_by(const SceneFile& file, const LoadOptions& options);

// Reads the file. `target_crs` and `ground` matter to rasters and footprints alone: their models
// come in that CRS (empty: their own, or the UTM zone), and stand on that ground.
Result<Model> read_model(const SceneFile& file, const LoadOptions& options,
                         const std::string& target_crs, const GroundAt& ground);

}  // namespace gnomon
