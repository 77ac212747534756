// How the surfaces of a scene look: materials, pictures on them, shading normals. Renderers use it;
// no shadow depends on it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gnomon/core/vec.h>

namespace gnomon {

// What lies beyond a picture's edge.
enum class TextureEdge { repeat, mirror, clamp };

// A picture on surfaces: 8 bits each of red, green, blue (sRGB-encoded; of normal maps as stored)
// and alpha (not premultiplied), row after row, the first row at the top.
struct Texture {
  std::string name;  // the file's, or what the model calls it; for messages
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // 4 * width * height
  TextureEdge edge_u = TextureEdge::repeat, edge_v = TextureEdge::repeat;
  bool smooth = true;  // false: texels are to be seen as squares
};

// What becomes of the base colour's alpha, where it has a texture.
enum class TextureAlpha { ignored, cut, blended };

// All colours are sRGB-encoded, 0 to 1, as artists give them (emissive may be more); a renderer
// that adds light decodes them first. The model is Blinn and Phong's: base colour * (light from all
// around + cosine), + specular * (n.h)^shininess. docs/formats.md, "Looks", has the formulas by
// which other models become this one.
struct Material {
  std::string name;
  Vec3 base_colour{0.8, 0.8, 0.8};  // decoded, times the decoded texture
  Vec3 emissive{0, 0, 0};
  Vec3 specular{0, 0, 0};
  double shininess = 0;     // exponent; 0: no highlight whatever `specular` is
  double opacity = 1;       // times the texture's alpha where that is blended
  int base_texture = -1;    // index into Appearance::textures; -1: none
  int normal_texture = -1;  // rgb * 2 - 1 in the frame of u (right), -v (up on the picture), normal
  int emissive_texture = -1;  // decoded, times `emissive` decoded
  double normal_scale = 1;    // of the normal map's x and y
  TextureAlpha alpha = TextureAlpha::ignored;
  double alpha_cutoff = 0.5;  // cut: what has less alpha is a hole
  bool double_sided = true;   // false: the file wants back faces not to be drawn
  friend bool operator==(const Material&, const Material&) = default;
};

inline constexpr std::uint32_t kNoMaterial = 0xffffffffu;

// Lists per triangle go with Scene::mesh.triangles, their three corners with the triangle's. All
// are empty where looks were not asked for.
struct Appearance {
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<std::uint32_t> material_of;  // per triangle: index into materials, or kNoMaterial
  // (0, 0) is the upper left corner of the picture, (1, 1) the lower right one. Empty where no
  // material has a texture.
  std::vector<std::array<glm::vec2, 3>> uv;
  // Shading normals where files have them, of length 1 in scene coordinates; a zero vector: the
  // facet's own is meant. Empty where no file has any.
  std::vector<std::array<glm::vec3, 3>> normals;
};

// Adds triangles of no material until there are `triangles`, if looks were asked for: what is made
// after the models (ground) has none.
void fill_up(Appearance& appearance, std::size_t triangles);

// The triangles `kept` (indices, ascending or not) alone, in that order; nothing happens where
// looks were not asked for.
void keep_triangles(Appearance& appearance, const std::vector<std::uint32_t>& kept);

}  // namespace gnomon
