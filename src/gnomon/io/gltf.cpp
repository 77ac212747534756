#include <fmt/format.h>
#include <gnomon/io/gltf.h>
#include <gnomon/io/gltf_file.h>
#include <gnomon/io/mesh_text.h>
#include <gnomon/io/read_text.h>

#include <glm/mat4x4.hpp>
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
using Mat4 = glm::dmat4;

// Nodes within nodes; deeper ones would overflow the stack, and no modeller makes them.
constexpr int kDeepestNode = 1000;

std::size_t size_of(const Json* list) { return list && list->is_array() ? list->size() : 0; }

Vec3 at(const std::vector<double>& numbers, std::size_t k) {
  return {numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]};
}

// `count` finite numbers; nothing if they are not.
std::optional<std::vector<double>> numbers_of(const Json* list, std::size_t count) {
  if (size_of(list) != count) return {};
  std::vector<double> out;
  for (std::size_t k = 0; k < count; ++k) {
    const auto d = cityjson::number(element(list, k));
    if (!d) return {};
    out.push_back(*d);
  }
  return out;
}

// Columns, as in the file.
Mat4 matrix_of(const double* m) {
  return Mat4(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10], m[11], m[12],
              m[13], m[14], m[15]);
}

// The node's own transform: `matrix`, or translation * rotation * scale.
std::optional<Mat4> transform_of(const Json& node) {
  if (const Json* matrix = member(&node, "matrix")) {
    const auto m = numbers_of(matrix, 16);
    if (!m) return {};
    return matrix_of(m->data());
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
  // A quaternion of single precision is not quite of length 1; its direction is meant.
  const double length = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
  if (!(length > 0) || !std::isfinite(length)) return {};
  const double x = r[0] / length, y = r[1] / length, z = r[2] / length, w = r[3] / length;
  return Mat4(s[0] * (1 - 2 * (y * y + z * z)), s[0] * 2 * (x * y + z * w),
              s[0] * 2 * (x * z - y * w), 0, s[1] * 2 * (x * y - z * w),
              s[1] * (1 - 2 * (x * x + z * z)), s[1] * 2 * (y * z + x * w), 0,
              s[2] * 2 * (x * z + y * w), s[2] * 2 * (y * z - x * w),
              s[2] * (1 - 2 * (x * x + y * y)), 0, t[0], t[1], t[2], 1);
}

Vec3 moved(const Mat4& m, const Vec3& p) {
  const Vec4 q = m * Vec4(p, 1.0);
  return {q.x, q.y, q.z};
}

class GltfReader {
 public:
  explicit GltfReader(const GltfFile& f) : f_(f) {
    nodes_ = member(&f_.json, "nodes");
    meshes_ = member(&f_.json, "meshes");
    Model& m = builder_.model;
    m.report.path = f.path;
    m.report.format = f.glb ? "GLB 2.0" : "glTF 2.0";
  }

  Result<Model> run() {
    auto roots = find_roots();
    if (!roots) return roots.error();
    for (const std::size_t r : roots.value()) {
      if (auto error = place(r, Mat4(1), "", 0, 0)) return *error;
    }
    for (const Placed& p : placed_) {
      if (auto error = add_node(p)) return *error;
    }
    warn_of_nodes_outside();
    Model& m = builder_.model;
    warn(m.warnings, "Animations are not played: the model stands as the file has it at rest.",
         f_.path, size_of(member(&f_.json, "animations")));
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
    Mat4 world;
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
      if (world_.contains(k) || !member(node, "mesh")) continue;
      const std::string name = cityjson::text(member(node, "name"));
      warn(builder_.model.warnings,
           "Nodes with meshes that stand outside the file's default scene were left out.",
           damaged(fmt::format("node {}{}", k, name.empty() ? "" : " " + in_quotes(name, 200)))
               .message);
    }
  }

  std::optional<Error> place(std::size_t k, const Mat4& parent, std::string object,
                             std::size_t whole, int depth) {
    const Json* node = element(nodes_, k);
    if (world_.contains(k)) {
      return damaged(fmt::format("node {} stands under two nodes or within itself.", k));
    }
    if (depth > kDeepestNode) {
      return damaged(fmt::format(
          "node {}: more than {} nodes stand within each other; flatten them.", k, kDeepestNode));
    }
    const auto own = node && node->is_object() ? transform_of(*node) : std::nullopt;
    if (!own) {
      return damaged(fmt::format(
          "node {}: its matrix, translation, rotation or scale is not made of finite numbers.", k));
    }
    const Mat4 here = parent * *own;
    world_.emplace(k, here);
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
      if (auto error = place(*child, here, object, whole, depth + 1)) return error;
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
    auto raw = read_accessor(f_, position, "VEC3");
    if (!raw) return raw.error();
    std::vector<double> positions = std::move(raw).value();
    const std::size_t count = positions.size() / 3;
    if (auto error = apply_targets(node, mesh, primitive, positions)) return error;
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
    std::vector<Vec3> placed;
    for (std::size_t k = 0; k < count; ++k) placed.push_back(moved(p.world, at(positions, k)));
    if (auto error = apply_skin(node, *attributes, where, positions, placed)) return error;
    return add_triangles(*mode, indices, positions, placed, object, p.whole, mesh, primitive,
                         where);
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

  // Morph targets, with the weights that the file has at rest.
  std::optional<Error> apply_targets(const Json& node, const Json& mesh, const Json& primitive,
                                     std::vector<double>& positions) const {
    const Json* targets = member(&primitive, "targets");
    const Json* weights =
        member(&node, "weights") ? member(&node, "weights") : member(&mesh, "weights");
    for (std::size_t k = 0; k < size_of(targets); ++k) {
      const double weight = cityjson::number(element(weights, k)).value_or(0);
      const Json* of = member(element(targets, k), "POSITION");
      if (weight == 0 || !of) continue;
      const auto moves = read_accessor(f_, of, "VEC3");
      if (!moves) return moves.error();
      if (moves.value().size() != positions.size()) {
        return damaged(
            fmt::format("morph target {} has another number of vertices than its mesh.", k));
      }
      for (std::size_t c = 0; c < positions.size(); ++c) positions[c] += weight * moves.value()[c];
    }
    return std::nullopt;
  }

  // Vertices with weights go where their joints are, whatever the node of the mesh is
  // (glTF, 3.7.3).
  std::optional<Error> apply_skin(const Json& node, const Json& attributes,
                                  const std::string& where, const std::vector<double>& positions,
                                  std::vector<Vec3>& placed) const {
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
    std::vector<Mat4> bones;
    for (std::size_t j = 0; j < size_of(joints); ++j) {
      const auto joint = cityjson::index_below(element(joints, j), size_of(nodes_));
      const auto found = joint ? world_.find(*joint) : world_.end();
      if (found == world_.end()) {
        return damaged(fmt::format("skin {}: joint {} is no node of the scene.", *s, j));
      }
      bones.push_back(inverse.empty() ? found->second
                                      : found->second * matrix_of(inverse.data() + 16 * j));
    }
    std::vector<Vec3> bent(placed.size(), Vec3(0));
    std::vector<double> sum(placed.size(), 0.0);
    for (int set = 0; member(&attributes, fmt::format("JOINTS_{}", set).c_str()); ++set) {
      const auto of =
          read_accessor(f_, member(&attributes, fmt::format("JOINTS_{}", set).c_str()), "VEC4");
      if (!of) return of.error();
      const auto by =
          read_accessor(f_, member(&attributes, fmt::format("WEIGHTS_{}", set).c_str()), "VEC4");
      if (!by) return by.error();
      if (of.value().size() != 4 * placed.size() || by.value().size() != of.value().size()) {
        return damaged(
            fmt::format("{}: it has another number of joints or weights than vertices.", where));
      }
      for (std::size_t k = 0; k < of.value().size(); ++k) {
        const double weight = by.value()[k], bone = of.value()[k];
        if (weight == 0) continue;
        if (!(bone >= 0 && bone < double(bones.size()) && bone == std::floor(bone))) {
          return damaged(fmt::format("{}: vertex {} names joint {}, but there are {}.", where,
                                     k / 4, bone, bones.size()));
        }
        bent[k / 4] += weight * moved(bones[static_cast<std::size_t>(bone)], at(positions, k / 4));
        sum[k / 4] += weight;
      }
    }
    for (std::size_t k = 0; k < placed.size(); ++k) {
      if (sum[k] != 0) placed[k] = bent[k] / sum[k];
    }
    return std::nullopt;
  }

  std::optional<Error> add_triangles(std::size_t mode, const std::vector<std::uint32_t>& indices,
                                     const std::vector<double>& raw,
                                     const std::vector<Vec3>& placed, const std::string& object,
                                     std::size_t whole, const Json& mesh, const Json& primitive,
                                     const std::string& where) {
    const Json* materials = member(&f_.json, "materials");
    const auto material = cityjson::index_below(member(&primitive, "material"), size_of(materials));
    const std::uint32_t surface = builder_.surface(
        object, cityjson::text(member(&mesh, "name")),
        material ? cityjson::text(member(element(materials, *material), "name")) : std::string(),
        "", whole);
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> vertex_of(placed.size(), kNone);
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
          if (!is_finite(placed[v]) || !is_finite(at(raw, v))) {
            const Vec3 p = at(raw, v);
            return damaged(fmt::format(
                "{}: vertex {} ({}, {}, {}) is not finite; repair the model and export it again.",
                where, v, p.x, p.y, p.z));
          }
          vertex_of[v] = builder_.vertex(z_up(placed[v], 'y'));
        }
        ring[0].push_back(vertex_of[v]);
      }
      builder_.polygon(surface, number++, ring);
    }
    return std::nullopt;
  }

  const GltfFile& f_;
  ModelBuilder builder_;
  const Json* nodes_ = nullptr;
  const Json* meshes_ = nullptr;
  std::unordered_map<std::size_t, Mat4> world_;  // of every node of the scene
  std::vector<Placed> placed_;                   // nodes with meshes, in the scene's order
  std::unordered_map<std::string, std::uint32_t> polygons_of_;
};

}  // namespace

Result<Model> read_gltf(std::string_view bytes, const std::string& path) {
  const auto file = open_gltf(bytes, path);
  if (!file) return file.error();
  return GltfReader(file.value()).run();
}

}  // namespace gnomon
