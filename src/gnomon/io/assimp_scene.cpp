#include <assimp/scene.h>
#include <fmt/format.h>
#include <gnomon/io/assimp_looks.h>
#include <gnomon/io/assimp_rig.h>
#include <gnomon/io/assimp_scene.h>
#include <gnomon/io/choose_animation.h>
#include <gnomon/io/digits.h>
#include <gnomon/io/read_text.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <string_view>
#include <unordered_map>

namespace gnomon {
namespace {

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
  Walk(ModelBuilder& builder, const aiScene& scene, const SceneAxes& axes, bool ifc,
       const ReadOptions& options, const KeyFrames* frames)
      : builder_(builder),
        scene_(scene),
        axes_{axes.x, axes.y, axes.z},
        ifc_(ifc),
        options_(options),
        frames_(frames),
        rig_(options.rig ? *options.rig : own_rig_) {
    rig_.axes = axes_;
    if (options.appearance) looks_.emplace(scene, builder.model);
  }

  std::optional<Error> run() {
    if (!scene_.mRootNode) return std::nullopt;
    if (auto error = add_nodes(scene_, path(), rig_, nodes_)) return error;
    if (auto error = find_pose()) return error;
    if (auto error = visit(*scene_.mRootNode, "", 0, "")) return error;
    report();
    return std::nullopt;
  }

 private:
  const std::string& path() const { return builder_.model.report.path; }

  // The chosen animation, and where all nodes stand.
  std::optional<Error> find_pose() {
    rig_.clip_names = frames_ ? frames_->names : assimp_animation_names(scene_);
    builder_.model.animations = rig_.clip_names.size();
    const auto chosen = choose_animation(rig_.clip_names, options_, path());
    if (!chosen) return chosen.error();
    rig_.chosen = chosen.value();
    if (rig_.chosen && frames_) {
      rig_.clip = frames_->clips[*rig_.chosen];
    } else if (rig_.chosen) {
      auto clip = read_assimp_animation(scene_, *rig_.chosen, path(), nodes_, rig_.nodes,
                                        builder_.model.warnings);
      if (!clip) return clip.error();
      rig_.clip = std::move(clip).value();
    }
    pose_ = rig_.clip && !options_.rig ? pose_at(rig_.nodes, *rig_.clip, options_.time.value_or(0))
                                       : pose_at_rest(rig_.nodes);
    return std::nullopt;
  }

  std::optional<Error> visit(const aiNode& node, std::string object, std::size_t whole,
                             std::string type) {
    const std::uint32_t here = nodes_.of_node.at(&node);
    const std::string_view name = text_of(node.mName);
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
      if (auto error = visit(*node.mChildren[k], object, whole, type)) return error;
    }
    return std::nullopt;
  }

  std::string material_of(const aiMesh& mesh) const {
    if (mesh.mMaterialIndex >= scene_.mNumMaterials) return {};
    aiString name;
    scene_.mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_NAME, name);
    const std::string_view found = text_of(name);
    return found == AI_DEFAULT_MATERIAL_NAME ? std::string() : std::string(found);
  }

  std::optional<Error> add(const aiMesh& mesh, std::uint32_t node, const std::string& object,
                           std::size_t whole, const std::string& type) {
    const std::string_view mesh_name = text_of(mesh.mName);
    const auto where = [&] {
      return fmt::format("{}: object {}, mesh {}", path(), in_quotes(object, 200),
                         in_quotes(mesh_name));
    };
    if (mesh.mNumFaces == 0 || !mesh.mFaces || !mesh.mVertices) {
      if (mesh.mNumVertices > 0) warn_of_points(where(), mesh.mNumVertices);
      return std::nullopt;
    }
    RigPart part = rig_part(mesh, node, nodes_, options_.appearance, rig_.clip.has_value());
    if (rig_.clip && frames_) {
      part.frames = frames_->shapes(*rig_.chosen, options_.appearance);
      if (part.frames[0].points.size() != part.shape.points.size()) {
        return Error{fmt::format("{}: its frames do not fit its triangles; export the model again.",
                                 where())};
      }
    }
    morphs_ = morphs_ || (mesh.mNumAnimMeshes > 0 && !is_morphed(node));
    const RigShape shape = posed(part, pose_);
    const std::vector<Vec3>& at = shape.points;
    const std::uint32_t material = looks_ ? looks_->material(mesh) : kNoMaterial;
    const std::vector<glm::vec2> uv = looks_ ? looks_->uv(mesh) : std::vector<glm::vec2>();
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
          vertex_of[v] = vertex(turned(axes_, at[v]), v);
        }
        ring[0].push_back(vertex_of[v]);
      }
      builder_.polygon(surface, number++, ring);
      if (looks_) look(face, material, uv, shape.normals);
    }
    if (options_.rig) rig_.parts.push_back(std::move(part));
    warn_of_points(where(), points_and_lines);
    return std::nullopt;
  }

  // Of the part that is being read. Those of a rig stay apart.
  std::uint32_t vertex(const Vec3& p, unsigned of_part) {
    if (!options_.rig) return builder_.vertex(p);
    rig_.points.push_back({static_cast<std::uint32_t>(rig_.parts.size()), of_part});
    builder_.model.vertices.push_back(p + Vec3(0));
    return static_cast<std::uint32_t>(rig_.points.size() - 1);
  }

  void look(const aiFace& face, std::uint32_t material, const std::vector<glm::vec2>& uv,
            const std::vector<Vec3>& normals) {
    std::vector<glm::vec2> at;
    std::vector<glm::vec3> upright;
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      if (!uv.empty()) at.push_back(uv[face.mIndices[k]]);
      if (!normals.empty()) upright.emplace_back(turned(axes_, normals[face.mIndices[k]]));
    }
    add_look(builder_.model, material, at, upright);
  }

  bool is_morphed(std::uint32_t node) const {
    if (!rig_.clip) return false;
    return std::any_of(rig_.clip->tracks.begin(), rig_.clip->tracks.end(), [&](const RigTrack& t) {
      return t.of == RigTrack::Of::weights && t.node == node;
    });
  }

  void warn_of_points(const std::string& where, std::size_t count) {
    warn(builder_.model.warnings, "Points and lines cast no shadow and were left out.", where,
         count);
  }

  void report() {
    Model& m = builder_.model;
    if (scene_.mNumAnimations > 0 && !asks_for_animation(options_)) {
      warn(m.warnings,
           "Animations are not played: the model stands as the file has it at rest; --time SECONDS "
           "poses it.",
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
  const std::array<Vec3, 3> axes_;
  bool ifc_;
  const ReadOptions& options_;
  const KeyFrames* frames_;
  Rig own_rig_;
  Rig& rig_;  // the one that is asked for, or our own
  AssimpNodes nodes_;
  RigPose pose_;
  std::optional<AssimpLooks> looks_;
  bool morphs_ = false;
  double largest_ = 0;
  std::unordered_map<std::string, std::uint32_t> polygons_of_;
};

}  // namespace

std::optional<Error> add_assimp_scene(ModelBuilder& builder, const aiScene& scene,
                                      const SceneAxes& axes, bool ifc, const ReadOptions& options,
                                      const KeyFrames* frames) {
  return Walk(builder, scene, axes, ifc, options, frames).run();
}

}  // namespace gnomon
