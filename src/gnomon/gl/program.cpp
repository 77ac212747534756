#include <gnomon/gl/program.h>

#include <array>
#include <iterator>
#include <vector>

#include <glm/gtc/type_ptr.hpp>

#include <gnomon/gl/shaders.h>

namespace gnomon::gl {
namespace {

Result<GLuint> compile_stage(std::string_view name, GLenum stage, std::string_view text,
                             const std::string& defines) {
  const std::string version =
      epoxy_is_desktop_gl() ? "#version 330 core\n"
                            : "#version 300 es\nprecision highp float;\nprecision highp int;\n"
                              "precision highp sampler2D;\n";
  const std::string source = version + defines + std::string(text);
  const GLuint shader = glCreateShader(stage);
  const char* data = source.c_str();
  glShaderSource(shader, 1, &data, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good == GL_TRUE) return shader;
  std::array<char, 2048> log{};
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  glDeleteShader(shader);
  return Error{"OpenGL does not compile the " +
               std::string(stage == GL_VERTEX_SHADER ? "vertex" : "fragment") + " shader '" +
               std::string(name) + "': " + log.data()};
}

}  // namespace

Result<ProgramHandle> compile(std::string_view name, std::string_view vertex,
                              std::string_view fragment, const std::string& defines) {
  const Result<GLuint> v = compile_stage(name, GL_VERTEX_SHADER, vertex, defines);
  if (!v) return v.error();
  const Result<GLuint> f = compile_stage(name, GL_FRAGMENT_SHADER, fragment, defines);
  if (!f) {
    glDeleteShader(v.value());
    return f.error();
  }
  ProgramHandle program = ProgramHandle::make();
  glAttachShader(program.id(), v.value());
  glAttachShader(program.id(), f.value());
  glBindAttribLocation(program.id(), kVertex, "a_vertex");
  glBindAttribLocation(program.id(), kNormal, "a_normal");
  glBindAttribLocation(program.id(), kTexture, "a_texture");
  glLinkProgram(program.id());
  glDeleteShader(v.value());
  glDeleteShader(f.value());
  GLint good = 0;
  glGetProgramiv(program.id(), GL_LINK_STATUS, &good);
  if (good == GL_TRUE) return program;
  std::array<char, 2048> log{};
  glGetProgramInfoLog(program.id(), static_cast<GLsizei>(log.size()), nullptr, log.data());
  return Error{"OpenGL does not link the shaders '" + std::string(name) + "': " + log.data()};
}

void set(GLuint program, const char* name, int value) {
  glUniform1i(glGetUniformLocation(program, name), value);
}
void set(GLuint program, const char* name, float value) {
  glUniform1f(glGetUniformLocation(program, name), value);
}
void set(GLuint program, const char* name, const glm::vec3& value) {
  glUniform3fv(glGetUniformLocation(program, name), 1, glm::value_ptr(value));
}
void set(GLuint program, const char* name, const glm::vec4& value) {
  glUniform4fv(glGetUniformLocation(program, name), 1, glm::value_ptr(value));
}
void set(GLuint program, const char* name, const glm::mat3& value) {
  glUniformMatrix3fv(glGetUniformLocation(program, name), 1, GL_FALSE, glm::value_ptr(value));
}
void set(GLuint program, const char* name, const glm::mat4& value) {
  glUniformMatrix4fv(glGetUniformLocation(program, name), 1, GL_FALSE, glm::value_ptr(value));
}

Result<Programs> compile_programs() {
  using namespace shaders;
  Programs p;
  struct Item {
    ProgramHandle* to;
    const char *name, *vertex, *fragment, *defines;
  };
  const Item items[] = {
      {&p.volume_inside, "volume, clipped", kVolumeVertex, kColourFragment,
       "#define FACES\n#define SHADER\n#define INSIDE\n"},
      {&p.flat_inside, "flat, clipped", kFlatVertex, kColourFragment, "#define INSIDE\n"},
      {&p.near_light, "near plane from the light", kNearLightVertex, kNearLightFragment, ""},
      {&p.flat, "flat", kFlatVertex, kColourFragment, ""},
      {&p.rectangle, "rectangle", kRectangleVertex, kColourFragment, ""},
      {&p.texture, "texture", kRectangleVertex, kTextureFragment, ""},
      {&p.overflow, "overflow", kRectangleVertex, kOverflowFragment, ""},
      {&p.plain, "plain", kPlainVertex, kColourFragment, ""},
  };
  for (const Item& item : items) {
    Result<ProgramHandle> made = compile(item.name, item.vertex, item.fragment, item.defines);
    if (!made) return made.error();
    *item.to = std::move(made).value();
  }
  const char* by_extrusion[] = {"", "#define SHADER\n", "#define BLEND\n", "#define BLEND\n"};
  struct Variant {
    ProgramHandle* to;
    const char *name, *defines;
  };
  std::vector<Variant> variants{{p.volume, "volume", ""},
                                {p.volume_cut, "volume, cut", "#define CUT\n"}};
  if (epoxy_is_desktop_gl()) {
    variants.push_back(
        {p.volume_near_clip, "volume, clipped by the near plane", "#define NEAR_CLIP\n"});
  }
  for (const Variant& variant : variants) {
    for (std::size_t k = 0; k < std::size(by_extrusion); ++k) {
      Result<ProgramHandle> made =
          compile(variant.name, kVolumeVertex, kColourFragment,
                  std::string("#define FACES\n") + variant.defines + by_extrusion[k]);
      if (!made) return made.error();
      variant.to[k] = std::move(made).value();
    }
  }
  return p;
}

Result<GLuint> surface_program(Programs& programs, unsigned variant) {
  ProgramHandle& program = programs.surface[variant];
  if (!program) {
    constexpr const char* kNames[] = {"LIT",    "TEXTURED", "FACETS", "SPECULAR",
                                      "FADING", "MASKED",   "INSIDE"};
    std::string defines;
    for (int i = 0; i < 7; ++i) {
      if ((variant >> i & 1u) != 0) defines += std::string("#define ") + kNames[i] + "\n";
    }
    Result<ProgramHandle> made =
        compile("surface", shaders::kSurfaceVertex, shaders::kSurfaceFragment, defines);
    if (!made) return made.error();
    program = std::move(made).value();
  }
  return program.id();
}

}  // namespace gnomon::gl
