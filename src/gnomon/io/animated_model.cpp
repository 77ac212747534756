#include <fmt/format.h>
#include <gnomon/core/exact.h>
#include <gnomon/io/add_model.h>
#include <gnomon/io/animated_model.h>
#include <gnomon/io/assimp_formats.h>
#include <gnomon/io/assimp_model.h>
#include <gnomon/io/rig.h>
#include <gnomon/io/rig_weld.h>

#include <cmath>
#include <utility>

namespace gnomon {

struct AnimatedModel::Source {
  Rig rig;                               // parts hold the vertices that are kept, and no others
  Vec3 scale;                            // after the axes
  std::vector<std::uint32_t> vertex_of;  // per point of the rig, part after part: in the mesh
  // Per corner of the triangles: the point whose normal it has.
  std::vector<std::array<RigPoint, 3>> corners;
};

namespace {

bool never_animated(const std::filesystem::path& path) {
  const MeshFormat* format = mesh_format(path);
  if (!format) return true;
  switch (format->reader) {
    case MeshReader::kStl:
    case MeshReader::kPly:
    case MeshReader::kOff:
    case MeshReader::kIfc:
      return true;
    default:
      return false;
  }
}

glm::vec3 unit(const Vec3& v) {
  const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  return length > 0 && std::isfinite(length) ? glm::vec3(v / length) : glm::vec3(0);
}

std::vector<RigShape> all_posed(const AnimatedModel::Source& source, double time) {
  const Rig& rig = source.rig;
  const RigPose at = rig.clip ? pose_at(rig.nodes, *rig.clip, time) : pose_at_rest(rig.nodes);
  std::vector<RigShape> shapes;
  for (const RigPart& part : rig.parts) shapes.push_back(posed(part, at));
  return shapes;
}

}  // namespace

Result<AnimatedModel> open_animated(const std::filesystem::path& path,
                                    const AnimatedOptions& options) {
  if (never_animated(path)) {
    return Error{fmt::format(
        "{}: files of this format are never animated; glTF, Collada, FBX, MD2 and others are.",
        path.string())};
  }
  auto source = std::make_shared<AnimatedModel::Source>();
  Rig& rig = source->rig;
  ReadOptions reading;
  reading.appearance = options.appearance;
  reading.animation = options.animation;
  reading.rig = &rig;
  auto read = read_assimp(path, options.up, options.metres_per_unit, reading);
  if (!read) return read.error();
  Model& model = read.value();
  for (const Vec3& v : model.vertices) {
    const Vec3 p = v * model.scale;
    if (!(std::fabs(p.x) <= kLargestCoordinate && std::fabs(p.y) <= kLargestCoordinate &&
          std::fabs(p.z) <= kLargestCoordinate)) {
      return Error{fmt::format("{}: a vertex lies beyond {:g} m; check the file's unit.",
                               path.string(), kLargestCoordinate)};
    }
  }

  AnimatedModel out;
  out.animations = rig.clip_names;
  out.animation = rig.chosen.value_or(0);
  out.duration = rig.clip ? rig.clip->duration : 0;
  source->scale = model.scale;
  Scene scene;
  add_model(scene, model, 0, false);
  if (scene.mesh.triangles.empty()) {
    return Error{fmt::format("{}: there are no surfaces in it.", path.string())};
  }
  if (options.appearance) finish_looks(scene.appearance, scene.mesh.triangles.size());
  if (!rig.clip)
    warn(scene.warnings, "The file has no animations; it stands still.", path.string());

  const RigWeld weld = weld_rig(rig, scene.mesh.positions);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    const Triangle& in = scene.mesh.triangles[t];
    const Triangle v{weld.vertex_of[in[0]], weld.vertex_of[in[1]], weld.vertex_of[in[2]]};
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    kept.push_back(t);
    out.mesh.triangles.push_back(v);
    out.surface_of.push_back(scene.surface_of[t]);
  }
  if (kept.empty()) {
    return Error{fmt::format("{}: none of its surfaces has an area.", path.string())};
  }
  warn(scene.warnings, "Triangles without area were dropped.", path.string(),
       scene.mesh.triangles.size() - kept.size());
  keep_triangles(scene.appearance, kept);
  out.mesh.positions = weld.positions;
  out.surfaces = std::move(scene.surfaces);
  out.appearance = std::move(scene.appearance);
  out.warnings = std::move(scene.warnings);
  if (!out.appearance.normals.empty()) {  // each corner has its own
    for (const std::uint32_t t : kept) {
      const Triangle& in = scene.mesh.triangles[t];
      source->corners.push_back({rig.points[in[0]], rig.points[in[1]], rig.points[in[2]]});
    }
    source->vertex_of = weld.vertex_of;
  } else {
    source->vertex_of = keep_points(rig, weld);
  }
  out.source = std::move(source);
  return out;
}

void AnimatedModel::pose(double time, std::vector<Vec3>& positions) const {
  std::vector<std::array<glm::vec3, 3>> normals;
  pose(time, positions, normals);
}

void AnimatedModel::pose(double time, std::vector<Vec3>& positions,
                         std::vector<std::array<glm::vec3, 3>>& normals) const {
  const Rig& rig = source->rig;
  const std::vector<RigShape> shapes = all_posed(*source, time);
  positions.resize(mesh.positions.size());
  for (std::size_t k = 0; k < rig.points.size(); ++k) {
    const RigPoint& p = rig.points[k];
    positions[source->vertex_of[k]] =
        (turned(rig.axes, shapes[p.part].points[p.vertex]) + Vec3(0)) * source->scale;
  }
  normals.clear();
  for (const auto& corners : source->corners) {
    auto& of = normals.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      const RigShape& shape = shapes[corners[c].part];
      if (!shape.normals.empty()) of[c] = unit(turned(rig.axes, shape.normals[corners[c].vertex]));
    }
  }
}

}  // namespace gnomon
