// A scene that Assimp has read -> Model. Nothing that it says is believed.
#pragma once

#include <optional>

#include <gnomon/core/result.h>
#include <gnomon/io/assimp_formats.h>
#include <gnomon/io/key_frames.h>
#include <gnomon/io/model.h>
#include <gnomon/io/read_options.h>

struct aiScene;

namespace gnomon {

// Which way the axes of a scene look: rows are the scene's right (x), north (y) and up (z) as
// functions of the coordinates that Assimp hands over.
struct SceneAxes {
  Vec3 x{1, 0, 0}, y{0, 0, -1}, z{0, 1, 0};  // of a scene with y up
};

// Adds all meshes under all nodes, transformed in double precision; bones are applied in the pose
// of options.time, else in that of the file. `frames`: those of an MD2, which Assimp does not hand
// over. Warns of points, lines, animations, of single precision that loses more than
// kNoticeableLoss and, of IFC, of elements that are not built. Errors (file, object, mesh, vertex):
// vertices that are not finite, indices out of range, nodes nested too deeply.
std::optional<Error> add_assimp_scene(ModelBuilder& builder, const aiScene& scene,
                                      const SceneAxes& axes, bool ifc, const ReadOptions& options,
                                      const KeyFrames* frames = nullptr);

}  // namespace gnomon
