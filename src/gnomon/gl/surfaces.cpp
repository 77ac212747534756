// Surfaces and rectangles.
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <gnomon/gl/renderer_state.h>

namespace gnomon::gl {
namespace {

void draw_surfaces(const Frame& frame, GLuint program, const glm::vec4& colour) {
  glUseProgram(program);
  set(program, "u_colour", colour);
  for (const InstanceSlot& instance : frame.state->instances) {
    if (!instance.alive) continue;
    const GpuMesh& mesh = frame.state->meshes[instance.mesh].gpu;
    if (mesh.surface_count == 0) continue;
    set(program, "u_clip", frame.clip_of(instance));
    glBindVertexArray(mesh.surface.id());
    glDrawElements(GL_TRIANGLES, mesh.surface_count, GL_UNSIGNED_INT, nullptr);
  }
  ++frame.stats->passes;
}

}  // namespace

void draw_depth(const Frame& frame, const Pass& pass) { draw_flat(frame, pass, glm::vec4(0)); }

void draw_flat(const Frame& frame, const Pass& pass, const glm::vec4& colour) {
  apply(pass, frame);
  draw_surfaces(frame, frame.state->programs.flat.id(), colour);
}

void draw_lit(const Frame& frame, const Pass& pass, const Lighting& l) {
  apply(pass, frame);
  const LightSource none{{0, 0, 1, 0}, {0, 0, 0}, {1, 0, 0}, 0};
  const LightSource& light = l.light != nullptr ? *l.light : none;
  Vec4 towards = light.light;
  if (towards.w != 0) towards /= towards.w;
  unsigned common = 0;
  if (l.light != nullptr) {
    common |= kLit;
    if (towards.w != 0 && (light.attenuation != Vec3(1, 0, 0) || light.radius > 0))
      common |= kFading;
    if (l.mask != nullptr) common |= kMasked;
  }
  GLuint program = 0;
  for (const InstanceSlot& instance : frame.state->instances) {
    if (!instance.alive) continue;
    const GpuMesh& mesh = frame.state->meshes[instance.mesh].gpu;
    glBindVertexArray(mesh.shaded.id());
    GLuint of_instance = 0;
    for (const MaterialRange& range : mesh.materials) {
      const GpuMaterial& look = range.material;
      unsigned variant = common;
      if (look.base_texture || (l.light != nullptr && look.normal_texture)) variant |= kTextured;
      if (l.light != nullptr && mesh.smooth) variant |= kSmooth;
      if (l.light != nullptr && look.shininess > 0) variant |= kSpecular;
      const Result<GLuint> made = surface_program(frame.state->programs, variant);
      if (!made) {
        frame.state->failure = made.error();
        return;
      }
      if (made.value() != program) {
        program = made.value();
        glUseProgram(program);
        set(program, "u_eye", glm::vec4(frame.camera->eye));
        set(program, "u_light", glm::vec4(towards));
        set(program, "u_light_colour", glm::vec3(light.colour));
        set(program, "u_attenuation", glm::vec3(light.attenuation));
        set(program, "u_radius", static_cast<float>(light.radius));
        set(program, "u_ambient", glm::vec3(l.ambient));
        set(program, "u_base_map", 0);
        set(program, "u_normal_map", 1);
        set(program, "u_mask", 2);
        if (l.mask != nullptr) {
          glActiveTexture(GL_TEXTURE2);
          glBindTexture(GL_TEXTURE_2D, l.mask->colour.id());
          set(program, "u_mask_channel", l.mask_channel);
          glUniform2f(glGetUniformLocation(program, "u_mask_scale"),
                      1.0f / static_cast<float>(frame.camera->width),
                      1.0f / static_cast<float>(frame.camera->height));
        }
      }
      if (of_instance != program) {
        of_instance = program;
        set(program, "u_clip", frame.clip_of(instance));
        set(program, "u_model", glm::mat4(instance.to_scene));
        set(program, "u_normal_matrix",
            glm::mat3(glm::transpose(glm::inverse(glm::dmat3(instance.to_scene)))));
      }
      set(program, "u_base", look.base_colour);
      set(program, "u_emissive", l.emission ? look.emissive : glm::vec3(0.0f));
      set(program, "u_specular", look.specular);
      set(program, "u_shininess", look.shininess);
      set(program, "u_normal_scale", look.normal_scale);
      set(program, "u_has_base", look.base_texture ? 1 : 0);
      set(program, "u_has_normal", look.normal_texture ? 1 : 0);
      if (look.base_texture) {
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_2D, mesh.textures[*look.base_texture].id());
      }
      if (look.normal_texture) {
        glActiveTexture(GL_TEXTURE1);
        glBindTexture(GL_TEXTURE_2D, mesh.textures[*look.normal_texture].id());
      }
      glDrawArrays(GL_TRIANGLES, range.first, range.count);
    }
  }
  ++frame.stats->passes;
}

void draw_rectangle(const Frame& frame, const Pass& pass, const glm::vec4& colour, float depth) {
  apply(pass, frame);
  const GLuint program = frame.state->programs.rectangle.id();
  glUseProgram(program);
  set(program, "u_colour", colour);
  set(program, "u_depth", depth);
  glBindVertexArray(frame.state->empty.id());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void draw_texture(const Frame& frame, const Pass& pass, const Target& from,
                  const std::optional<glm::vec4>& channel) {
  apply(pass, frame);
  const GLuint program = frame.state->programs.texture.id();
  glUseProgram(program);
  glActiveTexture(GL_TEXTURE3);
  glBindTexture(GL_TEXTURE_2D, from.colour.id());
  set(program, "u_image", 3);
  set(program, "u_one_channel", channel ? 1 : 0);
  set(program, "u_channel", channel.value_or(glm::vec4(0)));
  set(program, "u_depth", -1.0f);
  glBindVertexArray(frame.state->empty.id());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

}  // namespace gnomon::gl
