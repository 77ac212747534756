// Which parts are counted z-pass or z-fail, as one or by polygon, with all triangles or half.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <gnomon/core/exact.h>
#include <gnomon/gl/renderer_state.h>
#include <gnomon/volume/near_clip.h>

namespace gnomon::gl {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

SceneBox box_of(std::span<const Vec3> points) {
  SceneBox box{points[0], points[0]};
  for (const Vec3& p : points) {
    box.lo = glm::min(box.lo, p);
    box.hi = glm::max(box.hi, p);
  }
  return box;
}

bool overlap(const SceneBox& box, const Vec3& lo, const Vec3& hi) {
  return box.lo.x <= hi.x && lo.x <= box.hi.x && box.lo.y <= hi.y && lo.y <= box.hi.y &&
         box.lo.z <= hi.z && lo.z <= box.hi.z;
}

bool along_view(const Camera& camera, const Light& light) {
  return camera.eye.w == 0 && light.w == 0 &&
         glm::cross(Vec3(camera.eye), Vec3(light)) == Vec3(0.0);
}

// Points thrown from the light onto the near plane lose as many bits as the light's distance from
// it is smaller than the coordinates: floats keep 24, and a picture needs 12.
bool in_near_plane(const Camera& camera, const Light& light) {
  const glm::dmat4 rows = glm::transpose(camera.clip);
  const Vec4 plane = rows[3] + rows[2];
  double size = 0;
  for (int i = 0; i < 4; ++i) size += std::fabs(plane[i] * light[i]);
  return std::fabs(glm::dot(plane, light)) <= 0x1p-12 * size;
}

constexpr double kReachSlack = 1e-6;   // of a radius: far above rounding, far below a pixel
constexpr double kLarge = 16777216.0;  // "Accelerated Stencil Shadow Extrusion": LARGE
// How far beyond everything that is seen the bounding plane lies: this share of the scene's
// diagonal, and so many steps of the depth buffer at the farthest of it.
constexpr double kBoundMargin = 0x1p-13;
// The light's distance from the highest caster, of that from the plane, and the sine of a sun's
// height over it, are more than this: floats hold the points on the plane to 2^-24 of their
// distance from the caster over it, 2^-14.
constexpr double kBoundClear = 0x1p-10;
constexpr double kBoundSteps = 8;

// Round boxes of all instances, which are given in their meshes' coordinates.
SceneBox box_round(const Frame& frame, Vec3 GpuMesh::*lo, Vec3 GpuMesh::*hi) {
  SceneBox out{Vec3(kInf), Vec3(-kInf)};
  for (const InstanceSlot& instance : frame.state->instances) {
    if (!instance.alive) continue;
    const GpuMesh& mesh = frame.state->meshes[instance.mesh].gpu;
    if (!((mesh.*lo).x <= (mesh.*hi).x)) continue;
    for (const Vec3& corner : corners_of({mesh.*lo, mesh.*hi})) {
      const Vec3 p(instance.to_scene * point(corner));
      out.lo = glm::min(out.lo, p);
      out.hi = glm::max(out.hi, p);
    }
  }
  return out;
}

SceneBox casters_of(const Frame& frame) {
  return box_round(frame, &GpuMesh::caster_lo, &GpuMesh::caster_hi);
}

// A plane h with light, near rectangle, receivers and casters on its positive side (h . X > 0) and
// every ray from the light through a caster crossing it: of the six sides of the box round
// receivers, casters and near rectangle, moved outwards, the one that the light meets most
// directly.
struct Bound {
  Vec4 plane;
  // h . X of whatever receives, and of the near rectangle, is no less than this; -infinite where
  // the near rectangle reaches beyond the receivers.
  double receivers = 0;
};
std::optional<Bound> bounding_plane(const Frame& frame, const Light& light) {
  const auto [lo, hi] = receivers_of(frame);
  const auto [caster_lo, caster_hi] = casters_of(frame);
  if (!(lo.x <= hi.x) || !(caster_lo.x <= caster_hi.x)) return {};
  // One step of a 24-bit depth buffer at the farthest corner, in metres.
  const Camera& camera = *frame.camera;
  const glm::dmat4 rows = glm::transpose(camera.clip);
  double step = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p((i & 1) != 0 ? hi.x : lo.x, (i & 2) != 0 ? hi.y : lo.y,
                 (i & 4) != 0 ? hi.z : lo.z);
    const double z = glm::dot(rows[2], point(p)), w = glm::dot(rows[3], point(p));
    if (!(w > 0)) continue;
    // d(z/w) along the axis of view, per metre.
    const Vec3 slope = (Vec3(rows[2]) * w - Vec3(rows[3]) * z) / (w * w);
    step = std::max(step, 0x1p-23 / glm::length(slope));
  }
  const double margin = glm::distance(lo, hi) * kBoundMargin + kBoundSteps * step;
  const auto near_low = [&](int axis, double sign) {
    double low = kInf;
    for (const Vec3& p : camera.near_rectangle) low = std::min(low, sign * p[axis]);
    return low;
  };
  std::optional<Bound> best;
  double most = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Vec4 h(0, 0, 0, 0);
      h[axis] = sign;
      const double low =
          sign > 0 ? std::min(lo[axis], caster_lo[axis]) : -std::max(hi[axis], caster_hi[axis]);
      const double near = near_low(axis, sign);
      h.w = -(std::min(low, near) - margin);
      const double top = sign > 0 ? caster_hi[axis] : -caster_lo[axis];  // of casters
      const double side = glm::dot(h, light);
      // A point light keeps its distance from the highest caster, a sun an angle from the plane.
      const double clear =
          light.w != 0 ? (side - (top + h.w)) / side : side / glm::length(Vec3(light));
      if (!(side > 0) || !(clear > kBoundClear) || clear < most) continue;
      most = clear;
      const double receivers = sign > 0 ? lo[axis] : -hi[axis];
      best = Bound{h, near > receivers ? receivers + h.w : -kInf};
    }
  }
  return best;
}

// Points behind vertices, in the mesh's coordinates; `bound` in the scene's.
glm::mat4 projection(const Light& light, const Method& m, const std::optional<Bound>& bound,
                     const glm::dmat4& to_scene) {
  glm::dmat4 out(0.0);
  if (m.reach == Reach::bounded) {
    // X' = (h.L) X - (h.X) L, divided by h.L.
    const Vec4 h = bound->plane * to_scene;  // row times matrix
    const double side = glm::dot(h, light);
    for (int column = 0; column < 4; ++column) {
      for (int row = 0; row < 4; ++row)
        out[column][row] = (column == row ? 1.0 : 0.0) - light[row] * h[column] / side;
    }
    return glm::mat4(out);
  }
  const bool large = m.extrusion == Extrusion::blend_large;
  const double k = large ? kLarge : 1.0;
  for (int i = 0; i < 3; ++i) {
    out[i][i] = light.w * k;
    out[3][i] = -light[i] * k;
  }
  out[3][3] = large ? 1.0 : 0.0;
  return glm::mat4(out);
}

// Precondition: `rows` of the matrix from the mesh's coordinates to clip space.
void find_planes(LightPlan::OfInstance& out, const glm::dmat4& rows, const GpuMesh& mesh) {
  if (!(mesh.caster_lo.x <= mesh.caster_hi.x)) return;
  for (const Vec3& corner : corners_of({mesh.caster_lo, mesh.caster_hi})) {
    out.beyond_far |= glm::dot(rows[3] - rows[2], point(corner)) < 0;
    out.before_near |= glm::dot(rows[3] + rows[2], point(corner)) < 0;
  }
}

}  // namespace

SceneBox receivers_of(const Frame& frame) { return box_round(frame, &GpuMesh::lo, &GpuMesh::hi); }

Frame within_reach(const Frame& frame, const LightSource& light) {
  if (light.light.w == 0 || !(light.radius > 0)) return frame;
  const Camera& camera = *frame.camera;
  const Vec3 at = Vec3(light.light) / light.light.w;
  const SceneBox ball{at - light.radius, at + light.radius};
  const Rect rectangle = rectangle_round(camera, ball);
  Frame out = frame;
  out.scissor = frame.scissor ? common(*frame.scissor, rectangle) : rectangle;
  double nearest = kInf, farthest = -kInf;
  for (const Vec3& corner : corners_of(ball)) {
    const Vec4 p = camera.clip * point(corner);
    if (!(p.w > 0)) return out;  // the ball's box meets the eye's plane: no bound of depths
    nearest = std::min(nearest, p.z / p.w);
    farthest = std::max(farthest, p.z / p.w);
  }
  constexpr double kSteps = 0x1p-22;  // a few steps of 24 bits
  out.depth_bounds = {std::clamp(nearest / 2 + 0.5 - kSteps, 0.0, 1.0),
                      std::clamp(farthest / 2 + 0.5 + kSteps, 0.0, 1.0)};
  return out;
}

Result<LightPlan> plan_light(const Frame& frame, const Light& asked, double radius,
                             std::uint32_t number, const Method& wanted,
                             const TargetFacts& target) {
  const Light light = clear_of_casters(frame, asked);
  const Renderer::State& state = *frame.state;
  const Camera& camera = *frame.camera;
  LightPlan plan;
  plan.light = light;
  plan.number = number;

  Situation s;
  s.parallel_view = camera.eye.w == 0;
  s.light_along_view = along_view(camera, light);
  s.light_in_near_plane = in_near_plane(camera, light);
  s.directional_light = light.w == 0;
  s.target_stencil = target.stencil;
  s.target_alpha = target.alpha;
  s.infinite_view = camera.infinite;
  s.lights = target.lights;
  s.foreign_receivers = target.foreign;

  plan.instances.resize(state.instances.size());
  std::vector<std::vector<bool>> shades(state.instances.size());
  for (std::size_t i = 0; i < state.instances.size(); ++i) {
    const InstanceSlot& instance = state.instances[i];
    if (!instance.alive) continue;
    const GpuMesh& mesh = state.meshes[instance.mesh].gpu;
    LightPlan::OfInstance& out = plan.instances[i];
    const bool moved = instance.to_scene != glm::dmat4(1.0);
    const glm::dmat4 to_mesh = moved ? glm::inverse(instance.to_scene) : glm::dmat4(1.0);
    out.light = snapped(moved ? to_mesh * light : light);
    if (out.light.w != 0) out.light /= out.light.w;
    std::array<Vec3, 4> rectangle = camera.near_rectangle;
    if (moved) {
      for (Vec3& p : rectangle) p = Vec3(to_mesh * point(p));
    }
    const SceneBox near_box = box_of(rectangle);
    out.near = near_clip_volume(rectangle, out.light);
    const SceneBox light_box{Vec3(out.light), Vec3(out.light)};
    find_planes(out, glm::transpose(camera.clip * instance.to_scene), mesh);
    if (target.foreign || culls_back_faces(frame, instance, mesh))
      out.caps_in_front = CapsInFront::seen_from_behind;
    out.parts.resize(mesh.parts.parts.size());
    shades[i].resize(mesh.parts.parts.size());
    for (std::size_t p = 0; p < mesh.parts.parts.size(); ++p) {
      const Part& part = mesh.parts.parts[p];
      PartPlan& pp = out.parts[p];
      shades[i][p] = may_shade_near(out.near, part.lo, part.hi) &&
                     may_any_shade_near(out.near, mesh.mesh, part.triangles);
      if (shades[i][p]) s.near_shaded = true;
      if (mesh.part_seen[p] == 0) out.caps_in_front = CapsInFront::all;
      // What a light of a radius cannot reach shades nothing that it reaches.
      const double scale = std::cbrt(std::fabs(glm::determinant(glm::dmat3(instance.to_scene))));
      pp.left_out =
          radius > 0 && light.w != 0 &&
          glm::distance(Vec3(out.light), glm::clamp(Vec3(out.light), part.lo, part.hi)) * scale >
              radius * (1 + kReachSlack);
      // A closed surface that is drawn as a whole: everything seen lies outside it, as does the
      // light, so half of its triangles count (docs/renderer.md).
      const bool half = part.closed && mesh.part_seen[p] != 0 &&
                        !overlap(near_box, part.lo, part.hi) &&
                        (light.w == 0 || !overlap(light_box, part.lo, part.hi));
      if (half) {
        pp.casting =
            part.convex && part.winding < 0 ? Casting::positive_sides : Casting::negative_sides;
      }
      if (!half || !part.convex) s.all_convex = false;
    }
  }
  if (!target.foreign) plan.receivers = receivers_of(frame);
  const std::optional<Bound> bound = bounding_plane(frame, light);
  s.can_bound = bound.has_value();
  Result<Method> decided = decide(wanted, s, state.capabilities);
  if (!decided) return decided.error();
  plan.method = decided.value();
  const Method& m = plan.method;
  for (std::size_t i = 0; i < plan.instances.size(); ++i) {
    if (!state.instances[i].alive) continue;
    plan.instances[i].project =
        projection(plan.instances[i].light, m, bound, state.instances[i].to_scene);
    if (m.reach == Reach::bounded && std::isfinite(bound->receivers)) {
      Vec4 h = bound->plane;
      h.w -= bound->receivers;
      plan.instances[i].receivers = h * state.instances[i].to_scene;
    }
    for (std::size_t p = 0; p < plan.instances[i].parts.size(); ++p) {
      PartPlan& pp = plan.instances[i].parts[p];
      pp.by_polygon = m.volumes == VolumesOf::polygon;
      // A part that nothing of shades the near rectangle needs no closer look.
      pp.by_region = m.count == Count::mixed && shades[i][p];
      pp.z_fail = m.count == Count::z_fail || (m.count == Count::automatic && shades[i][p]);
    }
  }
  return plan;
}

}  // namespace gnomon::gl
