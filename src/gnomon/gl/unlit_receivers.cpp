// Receivers that are in shadow though no volume of their own says so.
#include <array>

#include <gnomon/core/exact.h>
#include <gnomon/gl/mask_counts.h>

namespace gnomon::gl {

// The unlit side of a receiver that does not cast is in shadow though nothing of its own counts
// (docs/exactness.md). Of one that casts and lies nearly in a plane with the light, the side that
// belongs before the unlit side may have come behind it: by rounding, or because it is moved away.
// Such receivers, drawn again where they are seen, add one.
void count_unlit_receivers(const Frame& frame, const LightPlan& plan, const Prepared& prepared) {
  const Method& m = plan.method;
  for (std::size_t i = 0; i < plan.instances.size(); ++i) {
    const InstanceSlot& instance = frame.state->instances[i];
    if (!instance.alive) continue;
    const GpuMesh& mesh = frame.state->meshes[instance.mesh].gpu;
    // By light side: of -1 the light sees the counterclockwise side, and the other one is unlit.
    std::array<std::vector<std::uint32_t>, 2> indices;
    const auto add = [&](std::uint32_t t, int side) {
      const Triangle& v = mesh.mesh.triangles[t];
      std::vector<std::uint32_t>& to = indices[side > 0 ? 1 : 0];
      to.insert(to.end(), {2 * v[0], 2 * v[1], 2 * v[2]});
    };
    ExactStats exact;
    for (const std::uint32_t t : mesh.only_receive) {
      const Triangle& v = mesh.mesh.triangles[t];
      add(t, light_side(mesh.mesh.positions[v[0]], mesh.mesh.positions[v[1]],
                        mesh.mesh.positions[v[2]], plan.instances[i].light, exact));
    }
    if (!plan.instances[i].parts.empty()) {
      const CasterVolumes& v = instance.volumes[plan.number];
      for (const NearlyGrazed& t : v.nearly_grazed) add(t.triangle, t.light_side);
    }
    for (const bool positive : {false, true}) {
      const std::vector<std::uint32_t>& drawn = indices[positive ? 1 : 0];
      if (drawn.empty()) continue;
      Pass p;
      p.depth_func = GL_EQUAL;
      p.cull = positive ? GL_BACK : GL_FRONT;
      float brightness = 1;
      if (m.mask == MaskIn::stencil) {
        p.stencil_test = true;
        if (prepared.grouped) {  // the shaded bit says it all
          p.stencil_ref = static_cast<GLint>(kShadedBit);
          p.stencil_write = kShadedBit;
        }
        p.front.depth_pass = p.back.depth_pass = prepared.grouped ? GL_REPLACE : GL_INCR;
      } else {
        p.blend = true;
        p.source = kFaceSource;
        p.destination = kFaceDestination;
        p.colour = mask_channels(m);
        brightness = m.arithmetic == Arithmetic::doubling ? kDoubles : kHalves;
      }
      apply(p, frame);
      const GLuint program = frame.state->programs.flat.id();
      glUseProgram(program);
      set(program, "u_clip", frame.clip_of(instance));
      set(program, "u_colour", glm::vec4(brightness));
      draw_indexed(GL_TRIANGLES, mesh.doubled, drawn);
    }
  }
}

}  // namespace gnomon::gl
