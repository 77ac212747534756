// Which parts are counted z-pass or z-fail, as one or by polygon, with all triangles or half.
#include <algorithm>
#include <array>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <gnomon/core/exact.h>
#include <gnomon/gl/renderer_state.h>
#include <gnomon/volume/near_clip.h>

namespace gnomon::gl {
namespace {

struct Box3 {
  Vec3 lo, hi;
};

Box3 box_of(std::span<const Vec3> points) {
  Box3 box{points[0], points[0]};
  for (const Vec3& p : points) {
    box.lo = glm::min(box.lo, p);
    box.hi = glm::max(box.hi, p);
  }
  return box;
}

bool overlap(const Box3& box, const Vec3& lo, const Vec3& hi) {
  return box.lo.x <= hi.x && lo.x <= box.hi.x && box.lo.y <= hi.y && lo.y <= box.hi.y &&
         box.lo.z <= hi.z && lo.z <= box.hi.z;
}

bool along_view(const Camera& camera, const Light& light) {
  return camera.eye.w == 0 && light.w == 0 &&
         glm::cross(Vec3(camera.eye), Vec3(light)) == Vec3(0.0);
}

}  // namespace

Result<LightPlan> plan_light(const Frame& frame, const Light& light, std::uint32_t number,
                             const Method& wanted, const TargetFacts& target) {
  const Renderer::State& state = *frame.state;
  const Camera& camera = *frame.camera;
  LightPlan plan;
  plan.light = light;
  plan.number = number;

  Situation s;
  s.parallel_view = camera.eye.w == 0;
  s.light_along_view = along_view(camera, light);
  s.directional_light = light.w == 0;
  s.target_stencil = target.stencil;
  s.target_alpha = target.alpha;
  s.infinite_view = camera.infinite;
  s.lights = target.lights;

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
    const Box3 near_box = box_of(rectangle);
    out.near = near_clip_volume(rectangle, out.light);
    const Box3 light_box{Vec3(out.light), Vec3(out.light)};
    out.parts.resize(mesh.parts.parts.size());
    shades[i].resize(mesh.parts.parts.size());
    for (std::size_t p = 0; p < mesh.parts.parts.size(); ++p) {
      const Part& part = mesh.parts.parts[p];
      PartPlan& pp = out.parts[p];
      shades[i][p] = may_shade_near(out.near, part.lo, part.hi) &&
                     may_any_shade_near(out.near, mesh.mesh, part.triangles);
      if (shades[i][p]) s.near_shaded = true;
      if (mesh.part_seen[p] == 0) out.caps_in_front = true;
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
  Result<Method> decided = decide(wanted, s, state.capabilities);
  if (!decided) return decided.error();
  plan.method = decided.value();
  const Method& m = plan.method;
  for (std::size_t i = 0; i < plan.instances.size(); ++i) {
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
