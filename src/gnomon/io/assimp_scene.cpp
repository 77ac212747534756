#include <assimp/scene.h>
#include <fmt/format.h>
#include <gnomon/io/assimp_scene.h>
#include <gnomon/io/digits.h>
#include <gnomon/io/read_text.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/mat4x4.hpp>
#include <limits>
#include <set>
#include <string_view>
#include <unordered_map>

namespace gnomon {
namespace {

using Mat4 = glm::dmat4;

// Nodes within nodes; deeper ones would overflow the stack, and no modeller makes them.
constexpr int kDeepestNode = 1000;

Mat4 to_double(const aiMatrix4x4& m) {
  return Mat4(m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2,  // glm's matrices go by columns
              m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4);
}

std::string_view text(const aiString& s) {
  return {s.data, std::min<std::size_t>(s.length, sizeof s.data - 1)};
}

bool is_finite(const Vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

// Names that Assimp or an exporter's plumbing made up, not the modeller.
bool made_up(std::string_view name) {
  return name.empty() || name[0] == '$' || name[0] == '<' || name == "ROOT" || name == "RootNode" ||
         name.find("_$AssimpFbx$_") != std::string_view::npos;
}

// "IfcWall" of "IfcWall_Name_GUID".
std::string_view ifc_type(std::string_view name) { return name.substr(0, name.find('_')); }

// True for what stands in an IFC file, but not in the building.
bool is_not_built(std::string_view type) {
  return type == "IfcOpeningElement" || type == "IfcOpeningStandardCase" || type == "IfcSpace" ||
         type == "IfcSpatialZone" || type == "IfcAnnotation" || type == "IfcGrid" ||
         type == "IfcVirtualElement";
}

class Walk {
 public:
  Walk(ModelBuilder& builder, const aiScene& scene, const SceneAxes& axes, bool ifc)
      : builder_(builder), scene_(scene), axes_(axes), ifc_(ifc) {}

  std::optional<Error> run() {
    if (!scene_.mRootNode) return std::nullopt;
    if (auto error = find_bones(*scene_.mRootNode, Mat4(1), 0)) return error;
    if (auto error = visit(*scene_.mRootNode, Mat4(1), "", 0, "")) return error;
    report();
    return std::nullopt;
  }

 private:
  const std::string& path() const { return builder_.model.report.path; }

  // Where every named node stands, for the bones.
  std::optional<Error> find_bones(const aiNode& node, const Mat4& parent, int depth) {
    if (depth > kDeepestNode) {
      return Error{fmt::format(
          "{}: node {}: there are more than {} nodes within each other; flatten the model's nodes.",
          path(), in_quotes(text(node.mName)), kDeepestNode)};
    }
    const Mat4 here = parent * to_double(node.mTransformation);
    node_of_.try_emplace(std::string(text(node.mName)), here);
    for (unsigned k = 0; k < node.mNumChildren; ++k) {
      if (auto error = find_bones(*node.mChildren[k], here, depth + 1)) return error;
    }
    return std::nullopt;
  }

  std::optional<Error> visit(const aiNode& node, const Mat4& parent, std::string object,
                             std::size_t whole, std::string type) {
    const Mat4 here = parent * to_double(node.mTransformation);
    const std::string_view name = text(node.mName);
    if (ifc_) {
      if (name.starts_with("Ifc") && name.find('_') != std::string_view::npos) {
        object = name;
        type = ifc_type(name);
      }
    } else if (!made_up(name)) {
      if (!object.empty()) object += '/';
      object += name;
      if (whole == 0) whole = object.size();
    }
    if (ifc_ && is_not_built(type)) {
      warn(builder_.model.warnings,
           "IFC spaces, openings and other elements that are not built cast no shadow and were "
           "left out.",
           fmt::format("{}: object {}", path(), in_quotes(object, 200)));
      return std::nullopt;
    }
    for (unsigned k = 0; k < node.mNumMeshes; ++k) {
      if (node.mMeshes[k] >= scene_.mNumMeshes) {
        return Error{fmt::format("{}: object {}: there is no mesh {} in the file; export it again.",
                                 path(), in_quotes(object), node.mMeshes[k])};
      }
      if (auto error = add(*scene_.mMeshes[node.mMeshes[k]], here, object, whole, type))
        return error;
    }
    for (unsigned k = 0; k < node.mNumChildren; ++k) {
      if (auto error = visit(*node.mChildren[k], here, object, whole, type)) return error;
    }
    return std::nullopt;
  }

  std::string material_of(const aiMesh& mesh) const {
    if (mesh.mMaterialIndex >= scene_.mNumMaterials) return {};
    aiString name;
    scene_.mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_NAME, name);
    const std::string_view found = text(name);
    return found == AI_DEFAULT_MATERIAL_NAME ? std::string() : std::string(found);
  }

  // The mesh's vertices where the bones have them, in the scene of Assimp: the sum over the bones
  // of weight * (where the bone is) * (mesh to bone). Weights are scaled to a sum of 1.
  std::vector<Vec3> positions(const aiMesh& mesh, const Mat4& node) const {
    std::vector<Vec3> at(mesh.mNumVertices);
    std::vector<Vec3> bent(mesh.mNumBones > 0 ? mesh.mNumVertices : 0, Vec3(0));
    std::vector<double> weight(bent.size(), 0.0);
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const aiBone& bone = *mesh.mBones[b];
      const auto found = node_of_.find(std::string(text(bone.mName)));
      if (found == node_of_.end()) continue;
      const Mat4 m = found->second * to_double(bone.mOffsetMatrix);
      for (unsigned w = 0; w < bone.mNumWeights; ++w) {
        const aiVertexWeight& of = bone.mWeights[w];
        if (of.mVertexId >= mesh.mNumVertices || !(of.mWeight > 0)) continue;
        const aiVector3D& v = mesh.mVertices[of.mVertexId];
        const Vec4 p = m * Vec4(v.x, v.y, v.z, 1.0);
        bent[of.mVertexId] += double(of.mWeight) * Vec3(p.x, p.y, p.z);
        weight[of.mVertexId] += double(of.mWeight);
      }
    }
    for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
      if (!weight.empty() && weight[k] > 0) {
        at[k] = bent[k] / weight[k];
        continue;
      }
      const aiVector3D& v = mesh.mVertices[k];
      const Vec4 p = node * Vec4(v.x, v.y, v.z, 1.0);
      at[k] = Vec3(p.x, p.y, p.z);
    }
    return at;
  }

  std::optional<Error> add(const aiMesh& mesh, const Mat4& node, const std::string& object,
                           std::size_t whole, const std::string& type) {
    const std::string_view mesh_name = text(mesh.mName);
    const auto where = [&] {
      return fmt::format("{}: object {}, mesh {}", path(), in_quotes(object, 200),
                         in_quotes(mesh_name));
    };
    if (mesh.mNumFaces == 0 || !mesh.mFaces || !mesh.mVertices) {
      if (mesh.mNumVertices > 0) warn_of_points(where(), mesh.mNumVertices);
      return std::nullopt;
    }
    bones_ = bones_ || mesh.mNumBones > 0;
    morphs_ = morphs_ || mesh.mNumAnimMeshes > 0;
    const std::vector<Vec3> at = positions(mesh, node);
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> vertex_of(at.size(), kNone);
    const std::uint32_t surface = builder_.surface(
        object, ifc_ ? std::string_view(type) : mesh_name, material_of(mesh), "", whole);
    std::uint32_t& number = polygons_of_[object];
    std::vector<std::vector<std::uint32_t>> ring(1);
    std::size_t points_and_lines = 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices < 3) {
        ++points_and_lines;
        continue;
      }
      ring[0].clear();
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        const unsigned v = face.mIndices[k];
        if (v >= mesh.mNumVertices) {
          return Error{
              fmt::format("{}: face {} names vertex {}, but there are {}; export the model again.",
                          where(), f, v, mesh.mNumVertices)};
        }
        if (vertex_of[v] == kNone) {
          const aiVector3D& raw = mesh.mVertices[v];
          if (!is_finite(at[v])) {
            return Error{fmt::format(
                "{}: vertex {} ({}, {}, {}) is not finite; repair the model and export it again.",
                where(), v, raw.x, raw.y, raw.z)};
          }
          for (int c = 0; c < 3; ++c) {
            largest_ =
                std::max({largest_, std::fabs(at[v][c]), std::fabs(double(raw[unsigned(c)]))});
          }
          vertex_of[v] = builder_.vertex(
              Vec3(glm_dot(axes_.x, at[v]), glm_dot(axes_.y, at[v]), glm_dot(axes_.z, at[v])));
        }
        ring[0].push_back(vertex_of[v]);
      }
      builder_.polygon(surface, number++, ring);
    }
    warn_of_points(where(), points_and_lines);
    return std::nullopt;
  }

  static double glm_dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

  void warn_of_points(const std::string& where, std::size_t count) {
    warn(builder_.model.warnings, "Points and lines cast no shadow and were left out.", where,
         count);
  }

  void report() {
    Model& m = builder_.model;
    if (scene_.mNumAnimations > 0) {
      warn(m.warnings, "Animations are not played: the model stands as the file has it at rest.",
           path(), scene_.mNumAnimations);
    }
    if (morphs_) {
      warn(m.warnings, "Morph targets are not applied: the model has its basic shape.", path());
    }
    // Half a unit in the last place of the largest number, in metres.
    const double loss = std::ldexp(largest_, -24) * m.scale.x;
    if (loss > kNoticeableLoss) {
      warn(m.warnings,
           fmt::format("Coordinates reach {:.0f} m from the origin, and their reader keeps single "
                       "precision, which moves vertices by up to {:.2g} m; move the model near the "
                       "origin, or export glTF with the offset in a node.",
                       largest_ * m.scale.x, loss),
           path());
    }
  }

  ModelBuilder& builder_;
  const aiScene& scene_;
  const SceneAxes& axes_;
  bool ifc_;
  bool bones_ = false, morphs_ = false;
  double largest_ = 0;
  std::unordered_map<std::string, Mat4> node_of_;
  std::unordered_map<std::string, std::uint32_t> polygons_of_;
};

}  // namespace

std::optional<Error> add_assimp_scene(ModelBuilder& builder, const aiScene& scene,
                                      const SceneAxes& axes, bool ifc) {
  return Walk(builder, scene, axes, ifc).run();
}

}  // namespace gnomon
