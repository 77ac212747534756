// The renderer: scenes, lights and a camera to pictures and shadow masks, by any method of the four
// papers; in a context and framebuffer of our own, or inside somebody else's engine.
// Based on: Everitt and Kilgard, Practical and Robust Stenciled Shadow Volumes, 2002 (3.3, the
// rendering procedure); Roettger, Irion, Ertl, Shadow Volumes Revisited, 2002; docs/renderer.md.
//
// All calls need the OpenGL context current that was current in Renderer::create(), and leave its
// state as it was.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include <gnomon/core/result.h>
#include <gnomon/core/vec.h>
#include <gnomon/gl/camera.h>
#include <gnomon/gl/capabilities.h>
#include <gnomon/gl/method.h>
#include <gnomon/mesh/tri_mesh.h>
#include <gnomon/scene/scene.h>
#include <gnomon/view/shadow_mask.h>

namespace gnomon::gl {

// 8-bit RGBA, row-major, row 0 at the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

struct LightSource {
  Light light{0, 0, 1, 0};     // scene coordinates
  Vec3 colour{0.8, 0.8, 0.8};  // added where it reaches a surface at right angles
  Vec3 attenuation{1, 0, 0};   // of a point light: 1 / (a + b d + c d^2), d in metres
  double radius = 0;           // metres; the light ends there; 0: it does not end
};

// What of the computation is drawn over the picture.
struct Overlay {
  bool volumes = false;      // the sides of the shadow volumes, yellow and transparent
  bool silhouettes = false;  // the edges that they start from, pink
  bool edges = false;        // all edges of the meshes: wire frame, without surfaces
  bool lights = false;       // where point lights are, as small crosses
  bool counts = false;       // the count in the stencil as a colour: blue 1, green 2, ... red many
  std::optional<Camera> frustum{};  // the edges of another camera's frustum
};

struct FrameOptions {
  Method method{};
  Overlay overlay{};
  Vec3 ambient{0.25, 0.25, 0.25};
  Vec3 background{0.62, 0.71, 0.82};
};

// What was done for a frame. Passes and rectangles as the first paper's Table 1 counts them.
struct FrameStats {
  Method method;             // with its automatic choices made
  int passes = 0;            // times the scene was drawn
  int rectangles = 0;        // rectangles over the whole picture to normalise and apply masks
  int other_rectangles = 0;  // rectangles for what the paper does not count: background, copies
  int volume_draws = 0;      // draw calls of volumes
  std::uint64_t volume_triangles = 0;
  int z_pass_volumes = 0, z_fail_volumes = 0;
  int polygon_volumes = 0;    // of these, volumes of single polygons
  int scissored_volumes = 0;  // volumes drawn within a rectangle of their own
  int culled_volumes = 0;     // volumes that shade nothing in the picture and were not drawn
  // The cache of volumes, by instance and light: what nothing has changed for is kept.
  int rebuilt = 0, kept = 0;
  int by_tree = 0;         // casters, made anew or kept, whose model's last silhouette a tree found
  double volumes_ms = 0;   // until silhouettes were found, volumes made and handed to OpenGL
  int moved_lights = 0;    // lamps that touched a caster: shadows are those of lamps beside them,
                           // 2^-13 of the largest coordinate away (docs/renderer-limits.md)
  int stencil_groups = 0;  // groups of casters counted apart so that no count overflows
  // Of draw_mask(): a sample is lit where (stencil & lit_bits) <= lit_at_most.
  int lit_at_most = 0;
  unsigned lit_bits = 0xff;
};

using MeshId = std::uint32_t;
using InstanceId = std::uint32_t;

class Renderer {
 public:
  // Errors: shaders that the driver does not take.
  static Result<Renderer> create(const Capabilities& capabilities);
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;
  ~Renderer();

  // A mesh that casts and receives; `casts`, `receives`: one flag per triangle, empty: all do.
  // Preconditions here and below: ids that were given out, indices of vertices that there are,
  // finite numbers.
  // `look`: materials, pictures, normals; none: white.
  MeshId add_mesh(const TriMesh& mesh, std::vector<std::uint8_t> casts = {},
                  std::vector<std::uint8_t> receives = {}, const Appearance* look = nullptr);
  // New positions for the same triangles (a skinned or morphed mesh), some of which may lose their
  // area. Precondition: as many as before; equal ones stay equal.
  void update_mesh(MeshId mesh, std::span<const Vec3> positions);
  // The same from a buffer of the caller's: float x, y, z at `offset` + i * `stride` bytes. They
  // are read back, since silhouettes are found on the CPU. Errors: the buffer is shorter than that,
  // or mapped; the mesh stays as it was.
  Result<bool> update_mesh_from_buffer(MeshId mesh, unsigned buffer, std::size_t offset,
                                       std::size_t stride);

  // `to_scene`: rigid motion with or without a uniform scale, not mirrored (asserted).
  InstanceId add_instance(MeshId mesh, const glm::dmat4& to_scene = glm::dmat4(1.0));
  void move_instance(InstanceId instance, const glm::dmat4& to_scene);
  void remove_instance(InstanceId instance);

  // One mesh and one instance of it.
  InstanceId add_scene(const Scene& scene);

  // A frame in a framebuffer of the renderer's own, which is kept for the next one. Errors:
  // decide()'s reasons, too large a picture.
  Result<FrameStats> draw(const Camera& camera, std::span<const LightSource> lights,
                          const FrameOptions& options);
  // Waits until all that was asked of OpenGL is done: to be called before a clock is read.
  void finish() const;
  // The pixels of the last frame. Precondition: there is one.
  Image read() const;
  // Copies the last frame to the framebuffer that is bound for drawing, from its lower left corner.
  void present() const;
  // draw() and read().
  Result<Image> render(const Camera& camera, std::span<const LightSource> lights,
                       const FrameOptions& options, FrameStats* stats = nullptr);
  // The mask of one light: lit, shadow or no sample per pixel.
  Result<ShadowMask> mask(const Camera& camera, const Light& light, const Method& method,
                          FrameStats* stats = nullptr);

  // Inside an engine (docs/engine.md). The framebuffer that is bound for drawing holds the depths
  // of the scene, drawn with clip_of() (see there) in the viewport, depth range and provoking
  // vertex that are set; nearer depths are less. Afterwards a sample is in shadow where, by
  // method.mask, in the stencil (stencil & lit_bits) > lit_at_most, see FrameStats; or where alpha
  // is below one half. Colours (alpha: rgb) and depths are not touched; of
  // further colour attachments alpha is undefined then, unless glDrawBuffers leaves them out.
  // Shadows fall on whatever is in the depths; if all of that was added here, Reach::bounded saves
  // time. What was added and receives is expected to be there: a caster that is not drawn
  // (transparent, cut away, behind a clip plane of the caller's) must not be one that receives.
  // Errors: decide()'s reasons; a screen mask or one of lower resolution, or one in floats (see
  // Method), which need a framebuffer of ours; a clip space that is not OpenGL's usual one.
  // Precondition: no query and no transform feedback is active. `number`: which of the frame's
  // lights, 0 and up: each keeps its volumes from frame to frame.
  Result<FrameStats> draw_mask(const Camera& camera, const Light& light, const Method& method,
                               std::uint32_t number = 0);

  // For an engine's own vertex shaders: "invariant gl_Position; gl_Position = m * vec4(position,
  // 1.0)" with this m gives depths that are the bits of our volumes' caps.
  glm::mat4 clip_of(InstanceId instance, const Camera& camera) const;

  const Capabilities& capabilities() const;

  struct State;  // internal: renderer_state.h

 private:
  explicit Renderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace gnomon::gl
