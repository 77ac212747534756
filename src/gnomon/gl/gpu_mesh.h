// A mesh as the renderer keeps it: what is needed to find its volumes, and its buffers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <gnomon/gl/handles.h>
#include <gnomon/mesh/edge_table.h>
#include <gnomon/mesh/tri_mesh.h>
#include <gnomon/volume/parts.h>
#include <gnomon/volume/volume_lists.h>

namespace gnomon::gl {

struct GpuMesh {
  TriMesh mesh;                        // positions rounded to float: what the GPU draws
  std::vector<std::uint8_t> casts;     // per triangle
  std::vector<std::uint8_t> receives;  // per triangle
  EdgeTable edges;                     // of the casting triangles
  Parts parts;                         // of the casting triangles
  EdgesOfParts part_edges;
  std::vector<std::uint8_t> part_seen;  // per part: all its triangles receive, so are drawn
  bool all_cast = true;                 // every triangle that receives casts

  Buffer doubled;             // vec4 per index of VolumeLists
  Buffer corners;             // position and normal of every corner of receiving triangles
  Buffer surface_indices;     // the same triangles, as indices into `doubled`
  VertexArray surface;        // doubled, surface_indices
  VertexArray shaded;         // corners
  GLsizei surface_count = 0;  // corners of receiving triangles
  // Receiving triangles that do not cast, by their light side, are found per light.
  std::vector<std::uint32_t> only_receive;
};

// Positions are rounded to float first, once, so that triangles that share a position still do.
GpuMesh make_gpu_mesh(const TriMesh& mesh, std::vector<std::uint8_t> casts,
                      std::vector<std::uint8_t> receives);

// New positions for the same triangles; parts are found again, since a part may have become convex
// or ceased to be.
void move_vertices(GpuMesh& mesh, std::span<const Vec3> positions);

}  // namespace gnomon::gl
