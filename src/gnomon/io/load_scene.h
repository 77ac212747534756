// Model files -> one Scene: read, placed, triangulated, welded, with its ground.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <gnomon/core/place.h>
#include <gnomon/core/result.h>
#include <gnomon/io/file_report.h>
#include <gnomon/io/footprint_layer.h>
#include <gnomon/io/ground.h>
#include <gnomon/io/surface_raster.h>
#include <gnomon/scene/scene.h>

namespace gnomon {

// Where the origin of a model in local coordinates stands.
struct Site {
  Place place;
  bool on_ground = false;  // the height is not known: among models that are placed by a CRS it
                           // stands on the ground below it
  Site() = default;
  Site(const Place& at, bool stands_on_ground = false)  // NOLINT: converts by design
      : place(at), on_ground(stands_on_ground) {}
};

// What some files of a scene need to be told, where others do not: as the members of LoadOptions of
// the same names. Empty ones say nothing.
struct FileOptions {
  std::string file = {};  // the file's name, its path as given, or a glob over either
  char up = 0;            // 'y' or 'z'
  std::string unit = {};
  std::optional<double> north = {};  // radians
  std::string crs = {};              // an error where the file names another one itself
  std::optional<Site> site = {};     // an error where the file has a CRS; so is north
  std::optional<double> time = {};
  std::string animation = {};
};

struct LoadOptions {
  std::string lod = {};  // CityJSON level of detail to take; empty: per object the highest it has
  char up = 0;  // 'y' or 'z': up axis of formats that do not say; 0: the format's usual one
  std::string unit = {};  // "m", "mm", "cm", "ft", "in" of formats that do not say; empty: m
  // Radians clockwise from the +y of local coordinates to true north; in a scene where all files
  // have a CRS, of the scene's +y, and overrides the CRS.
  std::optional<double> north = {};
  std::string crs = {};  // of files that do not say (if all say, another one is an error)
  // Of models without CRS. Overrides the place (not the coordinates) where every file has a CRS.
  std::optional<Site> site = {};
  std::vector<FileOptions> for_files = {};  // stronger than the above; the last that matches wins
  FootprintOptions footprints = {};
  RasterMesh surface = RasterMesh::triangles;
  // Fill Scene::appearance, and read pictures and .mtl files for it. No triangle is another one.
  bool appearance = false;
  // Animated models stand as they do then, seconds from the start of the animation; more than its
  // length goes round, less than 0 is an error. Empty: at rest, as the file has them.
  std::optional<double> time = {};
  std::string animation =
      {};  // its name, or its number from 0; empty: the first. Without a time: 0
  std::vector<std::string> above_ground =
      {};                                     // globs over rasters' names: heights above the ground
  std::string ground = "auto";                // see GroundOptions::mode
  std::optional<Bounds2> ground_extent = {};  // scene CRS coordinates; empty: the model's box and 6
                                              // times its height around it
  std::vector<std::string> cast = {}, no_cast = {}, receive = {};  // globs, see scene/select.h
  // Told what begins now, for people: "reading terrain.tif".
  std::function<void(const std::string&)> progress = {};
};

struct LoadedScene {
  Scene scene;
  std::vector<FileReport> files;
  GroundReport ground;
  // Who said where the scene stands and where true north is, for people: "--site", "house.ifc",
  // "meridian convergence of the CRS"; place_by is empty where nobody did.
  std::string place_by, north_by = "assumed; --north DEG says otherwise";
  std::size_t zero_area_triangles = 0;
};

// The scene's CRS is that of the first model that has one, else of the first surface model or
// footprints (a geographic one gives way to its UTM zone); files in other CRSs are moved into it,
// horizontally; local models are put at their site, turned by the meridian convergence. Footprints,
// heights above ground and models without a height are placed last, on the ground of the others. A
// scene without any CRS keeps local coordinates; if its files stand at different sites, it gets the
// UTM zone of the first. docs/placing.md.
//
// Errors name file and element. Nothing at all to cast a shadow is an error, and so are files that
// lie more than 100 km apart.
Result<LoadedScene> load_scene(const std::vector<std::filesystem::path>& models,
                               const LoadOptions& options);

}  // namespace gnomon
