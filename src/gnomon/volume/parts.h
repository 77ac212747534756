// The parts of a caster set: what is connected through edges, and which parts are closed or convex.
//
// A closed part's volume can be counted with its light-facing triangles alone; a convex part is
// entered and left at most once by any ray, so it is one layer of shadow, not two. Both are exact
// properties of the stored coordinates. Made once per mesh, for all lights; anew after vertices
// have moved, for what is convex, its winding and the boxes.
//
// Convexity is certified, not guessed, after Mehlhorn, Naeher, Seel, Seidel, Schilz, Schirra and
// Uhrig, "Checking geometric programs or verification of geometric structures", 1999: see
// docs/volumes.md for why the conditions are enough.
#pragma once

#include <cstdint>
#include <vector>

#include <gnomon/mesh/edge_table.h>
#include <gnomon/mesh/tri_mesh.h>

namespace gnomon {

// One maximal set of selected triangles connected through edges (sharing a vertex is not enough).
struct Part {
  std::vector<std::uint32_t> triangles;  // ascending
  // Every edge runs as often forward as backward over the part's triangles: its boundary as a chain
  // is empty. Edges of more than two triangles may balance.
  bool closed = false;
  // The boundary of a convex body of positive volume, each point of it covered once, wound outwards
  // everywhere or inwards everywhere. Coplanar neighbours are allowed. Implies closed, exactly two
  // triangles at each edge, and genus 0.
  bool convex = false;
  // Only if convex: +1 if wound outwards, -1 if inwards. A triangle t of the part is lit, that is,
  // the light is on its outer side, exactly if light_sides()[t] == -winding.
  int winding = 0;
  Vec3 lo{0.0}, hi{0.0};  // bounding box, exact
};

inline constexpr std::uint32_t kNoPart = 0xffffffffu;

struct Parts {
  std::vector<Part> parts;             // ordered by their lowest triangle
  std::vector<std::uint32_t> part_of;  // per triangle: index into parts; kNoPart if not selected
};

// Preconditions: welded mesh without triangles of zero area; `edges` was built from this mesh,
// from all triangles or at least from the selected ones. `selected` empty means all triangles, else
// one flag per triangle. Time and memory linear in the triangles and edges.
Parts split_into_parts(const TriMesh& mesh, const EdgeTable& edges,
                       const std::vector<std::uint8_t>& selected = {});

}  // namespace gnomon
