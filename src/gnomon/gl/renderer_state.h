// What a Renderer owns, and how its files draw with it. Internal to this room.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include <gnomon/gl/caster_volumes.h>
#include <gnomon/gl/gpu_mesh.h>
#include <gnomon/gl/pass.h>
#include <gnomon/gl/program.h>
#include <gnomon/gl/renderer.h>
#include <gnomon/gl/screen_rectangle.h>
#include <gnomon/gl/target.h>

namespace gnomon::gl {

struct MeshSlot {
  GpuMesh gpu;
  std::uint64_t version = 0;  // of its positions
};

struct InstanceSlot {
  MeshId mesh = 0;
  glm::dmat4 to_scene{1.0};
  bool alive = false;
  std::vector<CasterVolumes> volumes;  // per light of the frame, by its number
};

struct Renderer::State {
  Capabilities capabilities;
  PassSupport support;
  Programs programs;
  VertexArray empty;  // rectangles have no attributes
  std::vector<MeshSlot> meshes;
  std::vector<InstanceSlot> instances;
  Buffer near_caps;  // vertices in clip space
  VertexArray near_cap_array;
  Query query;
  std::optional<Target> picture;  // of draw()
  std::optional<int> stencil;     // what the whole stencil is known to hold: the frame cleared it
  std::optional<Error> failure;   // of a shader that was needed in the middle of a frame
};

// One frame: what every step needs to know.
struct Frame {
  Renderer::State* state = nullptr;
  const Camera* camera = nullptr;
  FrameStats* stats = nullptr;

  bool whole_volumes = false;  // volumes are looked at, with all caps

  std::optional<Rect> scissor{};                        // outside it nothing is seen
  std::optional<std::array<double, 2>> depth_bounds{};  // likewise, in 0 .. 1

  glm::mat4 clip_of(const InstanceSlot& instance) const {
    return glm::mat4(camera->clip * instance.to_scene);
  }
};

// The pass, inside the frame's scissor.
inline void apply(Pass pass, const Frame& frame) {
  if (!pass.scissor) pass.scissor = frame.scissor;
  if (!pass.depth_bounds) pass.depth_bounds = frame.depth_bounds;
  apply(pass, frame.state->support);
}

// Which light caps z-pass counts too. Caps lie on the casters' surfaces, at the same depth bit for
// bit, so they are in front of nothing where casters are drawn, but for faces that are seen from
// behind and were left out (culls_back_faces()), and for casters that are not drawn at all.
enum class CapsInFront : std::uint8_t { none, seen_from_behind, all };

// Pixels across and down of a mask `scale` times as large as the picture.
inline std::array<int, 2> mask_size(const Camera& camera, double scale) {
  return {std::max(1, static_cast<int>(std::ceil(camera.width * scale))),
          std::max(1, static_cast<int>(std::ceil(camera.height * scale)))};
}

// One light of a frame.
struct LightPlan {
  Light light{0, 0, 1, 0};
  std::uint32_t number = 0;  // which of the frame's lights
  Method method;             // decided
  struct OfInstance {
    Light light{0, 0, 1, 0};     // in the mesh's coordinates
    NearClip near;               // likewise
    glm::mat4 project{0.0f};     // likewise: a vertex to the point behind it
    Vec4 receivers{0, 0, 0, 1};  // likewise: see update_lists()
    std::vector<PartPlan> parts;
    CapsInFront caps_in_front = CapsInFront::none;
    bool before_near = false, beyond_far = false;  // casters reach there
  };
  std::vector<OfInstance> instances;  // by InstanceId; empty parts where not alive
  std::optional<SceneBox> receivers;  // nothing else is seen, if known
};

// What decides the method, and the plan of every part. Error: decide()'s. `target_*`: of the
// framebuffer that is drawn to.
struct TargetFacts {
  bool stencil = true, alpha = true;
  int lights = 1;
  bool foreign = false;  // its depths are another renderer's, maybe of more than was added here
};
// `radius`: the light ends there, metres; 0: it does not end.
Result<LightPlan> plan_light(const Frame& frame, const Light& light, double radius,
                             std::uint32_t number, const Method& wanted, const TargetFacts& target);

// The box round all that is seen.
SceneBox receivers_of(const Frame& frame);

// The frame within the reach of a light: scissor and depth bounds.
Frame within_reach(const Frame& frame, const LightSource& light);

// The light, or, where it touches a caster, a lamp 2^-13 of the largest coordinate beside it (4 mm
// at 30 m), on the side that the tie rule says; counted in the frame's stats.
Light clear_of_casters(const Frame& frame, const Light& light);

// Whether back faces of an instance's solid parts are left out of the picture. Their depths are not
// there then, and at the outline of a part, where back and front are equally far to rounding, its
// caps may come out in front: z-pass counts them like those of casters that are not seen.
bool culls_back_faces(const Frame& frame, const InstanceSlot& instance, const GpuMesh& mesh);

// Draws surfaces.
void draw_depth(const Frame& frame, const Pass& pass);  // no colour
void draw_flat(const Frame& frame, const Pass& pass, const glm::vec4& colour);
struct Lighting {
  const LightSource* light = nullptr;  // none: ambient and emission only
  Vec3 ambient{0, 0, 0};
  bool emission = false;
  const Target* mask = nullptr;  // multiplied in, bilinearly
  glm::vec4 mask_channel{1, 0, 0, 0};
};
void draw_lit(const Frame& frame, const Pass& pass, const Lighting& lighting);

// Of a mesh's doubled vertices, by the pass and program that are set, what changes from frame to
// frame.
void draw_indexed(GLenum primitive, const Buffer& vertices,
                  const std::vector<std::uint32_t>& indices);

// Rectangles over the viewport. `depth`: -1 the near plane, 1 the far plane.
void draw_rectangle(const Frame& frame, const Pass& pass, const glm::vec4& colour,
                    float depth = -1);
void draw_texture(const Frame& frame, const Pass& pass, const Target& from,
                  const std::optional<glm::vec4>& channel);

// What tells lit from shadow in the stencil: the state of a pass that draws where it is lit.
struct LitTest {
  GLenum func = GL_GEQUAL;
  GLint ref = 0;
  GLuint read = 0xff;
  // Where a light is added once and no more though two fragments share a depth (the paper's INCR).
  GLenum once = GL_INCR;
  GLuint write = 0xff;
};
void draw_where_lit(Pass& pass, const LitTest& lit, bool once);
void draw_where_shadowed(Pass& pass, const LitTest& lit);

// The mask of one light into the bound framebuffer, whose depth is there. Its place is cleared
// first. Alpha and screen: normalised to 0 in shadow, 1 where lit (254/255); attenuated: to 1/2 and
// 1. Error: more layers than half floats count. `colour`: the texture that a half-float mask lives
// in.
Result<LitTest> draw_light_mask(const Frame& frame, const LightPlan& plan, const Target* target);

// Over the picture in the bound framebuffer.
// Error: counts of a mask that has none.
Result<bool> draw_overlay(const Frame& frame, std::span<const LightSource> lights,
                          std::span<const LightPlan> plans, const Overlay& overlay,
                          const Vec3& background);

}  // namespace gnomon::gl
