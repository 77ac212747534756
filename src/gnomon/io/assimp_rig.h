// Nodes, bones, morph targets and animations of a scene that Assimp has read -> Rig.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/core/warnings.h>
#include <gnomon/io/rig.h>

struct aiMesh;
struct aiNode;
struct aiScene;
struct aiString;

namespace gnomon {

std::string_view text_of(const aiString& s);

// Nodes of the rig, by node and by name (the first of each).
struct AssimpNodes {
  std::unordered_map<const aiNode*, std::uint32_t> of_node;
  std::unordered_map<std::string, std::uint32_t> of_name;
};

// Fills rig.nodes. `path`: for messages. Errors: nodes nested too deeply.
std::optional<Error> add_nodes(const aiScene& scene, const std::string& path, Rig& rig,
                               AssimpNodes& nodes);

// As animation_names() has them.
std::vector<std::string> assimp_animation_names(const aiScene& scene);

// Number `animation` of them, seconds by its ticks (kTicksPerSecond where the file does not say).
// Warnings: channels of nodes or meshes that are not in the scene. Errors: times that do not
// ascend, numbers that are not finite.
Result<RigClip> read_assimp_animation(const aiScene& scene, std::size_t animation,
                                      const std::string& path, const AssimpNodes& nodes,
                                      std::vector<RigNode>& rig_nodes, Warnings& warnings);

inline constexpr double kTicksPerSecond = 25;

// The mesh under a node, with its bones; bones of no node and weights of no vertex move nothing.
// `normals`, `targets`: whether those come along.
RigPart rig_part(const aiMesh& mesh, std::uint32_t node, const AssimpNodes& nodes, bool normals,
                 bool targets);

}  // namespace gnomon
