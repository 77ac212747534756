// An animated model, read once and posed at many times: for renderers that play it. (A scene of one
// time is load_scene's, with LoadOptions::time.)
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/core/warnings.h>
#include <gnomon/scene/scene.h>

namespace gnomon {

struct Rig;

struct AnimatedOptions {
  char up = 0;                 // as in LoadOptions
  double metres_per_unit = 0;  // of formats that do not say; 0: the format's usual one
  std::string animation = {};  // its name, or its number from 0; empty: the first
  bool appearance = false;
};

struct AnimatedModel {
  std::vector<std::string> animations;  // their names, in the file's order; may be empty
  std::size_t animation = 0;            // the one that pose() plays
  double duration = 0;                  // of it, seconds

  // At rest, as the file has it, in the model's own coordinates (z up, metres); load_scene, which
  // subtracts Frame::origin and may turn the model, has the same positions there. Vertices of the
  // file are one where they coincide at rest and move together whatever the animation: under the
  // same node, or the same bones with the same weights, with the same changes by morph targets and
  // frames. Where only the former holds, both stay, and an edge between such pairs is two open ones
  // at each time; as the silhouette counts every edge of every triangle, shadows are exact all the
  // same. Triangles that use a vertex twice are left out; others may have no area at some times.
  TriMesh mesh;
  std::vector<std::uint32_t> surface_of;  // per triangle
  std::vector<Surface> surfaces;
  Appearance appearance;  // empty where it was not asked for; normals are those at rest
  Warnings warnings;

  // Positions of mesh at a time, seconds from 0 on; more than the duration goes round. `positions`
  // becomes as long as mesh.positions. From equal files these are the same bits as load_scene's
  // before it subtracts the origin. Several threads may pose one model. What a
  // hostile file moves beyond all bounds is not looked for.
  void pose(double time, std::vector<Vec3>& positions) const;
  // And shading normals, three to a triangle as in appearance.normals, which stay empty where the
  // file has none.
  void pose(double time, std::vector<Vec3>& positions,
            std::vector<std::array<glm::vec3, 3>>& normals) const;

  struct Source;  // what pose() needs
  std::shared_ptr<const Source> source;
};

// Errors as load_scene's for the file; also formats that are never animated. A file of the others
// without an animation gives a model of duration 0 that stands still, with a warning.
Result<AnimatedModel> open_animated(const std::filesystem::path& path,
                                    const AnimatedOptions& options = {});

}  // namespace gnomon
