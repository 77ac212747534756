// How shadows are drawn: every choice of the four papers in one struct, and the one function that
// says which go together. docs/methods.md is generated from it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/gl/capabilities.h>
#include <gnomon/silhouette/silhouette_finder.h>

namespace gnomon::gl {

// Where the shadow mask lives. Roettger, Irion and Ertl 2002, section 4.2.
enum class MaskIn : std::uint8_t { stencil, alpha, screen };

// How faces of the volumes are counted. z_pass: in front of the sample (Heidmann); z_fail: behind
// it (Everitt and Kilgard, 2.2.3); near_cap: z-pass, and the volume's cut with the near plane as a
// front face; zp_plus: z-pass, and the casters between near plane and light counted from the light
// first; automatic: z-pass for each caster that the near clip volume does not meet ("Geometry of
// shadows in real time", section 5), z-fail for the others; mixed: the same per connected lit
// region.
enum class Count : std::uint8_t { z_pass, z_fail, near_cap, zp_plus, automatic, mixed };

enum class StencilPasses : std::uint8_t { two_sided, culled };  // one pass; one for each facing
enum class StencilOps : std::uint8_t { wrap, saturate };
enum class VolumesOf : std::uint8_t { automatic, caster, polygon };
enum class Arithmetic : std::uint8_t { doubling, maximum };  // of alpha and screen masks
enum class FarPlane : std::uint8_t { automatic, infinite, clamp };
enum class Extrusion : std::uint8_t { cpu, shader, blend, blend_large };
// How far volumes reach: to infinity, as the papers have them, or to a plane beyond everything that
// receives, where light, casters and eye allow one; it saves filling what lies below the ground.
// automatic: bounded where it can be, but infinite in another renderer's framebuffer.
enum class Reach : std::uint8_t { automatic, infinite, bounded };
enum class Primitives : std::uint8_t { quads, strips, fans };

// What becomes of the mask. lights: each light adds its part where it is not shadowed (Everitt and
// Kilgard, 3.3). The next are the first paper's for one light: black; ambient: and an ambient term
// added; attenuated: the lit scene at half its brightness. none: there are no shadows, as a measure
// of what they cost; the first light is drawn with the ambient term in one pass. automatic: lights.
enum class Shadows : std::uint8_t { automatic, lights, black, ambient, attenuated, none };

struct Method {
  MaskIn mask = MaskIn::stencil;
  Count count = Count::automatic;
  StencilPasses passes = StencilPasses::two_sided;
  StencilOps ops = StencilOps::wrap;
  VolumesOf volumes = VolumesOf::automatic;
  Arithmetic arithmetic = Arithmetic::doubling;
  FarPlane far_plane = FarPlane::automatic;
  Extrusion extrusion = Extrusion::shader;
  Reach reach = Reach::automatic;
  Primitives primitives = Primitives::quads;
  SilhouetteBy silhouettes = SilhouetteBy::automatic;  // all find the same edges
  Shadows shadows = Shadows::automatic;
  double mask_scale = 1;  // size of the mask over that of the picture, 0 < scale <= 1
  int samples = 1;        // a pixel
  // Alpha and screen masks in floats of 16 or 32 bits, whose powers of two count without a clamp;
  // 0: in 8 bits. Decided, not asked for: casters that a view ray can enter twice need it.
  int float_bits = 0;
  // For demonstrations: counts z-pass, and along a parallel view's light, where decide() would
  // refuse it since the mask is wrong there. What cannot be drawn at all is refused all the same.
  bool unchecked = false;
  bool keep_double_blending = false;  // KEEP instead of INCR where a light is added (stencil): the
                                      // paper's 3.4; only where no two fragments share a depth
};

// What of scene, light and target matters to the decision.
struct Situation {
  bool parallel_view = false;
  bool light_along_view = false;  // a parallel view exactly along a directional light
  bool directional_light = false;
  bool light_in_near_plane = false;  // to rounding: seen from it the plane is a line
  bool all_convex = true;            // every caster is closed and convex
  bool near_shaded = false;          // some caster may shade the near rectangle (near clip volume)
  bool target_stencil = true;        // the framebuffer can have a stencil attachment
  bool target_alpha = true;
  bool infinite_view = true;       // the view's far plane can be at infinity
  bool can_bound = false;          // there is a plane for Reach::bounded
  bool foreign_receivers = false;  // more may be seen than the casters and receivers that are known
  int lights = 1;
};

// The method with every automatic choice made, or why it would not draw the stencil's mask. The
// reason names the choice, the cause, and what to take instead.
Result<Method> decide(Method wanted, const Situation& situation, const Capabilities& capabilities);

// Names as the command line has them: "stencil", "zfail", "two-sided" ...
std::string_view name_of(MaskIn);
std::string_view name_of(Count);
std::string_view name_of(StencilPasses);
std::string_view name_of(StencilOps);
std::string_view name_of(VolumesOf);
std::string_view name_of(Arithmetic);
std::string_view name_of(FarPlane);
std::string_view name_of(Extrusion);
std::string_view name_of(Reach);
std::string_view name_of(Primitives);
std::string_view name_of(SilhouetteBy);
std::string_view name_of(Shadows);

// "stencil, zfail, two-sided, wrap, caster, ..." for messages and tables.
std::string describe(const Method& method);

}  // namespace gnomon::gl
