#include <gnomon/gl/method.h>

namespace gnomon::gl {
namespace {

Error refuse(std::string why) { return Error{std::move(why)}; }

}  // namespace

std::string_view name_of(MaskIn v) {
  return v == MaskIn::stencil ? "stencil" : v == MaskIn::alpha ? "alpha" : "screen";
}
std::string_view name_of(Count v) {
  switch (v) {
    case Count::z_pass:
      return "zpass";
    case Count::z_fail:
      return "zfail";
    case Count::near_cap:
      return "near-cap";
    case Count::zp_plus:
      return "zp-plus";
    case Count::automatic:
      return "auto";
    case Count::mixed:
      return "mixed";
  }
  return "";
}
std::string_view name_of(StencilPasses v) {
  return v == StencilPasses::two_sided ? "two-sided" : "culled";
}
std::string_view name_of(StencilOps v) { return v == StencilOps::wrap ? "wrap" : "saturate"; }
std::string_view name_of(VolumesOf v) {
  return v == VolumesOf::automatic ? "auto" : v == VolumesOf::caster ? "caster" : "polygon";
}
std::string_view name_of(Arithmetic v) {
  return v == Arithmetic::doubling ? "doubling" : "maximum";
}
std::string_view name_of(FarPlane v) {
  return v == FarPlane::automatic ? "auto" : v == FarPlane::infinite ? "infinite" : "clamp";
}
std::string_view name_of(Extrusion v) {
  switch (v) {
    case Extrusion::cpu:
      return "cpu";
    case Extrusion::shader:
      return "shader";
    case Extrusion::blend:
      return "blend";
    case Extrusion::blend_large:
      return "blend-large";
  }
  return "";
}
std::string_view name_of(Reach v) {
  return v == Reach::automatic ? "auto" : v == Reach::infinite ? "infinite" : "bounded";
}
std::string_view name_of(Primitives v) {
  return v == Primitives::quads ? "quads" : v == Primitives::strips ? "strips" : "fans";
}
std::string_view name_of(SilhouetteBy v) {
  switch (v) {
    case SilhouetteBy::automatic:
      return "auto";
    case SilhouetteBy::brute_force:
      return "brute-force";
    case SilhouetteBy::dual_space:
      return "dual-space";
    case SilhouetteBy::edge_tree:
      return "edge-tree";
  }
  return "";
}
std::string_view name_of(Shadows v) {
  switch (v) {
    case Shadows::automatic:
      return "auto";
    case Shadows::lights:
      return "lights";
    case Shadows::black:
      return "black";
    case Shadows::ambient:
      return "ambient";
    case Shadows::attenuated:
      return "attenuated";
    case Shadows::none:
      return "none";
  }
  return "";
}

std::string describe(const Method& m) {
  std::string text(name_of(m.mask));
  const auto add = [&](std::string_view word) { text += ", " + std::string(word); };
  add(name_of(m.count));
  if (m.mask == MaskIn::stencil) {
    add(name_of(m.passes));
    add(name_of(m.ops));
  } else {
    add(name_of(m.arithmetic));
    if (m.float_bits > 0) add(m.float_bits == 16 ? "16-bit floats" : "32-bit floats");
  }
  add("volumes of " + std::string(name_of(m.volumes)));
  add("far plane " + std::string(name_of(m.far_plane)));
  add("extruded by " + std::string(name_of(m.extrusion)));
  add(std::string(name_of(m.reach)) + " reach");
  add(name_of(m.primitives));
  add(name_of(m.shadows));
  return text;
}

Result<Method> decide(Method m, const Situation& s, const Capabilities& c) {
  const bool stencil = m.mask == MaskIn::stencil;

  // Framebuffer.
  if (stencil && !s.target_stencil) {
    return refuse(
        "The framebuffer has no stencil attachment: take --method alpha, which needs none.");
  }
  if (m.mask == MaskIn::alpha && !s.target_alpha) {
    return refuse("The framebuffer has no alpha channel: take --method stencil or screen.");
  }
  if (m.samples > 1 && c.max_samples < 2)
    return refuse("There is no multisampling here: take --samples 1.");
  if (m.samples > 1 && m.samples > c.max_samples) {
    return refuse("There are at most " + std::to_string(c.max_samples) +
                  " samples a pixel here: take --samples " + std::to_string(c.max_samples) +
                  " or fewer.");
  }
  if (!(m.mask_scale > 0 && m.mask_scale <= 1))
    return refuse("The mask's size is a share of the picture's: above 0 and at most 1.");
  if (m.mask_scale < 1 && m.samples > 1) {
    return refuse(
        "A mask of lower resolution is magnified to whole pixels and would undo multisampling: "
        "take --mask-scale 1 or --samples 1.");
  }

  // Far plane: nothing of a volume may be lost there (Everitt and Kilgard, 3.2.1 and 4.2).
  if (m.far_plane == FarPlane::automatic)
    m.far_plane = s.infinite_view ? FarPlane::infinite : FarPlane::clamp;
  if (m.far_plane == FarPlane::infinite && s.parallel_view) {
    return refuse("A parallel view has no infinite projection: take --far clamp (depth clamp).");
  }
  if (m.far_plane == FarPlane::infinite && !s.infinite_view) {
    return refuse(
        "The view's own matrix has a finite far plane: take --far clamp (depth clamp), or give a "
        "matrix with the far plane at infinity.");
  }
  if (m.far_plane == FarPlane::clamp && !c.depth_clamp) {
    return refuse(
        "This OpenGL has no depth clamp, so the far plane would slice volumes open: take --far "
        "infinite with a perspective camera.");
  }

  // Extrusion.
  if (m.extrusion == Extrusion::blend_large && s.parallel_view) {
    return refuse(
        "Finite extrusion puts far ends at 16777216 times their distance from the light, beyond "
        "the precision of a parallel view: take --extrusion shader.");
  }

  // Reach.
  if (m.extrusion == Extrusion::blend_large && m.reach == Reach::bounded) {
    return refuse(
        "Finite extrusion by a large factor is a reach of its own: take --extrusion shader with "
        "--reach bounded.");
  }
  if (m.reach == Reach::automatic) {
    const bool infinite = !s.can_bound || s.foreign_receivers ||
                          m.extrusion == Extrusion::blend_large || m.primitives == Primitives::fans;
    m.reach = infinite ? Reach::infinite : Reach::bounded;
  }
  if (m.reach == Reach::bounded && !s.can_bound) {
    return refuse(
        "No plane beyond the scene has light, casters and near plane on one side and the shadows "
        "running towards it (is the light lower than a caster?): take --reach infinite.");
  }
  const bool one_point = s.directional_light && m.reach == Reach::infinite;

  // Counting.
  if (m.count == Count::z_pass && s.near_shaded && !m.unchecked) {
    return refuse(
        "z-pass counts from the near plane, and casters lie between the near plane and the light "
        "(near clip volume), so its counts would be wrong: take --count auto, zfail, near-cap or "
        "zp-plus.");
  }
  if (s.light_along_view && one_point && !m.unchecked &&
      (m.count == Count::z_fail || m.count == Count::near_cap || m.count == Count::zp_plus)) {
    return refuse(
        "The parallel view looks exactly along the light: all ends of the volumes fall into one "
        "point at infinity. Take --count auto, which counts z-pass there, or turn the view.");
  }
  if (s.light_along_view && s.near_shaded && !m.unchecked) {
    return refuse(
        "The parallel view looks exactly against the light, from behind the casters: no counting "
        "on the graphics card is right there. Turn the view.");
  }

  if (m.count == Count::zp_plus && s.light_in_near_plane && s.near_shaded) {
    return refuse(
        "The light lies in the near plane, so nothing can be drawn on it as seen from the light: "
        "take --count auto, zfail or near-cap.");
  }
  if (s.parallel_view && !s.directional_light && m.reach == Reach::infinite && !m.unchecked &&
      (m.count == Count::z_fail || ((m.count == Count::near_cap || m.count == Count::zp_plus ||
                                     m.count == Count::automatic || m.count == Count::mixed) &&
                                    s.near_shaded))) {
    return refuse(
        "Rays of a parallel view may run inside a lamp's volume for ever, and its dark cap at "
        "infinity has no place in the picture: take " +
        std::string(s.can_bound ? "--reach bounded."
                                : "a perspective view, or raise the lamp above all casters."));
  }

  // Volumes.
  if (!stencil) {
    // The clamp at 1 loses counts unless every draw has one entry and one exit on each view ray;
    // powers of two in floats count without one.
    const bool floats = !s.all_convex || m.volumes == VolumesOf::polygon || m.count == Count::mixed;
    m.float_bits = !floats ? 0 : c.float_blend ? 32 : 16;
    if (m.volumes == VolumesOf::automatic) m.volumes = VolumesOf::caster;
    if (floats && !c.float_colour) {
      return refuse(
          "Doubling and halving in 8 bits loses counts where a view ray enters one volume twice or "
          "volumes touch, and some casters are not convex; this OpenGL draws no floats, which "
          "would hold them. Take --method stencil.");
    }
    if (floats && m.samples > 1) {
      return refuse(
          "Casters that are not convex need a mask in floats, whose overflow is looked for "
          "pixel by pixel: take --samples 1, or --method stencil.");
    }
  } else if (m.volumes == VolumesOf::automatic) {
    m.volumes = VolumesOf::caster;
  }
  if (m.count == Count::mixed && m.volumes == VolumesOf::polygon) {
    return refuse(
        "Lit regions and polygons are two ways to take a caster apart: take --volumes caster with "
        "--count mixed, or --count auto, which decides per polygon.");
  }
  if (m.primitives != Primitives::quads && m.volumes == VolumesOf::polygon) {
    return refuse(
        "A polygon's volume has its own few sides and no loop to string together: take "
        "--primitives quads.");
  }
  if (m.primitives == Primitives::fans && !one_point) {
    return refuse(
        "A fan needs one point at infinity behind all edges, which only a directional light has, "
        "and infinite reach: take --primitives strips.");
  }
  if (m.primitives == Primitives::strips && one_point) {
    return refuse(
        "Behind a directional light's edges there is one point at infinity: sides are triangles, "
        "which make no strip. Take --primitives fans.");
  }

  // Stencil operations.
  if (stencil && m.passes == StencilPasses::two_sided && m.ops == StencilOps::saturate) {
    return refuse(
        "In one two-sided pass decrements may come before increments, and saturating ones are then "
        "lost at 0 (Everitt and Kilgard, 4.3): take --stencil-ops wrap or --stencil-passes "
        "culled.");
  }

  // What becomes of the mask.
  if (m.arithmetic == Arithmetic::maximum) {
    if (stencil) {
      return refuse(
          "Maximum blending is arithmetic of alpha and screen masks; the stencil counts.");
    }
    if (m.shadows == Shadows::black || m.shadows == Shadows::ambient) {
      return refuse(
          "The maximum variant leaves shadows at one half and lit at one, which attenuates (Table "
          "1 "
          "of the paper): take --shadows attenuated or lights, or --arithmetic doubling.");
    }
  }
  if (m.shadows == Shadows::automatic) m.shadows = Shadows::lights;
  if (m.shadows != Shadows::lights && m.shadows != Shadows::none && s.lights > 1) {
    return refuse("Shadows that are " + std::string(name_of(m.shadows)) +
                  " are for one light: take --shadows lights for several.");
  }
  return m;
}

}  // namespace gnomon::gl
