#include <gnomon/gl/renderer.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <gnomon/gl/renderer_state.h>

namespace gnomon::gl {
namespace {

Pass colour_pass(GLenum depth_func) {
  Pass p;
  p.depth_func = depth_func;
  p.colour = {true, true, true, false};
  return p;
}

// The first pass: depths, and colour unless it is for depth alone.
Pass first_pass(bool colour) {
  Pass p;
  p.depth_write = true;
  if (colour) p.colour = {true, true, true, false};
  return p;
}

void clear(const Frame& frame, const Target& target, const Vec3& background) {
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.id());
  glViewport(0, 0, target.format.width, target.format.height);
  Pass p;
  p.depth_write = true;
  p.colour = {true, true, true, true};
  apply(p, frame);
  glClearColor(static_cast<float>(background.x), static_cast<float>(background.y),
               static_cast<float>(background.z), 0.0f);
  glClearDepthf(1.0f);
  glClearStencil(kWrapMiddle);  // where the first light's count most often begins
  frame.state->stencil = std::nullopt;
  if (target.format.stencil) frame.state->stencil = kWrapMiddle;
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT |
          (target.format.stencil ? GL_STENCIL_BUFFER_BIT : 0));
}

// A colour wherever nothing was drawn: a rectangle in the far plane.
void draw_background(const Frame& frame, const Vec3& colour) {
  Pass p = colour_pass(GL_EQUAL);
  p.depth_clamp = false;
  draw_rectangle(frame, p, glm::vec4(glm::vec3(colour), 1.0f), 1.0f);
  ++frame.stats->other_rectangles;
}

TargetFormat format_of(const Camera& camera, const Method& m, double scale) {
  TargetFormat f;
  const auto [width, height] = mask_size(camera, scale);
  f.width = width;
  f.height = height;
  f.samples = m.samples;
  f.stencil = m.mask == MaskIn::stencil;
  f.float_bits = m.float_bits;
  return f;
}

// The mask from where its method keeps it to all colours of the bound framebuffer: 1 where lit, and
// `shadow` where not.
void mask_to_colour(const Frame& frame, const Method& m, const LitTest& lit, float shadow) {
  Pass p;
  p.depth_test = false;
  p.colour = {true, true, true, false};
  if (m.mask == MaskIn::stencil) {
    draw_rectangle(frame, p, glm::vec4(1));
    draw_where_shadowed(p, lit);
    draw_rectangle(frame, p, glm::vec4(shadow));
    frame.stats->other_rectangles += 2;
  } else if (m.mask == MaskIn::alpha) {
    p.blend = true;
    p.source = GL_DST_ALPHA;
    p.destination = GL_ZERO;
    draw_rectangle(frame, p, glm::vec4(1));
    ++frame.stats->other_rectangles;
  }
}

glm::vec4 channel_of(const Method& m) {
  return m.mask == MaskIn::alpha ? glm::vec4(0, 0, 0, 1) : glm::vec4(1, 0, 0, 0);
}

// A mask at a lower resolution, in a texture (Roettger et al., 4.5).
Result<Target> low_mask(const Frame& full, const LightPlan& plan) {
  Result<Target> made = make_target(format_of(*full.camera, plan.method, plan.method.mask_scale));
  if (!made) return made.error();
  Target target = std::move(made).value();
  Frame frame = full;
  frame.scissor.reset();
  clear(frame, target, Vec3(0));
  if (full.scissor)
    frame.scissor = scaled(*full.scissor, *full.camera, target.format.width, target.format.height);
  draw_depth(frame, first_pass(false));
  const Result<LitTest> lit = draw_light_mask(frame, plan, &target);
  if (!lit) return lit.error();
  if (plan.method.mask == MaskIn::stencil)
    mask_to_colour(frame, plan.method, lit.value(),
                   plan.method.shadows == Shadows::attenuated ? 0.5f : 0.0f);
  return target;
}

void bind(const Target& target) {
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.id());
  glViewport(0, 0, target.format.width, target.format.height);
}

// Each light adds its part where it is not shadowed (Everitt and Kilgard, 3.3). The first one in
// the stencil draws over what is there, with that in its sum: nothing is blended, and rounded once.
Result<bool> add_lights(const Frame& whole, const Target& picture,
                        std::span<const LightSource> lights, std::span<const LightPlan> plans,
                        const FrameOptions& options) {
  std::optional<Target> screen;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Frame frame = within_reach(whole, lights[i]);
    const LightPlan& plan = plans[i];
    const Method& m = plan.method;
    Lighting lighting;
    lighting.light = &lights[i];
    Pass add = colour_pass(GL_EQUAL);
    add.blend = true;
    add.source = add.destination = GL_ONE;
    if (m.mask_scale < 1) {
      Result<Target> mask = low_mask(frame, plan);
      if (!mask) return mask.error();
      bind(picture);
      lighting.mask = &mask.value();
      lighting.mask_channel = channel_of(m);
      draw_lit(frame, add, lighting);
    } else if (m.mask == MaskIn::stencil) {
      const Result<LitTest> lit = draw_light_mask(frame, plan, &picture);
      if (!lit) return lit.error();
      if (i == 0) {
        add.blend = false;
        lighting.ambient = options.ambient;
        lighting.emission = true;
      }
      draw_where_lit(add, lit.value(), !m.keep_double_blending);
      draw_lit(frame, add, lighting);
    } else if (m.mask == MaskIn::alpha) {
      const Result<LitTest> lit = draw_light_mask(frame, plan, &picture);
      if (!lit) return lit.error();
      add.source = GL_DST_ALPHA;
      draw_lit(frame, add, lighting);
    } else {
      // The mask overwrites what earlier lights drew: it has a target of its own, with the same
      // depths, which is added when it holds mask times light.
      if (!screen) {
        TargetFormat format = picture.format;
        Result<Target> made = make_target(format, &picture);
        if (!made) return made.error();
        screen = std::move(made).value();
      }
      bind(*screen);
      const Result<LitTest> lit = draw_light_mask(frame, plan, &*screen);
      if (!lit) return lit.error();
      draw_background(frame, Vec3(0));
      Pass multiply = colour_pass(GL_EQUAL);
      multiply.blend = true;
      multiply.source = GL_DST_COLOR;
      multiply.destination = GL_ZERO;
      draw_lit(frame, multiply, lighting);
      bind(picture);
      Pass sum;
      sum.depth_test = false;
      sum.blend = true;
      sum.source = sum.destination = GL_ONE;
      sum.colour = {true, true, true, false};
      draw_texture(frame, sum, *screen, std::nullopt);
      ++frame.stats->other_rectangles;
    }
  }
  return true;
}

// Float bits of a picture that so many lights are added in; 0: eight bits a channel, which round
// each of them by half a step. Half floats round to a 4096th of the sum. Error: there are no
// floats.
Result<int> bits_for_lights(const Capabilities& c, std::size_t lights) {
  constexpr std::size_t kInBytes = 4, kInHalfFloats = 32, kInBytesAtMost = 16;
  if (lights <= kInBytes) return 0;
  if (lights > kInHalfFloats && c.float_blend) return 32;
  if (c.float_colour) return 16;
  if (lights <= kInBytesAtMost) return 0;
  return Error{
      "More than 16 lights are lost in the rounding of 8 bits a channel, and this OpenGL has no "
      "float colours: take fewer lights."};
}

// One light, as the first paper's Table 1 counts passes and rectangles.
Result<bool> draw_paper(const Frame& frame, const Target& picture, const LightSource& light,
                        const LightPlan& plan, const FrameOptions& options) {
  const Method& m = plan.method;
  const bool attenuated = m.shadows == Shadows::attenuated;
  Lighting lighting;
  lighting.light = &light;
  if (attenuated) {
    lighting.ambient = options.ambient;
    lighting.emission = true;
  }
  Pass apply_mask;
  apply_mask.depth_test = false;
  apply_mask.colour = {true, true, true, false};
  apply_mask.blend = true;
  if (m.mask_scale < 1) {
    Result<Target> mask = low_mask(frame, plan);
    if (!mask) return mask.error();
    bind(picture);
    draw_lit(frame, first_pass(true), lighting);
    apply_mask.source = GL_DST_COLOR;
    apply_mask.destination = GL_ZERO;
    draw_texture(frame, apply_mask, mask.value(), channel_of(m));
    ++frame.stats->rectangles;
    draw_background(frame, options.background);
  } else if (m.mask == MaskIn::screen) {
    draw_depth(frame, first_pass(false));
    const Result<LitTest> lit = draw_light_mask(frame, plan, &picture);
    if (!lit) return lit.error();
    draw_background(frame, options.background);
    Pass multiply = colour_pass(GL_EQUAL);
    multiply.blend = true;
    multiply.source = GL_DST_COLOR;
    multiply.destination = GL_ZERO;
    draw_lit(frame, multiply, lighting);
  } else {
    draw_lit(frame, first_pass(true), lighting);
    const Result<LitTest> lit = draw_light_mask(frame, plan, &picture);
    if (!lit) return lit.error();
    if (m.mask == MaskIn::alpha) {
      apply_mask.source = GL_ZERO;
      apply_mask.destination = GL_DST_ALPHA;
      draw_rectangle(frame, apply_mask, glm::vec4(1));
    } else {
      apply_mask.source = GL_DST_COLOR;
      apply_mask.destination = GL_ZERO;
      draw_where_shadowed(apply_mask, lit.value());
      draw_rectangle(frame, apply_mask, glm::vec4(attenuated ? 0.5f : 0.0f));
    }
    ++frame.stats->rectangles;
    draw_background(frame, options.background);
  }
  if (m.shadows == Shadows::ambient) {
    Pass add = colour_pass(GL_EQUAL);
    add.blend = true;
    add.source = add.destination = GL_ONE;
    Lighting ambient;
    ambient.ambient = options.ambient;
    ambient.emission = true;
    draw_lit(frame, add, ambient);
  }
  return true;
}

// Every light everywhere.
void draw_unshadowed(const Frame& frame, std::span<const LightSource> lights,
                     const FrameOptions& options) {
  Lighting lighting;
  lighting.light = &lights.front();
  lighting.ambient = options.ambient;
  lighting.emission = true;
  draw_lit(frame, first_pass(true), lighting);
  Pass add = colour_pass(GL_EQUAL);
  add.blend = true;
  add.source = add.destination = GL_ONE;
  for (const LightSource& light : lights.subspan(1)) {
    Lighting one;
    one.light = &light;
    draw_lit(frame, add, one);
  }
}

}  // namespace

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Result<Renderer> Renderer::create(const Capabilities& capabilities) {
  auto state = std::make_unique<State>();
  state->capabilities = capabilities;
  state->support = {capabilities.depth_clamp, capabilities.depth_bounds};
  const StateGuard guard(state->support);
  Result<Programs> programs = compile_programs();
  if (!programs) return programs.error();
  state->programs = std::move(programs).value();
  state->empty = VertexArray::make();
  return Renderer(std::move(state));
}

MeshId Renderer::add_mesh(const TriMesh& mesh, std::vector<std::uint8_t> casts,
                          std::vector<std::uint8_t> receives, const Appearance* look) {
  assert(casts.empty() || casts.size() == mesh.triangles.size());
  assert(receives.empty() || receives.size() == mesh.triangles.size());
  for ([[maybe_unused]] const Triangle& t : mesh.triangles)
    assert(std::max({t[0], t[1], t[2]}) < mesh.positions.size());
  const StateGuard guard(state_->support);
  state_->meshes.push_back({make_gpu_mesh(mesh, std::move(casts), std::move(receives), look), 1});
  return static_cast<MeshId>(state_->meshes.size() - 1);
}

void Renderer::update_mesh(MeshId mesh, std::span<const Vec3> positions) {
  assert(mesh < state_->meshes.size());
  assert(positions.size() == state_->meshes[mesh].gpu.mesh.positions.size());
  const StateGuard guard(state_->support);
  move_vertices(state_->meshes[mesh].gpu, positions);
  ++state_->meshes[mesh].version;
}

Result<bool> Renderer::update_mesh_from_buffer(MeshId mesh, unsigned buffer, std::size_t offset,
                                               std::size_t stride) {
  assert(mesh < state_->meshes.size());
  const StateGuard guard(state_->support);
  std::vector<Vec3> positions(state_->meshes[mesh].gpu.mesh.positions.size());
  const std::size_t bytes = positions.empty() ? 0 : (positions.size() - 1) * stride + 12;
  GLint64 size = 0;
  if (glIsBuffer(buffer) == GL_TRUE) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glGetBufferParameteri64v(GL_ARRAY_BUFFER, GL_BUFFER_SIZE, &size);
  }
  if (static_cast<std::size_t>(size) < offset + bytes) {
    return Error{"The buffer of new positions has " + std::to_string(size) + " bytes; " +
                 std::to_string(positions.size()) + " vertices need " +
                 std::to_string(offset + bytes) + " with that offset and stride."};
  }
  if (positions.empty()) return true;
  const auto* data = static_cast<const unsigned char*>(
      glMapBufferRange(GL_ARRAY_BUFFER, static_cast<GLintptr>(offset),
                       static_cast<GLsizeiptr>(bytes), GL_MAP_READ_BIT));
  if (data == nullptr) return Error{"OpenGL does not let the buffer of new positions be read."};
  for (std::size_t i = 0; i < positions.size(); ++i) {
    float xyz[3];
    std::copy_n(data + i * stride, sizeof(xyz), reinterpret_cast<unsigned char*>(xyz));
    positions[i] = Vec3(xyz[0], xyz[1], xyz[2]);
  }
  glUnmapBuffer(GL_ARRAY_BUFFER);
  move_vertices(state_->meshes[mesh].gpu, positions);
  ++state_->meshes[mesh].version;
  return true;
}

InstanceId Renderer::add_instance(MeshId mesh, const glm::dmat4& to_scene) {
  assert(mesh < state_->meshes.size() && glm::determinant(to_scene) > 0);
  InstanceSlot slot;
  slot.mesh = mesh;
  slot.to_scene = to_scene;
  slot.alive = true;
  state_->instances.push_back(std::move(slot));
  return static_cast<InstanceId>(state_->instances.size() - 1);
}

void Renderer::move_instance(InstanceId instance, const glm::dmat4& to_scene) {
  assert(instance < state_->instances.size() && glm::determinant(to_scene) > 0);
  state_->instances[instance].to_scene = to_scene;
}

void Renderer::remove_instance(InstanceId instance) {
  assert(instance < state_->instances.size());
  state_->instances[instance].alive = false;
  state_->instances[instance].volumes.clear();
}

InstanceId Renderer::add_scene(const Scene& scene) {
  std::vector<std::uint8_t> cast(scene.mesh.triangles.size()), receive(cast.size());
  for (std::uint32_t t = 0; t < cast.size(); ++t) {
    cast[t] = casts(scene, t) ? 1 : 0;
    receive[t] = receives(scene, t) ? 1 : 0;
  }
  return add_instance(add_mesh(scene.mesh, std::move(cast), std::move(receive), &scene.appearance));
}

Result<FrameStats> Renderer::draw(const Camera& camera, std::span<const LightSource> lights,
                                  const FrameOptions& options) {
  FrameStats counted;
  const StateGuard guard(state_->support);
  Frame frame{state_.get(), &camera, &counted};
  frame.whole_volumes = options.overlay.volumes;
  Method wanted = options.method;
  const TargetFacts facts{true, true, static_cast<int>(lights.size())};
  counted.method = wanted;
  std::vector<LightPlan> plans;
  for (std::size_t i = 0; i < lights.size() && wanted.shadows != Shadows::none; ++i) {
    Result<LightPlan> plan = plan_light(frame, lights[i].light, lights[i].radius,
                                        static_cast<std::uint32_t>(i), wanted, facts);
    if (!plan) return plan.error();
    plans.push_back(std::move(plan).value());
  }
  if (!plans.empty()) counted.method = plans.front().method;
  const Result<int> bits = bits_for_lights(state_->capabilities, lights.size());
  if (!bits) return bits.error();
  wanted.float_bits = bits.value();
  // Masks in half floats hold fewer shadows over each other than others do.
  if (wanted.float_bits > 0 && wanted.mask != MaskIn::stencil && state_->capabilities.float_blend)
    wanted.float_bits = 32;
  for (const LightPlan& plan : plans)
    wanted.float_bits = std::max(wanted.float_bits, plan.method.float_bits);
  for (LightPlan& plan : plans) {  // masks live in the picture's alpha, and count as it does
    if (plan.method.mask != MaskIn::stencil && plan.method.mask_scale == 1)
      plan.method.float_bits = wanted.float_bits;
  }
  const TargetFormat format = format_of(camera, wanted, 1.0);
  if (!state_->picture || state_->picture->format != format) {
    Result<Target> made = make_target(format);
    if (!made) return made.error();
    state_->picture = std::move(made).value();
  }
  const Target& picture = *state_->picture;
  clear(frame, picture, options.background);
  const SceneBox seen = receivers_of(frame);
  if (seen.lo.x <= seen.hi.x) frame.scissor = rectangle_round(camera, seen);
  Result<bool> drawn = true;
  const Shadows shadows = lights.empty()  ? Shadows::lights
                          : plans.empty() ? Shadows::none
                                          : plans.front().method.shadows;
  if (shadows == Shadows::lights) {
    Lighting ambient;
    ambient.ambient = options.ambient;
    ambient.emission = true;
    draw_lit(frame, first_pass(true), ambient);
    // Its threads draw while volumes are made; on a graphics card it would only break up the pass.
    if (state_->capabilities.software) glFlush();
    drawn = add_lights(frame, picture, lights, plans, options);
  } else if (shadows == Shadows::none) {
    draw_unshadowed(frame, lights, options);
  } else {
    drawn = draw_paper(frame, picture, lights.front(), plans.front(), options);
  }
  if (!drawn) return drawn.error();
  if (state_->failure) return *std::exchange(state_->failure, std::nullopt);
  bind(picture);
  frame.scissor.reset();  // volumes are seen beyond what they shade
  drawn = draw_overlay(frame, lights, plans, options.overlay, options.background);
  if (!drawn) return drawn.error();
  return counted;
}

void Renderer::finish() const { glFinish(); }

Image Renderer::read() const {
  const StateGuard guard(state_->support);
  return read_colours(*state_->picture);
}

void Renderer::present() const {
  GLint to = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &to);
  const StateGuard guard(state_->support);
  const TargetFormat& f = state_->picture->format;
  // Of several samples OpenGL ES makes one only in the same format.
  Resolved resolved;
  if (f.samples > 1) resolved = resolve(*state_->picture);
  glBindFramebuffer(GL_READ_FRAMEBUFFER,
                    f.samples > 1 ? resolved.framebuffer.id() : state_->picture->framebuffer.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(to));
  apply(colour_pass(GL_ALWAYS), state_->support);
  glBlitFramebuffer(0, 0, f.width, f.height, 0, 0, f.width, f.height, GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
}

Result<Image> Renderer::render(const Camera& camera, std::span<const LightSource> lights,
                               const FrameOptions& options, FrameStats* stats) {
  Result<FrameStats> drawn = draw(camera, lights, options);
  if (!drawn) return drawn.error();
  if (stats != nullptr) *stats = drawn.value();
  return read();
}

Result<ShadowMask> Renderer::mask(const Camera& camera, const Light& light, const Method& method,
                                  FrameStats* stats) {
  FrameStats own;
  FrameStats& counted = stats != nullptr ? *stats : own;
  counted = {};
  const StateGuard guard(state_->support);
  const Frame frame{state_.get(), &camera, &counted};
  Result<LightPlan> planned = plan_light(frame, light, 0, 0, method, {});
  if (!planned) return planned.error();
  const LightPlan& plan = planned.value();
  const Method& m = counted.method = plan.method;
  Result<Target> made = make_target(format_of(camera, m, 1.0));
  if (!made) return made.error();
  const Target& picture = made.value();
  clear(frame, picture, Vec3(0));
  draw_depth(frame, first_pass(false));
  if (m.mask_scale < 1) {
    Result<Target> low = low_mask(frame, plan);
    if (!low) return low.error();
    bind(picture);
    Pass copy;
    copy.depth_test = false;
    copy.colour = {true, true, true, false};
    draw_texture(frame, copy, low.value(), channel_of(m));
    ++counted.other_rectangles;
  } else {
    const Result<LitTest> lit = draw_light_mask(frame, plan, &picture);
    if (!lit) return lit.error();
    mask_to_colour(frame, m, lit.value(), m.shadows == Shadows::attenuated ? 0.5f : 0.0f);
  }
  // Alpha: where there is a sample.
  Pass alpha;
  alpha.depth_test = false;
  alpha.colour = {false, false, false, true};
  draw_rectangle(frame, alpha, glm::vec4(0));
  ++counted.other_rectangles;
  alpha.depth_test = true;
  alpha.depth_func = GL_EQUAL;
  draw_flat(frame, alpha, glm::vec4(1));
  const Image image = read_colours(picture);
  ShadowMask out;
  out.width = image.width;
  out.height = image.height;
  out.state.resize(std::size_t(image.width) * image.height);
  // Halfway between shadow (0; attenuated 128) and lit (254 or 255).
  const int threshold = m.shadows == Shadows::attenuated ? 192 : 128;
  for (std::size_t i = 0; i < out.state.size(); ++i) {
    const std::uint8_t value = image.rgba[4 * i], there = image.rgba[4 * i + 3];
    out.state[i] = there < 128          ? ShadowMask::kNoSample
                   : value >= threshold ? ShadowMask::kLit
                                        : ShadowMask::kShadow;
  }
  return out;
}

Result<FrameStats> Renderer::draw_mask(const Camera& camera, const Light& light,
                                       const Method& method, std::uint32_t number) {
  if (method.mask == MaskIn::screen || method.mask_scale != 1) {
    return Error{
        "A mask in the screen buffer or of lower resolution needs a framebuffer of its own: take "
        "the stencil or the alpha channel inside another renderer's framebuffer."};
  }
  if (glGetString(GL_VERSION) == nullptr)
    return Error{"No OpenGL context is current on this thread."};
  if (!has_usual_clip_space()) {
    return Error{
        "The depth range runs backwards, or glClipControl is not GL_LOWER_LEFT and "
        "GL_NEGATIVE_ONE_TO_ONE: draw the depths and the mask with OpenGL's usual clip space."};
  }
  FrameStats counted;
  const Frame frame{state_.get(), &camera, &counted};
  GLint bound = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
  const GLenum back = epoxy_is_desktop_gl() ? GL_BACK_LEFT : GL_BACK;
  const auto has = [&](GLenum of_window, GLenum of_object, GLenum bits) {
    const GLenum attachment = bound == 0 ? of_window : of_object;
    GLint type = GL_NONE, size = 0;
    glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, attachment,
                                          GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &type);
    if (type == GL_NONE) return false;
    glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, attachment, bits, &size);
    return size > 0;
  };
  const bool stencil =
                 has(GL_STENCIL, GL_STENCIL_ATTACHMENT, GL_FRAMEBUFFER_ATTACHMENT_STENCIL_SIZE),
             alpha = has(back, GL_COLOR_ATTACHMENT0, GL_FRAMEBUFFER_ATTACHMENT_ALPHA_SIZE);
  Result<LightPlan> plan = plan_light(frame, light, 0, number, method, {stencil, alpha, 1, true});
  if (!plan) return plan.error();
  counted.method = plan.value().method;
  if (counted.method.float_bits > 0) {
    return Error{
        "Some casters are not closed and convex, or are not drawn as a whole: their alpha mask "
        "needs "
        "floats, which are counted in a framebuffer of our own only. Take --method stencil."};
  }
  const StateGuard guard(state_->support, DepthsOf::caller);
  state_->stencil.reset();  // what was known is of another framebuffer
  const Result<LitTest> lit = draw_light_mask(frame, plan.value(), nullptr);
  if (!lit) return lit.error();
  counted.lit_at_most = lit.value().ref;
  counted.lit_bits = lit.value().read;
  return counted;
}

glm::mat4 Renderer::clip_of(InstanceId instance, const Camera& camera) const {
  return glm::mat4(camera.clip * state_->instances[instance].to_scene);
}

const Capabilities& Renderer::capabilities() const { return state_->capabilities; }

}  // namespace gnomon::gl
