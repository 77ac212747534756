// GLSL, common to 3.30 core and 3.00 ES. Every program computes gl_Position of a vertex at w = 1 by
// the same expression on the same numbers, and says "invariant": surfaces, their redraws and the
// caps of volumes get the same depth, bit for bit.
#pragma once

namespace gnomon::gl::shaders {

// Sides and caps. a_vertex: a mesh vertex with w = 1, or w = 0 for the point behind it as seen from
// the light. CPU: already extruded. SHADER: one or the other by the weight w. BLEND: the sum of
// both by the weight ("Accelerated Stencil Shadow Extrusion via Vertex Blending"), here in mesh
// coordinates before the one matrix to clip space, where the paper has two modelview matrices
// before one projection. u_project for a far end at infinity has the rows (Lw 0 0 -Lx), ..., (0 0 0
// 0): its product is the difference of the paper, as one subtraction rounds it.
// v_beyond: how far beyond the plane u_keep (a row of clip space), and that cut off at 0. Over a
// sliver that is seen edge-on drivers may interpolate the first to anything; the second stays 0
// where no corner is before the plane.
inline constexpr const char* kVolumeVertex = R"(
in vec4 a_vertex;
uniform mat4 u_clip;
uniform mat4 u_project;
#ifdef INSIDE
uniform mat4 u_inside;
out vec4 v_inside;
#endif
#ifdef CUT
uniform vec4 u_keep;
out vec2 v_beyond;
#endif
#ifdef NEAR_CLIP
out float gl_ClipDistance[1];
#endif
invariant gl_Position;
void main() {
#if defined(SHADER)
  vec4 p = a_vertex.w > 0.5 ? a_vertex : u_project * vec4(a_vertex.xyz, 1.0);
#elif defined(BLEND)
  vec4 v = vec4(a_vertex.xyz, 1.0);
  vec4 p = v * a_vertex.w + (u_project * v) * (1.0 - a_vertex.w);
#else
  vec4 p = a_vertex;
#endif
  gl_Position = u_clip * p;
#ifdef INSIDE
  v_inside = u_inside * p;
#endif
#ifdef NEAR_CLIP
  gl_ClipDistance[0] = gl_Position.z + gl_Position.w;
#endif
#ifdef CUT
  float beyond = dot(u_keep, gl_Position);
  v_beyond = vec2(beyond, min(beyond, 0.0));
#endif
}
)";

// FACES: one colour for front faces, another for back faces.
inline constexpr const char* kColourFragment = R"(
#ifdef FACES
uniform vec4 u_front_colour, u_back_colour;
#else
uniform vec4 u_colour;
#endif
out vec4 o_colour;
#ifdef INSIDE
in vec4 v_inside;
#endif
#ifdef CUT
in vec2 v_beyond;
#endif
void main() {
#ifdef INSIDE
  if (any(greaterThan(abs(v_inside.xyz), vec3(v_inside.w)))) discard;
#endif
#ifdef CUT
  if (max(v_beyond.x, v_beyond.y) < 0.0) discard;
#endif
#ifdef FACES
  o_colour = gl_FrontFacing ? u_front_colour : u_back_colour;
#else
  o_colour = u_colour;
#endif
}
)";

// The shadow that a caster's vertex throws on the near plane n . X = 0: X' = (n.L) X - (n.X) L.
// What lies beyond the plane is discarded; what lies beyond the light has w < 0 and is clipped.
inline constexpr const char* kNearLightVertex = R"(
in vec4 a_vertex;
uniform mat4 u_clip;
uniform vec4 u_light;
uniform vec4 u_plane;
uniform float u_light_side;
out float v_side;
void main() {
  vec4 x = vec4(a_vertex.xyz, 1.0);
  float side = dot(u_plane, x);
  vec4 shadow = u_light_side * x - side * u_light;
  vec4 p = u_clip * shadow;
  v_side = side;
  gl_Position = vec4(p.xy, 0.0, p.w);
}
)";
inline constexpr const char* kNearLightFragment = R"(
in float v_side;
uniform vec4 u_colour;
out vec4 o_colour;
void main() {
  if (v_side < 0.0) discard;
  o_colour = u_colour;
}
)";

inline constexpr const char* kFlatVertex = R"(
in vec4 a_vertex;
uniform mat4 u_clip;
#ifdef INSIDE
uniform mat4 u_inside;
out vec4 v_inside;
#endif
invariant gl_Position;
void main() {
  gl_Position = u_clip * a_vertex;
#ifdef INSIDE
  v_inside = u_inside * a_vertex;
#endif
}
)";

inline constexpr const char* kSurfaceVertex = R"(
in vec4 a_vertex;
in vec3 a_normal;
in vec2 a_texture;
uniform mat4 u_clip;
uniform mat4 u_model;
uniform mat3 u_normal_matrix;
uniform vec4 u_light;
#ifdef INSIDE
uniform mat4 u_inside;
out vec4 v_inside;
#endif
invariant gl_Position;
#ifdef FACETS
flat out float v_height;
#else
out vec3 v_normal;
#endif
out vec3 v_position;
out vec3 v_to_light;
out vec2 v_texture;
void main() {
  gl_Position = u_clip * a_vertex;
  v_position = (u_model * a_vertex).xyz;
  v_to_light = u_light.xyz - v_position * u_light.w;
  vec3 normal = u_normal_matrix * a_normal;
  float squared = dot(normal, normal);
  if (squared > 0.0) normal *= inversesqrt(squared);
#ifdef FACETS
  v_height = dot(normal, v_to_light);
#else
  v_normal = normal;
#endif
  v_texture = a_texture;
#ifdef INSIDE
  v_inside = u_inside * a_vertex;
#endif
}
)";

// Blinn and Phong, per pixel, in the encoding of the picture. Both sides of a surface are drawn:
// the normal is turned to the eye. Normal maps take their tangents from the derivatives of position
// and texture coordinates. Variants by SurfaceVariant: what a picture does not have is not
// computed. FACETS: matt ones, over which the light's height is the same everywhere.
inline constexpr const char* kSurfaceFragment = R"(
#ifdef FACETS
flat in float v_height;
#else
in vec3 v_normal;
#endif
in vec3 v_position;
in vec3 v_to_light;
in vec2 v_texture;
uniform vec4 u_eye;
uniform vec3 u_light_colour;
uniform vec3 u_ambient;
uniform vec3 u_attenuation;
uniform float u_radius;
uniform vec3 u_base;
uniform vec3 u_emissive;
uniform vec3 u_specular;
uniform float u_shininess;
uniform float u_normal_scale;
uniform int u_has_base;
uniform int u_has_normal;
uniform sampler2D u_base_map;
uniform sampler2D u_normal_map;
uniform sampler2D u_mask;
uniform vec4 u_mask_channel;
uniform vec2 u_mask_scale;
out vec4 o_colour;
vec3 mapped_normal(vec3 n) {
  vec3 dp1 = dFdx(v_position), dp2 = dFdy(v_position);
  vec2 du1 = dFdx(v_texture), du2 = dFdy(v_texture);
  vec3 dp2perp = cross(dp2, n), dp1perp = cross(n, dp1);
  vec3 t = dp2perp * du1.x + dp1perp * du2.x;
  vec3 b = dp2perp * du1.y + dp1perp * du2.y;
  float scale = max(dot(t, t), dot(b, b));
  if (scale <= 0.0) return n;
  vec3 m = texture(u_normal_map, v_texture).xyz * 2.0 - 1.0;
  m.xy *= u_normal_scale;
  // Texture rows run downwards, green upwards.
  return normalize((t * m.x - b * m.y) * inversesqrt(scale) + n * m.z);
}
#ifdef INSIDE
in vec4 v_inside;
#endif
void main() {
#ifdef INSIDE
  if (any(greaterThan(abs(v_inside.xyz), vec3(v_inside.w)))) discard;
#endif
  vec3 base = u_base;
#ifdef TEXTURED
  if (u_has_base == 1) base *= texture(u_base_map, v_texture).rgb;
#endif
  vec3 colour = base * u_ambient + u_emissive;
#ifdef LIT
  float squared = dot(v_to_light, v_to_light);
  float nearness = inversesqrt(squared);
#ifdef FACETS
  float diffuse = max(gl_FrontFacing ? v_height : -v_height, 0.0) * nearness;
#else
  vec3 n = normalize(gl_FrontFacing ? v_normal : -v_normal);
#ifdef TEXTURED
  if (u_has_normal == 1) n = mapped_normal(n);
#endif
  vec3 l = v_to_light * nearness;
  float diffuse = max(dot(n, l), 0.0);
#endif
  vec3 lit = base * diffuse;
#ifdef SPECULAR
  vec3 to_eye = normalize(u_eye.xyz - v_position * u_eye.w);
  if (diffuse > 0.0 && u_shininess > 0.0)
    lit += u_specular * pow(max(dot(n, normalize(l + to_eye)), 0.0), u_shininess);
#endif
  lit *= u_light_colour;
#ifdef FADING
  float distance = sqrt(squared);
  lit /= u_attenuation.x + (u_attenuation.y + u_attenuation.z * distance) * distance;
  if (u_radius > 0.0) {
    float edge = clamp(1.0 - pow(distance / u_radius, 4.0), 0.0, 1.0);
    lit *= edge * edge;
  }
#endif
#ifdef MASKED
  lit *= dot(texture(u_mask, gl_FragCoord.xy * u_mask_scale), u_mask_channel);
#endif
  colour += lit;
#endif
  o_colour = vec4(colour, 1.0);
}
)";

// Over the whole viewport, at depth u_depth (-1: near plane).
inline constexpr const char* kRectangleVertex = R"(
uniform float u_depth;
out vec2 v_texture;
void main() {
  vec2 p = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
  v_texture = p;
  gl_Position = vec4(p * 2.0 - 1.0, u_depth, 1.0);
}
)";
inline constexpr const char* kTextureFragment = R"(
in vec2 v_texture;
uniform sampler2D u_image;
uniform vec4 u_channel;
uniform int u_one_channel;
out vec4 o_colour;
void main() {
  vec4 texel = texture(u_image, v_texture);
  o_colour = u_one_channel == 1 ? vec4(dot(texel, u_channel)) : texel;
}
)";

// Floats at the ends of their range have lost a count, or are about to. So have those that are no
// power of two: a driver may round towards zero, so that too large a half float does not become
// infinite but stays at 65504, and is halved from there.
inline constexpr const char* kOverflowFragment = R"(
in vec2 v_texture;
uniform sampler2D u_image;
uniform vec4 u_channel;
uniform float u_least;
uniform float u_most;
out vec4 o_colour;
void main() {
  float value = dot(texture(u_image, v_texture), u_channel);
  bool power_of_two = (floatBitsToUint(value) & 0x7fffffu) == 0u;
  if (power_of_two && value >= u_least && value <= u_most) discard;
  o_colour = vec4(1.0);
}
)";

inline constexpr const char* kPlainVertex = R"(
in vec4 a_vertex;
void main() { gl_Position = a_vertex; }
)";

}  // namespace gnomon::gl::shaders
