// What kind of surface a mesh is: components, and for each whether it is closed, manifold,
// consistently wound.
//
// A solid component may be counted with its light-facing triangles alone and weight 1, as in the
// papers on shadow volumes, for every light outside of it; all others are counted with all
// triangles and weights of 2. One thing is not looked at here: a solid that intersects itself may
// have inverted lobes, for which weight 1 is wrong.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gnomon/mesh/edge_table.h>
#include <gnomon/mesh/tri_mesh.h>

namespace gnomon {

// Counts of triangles and of edges, each edge in every class that it belongs to.
struct EdgeCounts {
  std::size_t triangles = 0;
  std::size_t edges = 0;
  std::size_t boundary = 0;      // edges of one triangle
  std::size_t non_manifold = 0;  // edges of more than two triangles
  std::size_t mis_wound = 0;     // edges of two triangles that run the same way
  std::size_t unbalanced = 0;    // edges that do not run as often one way as the other; 0: closed
};

enum class SurfaceKind {
  solid,         // closed: two triangles at each edge, running opposite ways; volume > 0
  inside_out,    // the same with volume <= 0: a cavity, wound the wrong way round, or flat
  non_manifold,  // no boundary, some edges of more than two triangles; closed if counts.unbalanced
                 // == 0
  mis_wound,     // two triangles at each edge, but some neighbours are wound against each other
  open,          // has a boundary
};

// One maximal set of triangles connected through edges.
struct Component {
  EdgeCounts counts;
  std::uint32_t first_triangle = 0;  // lowest index; component_of orders components by it
  // Cubic metres, positive outwards, rounded; about its own first vertex. Means something only if
  // counts.unbalanced == 0.
  double volume = 0;
  SurfaceKind kind = SurfaceKind::open;
};

struct MeshReport {
  EdgeCounts total;
  std::vector<Component> components;        // ordered by first_triangle
  std::vector<std::uint32_t> component_of;  // per triangle: index into components
  std::array<std::size_t, 5> of_kind{};     // components, by SurfaceKind
  std::size_t weight_one_triangles = 0;     // those of solid components
};

// Precondition: `edges` is build_edge_table(mesh) of the whole welded mesh. Time and memory linear
// in the triangles.
MeshReport report_mesh(const TriMesh& mesh, const EdgeTable& edges);

// "solid", "inside out", "non-manifold", "mis-wound", "open".
const char* name_of(SurfaceKind kind);

// One line: "149 components: 120 solid, 29 open; 1203 boundary edges, 4 non-manifold, 0 mis-wound".
std::string classification(const MeshReport& report);

}  // namespace gnomon
