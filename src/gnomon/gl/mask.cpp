// The shadow mask of one light, in the stencil, the alpha channel or the screen.
#include <gnomon/gl/mask_counts.h>

namespace gnomon::gl {

void draw_where_lit(Pass& p, const LitTest& lit, bool once) {
  p.stencil_test = true;
  p.stencil_func = lit.func;
  p.stencil_ref = lit.ref;
  p.stencil_read = lit.read;
  p.stencil_write = lit.write;
  p.front.depth_pass = p.back.depth_pass = once ? lit.once : GL_KEEP;
}

void draw_where_shadowed(Pass& p, const LitTest& lit) {
  draw_where_lit(p, lit, false);
  p.stencil_func = GL_LESS;  // the opposite of GL_GEQUAL
}

Result<LitTest> draw_light_mask(const Frame& frame, const LightPlan& plan, const Target* target) {
  const Method& m = plan.method;
  Prepared prepared = prepare(frame, plan);
  for (const InstanceVolumes& v : prepared.all) {
    frame.stats->z_fail_volumes += static_cast<int>(v.volumes->z_fail_volumes);
    frame.stats->z_pass_volumes +=
        static_cast<int>(v.volumes->lists.volumes.size() - v.volumes->z_fail_volumes);
    for (const std::uint8_t p : v.volumes->polygon) frame.stats->polygon_volumes += p;
  }
  if (m.mask == MaskIn::stencil) {
    const LitTest lit = count_in_stencil(frame, plan, prepared);
    count_unlit_receivers(frame, plan, prepared);
    return lit;
  }
  clear_colours(frame, m);
  count_by_blending(frame, plan, prepared);
  count_unlit_receivers(frame, plan, prepared);
  if (m.float_bits > 0) {
    Result<bool> good = check_floats(frame, m, *target);
    if (!good) return good.error();
  }
  normalise(frame, m);
  return LitTest{};
}

}  // namespace gnomon::gl
