// How the files of a scene come to their places: in whose coordinates each is, in which CRS they
// meet, and which has to wait for which. docs/placing.md, steps 2 to 5.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/io/scene_file.h>

namespace gnomon {

// Rasters and footprints are read last, into the scene's CRS; all else before anything is placed.
bool is_read_first(const SceneFile& file);

// What a local file says, or is told, of its site and of true north.
std::optional<Site> site_of(const SceneFile& file);
std::optional<double> north_of(const SceneFile& file);

// The CRS of a file's coordinates: its own, or the one it is told; empty for a local model. A local
// format that has a site is not told the CRS that is meant for the others. Precondition, here and
// below: SceneFile::named_crs is known.
std::string crs_of(const SceneFile& file, bool others_georeferenced);

// True if some file has the coordinates of a map, so that local ones have to be placed among them.
bool has_georeferenced(const std::vector<SceneFile>& files);

// The CRS of the scene: that of the first model that has one, else of the first surface model or
// footprints that have one, in degrees its UTM zone; where there is none and local files stand at
// different sites, the UTM zone of the first; else empty. Footprints that are to decide are read
// once for it.
Result<std::string> scene_crs(const std::vector<SceneFile>& files, const LoadOptions& options);

// Files of lower ranks are placed first. Those from kAboveGround on ask for the ground of the
// others. `in_crs`: the scene has a CRS, or will have.
enum {
  kKnown,        // they know their coordinates
  kAtSite,       // local ones at a site with a height
  kAboveGround,  // rasters of heights above the ground
  kFootprints,
  kOnGround,  // local ones at a site whose height is not known
  kRanks
};
int rank_of(const SceneFile& file, bool others_georeferenced, bool in_crs);

// What the user says of the file and what it says itself must not contradict. `in_crs` as above.
std::optional<Error> check_told_place(const SceneFile& file, bool others_georeferenced,
                                      bool in_crs);

// Two CRSs agree if they are the same text, or put the same point at the same place: EPSG:28992 and
// EPSG:7415, which adds heights to it.
bool agree(const std::string& a, const std::string& b, const Vec3& at);

}  // namespace gnomon
