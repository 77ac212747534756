// The shaders of this room, compiled for OpenGL 3.3 core or OpenGL ES 3.0 from one text.
#pragma once

#include <string>
#include <string_view>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <gnomon/core/result.h>
#include <gnomon/core/vec.h>
#include <gnomon/gl/handles.h>

namespace gnomon::gl {

// Attribute locations, the same in every program.
inline constexpr GLuint kVertex = 0, kNormal = 1, kTexture = 2;

// `defines`: lines put after the version ("#define BLEND\n").
Result<ProgramHandle> compile(std::string_view name, std::string_view vertex,
                              std::string_view fragment, const std::string& defines);

// Uniforms by name; names that the program does not use are ignored. The program must be in use.
void set(GLuint program, const char* name, int value);
void set(GLuint program, const char* name, float value);
void set(GLuint program, const char* name, const glm::vec3& value);
void set(GLuint program, const char* name, const glm::vec4& value);
void set(GLuint program, const char* name, const glm::mat3& value);
void set(GLuint program, const char* name, const glm::mat4& value);

// What a lit surface needs: bits of a number below kSurfaceVariants.
enum SurfaceVariant : unsigned {
  kLit = 1,       // a light; without: ambient and emission alone
  kTextured = 2,  // pictures for base colour or normals
  kFacets = 4,    // every corner's normal is its facet's, and no highlight
  kSpecular = 8,
  kFading = 16,  // distance attenuation or a radius
  kMasked = 32,  // times a mask in a texture
  kInside = 64,  // nothing outside another camera's frustum
  kSurfaceVariants = 128
};

struct Programs {
  ProgramHandle volume[4];  // by Extrusion
  // Likewise; nothing before the plane u_keep of clip space.
  ProgramHandle volume_cut[4];
  // Likewise; clipped by the near plane as GL_CLIP_DISTANCE0. Desktop OpenGL alone.
  ProgramHandle volume_near_clip[4];
  ProgramHandle near_light;     // casters as the light sees them on the near plane (ZP+)
  ProgramHandle volume_inside;  // extruded in the shader; nothing outside another camera's frustum
  ProgramHandle flat_inside;    // likewise
  ProgramHandle flat;           // one colour on surfaces
  ProgramHandle surface[kSurfaceVariants];  // made when first used: surface_program()
  ProgramHandle rectangle;                  // one colour over the viewport, at the near plane
  ProgramHandle texture;                    // a texture over the viewport
  ProgramHandle overflow;                   // texels that half floats lost; others are discarded
  ProgramHandle plain;                      // vertices that are in clip space already, one colour
};
Result<Programs> compile_programs();

// Error: the driver does not take it.
Result<GLuint> surface_program(Programs& programs, unsigned variant);

}  // namespace gnomon::gl
