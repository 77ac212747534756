// Surfaces and rectangles.
#include <cstdint>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <gnomon/gl/renderer_state.h>

namespace gnomon::gl {
namespace {

// Sets the pass again where another culling is wanted than the last time.
class Culling {
 public:
  Culling(const Frame& frame, const Pass& pass) : frame_(frame), pass_(pass) {
    apply(pass_, frame_);
  }
  void set(bool cull) {
    if (cull == on_) return;
    on_ = cull;
    Pass p = pass_;
    if (cull) p.cull = GL_BACK;
    apply(p, frame_);
  }

 private:
  const Frame& frame_;
  const Pass& pass_;
  bool on_ = false;
};

// Some receiving triangles in one colour, of the vertices that all triangles share.
class FlatSurfaces {
 public:
  explicit FlatSurfaces(const Frame& frame)
      : frame_(frame),
        inside_(frame.camera->keep_inside),
        program_(inside_ ? frame.state->programs.flat_inside.id()
                         : frame.state->programs.flat.id()) {}
  void use(const InstanceSlot& instance, const GpuMesh& mesh) const {
    glUseProgram(program_);
    set(program_, "u_clip", frame_.clip_of(instance));
    if (inside_) set(program_, "u_inside", glm::mat4(*inside_ * instance.to_scene));
    glBindVertexArray(mesh.surface.id());
  }
  void draw(const glm::vec4& colour, GLsizei first, GLsizei count) const {
    if (count == 0) return;
    set(program_, "u_colour", colour);
    glDrawElements(
        GL_TRIANGLES, count, GL_UNSIGNED_INT,
        reinterpret_cast<const void*>(static_cast<std::uintptr_t>(first) * sizeof(std::uint32_t)));
  }

 private:
  const Frame& frame_;
  const std::optional<glm::dmat4>& inside_;
  GLuint program_;
};

}  // namespace

// Back faces of solid parts are left out where no such part may have the near rectangle inside.
bool culls_back_faces(const Frame& frame, const InstanceSlot& instance, const GpuMesh& mesh) {
  if (mesh.solid_count == 0) return false;
  const glm::dmat4 to_mesh = glm::inverse(instance.to_scene);
  Vec3 lo(to_mesh * point(frame.camera->near_rectangle[0])), hi = lo;
  for (const Vec3& corner : frame.camera->near_rectangle) {
    lo = glm::min(lo, Vec3(to_mesh * point(corner)));
    hi = glm::max(hi, Vec3(to_mesh * point(corner)));
  }
  for (std::size_t p = 0; p < mesh.parts.parts.size(); ++p) {
    const Part& part = mesh.parts.parts[p];
    if (part.winding > 0 && mesh.part_seen[p] != 0 && lo.x <= part.hi.x && part.lo.x <= hi.x &&
        lo.y <= part.hi.y && part.lo.y <= hi.y && lo.z <= part.hi.z && part.lo.z <= hi.z) {
      return false;
    }
  }
  return true;
}

void draw_depth(const Frame& frame, const Pass& pass) { draw_flat(frame, pass, glm::vec4(0)); }

void draw_flat(const Frame& frame, const Pass& pass, const glm::vec4& colour) {
  Culling culling(frame, pass);
  const FlatSurfaces flat(frame);
  for (const InstanceSlot& instance : frame.state->instances) {
    if (!instance.alive) continue;
    const GpuMesh& mesh = frame.state->meshes[instance.mesh].gpu;
    if (mesh.surface_count == 0) continue;
    const GLsizei solid = culls_back_faces(frame, instance, mesh) ? mesh.solid_count : 0;
    flat.use(instance, mesh);
    if (solid > 0) culling.set(true);
    flat.draw(colour, 0, solid);
    culling.set(false);
    flat.draw(colour, solid, mesh.surface_count - solid);
  }
  ++frame.stats->passes;
}

void draw_lit(const Frame& frame, const Pass& pass, const Lighting& l) {
  Culling culling(frame, pass);
  const LightSource none{{0, 0, 1, 0}, {0, 0, 0}, {1, 0, 0}, 0};
  const LightSource& light = l.light != nullptr ? *l.light : none;
  Vec4 towards = light.light;
  if (towards.w != 0) towards /= towards.w;
  const std::optional<glm::dmat4>& inside = frame.camera->keep_inside;
  unsigned common = inside ? kInside : 0u;
  if (l.light != nullptr) {
    common |= kLit;
    if (towards.w != 0 && (light.attenuation != Vec3(1, 0, 0) || light.radius > 0))
      common |= kFading;
    if (l.mask != nullptr) common |= kMasked;
  }
  const FlatSurfaces flat(frame);
  GLuint program = 0;
  for (const InstanceSlot& instance : frame.state->instances) {
    if (!instance.alive) continue;
    const GpuMesh& mesh = frame.state->meshes[instance.mesh].gpu;
    const bool cull = culls_back_faces(frame, instance, mesh);
    GLuint of_instance = 0;
    for (const MaterialRange& range : mesh.materials) {
      const GpuMaterial& look = range.material;
      culling.set(cull && range.solid);
      if (l.light == nullptr && !look.base_texture) {
        flat.use(instance, mesh);
        const glm::vec3 emissive = l.emission ? look.emissive : glm::vec3(0.0f);
        flat.draw(glm::vec4(look.base_colour * glm::vec3(l.ambient) + emissive, 1.0f), range.first,
                  range.count);
        program = of_instance = 0;
        continue;
      }
      unsigned variant = common;
      if (look.base_texture || (l.light != nullptr && look.normal_texture)) variant |= kTextured;
      if (l.light != nullptr && look.shininess > 0) variant |= kSpecular;
      if (l.light != nullptr && !mesh.smooth && !look.normal_texture && look.shininess <= 0)
        variant |= kFacets;
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
        glBindVertexArray(mesh.shaded.id());
        set(program, "u_clip", frame.clip_of(instance));
        if (inside) set(program, "u_inside", glm::mat4(*inside * instance.to_scene));
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

void draw_indexed(GLenum primitive, const Buffer& vertices,
                  const std::vector<std::uint32_t>& indices) {
  const VertexArray array = VertexArray::make();
  const Buffer buffer = Buffer::make();
  glBindVertexArray(array.id());
  glBindBuffer(GL_ARRAY_BUFFER, vertices.id());
  glEnableVertexAttribArray(kVertex);
  glVertexAttribPointer(kVertex, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer.id());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(),
               GL_STREAM_DRAW);
  glDrawElements(primitive, static_cast<GLsizei>(indices.size()), GL_UNSIGNED_INT, nullptr);
  glBindVertexArray(0);
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
