// glTF 2.0 (.gltf, .glb) -> Model, with nodes in double precision.
// Based on: Khronos Group, glTF 2.0 Specification, 2021.
//
// Read here and not by Assimp, which rounds nodes to single precision, drops faces whose indices
// are out of range, and crashes on some damaged files.
#pragma once

#include <string>
#include <string_view>

#include <gnomon/core/result.h>
#include <gnomon/io/model.h>
#include <gnomon/io/read_options.h>

namespace gnomon {

// The default scene: every mesh under every node, once per node; y up becomes z up (x, -z, y), so
// that -z of the file is north. Triangles, strips and fans; skins and morph targets in the pose of
// options.time, else of the file, with a warning where that has animations. Points and lines are
// left out with a warning. Surface::object is "parent/child" of the named nodes ("node 3" where
// none has a name), group the mesh's name. Errors name node, mesh, primitive and vertex; see also
// gltf_file.h.
Result<Model> read_gltf(std::string_view bytes, const std::string& path,
                        const ReadOptions& options = {});

}  // namespace gnomon
