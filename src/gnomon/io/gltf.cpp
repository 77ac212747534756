#include <fmt/format.h>
#include <gnomon/io/choose_animation.h>
#include <gnomon/io/gltf.h>
#include <gnomon/io/gltf_animation.h>
#include <gnomon/io/gltf_file.h>
#include <gnomon/io/gltf_looks.h>
#include <gnomon/io/gltf_values.h>
#include <gnomon/io/mesh_text.h>
#include <gnomon/io/read_text.h>
#include <gnomon/io/rig.h>

#include <limits>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

namespace gnomon {
namespace {

using cityjson::element;
using cityjson::member;
using Json = nlohmann::json;

// Nodes within nodes; deeper ones would overflow the stack, and no modeller makes them.
constexpr int kDeepestNode = 1000;

// Columns, as in the file.
Mat4 matrix_of(const double* m) {
  return Mat4(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10], m[11], m[12],
              m[13], m[14], m[15]);
}

// The node's own transform: `matrix`, or translation * rotation * scale. Nothing where they are not
// made of finite numbers.
std::optional<RigNode> rig_node(const Json& node) {
  RigNode out;
  if (const Json* matrix = member(&node, "matrix")) {
    const auto m = numbers_of(matrix, 16);
    if (!m) return {};
    out.matrix = matrix_of(m->data());
    return out;
  }
  std::vector<double> t = {0, 0, 0}, r = {0, 0, 0, 1}, s = {1, 1, 1};
  for (const auto& [key, into] : {std::pair<const char*, std::vector<double>*>{"translation", &t},
                                  {"rotation", &r},
                                  {"scale", &s}}) {
    const Json* value = member(&node, key);
    if (!value) continue;
    auto found = numbers_of(value, into->size());
    if (!found) return {};
    *into = std::move(*found);
  }
  const double length = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
  if (!(length > 0) || !std::isfinite(length)) return {};
  out.translation = Vec3(t[0], t[1], t[2]);
  out.rotation = Vec4(r[0], r[1], r[2], r[3]);
  out.scale = Vec3(s[0], s[1], s[2]);
  return out;
}

class GltfReader {
 public:
  GltfReader(const GltfFile& f, const ReadOptions& options)
      : f_(f), options_(options), rig_(options.rig ? *options.rig : own_rig_) {
    nodes_ = member(&f_.json, "nodes");
    meshes_ = member(&f_.json, "meshes");
    Model& m = builder_.model;
    m.report.path = f.path;
    m.report.format = f.glb ? "GLB 2.0" : "glTF 2.0";
    if (options.appearance) looks_.emplace(f, m);
  }

  Result<Model> run() {
    auto roots = find_roots();
    if (!roots) return roots.error();
    for (const std::size_t r : roots.value()) {
      if (auto error = place(r, -1, "", 0, 0)) return *error;
    }
    if (auto error = find_pose()) return *error;
    for (const Placed& p : placed_) {
      if (auto error = add_node(p)) return *error;
    }
    warn_of_nodes_outside();
    Model& m = builder_.model;
    if (!asks_for_animation(options_)) {
      warn(m.warnings,
           "Animations are not played: the model stands as the file has it at rest; --time SECONDS "
           "poses it.",
           f_.path, m.animations);
    }
    const Json* used = member(&f_.json, "extensionsUsed");
    for (std::size_t k = 0; k < size_of(used); ++k) {
      const std::string name = cityjson::text(element(used, k));
      if (name == "EXT_mesh_gpu_instancing" || name == "CESIUM_RTC" || name == "MSFT_lod") {
        warn(m.warnings,
             fmt::format(
                 "The extension {} is not read: the model may stand elsewhere, or stand there "
                 "less often or more than once.",
                 name),
             f_.path);
      }
    }
    std::set<std::string_view> objects;
    for (const Surface& s : m.surfaces) objects.insert(s.object);
    m.report.objects = objects.size();
    m.report.surfaces = m.polygons.size();
    return std::move(m);
  }

 private:
  struct Placed {
    std::size_t node;
    std::uint32_t rig_node;
    std::string object;
    std::size_t whole;  // see Surface
  };

  Error damaged(const std::string& what) const {
    return Error{fmt::format("{}: {}", f_.path, what)};
  }

  // Of the default scene; of files without scenes, all nodes that stand under no other.
  Result<std::vector<std::size_t>> find_roots() const {
    const Json* scenes = member(&f_.json, "scenes");
    std::vector<std::size_t> roots;
    if (size_of(scenes) == 0) {
      std::set<std::size_t> children;
      for (std::size_t k = 0; k < size_of(nodes_); ++k) {
        const Json* below = member(element(nodes_, k), "children");
        for (std::size_t c = 0; c < size_of(below); ++c) {
          if (const auto child = cityjson::index_below(element(below, c), size_of(nodes_))) {
            children.insert(*child);
          }
        }
      }
      for (std::size_t k = 0; k < size_of(nodes_); ++k) {
        if (!children.contains(k)) roots.push_back(k);
      }
      return roots;
    }
    const Json* chosen = member(&f_.json, "scene");
    const auto scene = chosen ? cityjson::index_below(chosen, scenes->size()) : std::size_t{0};
    if (!scene)
      return damaged(fmt::format("\"scene\" must be the number of one of {}, but is {}.",
                                 counted(size_of(scenes), "scene", "scenes"),
                                 cityjson::kind_of(chosen)));
    const Json* list = member(element(scenes, *scene), "nodes");
    for (std::size_t k = 0; k < size_of(list); ++k) {
      const auto node = cityjson::index_below(element(list, k), size_of(nodes_));
      if (!node) {
        return damaged(fmt::format("scene {}: there is no node {}.", *scene,
                                   cityjson::kind_of(element(list, k))));
      }
      roots.push_back(*node);
    }
    return roots;
  }

  void warn_of_nodes_outside() {
    for (std::size_t k = 0; k < size_of(nodes_); ++k) {
      const Json* node = element(nodes_, k);
      if (rig_node_of_.contains(k) || !member(node, "mesh")) continue;
      const std::string name = cityjson::text(member(node, "name"));
      warn(builder_.model.warnings,
           "Nodes with meshes that stand outside the file's default scene were left out.",
           damaged(fmt::format("node {}{}", k, name.empty() ? "" : " " + in_quotes(name, 200)))
               .message);
    }
  }

  // The chosen animation, and where all nodes stand.
  std::optional<Error> find_pose() {
    Warnings& warnings = builder_.model.warnings;
    rig_.clip_names = gltf_animation_names(f_);
    builder_.model.animations = rig_.clip_names.size();
    const auto chosen = choose_animation(rig_.clip_names, options_, f_.path);
    if (!chosen) return chosen.error();
    rig_.chosen = chosen.value();
    if (rig_.chosen) {
      auto clip = read_gltf_animation(f_, *rig_.chosen, rig_node_of_, rig_.nodes, warnings);
      if (!clip) return clip.error();
      rig_.clip = std::move(clip).value();
    }
    pose_ = rig_.clip && !options_.rig ? pose_at(rig_.nodes, *rig_.clip, options_.time.value_or(0))
                                       : pose_at_rest(rig_.nodes);
    return std::nullopt;
  }

  std::optional<Error> place(std::size_t k, std::int32_t parent, std::string object,
                             std::size_t whole, int depth) {
    const Json* node = element(nodes_, k);
    if (rig_node_of_.contains(k)) {
      return damaged(fmt::format("node {} stands under two nodes or within itself.", k));
    }
    if (depth > kDeepestNode) {
      return damaged(fmt::format(
          "node {}: more than {} nodes stand within each other; flatten them.", k, kDeepestNode));
    }
    auto own = node && node->is_object() ? rig_node(*node) : std::nullopt;
    if (!own) {
      return damaged(fmt::format(
          "node {}: its matrix, translation, rotation or scale is not made of finite numbers.", k));
    }
    const auto here = static_cast<std::uint32_t>(rig_.nodes.size());
    own->parent = parent;
    rig_.nodes.push_back(*own);
    rig_node_of_.emplace(k, here);
    const std::string name = cityjson::text(member(node, "name"));
    if (!name.empty()) object += (object.empty() ? "" : "/") + name;
    if (whole == 0) whole = object.size();
    if (member(node, "mesh")) placed_.push_back({k, here, object, whole});
    const Json* children = member(node, "children");
    for (std::size_t c = 0; c < size_of(children); ++c) {
      const auto child = cityjson::index_below(element(children, c), size_of(nodes_));
      if (!child) {
        return damaged(fmt::format("node {}: there is no node {} for its child.", k,
                                   cityjson::kind_of(element(children, c))));
      }
      if (auto error = place(*child, static_cast<std::int32_t>(here), object, whole, depth + 1)) {
        return error;
      }
    }
    return std::nullopt;
  }

  std::optional<Error> add_node(const Placed& p) {
    const Json* node = element(nodes_, p.node);
    const auto m = cityjson::index_below(member(node, "mesh"), size_of(meshes_));
    if (!m) {
      return damaged(fmt::format("node {}: there is no mesh {}.", p.node,
                                 cityjson::kind_of(member(node, "mesh"))));
    }
    const Json* mesh = element(meshes_, *m);
    const Json* primitives = member(mesh, "primitives");
    if (!primitives || !primitives->is_array()) {
      return damaged(fmt::format("mesh {}: \"primitives\" must be a list.", *m));
    }
    const std::string object = p.object.empty() ? fmt::format("node {}", p.node) : p.object;
    for (std::size_t k = 0; k < primitives->size(); ++k) {
      const std::string where =
          fmt::format("object {}, mesh {}, primitive {}", in_quotes(object, 200), *m, k);
      if (auto error = add_primitive(p, *node, *mesh, (*primitives)[k], object, where))
        return error;
    }
    return std::nullopt;
  }

  std::optional<Error> add_primitive(const Placed& p, const Json& node, const Json& mesh,
                                     const Json& primitive, const std::string& object,
                                     const std::string& where) {
    Model& model = builder_.model;
    const Json* attributes = member(&primitive, "attributes");
    const Json* position = member(attributes, "POSITION");
    if (!position) {
      warn(model.warnings, "Primitives without positions were left out.", damaged(where).message);
      return std::nullopt;
    }
    const Json* mode_value = member(&primitive, "mode");
    const auto mode = mode_value ? cityjson::index_below(mode_value, 7) : std::size_t{4};
    if (!mode) return damaged(fmt::format("{}: its mode is not one of glTF's.", where));
    const auto raw = read_accessor(f_, position, "VEC3");
    if (!raw) return raw.error();
    RigPart part;
    part.node = p.rig_node;
    part.shape.points = vectors_of(raw.value());
    const std::size_t count = part.shape.points.size();
    if (looks_) part.shape.normals = looks_->normals(*attributes, count, where);
    if (auto error = find_targets(node, mesh, primitive, part)) return error;
    std::vector<std::uint32_t> indices;
    if (auto error = find_indices(primitive, where, count, indices)) return error;
    if (*mode < 4) {
      warn(model.warnings, "Points and lines cast no shadow and were left out.",
           damaged(where).message,
           *mode == 0   ? indices.size()
           : *mode == 1 ? indices.size() / 2
                        : indices.size());
      return std::nullopt;
    }
    if (*mode == 4 && indices.size() % 3 != 0) {
      warn(model.warnings, "Vertices left over at the end of a list of triangles were left out.",
           damaged(where).message, indices.size() % 3);
    }
    if (auto error = find_skin(node, *attributes, where, part)) return error;
    const RigShape placed = posed(part, pose_);
    std::optional<GltfCorners> corners;
    if (looks_) corners = looks_->corners(primitive, count, where);
    if (auto error = add_triangles(*mode, indices, part.shape.points, placed, object, p.whole, mesh,
                                   primitive, corners, where)) {
      return error;
    }
    if (options_.rig) rig_.parts.push_back(std::move(part));
    return std::nullopt;
  }

  std::optional<Error> find_indices(const Json& primitive, const std::string& where,
                                    std::size_t count, std::vector<std::uint32_t>& indices) const {
    const Json* list = member(&primitive, "indices");
    if (!list) {
      for (std::size_t k = 0; k < count; ++k) indices.push_back(static_cast<std::uint32_t>(k));
      return std::nullopt;
    }
    const auto read = read_accessor(f_, list, "SCALAR");
    if (!read) return read.error();
    for (const double v : read.value()) {
      if (!(v >= 0 && v < double(count) && v == std::floor(v))) {
        return damaged(fmt::format(
            "{}: index {} names vertex {}, but there are {}; the file is damaged, export it again.",
            where, indices.size(), v, count));
      }
      indices.push_back(static_cast<std::uint32_t>(v));
    }
    return std::nullopt;
  }

  // Morph targets; those that have no weight in this pose are not read.
  std::optional<Error> find_targets(const Json& node, const Json& mesh, const Json& primitive,
                                    RigPart& part) const {
    const Json* targets = member(&primitive, "targets");
    const Json* weights =
        member(&node, "weights") ? member(&node, "weights") : member(&mesh, "weights");
    const std::vector<double>& animated = pose_.weights[part.node];
    for (std::size_t k = 0; k < size_of(targets); ++k) {
      part.weights.push_back(cityjson::number(element(weights, k)).value_or(0));
      part.targets.emplace_back();
      const double weight = animated.empty()      ? part.weights[k]
                            : k < animated.size() ? animated[k]
                                                  : 0.0;
      if (weight == 0 && !options_.rig) continue;
      RigShape& target = part.targets.back();
      for (const auto& [key, into] :
           {std::pair<const char*, std::vector<Vec3>*>{"POSITION", &target.points},
            {"NORMAL", &target.normals}}) {
        const Json* of = member(element(targets, k), key);
        if (!of || (into == &target.normals && part.shape.normals.empty())) continue;
        const auto moves = read_accessor(f_, of, "VEC3");
        if (!moves) return moves.error();
        *into = vectors_of(moves.value());
        if (into->size() != part.shape.points.size()) {
          return damaged(
              fmt::format("morph target {} has another number of vertices than its mesh.", k));
        }
      }
    }
    return std::nullopt;
  }

  // Vertices with weights go where their joints are, whatever the node of the mesh is
  // (glTF, 3.7.3).
  std::optional<Error> find_skin(const Json& node, const Json& attributes, const std::string& where,
                                 RigPart& part) const {
    const std::size_t count = part.shape.points.size();
    if (!member(&node, "skin")) return std::nullopt;
    const Json* skins = member(&f_.json, "skins");
    const auto s = cityjson::index_below(member(&node, "skin"), size_of(skins));
    if (!s) return damaged(fmt::format("{}: its skin is not in the file.", where));
    const Json* joints = member(element(skins, *s), "joints");
    std::vector<double> inverse;
    if (const Json* matrices = member(element(skins, *s), "inverseBindMatrices")) {
      auto read = read_accessor(f_, matrices, "MAT4");
      if (!read) return read.error();
      inverse = std::move(read).value();
      if (inverse.size() < 16 * size_of(joints)) {
        return damaged(fmt::format("skin {} has fewer inverseBindMatrices than joints.", *s));
      }
    }
    for (std::size_t j = 0; j < size_of(joints); ++j) {
      const auto joint = cityjson::index_below(element(joints, j), size_of(nodes_));
      const auto found = joint ? rig_node_of_.find(*joint) : rig_node_of_.end();
      if (found == rig_node_of_.end()) {
        return damaged(fmt::format("skin {}: joint {} is no node of the scene.", *s, j));
      }
      part.bones.push_back(
          {found->second, inverse.empty() ? Mat4(1) : matrix_of(inverse.data() + 16 * j)});
    }
    for (int set = 0; member(&attributes, fmt::format("JOINTS_{}", set).c_str()); ++set) {
      const auto of =
          read_accessor(f_, member(&attributes, fmt::format("JOINTS_{}", set).c_str()), "VEC4");
      if (!of) return of.error();
      const auto by =
          read_accessor(f_, member(&attributes, fmt::format("WEIGHTS_{}", set).c_str()), "VEC4");
      if (!by) return by.error();
      if (of.value().size() != 4 * count || by.value().size() != of.value().size()) {
        return damaged(
            fmt::format("{}: it has another number of joints or weights than vertices.", where));
      }
      for (std::size_t k = 0; k < of.value().size(); ++k) {
        const double weight = by.value()[k], bone = of.value()[k];
        if (weight == 0) continue;
        if (!(bone >= 0 && bone < double(part.bones.size()) && bone == std::floor(bone))) {
          return damaged(fmt::format("{}: vertex {} names joint {}, but there are {}.", where,
                                     k / 4, bone, part.bones.size()));
        }
        part.influences.push_back(
            {static_cast<std::uint32_t>(k / 4), static_cast<std::uint32_t>(bone), weight});
      }
    }
    return std::nullopt;
  }

  std::optional<Error> add_triangles(std::size_t mode, const std::vector<std::uint32_t>& indices,
                                     const std::vector<Vec3>& raw, const RigShape& placed,
                                     const std::string& object, std::size_t whole, const Json& mesh,
                                     const Json& primitive,
                                     const std::optional<GltfCorners>& corners,
                                     const std::string& where) {
    const Json* materials = member(&f_.json, "materials");
    const auto material = cityjson::index_below(member(&primitive, "material"), size_of(materials));
    const std::uint32_t surface = builder_.surface(
        object, cityjson::text(member(&mesh, "name")),
        material ? cityjson::text(member(element(materials, *material), "name")) : std::string(),
        "", whole);
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> vertex_of(placed.points.size(), kNone);
    std::uint32_t& number = polygons_of_[object];
    std::vector<std::vector<std::uint32_t>> ring(1);
    const std::size_t step = mode == 4 ? 3 : 1;
    for (std::size_t k = 0; k + 3 <= indices.size(); k += step) {
      const bool odd = mode == 5 && k % 2 == 1;  // every other triangle of a strip is turned
      std::uint32_t of[3] = {indices[mode == 6 ? 0
                                     : odd     ? k + 1
                                               : k],
                             indices[odd ? k : k + 1], indices[k + 2]};
      // Strips turn corners with triangles that have none; they are no part of the surface.
      if (mode == 5 && (of[0] == of[1] || of[1] == of[2] || of[2] == of[0])) continue;
      ring[0].clear();
      for (const std::uint32_t v : of) {
        if (vertex_of[v] == kNone) {
          if (!is_finite(placed.points[v]) || !is_finite(raw[v])) {
            const Vec3& p = raw[v];
            return damaged(fmt::format(
                "{}: vertex {} ({}, {}, {}) is not finite; repair the model and export it again.",
                where, v, p.x, p.y, p.z));
          }
          vertex_of[v] = vertex(z_up(placed.points[v], 'y'), v);
        }
        ring[0].push_back(vertex_of[v]);
      }
      builder_.polygon(surface, number++, ring);
      if (corners) add_look(builder_.model, *corners, placed.normals, of);
    }
    return std::nullopt;
  }

  // Of the part that is being read. Those of a rig stay apart.
  std::uint32_t vertex(const Vec3& p, std::uint32_t of_part) {
    if (!options_.rig) return builder_.vertex(p);
    rig_.points.push_back({static_cast<std::uint32_t>(rig_.parts.size()), of_part});
    builder_.model.vertices.push_back(p + Vec3(0));
    return static_cast<std::uint32_t>(rig_.points.size() - 1);
  }

  const GltfFile& f_;
  const ReadOptions& options_;
  ModelBuilder builder_;
  Rig own_rig_;
  Rig& rig_;  // the one that is asked for, or our own
  RigPose pose_;
  std::optional<GltfLooks> looks_;
  const Json* nodes_ = nullptr;
  const Json* meshes_ = nullptr;
  std::unordered_map<std::size_t, std::uint32_t> rig_node_of_;  // of every node of the scene
  std::vector<Placed> placed_;  // nodes with meshes, in the scene's order
  std::unordered_map<std::string, std::uint32_t> polygons_of_;
};

}  // namespace

Result<Model> read_gltf(std::string_view bytes, const std::string& path,
                        const ReadOptions& options) {
  const auto file = open_gltf(bytes, path);
  if (!file) return file.error();
  return GltfReader(file.value(), options).run();
}

}  // namespace gnomon
