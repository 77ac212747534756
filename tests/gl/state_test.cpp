// Inside an engine: its OpenGL state is left as it was, and does not spoil what is drawn.
#include <epoxy/gl.h>

#include <map>

#include <glm/gtc/type_ptr.hpp>

#include "gl_test.h"

namespace gnomon::gl {
namespace {

constexpr int kSize = 96;

struct Name {
  GLenum what;
  int values;
  const char* text;
};
#define GNOMON_NAME(what, values) \
  Name { GL_##what, values, #what }
const Name kNames[] = {GNOMON_NAME(VIEWPORT, 4),
                       GNOMON_NAME(DEPTH_RANGE, 2),
                       GNOMON_NAME(SCISSOR_BOX, 4),
                       GNOMON_NAME(SCISSOR_TEST, 1),
                       GNOMON_NAME(COLOR_CLEAR_VALUE, 4),
                       GNOMON_NAME(DEPTH_CLEAR_VALUE, 1),
                       GNOMON_NAME(STENCIL_CLEAR_VALUE, 1),
                       GNOMON_NAME(DEPTH_TEST, 1),
                       GNOMON_NAME(DEPTH_FUNC, 1),
                       GNOMON_NAME(DEPTH_WRITEMASK, 1),
                       GNOMON_NAME(DEPTH_CLAMP, 1),
                       GNOMON_NAME(STENCIL_TEST, 1),
                       GNOMON_NAME(STENCIL_FUNC, 1),
                       GNOMON_NAME(STENCIL_REF, 1),
                       GNOMON_NAME(STENCIL_VALUE_MASK, 1),
                       GNOMON_NAME(STENCIL_WRITEMASK, 1),
                       GNOMON_NAME(STENCIL_FAIL, 1),
                       GNOMON_NAME(STENCIL_PASS_DEPTH_FAIL, 1),
                       GNOMON_NAME(STENCIL_PASS_DEPTH_PASS, 1),
                       GNOMON_NAME(STENCIL_BACK_FUNC, 1),
                       GNOMON_NAME(STENCIL_BACK_REF, 1),
                       GNOMON_NAME(STENCIL_BACK_VALUE_MASK, 1),
                       GNOMON_NAME(STENCIL_BACK_WRITEMASK, 1),
                       GNOMON_NAME(STENCIL_BACK_FAIL, 1),
                       GNOMON_NAME(STENCIL_BACK_PASS_DEPTH_FAIL, 1),
                       GNOMON_NAME(STENCIL_BACK_PASS_DEPTH_PASS, 1),
                       GNOMON_NAME(BLEND_SRC_RGB, 1),
                       GNOMON_NAME(BLEND_DST_RGB, 1),
                       GNOMON_NAME(BLEND_SRC_ALPHA, 1),
                       GNOMON_NAME(BLEND_DST_ALPHA, 1),
                       GNOMON_NAME(BLEND_EQUATION_RGB, 1),
                       GNOMON_NAME(BLEND_EQUATION_ALPHA, 1),
                       GNOMON_NAME(BLEND_COLOR, 4),
                       GNOMON_NAME(COLOR_LOGIC_OP, 1),
                       GNOMON_NAME(LOGIC_OP_MODE, 1),
                       GNOMON_NAME(CULL_FACE, 1),
                       GNOMON_NAME(CULL_FACE_MODE, 1),
                       GNOMON_NAME(FRONT_FACE, 1),
                       GNOMON_NAME(POLYGON_MODE, 2),
                       GNOMON_NAME(POLYGON_OFFSET_FILL, 1),
                       GNOMON_NAME(POLYGON_OFFSET_LINE, 1),
                       GNOMON_NAME(POLYGON_OFFSET_FACTOR, 1),
                       GNOMON_NAME(POLYGON_OFFSET_UNITS, 1),
                       GNOMON_NAME(POLYGON_SMOOTH, 1),
                       GNOMON_NAME(LINE_SMOOTH, 1),
                       GNOMON_NAME(LINE_WIDTH, 1),
                       GNOMON_NAME(POINT_SIZE, 1),
                       GNOMON_NAME(PROVOKING_VERTEX, 1),
                       GNOMON_NAME(DITHER, 1),
                       GNOMON_NAME(FRAMEBUFFER_SRGB, 1),
                       GNOMON_NAME(RASTERIZER_DISCARD, 1),
                       GNOMON_NAME(MULTISAMPLE, 1),
                       GNOMON_NAME(SAMPLE_ALPHA_TO_COVERAGE, 1),
                       GNOMON_NAME(SAMPLE_ALPHA_TO_ONE, 1),
                       GNOMON_NAME(SAMPLE_COVERAGE, 1),
                       GNOMON_NAME(SAMPLE_COVERAGE_VALUE, 1),
                       GNOMON_NAME(SAMPLE_COVERAGE_INVERT, 1),
                       GNOMON_NAME(SAMPLE_MASK, 1),
                       GNOMON_NAME(PRIMITIVE_RESTART, 1),
                       GNOMON_NAME(PRIMITIVE_RESTART_INDEX, 1),
                       GNOMON_NAME(CURRENT_PROGRAM, 1),
                       GNOMON_NAME(VERTEX_ARRAY_BINDING, 1),
                       GNOMON_NAME(ARRAY_BUFFER_BINDING, 1),
                       GNOMON_NAME(ELEMENT_ARRAY_BUFFER_BINDING, 1),
                       GNOMON_NAME(PIXEL_PACK_BUFFER_BINDING, 1),
                       GNOMON_NAME(PIXEL_UNPACK_BUFFER_BINDING, 1),
                       GNOMON_NAME(UNIFORM_BUFFER_BINDING, 1),
                       GNOMON_NAME(DRAW_FRAMEBUFFER_BINDING, 1),
                       GNOMON_NAME(READ_FRAMEBUFFER_BINDING, 1),
                       GNOMON_NAME(RENDERBUFFER_BINDING, 1),
                       GNOMON_NAME(READ_BUFFER, 1),
                       GNOMON_NAME(DRAW_BUFFER0, 1),
                       GNOMON_NAME(DRAW_BUFFER1, 1),
                       GNOMON_NAME(ACTIVE_TEXTURE, 1),
                       GNOMON_NAME(PACK_ALIGNMENT, 1),
                       GNOMON_NAME(PACK_ROW_LENGTH, 1),
                       GNOMON_NAME(PACK_SKIP_PIXELS, 1),
                       GNOMON_NAME(PACK_SKIP_ROWS, 1),
                       GNOMON_NAME(PACK_SWAP_BYTES, 1),
                       GNOMON_NAME(UNPACK_ALIGNMENT, 1),
                       GNOMON_NAME(UNPACK_ROW_LENGTH, 1),
                       GNOMON_NAME(UNPACK_SKIP_PIXELS, 1),
                       GNOMON_NAME(UNPACK_SKIP_ROWS, 1),
                       GNOMON_NAME(UNPACK_SWAP_BYTES, 1),
                       GNOMON_NAME(UNPACK_IMAGE_HEIGHT, 1),
                       GNOMON_NAME(UNPACK_SKIP_IMAGES, 1)};
#undef GNOMON_NAME

std::map<std::string, std::vector<double>> state() {
  std::map<std::string, std::vector<double>> out;
  while (glGetError() != GL_NO_ERROR) {
  }
  for (const Name& name : kNames) {
    std::vector<double> values(static_cast<std::size_t>(name.values));
    glGetDoublev(name.what, values.data());
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR)) << name.text;
    out[name.text] = values;
  }
  for (GLuint k = 0; k < 2; ++k) {  // of each draw buffer
    GLboolean mask[4];
    glGetBooleani_v(GL_COLOR_WRITEMASK, k, mask);
    out["COLOR_WRITEMASK " + std::to_string(k)].assign(mask, mask + 4);
    out["BLEND " + std::to_string(k)] = {double(glIsEnabledi(GL_BLEND, k))};
  }
  for (GLuint k = 0; k < 8; ++k)
    out["CLIP_DISTANCE " + std::to_string(k)] = {double(glIsEnabled(GL_CLIP_DISTANCE0 + k))};
  GLint sample_mask = 0;
  glGetIntegeri_v(GL_SAMPLE_MASK_VALUE, 0, &sample_mask);
  out["SAMPLE_MASK_VALUE"] = {double(sample_mask)};
  GLint active = 0;
  glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
  for (GLenum unit = 0; unit < 6; ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    GLint texture = 0, sampler = 0;
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &texture);
    glGetIntegerv(GL_SAMPLER_BINDING, &sampler);
    out["TEXTURE " + std::to_string(unit)] = {double(texture), double(sampler)};
  }
  glActiveTexture(static_cast<GLenum>(active));
  return out;
}

GLuint compile_flat() {
  const char* const vertex =
      "#version 330 core\nin vec3 a_position;\nuniform mat4 u_clip;\ninvariant gl_Position;\n"
      "void main() { gl_Position = u_clip * vec4(a_position, 1.0); }";
  const char* const fragment =
      "#version 330 core\nout vec4 o_colour;\nvoid main() { o_colour = vec4(1.0); }";
  const GLuint program = glCreateProgram();
  for (const auto& [stage, text] :
       {std::pair(GL_VERTEX_SHADER, vertex), {GL_FRAGMENT_SHADER, fragment}}) {
    const GLuint shader = glCreateShader(static_cast<GLenum>(stage));
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
  }
  glLinkProgram(program);
  return program;
}

// What an engine has: a framebuffer with two colours, depth and stencil, and its own objects.
struct Engine {
  GLuint framebuffer = 0, program = compile_flat(), array = 0, buffers[5]{}, textures[6]{},
         samplers[6]{}, renderbuffers[4]{};
  GLsizei corners = 0;

  explicit Engine(const TriMesh& mesh) {
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glGenRenderbuffers(4, renderbuffers);
    for (int k = 0; k < 3; ++k) {
      glBindRenderbuffer(GL_RENDERBUFFER, renderbuffers[k]);
      glRenderbufferStorage(GL_RENDERBUFFER, k == 2 ? GL_DEPTH24_STENCIL8 : GL_RGBA8, kSize, kSize);
      glFramebufferRenderbuffer(
          GL_FRAMEBUFFER,
          k == 2 ? GL_DEPTH_STENCIL_ATTACHMENT : static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + k),
          GL_RENDERBUFFER, renderbuffers[k]);
    }
    const GLenum both[2] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, both);
    glBindRenderbuffer(GL_RENDERBUFFER, renderbuffers[3]);
    std::vector<float> data;
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t v : t) {
        for (int k = 0; k < 3; ++k) data.push_back(static_cast<float>(mesh.positions[v][k]));
      }
    }
    corners = static_cast<GLsizei>(data.size() / 3);
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenBuffers(5, buffers);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size() * sizeof(float)), data.data(),
                 GL_STATIC_DRAW);
    const auto at = static_cast<GLuint>(glGetAttribLocation(program, "a_position"));
    glEnableVertexAttribArray(at);
    glVertexAttribPointer(at, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    glGenTextures(6, textures);
    glGenSamplers(6, samplers);
    const std::vector<std::uint8_t> texels(4 * 4 * 4, 200);
    for (GLuint unit = 0; unit < 6; ++unit) {
      glActiveTexture(GL_TEXTURE0 + unit);
      glBindTexture(GL_TEXTURE_2D, textures[unit]);
      glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    }
  }

  // Everything that is at its default again, but what is bound: the engine draws its depths.
  void draw_depths(const glm::mat4& clip) const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, kSize, kSize);
    glEnable(GL_DEPTH_TEST);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    glUseProgram(program);
    glUniformMatrix4fv(glGetUniformLocation(program, "u_clip"), 1, GL_FALSE, glm::value_ptr(clip));
    glBindVertexArray(array);
    glDrawArrays(GL_TRIANGLES, 0, corners);
  }

  // Nothing is at its default. The viewport is that of the engine's picture.
  void set_unusual_state() const {
    glScissor(3, 5, 7, 11);
    glEnable(GL_SCISSOR_TEST);
    glClearColor(0.1f, 0.2f, 0.3f, 0.4f);
    glClearDepth(0.25);
    glClearStencil(77);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_FALSE);
    glEnable(GL_DEPTH_CLAMP);
    glEnable(GL_STENCIL_TEST);
    glStencilFuncSeparate(GL_FRONT, GL_NOTEQUAL, 3, 0x55);
    glStencilFuncSeparate(GL_BACK, GL_GEQUAL, 5, 0xaa);
    glStencilMaskSeparate(GL_FRONT, 0x0f);
    glStencilMaskSeparate(GL_BACK, 0xf0);
    glStencilOpSeparate(GL_FRONT, GL_INVERT, GL_ZERO, GL_REPLACE);
    glStencilOpSeparate(GL_BACK, GL_REPLACE, GL_INVERT, GL_INCR);
    glEnablei(GL_BLEND, 0);
    glDisablei(GL_BLEND, 1);
    glBlendFuncSeparate(GL_DST_COLOR, GL_SRC_ALPHA, GL_ONE_MINUS_DST_ALPHA, GL_CONSTANT_COLOR);
    glBlendEquationSeparate(GL_FUNC_REVERSE_SUBTRACT, GL_MAX);
    glBlendColor(0.2f, 0.4f, 0.6f, 0.8f);
    glColorMaski(0, GL_TRUE, GL_FALSE, GL_FALSE, GL_TRUE);
    glColorMaski(1, GL_FALSE, GL_TRUE, GL_TRUE, GL_FALSE);
    glEnable(GL_COLOR_LOGIC_OP);
    glLogicOp(GL_XOR);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT_AND_BACK);
    glFrontFace(GL_CW);
    glPolygonMode(GL_FRONT_AND_BACK, GL_POINT);
    for (const GLenum what :
         {GL_POLYGON_OFFSET_FILL, GL_POLYGON_OFFSET_LINE, GL_POLYGON_SMOOTH, GL_LINE_SMOOTH,
          GL_FRAMEBUFFER_SRGB, GL_RASTERIZER_DISCARD, GL_SAMPLE_ALPHA_TO_COVERAGE,
          GL_SAMPLE_ALPHA_TO_ONE, GL_SAMPLE_COVERAGE, GL_SAMPLE_MASK, GL_PRIMITIVE_RESTART}) {
      glEnable(what);
    }
    for (const GLenum what : {GL_DITHER, GL_MULTISAMPLE}) glDisable(what);
    for (GLenum k = 0; k < 8; k += 2) glEnable(GL_CLIP_DISTANCE0 + k);
    glPolygonOffset(2, 3);
    glPointSize(3);
    glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
    glSampleCoverage(0.25f, GL_TRUE);
    glSampleMaski(0, 0x2);
    glPrimitiveRestartIndex(2);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[2]);
    glBindBuffer(GL_UNIFORM_BUFFER, buffers[2]);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffers[3]);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffers[4]);
    for (GLuint unit = 0; unit < 6; ++unit) glBindSampler(unit, samplers[unit]);
    glActiveTexture(GL_TEXTURE4);
    for (const bool pack : {true, false}) {
      glPixelStorei(pack ? GL_PACK_ALIGNMENT : GL_UNPACK_ALIGNMENT, 8);
      glPixelStorei(pack ? GL_PACK_ROW_LENGTH : GL_UNPACK_ROW_LENGTH, 1000);
      glPixelStorei(pack ? GL_PACK_SKIP_PIXELS : GL_UNPACK_SKIP_PIXELS, 13);
      glPixelStorei(pack ? GL_PACK_SKIP_ROWS : GL_UNPACK_SKIP_ROWS, 17);
      glPixelStorei(pack ? GL_PACK_SWAP_BYTES : GL_UNPACK_SWAP_BYTES, GL_TRUE);
    }
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 3);
    glPixelStorei(GL_UNPACK_SKIP_IMAGES, 1);
  }

  // The lit bit of every pixel as draw_mask()'s stencil has it.
  std::vector<std::uint8_t> lit(const FrameStats& stats) const {
    std::vector<std::uint8_t> stencil(std::size_t{kSize} * kSize);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    for (const GLenum what : {GL_PACK_ROW_LENGTH, GL_PACK_SKIP_PIXELS, GL_PACK_SKIP_ROWS})
      glPixelStorei(what, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glReadPixels(0, 0, kSize, kSize, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, stencil.data());
    for (std::uint8_t& s : stencil)
      s = static_cast<int>(s & stats.lit_bits) <= stats.lit_at_most ? 1 : 0;
    return stencil;
  }
};

void expect_same(const std::map<std::string, std::vector<double>>& before,
                 const std::string& call) {
  const auto after = state();
  for (const auto& [name, value] : before) EXPECT_EQ(after.at(name), value) << name << ": " << call;
}

std::vector<Method> masks() {
  std::vector<Method> out(3);
  out[1].mask = MaskIn::alpha;
  out[2].mask = MaskIn::screen;
  return out;
}

TriMesh one_box() {  // closed and convex: for an alpha mask in 8 bits
  TriMesh m;
  test::add_box(m, {-3, -2, 0}, {1, 2, 6});
  return m;
}

Overlay everything_over(const Method& method) {
  Overlay over{true, true, true, true, method.mask == MaskIn::stencil, {}};
  over.frustum = camera_of(aerial(kSize, kSize), {.near_plane = 2, .far_plane = 30});
  return over;
}

TEST(State, EveryCallLeavesAnEnginesStateAsItWas) {
  const TriMesh mesh = test::scene_of(one_box()).mesh;  // welded, so that it is closed
  Stage stage = stage_of(test::scene_of(mesh));
  const Engine engine(mesh);
  const Camera camera = camera_of(aerial(kSize, kSize), {.near_plane = 1});
  const Light lamp(5, -4, 15, 1);
  const LightSource source{lamp};
  engine.draw_depths(stage.renderer.clip_of(0, camera));
  engine.set_unusual_state();
  glDepthRange(0.125, 0.75);
  const auto before = state();

  Renderer renderer = Renderer::create(find_capabilities().value()).value();
  expect_same(before, "create");
  const MeshId id = renderer.add_mesh(mesh);
  expect_same(before, "add_mesh");
  const InstanceId instance = renderer.add_instance(id);
  renderer.remove_instance(renderer.add_scene(test::scene_of(mesh)));
  expect_same(before, "add_scene");
  renderer.update_mesh(id, mesh.positions);
  expect_same(before, "update_mesh");
  std::vector<float> floats;
  for (const Vec3& p : mesh.positions)
    floats.insert(floats.end(), {float(p.x), float(p.y), float(p.z)});
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(floats.size() * sizeof(float)),
               floats.data(), GL_STATIC_DRAW);
  EXPECT_TRUE(renderer.update_mesh_from_buffer(id, engine.buffers[2], 0, 12));
  expect_same(before, "update_mesh_from_buffer");
  for (const Method& method : masks()) {
    FrameOptions options;
    options.method = method;
    for (const bool overlaid : {false, true}) {
      if (overlaid) options.overlay = everything_over(method);
      const auto drawn = renderer.draw(camera, {&source, 1}, options);
      EXPECT_TRUE(drawn) << drawn.error().message;
      expect_same(before, "draw: " + describe(method));
    }
    renderer.read();
    expect_same(before, "read");
    renderer.present();
    expect_same(before, "present");
    EXPECT_TRUE(renderer.mask(camera, lamp, method));
    expect_same(before, "mask: " + describe(method));
    if (method.mask != MaskIn::screen) {
      const auto drawn = renderer.draw_mask(camera, lamp, method);
      EXPECT_TRUE(drawn) << drawn.error().message;
      expect_same(before, "draw_mask: " + describe(method));
    }
  }
  renderer.move_instance(instance, glm::dmat4(1.0));
  renderer.remove_instance(instance);
  renderer.finish();
  expect_same(before, "remove_instance");
}

TEST(DrawMask, RefusesAnAlphaMaskThatEightBitsCannotCount) {
  const TriMesh mesh = boxes_on_ground();  // the ground is not closed
  Stage stage = stage_of(test::scene_of(mesh));
  const Engine engine(mesh);
  const Camera camera = camera_of(aerial(kSize, kSize), {.near_plane = 1});
  engine.draw_depths(stage.renderer.clip_of(0, camera));
  const auto drawn = stage.renderer.draw_mask(camera, Light(5, -4, 15, 1), {.mask = MaskIn::alpha});
  ASSERT_FALSE(drawn);
  EXPECT_NE(drawn.error().message.find("floats"), std::string::npos);
}

// An engine need not add what only receives: volumes do not end below what was added.
TEST(DrawMask, ShadesWhatWasNotAdded) {
  TriMesh casters;
  test::add_box(casters, {-3, -2, 1}, {1, 2, 6});
  TriMesh all = casters;
  test::add_ground(all, 20);
  const Light lamp(-5, 4, 15, 1);
  Stage stage = stage_of(test::scene_of(casters));
  const Engine engine(all);
  const View view = aerial(kSize, kSize);
  const Camera camera = camera_of(view, {.near_plane = 1});
  engine.draw_depths(stage.renderer.clip_of(0, camera));
  const std::vector<std::uint8_t> lit =
      engine.lit(stage.renderer.draw_mask(camera, lamp, {}).value());
  const ShadowMask exact = exact_mask(test::scene_of(all), lamp, view);
  const auto shadow = std::count(exact.state.begin(), exact.state.end(), ShadowMask::kShadow);
  ASSERT_GT(shadow, 100);
  EXPECT_NEAR(double(std::count(lit.begin(), lit.end(), 0)), double(shadow), 5);
}

TEST(DrawMask, CountsAnewAfterAPictureWithoutLights) {
  const TriMesh mesh = boxes_on_ground();
  Stage stage = stage_of(test::scene_of(mesh));
  const Engine engine(mesh);
  const Camera camera = camera_of(aerial(kSize, kSize), {.near_plane = 1});
  const Light lamp(5, -4, 15, 1);
  std::vector<std::vector<std::uint8_t>> lit;
  for (const bool after : {false, true}) {
    if (after) (void)stage.renderer.draw(camera, {}, {}).value();
    engine.draw_depths(stage.renderer.clip_of(0, camera));
    glClearStencil(200);
    glClear(GL_STENCIL_BUFFER_BIT);
    lit.push_back(engine.lit(stage.renderer.draw_mask(camera, lamp, {}).value()));
  }
  EXPECT_EQ(lit[0], lit[1]);
}

TEST(DrawMask, KeepsTheVolumesOfEachNumberedLight) {
  const TriMesh mesh = boxes_on_ground();
  Stage stage = stage_of(test::scene_of(mesh));
  const Engine engine(mesh);
  const Camera camera = camera_of(aerial(kSize, kSize), {.near_plane = 1});
  for (int frame = 0; frame < 3; ++frame) {
    for (const std::uint32_t k : {0u, 1u}) {
      engine.draw_depths(stage.renderer.clip_of(0, camera));
      const Light lamp(k == 0 ? 5 : -5, 4, 15, 1);
      const FrameStats stats = stage.renderer.draw_mask(camera, lamp, {}, k).value();
      EXPECT_EQ(stats.rebuilt, frame == 0 ? 1 : 0);
    }
  }
}

TEST(DrawMask, RefusesClipSpacesThatAreNotOpenGLsUsualOne) {
  const TriMesh mesh = one_box();
  Stage stage = stage_of(test::scene_of(mesh));
  const Engine engine(mesh);
  const Camera camera = camera_of(aerial(kSize, kSize), {.near_plane = 1});
  engine.draw_depths(stage.renderer.clip_of(0, camera));
  glDepthRange(1, 0);
  EXPECT_FALSE(stage.renderer.draw_mask(camera, Light(5, -4, 15, 1), {}));
  glDepthRange(0, 1);
  EXPECT_TRUE(stage.renderer.draw_mask(camera, Light(5, -4, 15, 1), {}));
  if (!epoxy_has_gl_extension("GL_ARB_clip_control")) return;
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  EXPECT_FALSE(stage.renderer.draw_mask(camera, Light(5, -4, 15, 1), {}));
}

TEST(State, UnusualStateOfAnEngineSpoilsNoPictureAndNoMask) {
  const TriMesh mesh = boxes_on_ground();
  const Scene scene = test::scene_of(mesh);
  Stage stage = stage_of(scene);
  const Engine engine(mesh);
  const Camera camera = camera_of(aerial(kSize, kSize), {.near_plane = 1});
  const LightSource source{Light(5, -4, 15, 1)};
  std::vector<std::vector<std::uint8_t>> usual, unusual;
  for (const bool second : {false, true}) {
    auto& out = second ? unusual : usual;
    // Depths of an engine with a depth range of its own; the provoking vertex is the same for
    // depths and mask, as their rounding depends on it.
    glDepthRange(0, second ? 0.5 : 1);
    engine.draw_depths(stage.renderer.clip_of(0, camera));
    if (second) engine.set_unusual_state();
    Renderer renderer = Renderer::create(find_capabilities().value()).value();
    renderer.add_scene(scene);
    for (const Method& method : masks()) {
      FrameOptions options;
      options.method = method;
      for (const bool overlaid : {false, true}) {
        if (overlaid) options.overlay = everything_over(method);
        out.push_back(renderer.render(camera, {&source, 1}, options).value().rgba);
      }
      out.push_back(renderer.mask(camera, source.light, method).value().state);
    }
    glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
    out.push_back(engine.lit(renderer.draw_mask(camera, source.light, {}).value()));
  }
  const auto different = [&](std::size_t k) {
    int n = usual[k].size() == unusual[k].size() ? 0 : -1;
    for (std::size_t i = 0; n >= 0 && i < usual[k].size(); ++i) n += usual[k][i] != unusual[k][i];
    return n;
  };
  for (std::size_t k = 0; k < usual.size(); ++k) EXPECT_EQ(different(k), 0) << k;
  const int lit = static_cast<int>(std::count(usual.back().begin(), usual.back().end(), 1));
  EXPECT_GT(lit, kSize * kSize / 4);
  EXPECT_LT(lit, kSize * kSize);
}

}  // namespace
}  // namespace gnomon::gl
