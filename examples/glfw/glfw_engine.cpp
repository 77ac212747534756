// Gnomon's shadows in a render loop that is not Gnomon's: a window of GLFW, vertex buffers, shaders
// and passes of its own, a lamp and a box that move. What is Gnomon's is marked with "G:".
//   glfw_engine [--frame N --save PICTURE.ppm]     draws frame N alone, into a file
#include <GLFW/glfw3.h>
#include <epoxy/gl.h>

#include <cstdlib>
#include <iostream>
#include <string>

#include <gnomon/gl/renderer.h>
#include <glm/gtc/type_ptr.hpp>

#include "save_window.h"
#include "things.h"

namespace gl = gnomon::gl;

// G: "invariant", and this very expression, so that depths are the bits of the volumes'.
static const char* const kVertex = R"(#version 330 core
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
uniform mat4 u_clip, u_place;
invariant gl_Position;
out vec3 v_position, v_normal;
void main() {
  gl_Position = u_clip * vec4(a_position, 1.0);
  v_position = (u_place * vec4(a_position, 1.0)).xyz;
  v_normal = mat3(u_place) * a_normal;
})";
static const char* const kFragment = R"(#version 330 core
in vec3 v_position, v_normal;
uniform vec3 u_lamp;
uniform vec2 u_share;  // of the ambient light, of the lamp's
out vec4 o_colour;
void main() {
  float facing = max(dot(normalize(v_normal), normalize(u_lamp - v_position)), 0.0);
  o_colour = vec4(vec3(u_share.x + u_share.y * (0.2 + facing)), 1.0);
})";

static GLuint link_program() {
  const GLuint program = glCreateProgram();
  for (const bool vertex : {true, false}) {
    const GLuint shader = glCreateShader(vertex ? GL_VERTEX_SHADER : GL_FRAGMENT_SHADER);
    glShaderSource(shader, 1, vertex ? &kVertex : &kFragment, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
  }
  glLinkProgram(program);
  return program;
}

struct Body {
  gl::InstanceId shadow;  // G: the instance that casts for it
  glm::dmat4 place;
  GLuint array = 0;
  GLsizei corners = 0;
};

static Body make_body(const Thing& thing, gl::Renderer& shadows) {
  Body body{shadows.add_instance(shadows.add_mesh(thing.mesh), thing.place), thing.place};  // G
  std::vector<glm::vec3> data;  // position and normal of each corner
  for (const gnomon::Triangle& t : thing.mesh.triangles) {
    const auto& p = thing.mesh.positions;
    const gnomon::Vec3 n = glm::normalize(glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
    for (const auto v : t) data.insert(data.end(), {glm::vec3(p[v]), glm::vec3(n)});
  }
  GLuint buffer = 0;
  glGenVertexArrays(1, &body.array);
  glBindVertexArray(body.array);
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(data.size() * sizeof(glm::vec3)), data.data(),
               GL_STATIC_DRAW);
  for (const GLuint k : {0u, 1u}) {
    glEnableVertexAttribArray(k);
    glVertexAttribPointer(k, 3, GL_FLOAT, GL_FALSE, 2 * sizeof(glm::vec3),
                          reinterpret_cast<void*>(k * sizeof(glm::vec3)));
  }
  body.corners = GLsizei(data.size() / 2);
  return body;
}

int main(int argc, char** argv) {
  const int only = argc == 5 ? std::atoi(argv[2]) : -1;
  const auto fail = [](const std::string& why) {
    std::cerr << "glfw_engine: " << why << '\n';
    return 1;
  };
  if (glfwInit() == GLFW_FALSE) return fail("GLFW finds no display");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_STENCIL_BITS, 8);
  GLFWwindow* window = glfwCreateWindow(640, 480, "Gnomon in another renderer", nullptr, nullptr);
  if (window == nullptr) return fail("no window with OpenGL 3.3 and a stencil buffer");
  glfwMakeContextCurrent(window);

  auto shadows = gl::Renderer::create(gl::find_capabilities().value()).value();  // G
  std::vector<Body> bodies;
  for (const Thing& thing : things()) bodies.push_back(make_body(thing, shadows));
  const GLuint program = link_program();
  const auto at = [&](const char* name) { return glGetUniformLocation(program, name); };
  glEnable(GL_DEPTH_TEST);

  for (int frame = only < 0 ? 0 : only; glfwWindowShouldClose(window) == GLFW_FALSE; ++frame) {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    const gnomon::Light lamp = lamp_of(frame);
    bodies[0].place = flight_of(frame);
    shadows.move_instance(bodies[0].shadow, bodies[0].place);                              // G
    const auto camera = gl::camera_of(view_matrix(width, height), width, height).value();  // G
    const auto draw = [&](float ambient, float light) {
      glUseProgram(program);
      glUniform3fv(at("u_lamp"), 1, glm::value_ptr(glm::vec3(lamp)));
      glUniform2f(at("u_share"), ambient, light);
      for (const Body& body : bodies) {
        const glm::mat4 clip = shadows.clip_of(body.shadow, camera), place(body.place);  // G
        glUniformMatrix4fv(at("u_clip"), 1, GL_FALSE, glm::value_ptr(clip));
        glUniformMatrix4fv(at("u_place"), 1, GL_FALSE, glm::value_ptr(place));
        glBindVertexArray(body.array);
        glDrawArrays(GL_TRIANGLES, 0, body.corners);
      }
    };

    glViewport(0, 0, width, height);
    glClearColor(0.6f, 0.7f, 0.8f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    draw(0.25f, 0.0f);  // the ambient pass leaves the depths

    const auto drawn = shadows.draw_mask(camera, lamp, {});  // G: into the stencil of this window
    if (!drawn) return fail(drawn.error().message);

    glEnable(GL_STENCIL_TEST);  // the lamp, where it reaches: (stencil & bits) <= at most
    glStencilFunc(GL_GEQUAL, drawn.value().lit_at_most, drawn.value().lit_bits);
    glDepthFunc(GL_EQUAL);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    draw(0.0f, 0.6f);
    glDisable(GL_BLEND);
    glDisable(GL_STENCIL_TEST);
    glDepthFunc(GL_LESS);

    if (only >= 0)
      return save_window(width, height, argv[4]) ? 0 : fail("cannot write the picture");
    glfwSwapBuffers(window);
    glfwPollEvents();
  }
}
