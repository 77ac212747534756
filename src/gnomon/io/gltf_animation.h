// Animations of a glTF file -> RigClip.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/core/warnings.h>
#include <gnomon/io/gltf_file.h>
#include <gnomon/io/rig.h>

namespace gnomon {

// As animation_names() has them.
std::vector<std::string> gltf_animation_names(const GltfFile& file);

// Number `animation` of them. `node_of`: of the file's nodes in the scene, their index in `nodes`;
// channels of other nodes change nothing. Warnings: channels of anything but translation, rotation,
// scale and weights, and of nodes that have a matrix, which glTF does not allow. Errors name the
// animation and its sampler: times that do not ascend from 0, as many values as do not fit them,
// numbers that are not finite.
Result<RigClip> read_gltf_animation(const GltfFile& file, std::size_t animation,
                                    const std::unordered_map<std::size_t, std::uint32_t>& node_of,
                                    const std::vector<RigNode>& nodes, Warnings& warnings);

}  // namespace gnomon
