// What is suspicious about the files of a scene once they are placed: sizes, heights, options that
// contradict or do nothing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/core/warnings.h>
#include <gnomon/io/scene_file.h>
#include <gnomon/scene/scene.h>

namespace gnomon {

// All of these: files that are read and placed, in the order of Surface::file.

// Warns of files whose size in metres hints at another unit. Error: all of the scene is smaller
// than a millimetre.
std::optional<Error> check_sizes(const std::vector<SceneFile>& files, Warnings& warnings);

// Error: the CRS that was named for the files that name none is not used by any, and is not `crs`,
// the scene's.
std::optional<Error> check_crs_used(const std::vector<SceneFile>& files, bool georeferenced,
                                    const std::string& crs, const LoadOptions& options);

// Warns of options that no file of the scene can use.
void warn_of_unused_options(const std::vector<SceneFile>& files, const LoadOptions& options,
                            Warnings& warnings);

// Warns of surface models over each other: heights above the ground that nobody calls so are taken
// for absolute ones, which looks right at the sea.
void warn_of_overlapping_surfaces(const std::vector<SceneFile>& files, Warnings& warnings);

// Warns of buildings, and of files without city objects as a whole, that stand beyond the scene's
// terrain, in the air or below the ground; where there is no terrain, of files that are far above
// or below the objects beside them. The scene is welded or not, but without made ground.
void warn_of_heights(Scene& scene, const std::vector<SceneFile>& files);

}  // namespace gnomon
