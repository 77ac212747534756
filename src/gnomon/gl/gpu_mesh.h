// A mesh as the renderer keeps it: what is needed to find its volumes, and its buffers.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <gnomon/gl/handles.h>
#include <gnomon/mesh/edge_table.h>
#include <gnomon/mesh/tri_mesh.h>
#include <gnomon/scene/appearance.h>
#include <gnomon/silhouette/silhouette_finder.h>
#include <gnomon/volume/part_silhouettes.h>
#include <gnomon/volume/parts.h>
#include <gnomon/volume/volume_lists.h>

namespace gnomon::gl {

// A material as the surface shader takes it.
struct GpuMaterial {
  glm::vec3 base_colour{1.0f}, emissive{0.0f}, specular{0.0f};
  float shininess = 0, normal_scale = 1;
  std::optional<std::size_t> base_texture, normal_texture;  // indices into GpuMesh::textures
};

struct MaterialRange {
  GpuMaterial material;
  bool solid =
      false;        // of convex parts, wound outwards: their back faces are never seen from outside
  GLint first = 0;  // corners
  GLsizei count = 0;
};

struct GpuMesh {
  TriMesh mesh;                        // positions rounded to float: what the GPU draws
  std::vector<std::uint8_t> casts;     // per triangle
  std::vector<std::uint8_t> receives;  // per triangle
  EdgeTable edges;                     // of the casting triangles
  Parts parts;                         // of the casting triangles
  PartsOfEdges part_edges;
  SilhouetteFinder silhouettes;         // of all casting triangles together
  std::vector<std::uint8_t> part_seen;  // per part: all its triangles receive, so are drawn

  Buffer doubled;             // vec4 per index of VolumeLists
  Buffer corners;             // position, normal, texture coordinates of corners, by material
  Buffer surface_indices;     // the same triangles, as indices into `doubled`
  VertexArray surface;        // doubled, surface_indices
  VertexArray shaded;         // corners
  GLsizei surface_count = 0;  // corners of receiving triangles
  GLsizei solid_count = 0;    // of these, the first ones: of convex parts, wound outwards
  // Receiving triangles that do not cast, by their light side, are found per light.
  std::vector<std::uint32_t> only_receive;

  std::vector<std::uint32_t> drawn;      // receiving triangles in the order of `corners`
  std::vector<MaterialRange> materials;  // of these
  std::vector<Texture2D> textures;
  bool smooth = false;                  // some corner has a normal that is not its facet's
  Appearance appearance;                // uv and normals, for when vertices move
  Vec3 lo{0.0}, hi{0.0};                // box of the receiving triangles
  Vec3 caster_lo{0.0}, caster_hi{0.0};  // box of the casting triangles
};

// Positions are rounded to float first, once, so that triangles that share a position still do.
GpuMesh make_gpu_mesh(const TriMesh& mesh, std::vector<std::uint8_t> casts,
                      std::vector<std::uint8_t> receives, const Appearance* look = nullptr);

// New positions for the same triangles; parts are found again, since a part may have become convex
// or ceased to be.
void move_vertices(GpuMesh& mesh, std::span<const Vec3> positions);

}  // namespace gnomon::gl
