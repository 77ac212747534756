#include <assimp/scene.h>
#include <fmt/format.h>
#include <gnomon/io/assimp_rig.h>
#include <gnomon/io/choose_animation.h>
#include <gnomon/io/read_text.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gnomon {
namespace {

// Nodes within nodes; deeper ones would overflow the stack, and no modeller makes them.
constexpr int kDeepestNode = 1000;

Mat4 to_double(const aiMatrix4x4& m) {
  return Mat4(m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2,  // glm's matrices go by columns
              m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4);
}

Vec3 to_double(const aiVector3D& v) { return {v.x, v.y, v.z}; }

std::optional<Error> add_node(const aiNode& node, std::int32_t parent, int depth,
                              const std::string& path, Rig& rig, AssimpNodes& nodes) {
  if (depth > kDeepestNode) {
    return Error{fmt::format(
        "{}: node {}: there are more than {} nodes within each other; flatten the model's nodes.",
        path, in_quotes(text_of(node.mName)), kDeepestNode)};
  }
  const auto here = static_cast<std::uint32_t>(rig.nodes.size());
  RigNode& added = rig.nodes.emplace_back();
  added.parent = parent;
  added.matrix = to_double(node.mTransformation);
  nodes.of_node.emplace(&node, here);
  nodes.of_name.try_emplace(std::string(text_of(node.mName)), here);
  for (unsigned k = 0; k < node.mNumChildren; ++k) {
    if (auto error = add_node(*node.mChildren[k], static_cast<std::int32_t>(here), depth + 1, path,
                              rig, nodes)) {
      return error;
    }
  }
  return std::nullopt;
}

bool is_good(const RigTrack& t) {
  const auto finite = [](double d) { return std::isfinite(d); };
  return std::all_of(t.times.begin(), t.times.end(), finite) &&
         std::all_of(t.values.begin(), t.values.end(), finite) &&
         std::is_sorted(t.times.begin(), t.times.end());
}

class ClipReader {
 public:
  ClipReader(const aiScene& scene, const aiAnimation& animation, const AssimpNodes& nodes,
             std::vector<RigNode>& rig_nodes)
      : scene_(scene), animation_(animation), nodes_(nodes), rig_nodes_(rig_nodes) {
    ticks_ = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : kTicksPerSecond;
  }

  bool run() {
    for (unsigned k = 0; k < animation_.mNumChannels; ++k) channel(*animation_.mChannels[k]);
    for (unsigned k = 0; k < animation_.mNumMorphMeshChannels; ++k) {
      morphs(*animation_.mMorphMeshChannels[k]);
    }
    for (const RigTrack& t : clip.tracks) {
      if (!is_good(t)) return false;
      clip.duration = std::max(clip.duration, t.times.back());
    }
    const double said = animation_.mDuration / ticks_;
    if (std::isfinite(said)) clip.duration = std::max(clip.duration, said);
    return true;
  }

  RigClip clip;
  std::size_t left_out = 0;
  std::string first_left_out;

 private:
  void leave_out(std::string_view name) {
    if (left_out++ == 0) first_left_out = name;
  }

  void channel(const aiNodeAnim& c) {
    const auto at = nodes_.of_name.find(std::string(text_of(c.mNodeName)));
    if (at == nodes_.of_name.end()) return leave_out(text_of(c.mNodeName));
    keep_rest(at->second);
    vectors(at->second, RigTrack::Of::translation, c.mPositionKeys, c.mNumPositionKeys);
    vectors(at->second, RigTrack::Of::scale, c.mScalingKeys, c.mNumScalingKeys);
    if (c.mNumRotationKeys == 0) return;
    RigTrack t;
    t.node = at->second;
    t.of = RigTrack::Of::rotation;
    t.width = 4;
    for (unsigned k = 0; k < c.mNumRotationKeys; ++k) {
      const aiQuatKey& key = c.mRotationKeys[k];
      t.times.push_back(key.mTime / ticks_);
      for (const float f : {key.mValue.x, key.mValue.y, key.mValue.z, key.mValue.w}) {
        t.values.push_back(double(f));
      }
    }
    clip.tracks.push_back(std::move(t));
  }

  // What a channel has no keys of stays as the node's matrix has it.
  void keep_rest(std::uint32_t node) {
    RigNode& n = rig_nodes_[node];
    if (!n.matrix) return;
    const Mat4& m = *n.matrix;
    const aiMatrix4x4 single(float(m[0].x), float(m[1].x), float(m[2].x), float(m[3].x),
                             float(m[0].y), float(m[1].y), float(m[2].y), float(m[3].y),
                             float(m[0].z), float(m[1].z), float(m[2].z), float(m[3].z), 0, 0, 0,
                             1);
    aiVector3D scale, translation;
    aiQuaternion rotation;
    single.Decompose(scale, rotation, translation);
    n.translation = to_double(translation);
    n.scale = to_double(scale);
    const Vec4 turn(rotation.x, rotation.y, rotation.z, rotation.w);
    const double length = turn.x * turn.x + turn.y * turn.y + turn.z * turn.z + turn.w * turn.w;
    n.rotation = length > 0 && std::isfinite(length) ? turn : Vec4(0, 0, 0, 1);
  }

  void vectors(std::uint32_t node, RigTrack::Of of, const aiVectorKey* keys, unsigned count) {
    if (count == 0) return;
    RigTrack t;
    t.node = node;
    t.of = of;
    for (unsigned k = 0; k < count; ++k) {
      t.times.push_back(keys[k].mTime / ticks_);
      for (const float f : {keys[k].mValue.x, keys[k].mValue.y, keys[k].mValue.z}) {
        t.values.push_back(double(f));
      }
    }
    clip.tracks.push_back(std::move(t));
  }

  // The channel's name is a node's or a mesh's, with "*" and a number after it or not.
  void morphs(const aiMeshMorphAnim& c) {
    std::string_view name = text_of(c.mName);
    name = name.substr(0, name.find('*'));
    bool any = false;
    for (const auto& [node, index] : nodes_.of_node) {
      for (unsigned k = 0; k < node->mNumMeshes; ++k) {
        if (node->mMeshes[k] >= scene_.mNumMeshes) continue;
        const aiMesh& mesh = *scene_.mMeshes[node->mMeshes[k]];
        if (mesh.mNumAnimMeshes == 0 || c.mNumKeys == 0) continue;
        if (name != text_of(node->mName) && name != text_of(mesh.mName)) continue;
        any = true;
        weights(c, index, mesh.mNumAnimMeshes);
        break;
      }
    }
    if (!any) leave_out(name);
  }

  void weights(const aiMeshMorphAnim& c, std::uint32_t node, std::size_t targets) {
    RigTrack t;
    t.node = node;
    t.of = RigTrack::Of::weights;
    t.width = targets;
    for (unsigned k = 0; k < c.mNumKeys; ++k) {
      const aiMeshMorphKey& key = c.mKeys[k];
      t.times.push_back(key.mTime / ticks_);
      const std::size_t first = t.values.size();
      t.values.resize(first + targets, 0.0);
      for (unsigned v = 0; v < key.mNumValuesAndWeights; ++v) {
        if (key.mValues[v] < targets) t.values[first + key.mValues[v]] = key.mWeights[v];
      }
    }
    clip.tracks.push_back(std::move(t));
  }

  const aiScene& scene_;
  const aiAnimation& animation_;
  const AssimpNodes& nodes_;
  std::vector<RigNode>& rig_nodes_;
  double ticks_;
};

// What the targets of a mesh add to it; Assimp has them whole.
RigShape target_of(const aiMesh& mesh, const aiAnimMesh& target, bool normals) {
  RigShape out;
  if (target.mNumVertices != mesh.mNumVertices) return out;
  for (unsigned k = 0; target.mVertices && k < mesh.mNumVertices; ++k) {
    out.points.push_back(to_double(target.mVertices[k]) - to_double(mesh.mVertices[k]));
  }
  for (unsigned k = 0; normals && target.mNormals && k < mesh.mNumVertices; ++k) {
    out.normals.push_back(to_double(target.mNormals[k]) - to_double(mesh.mNormals[k]));
  }
  return out;
}

}  // namespace

std::string_view text_of(const aiString& s) {
  return {s.data, std::min<std::size_t>(s.length, sizeof s.data - 1)};
}

std::optional<Error> add_nodes(const aiScene& scene, const std::string& path, Rig& rig,
                               AssimpNodes& nodes) {
  return add_node(*scene.mRootNode, -1, 0, path, rig, nodes);
}

std::vector<std::string> assimp_animation_names(const aiScene& scene) {
  std::vector<std::string> names;
  for (unsigned k = 0; k < scene.mNumAnimations; ++k) {
    names.emplace_back(text_of(scene.mAnimations[k]->mName));
  }
  return animation_names(std::move(names));
}

Result<RigClip> read_assimp_animation(const aiScene& scene, std::size_t number,
                                      const std::string& path, const AssimpNodes& nodes,
                                      std::vector<RigNode>& rig_nodes, Warnings& warnings) {
  const aiAnimation& animation = *scene.mAnimations[number];
  ClipReader reader(scene, animation, nodes, rig_nodes);
  if (!reader.run()) {
    return Error{fmt::format(
        "{}: animation {}: its times must ascend, and its values be finite numbers; export the "
        "model again.",
        path, in_quotes(text_of(animation.mName)))};
  }
  warn(warnings, "Channels of animations move nodes that are not in the scene, and were left out.",
       fmt::format("{}: {}", path, in_quotes(reader.first_left_out, 200)), reader.left_out);
  return std::move(reader.clip);
}

RigPart rig_part(const aiMesh& mesh, std::uint32_t node, const AssimpNodes& nodes, bool normals,
                 bool targets) {
  RigPart part;
  part.node = node;
  const bool has_normals = normals && mesh.mNormals;
  part.shape.points.reserve(mesh.mNumVertices);
  for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
    part.shape.points.push_back(to_double(mesh.mVertices[k]));
    if (has_normals) part.shape.normals.push_back(to_double(mesh.mNormals[k]));
  }
  for (unsigned t = 0; targets && t < mesh.mNumAnimMeshes; ++t) {
    part.targets.push_back(target_of(mesh, *mesh.mAnimMeshes[t], has_normals));
  }
  part.weights.assign(part.targets.size(), 0.0);
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    const aiBone& bone = *mesh.mBones[b];
    const auto found = nodes.of_name.find(std::string(text_of(bone.mName)));
    if (found == nodes.of_name.end()) continue;
    const auto here = static_cast<std::uint32_t>(part.bones.size());
    part.bones.push_back({found->second, to_double(bone.mOffsetMatrix)});
    for (unsigned w = 0; w < bone.mNumWeights; ++w) {
      const aiVertexWeight& of = bone.mWeights[w];
      if (of.mVertexId >= mesh.mNumVertices || !(of.mWeight > 0)) continue;
      part.influences.push_back({of.mVertexId, here, double(of.mWeight)});
    }
  }
  return part;
}

}  // namespace gnomon
