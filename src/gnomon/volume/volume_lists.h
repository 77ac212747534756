// Shadow volumes as index lists for a renderer: what it draws is vertices that the GPU has already,
// each twice, and a list that says which of the two.
// Based on: Everitt and Kilgard 2002, sections 3.2 and 3.4; Accelerated Stencil Shadow Extrusion
// via Vertex Blending, 2003 (doubled vertices); weights after Kim et al. 2007.
//
// Index 2v is vertex v of the mesh, (x, y, z, 1); index 2v + 1 is the point behind it as seen from
// the light: at infinity, (x, y, z, 1) Lw - L, w = 0, or on a plane beyond which nothing is seen.
// Behind a directional light's vertices there is one point at infinity for all: `one_point`.
//
// Faces: a triangle of `sides`, `light_cap` and `dark_cap` is counterclockwise as seen from where a
// ray enters the volume: its front face counts +1. The turned lists are the other way round: there
// a back face counts +1. A polygon always has its corners in one order, whichever way it is turned
// (sides from the lower vertex of the edge to the higher, caps in the mesh's order): a side that
// two volumes share, and a cap and the drawn surface, have the same depths bit for bit.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <gnomon/mesh/edge_table.h>
#include <gnomon/mesh/tri_mesh.h>
#include <gnomon/silhouette/silhouette.h>
#include <gnomon/volume/loops.h>

namespace gnomon {

// Which triangles of a caster cast. Where all do, each counts 1: right for any soup, and every side
// of a closed surface is drawn twice. Where the surface is closed, its winding consistent, and
// neither light nor eye inside, those of one light side suffice: a ray to the light crosses as many
// of them as of the others (docs/renderer.md). The light sees the counterclockwise side of those of
// light side -1: of a surface that is wound outwards, they face it.
enum class Casting : std::uint8_t { all_triangles, negative_sides, positive_sides };

inline bool casts(Casting casting, std::int8_t light_side) {
  return casting == Casting::all_triangles ||
         (light_side < 0) == (casting == Casting::negative_sides);
}

// Where a list begins and how many indices it has.
struct IndexRange {
  std::uint32_t first = 0, count = 0;
};

enum ListKind : std::uint8_t {
  kSides,
  kLightCap,
  kDarkCap,
  kGrazingSides,
  kSidesTurned,
  kLightCapTurned,
  kDarkCapTurned,
  kGrazingSidesTurned,
  kListKinds
};

// One closed shadow volume: ranges in the lists of VolumeLists.
struct Volume {
  std::uint32_t caster = 0;  // what the caller makes of it: a part, a region, a triangle
  std::array<IndexRange, kListKinds> lists{};
};

struct VolumeLists {
  std::array<std::vector<std::uint32_t>, kListKinds> lists;  // triangles
  std::vector<Volume> volumes;
};

// How the sides over a loop of edges are sent: as triangles, or in one piece, which ends with the
// index kRestart. Everitt and Kilgard 2002, section 3.4.
enum class SideForm : std::uint8_t {
  triangles,
  strips,  // two vertices an edge; point lights
  fans     // one vertex an edge round the point behind; directional lights
};
inline constexpr std::uint32_t kRestart = 0xffffffffu;

// Edges of triangles whose plane holds the light, or nearly: vertices a < b, ascending. The sides
// over them lie in that plane, and go to lists of their own.
using GrazedEdges = std::vector<std::array<std::uint32_t, 2>>;

// Appends the volume of triangles whose silhouette is known already (a part, a lit region).
// `triangles` are those whose caps are made (of them, those that `casting` lets cast), `sides` the
// mesh's light_sides(); both may be empty: sides alone, which is all that z-pass needs.
// Strips and fans have no turned sides: loops run the way that they count.
// `beyond`: per vertex of the mesh, 1 where it and all far ends lie beyond everything that
// receives, as seen from the eye; triangles of sides that have no other corner go to the dark cap
// (form triangles): z-fail counts them behind everything, z-pass never. Empty: none.
void append_volume(VolumeLists& lists, const TriMesh& mesh,
                   std::span<const SilhouetteEdge> silhouette,
                   std::span<const std::uint32_t> triangles, std::span<const std::int8_t> sides,
                   bool one_point, Casting casting, SideForm form, std::uint32_t caster,
                   std::span<const std::uint8_t> beyond, LoopScratch& scratch,
                   const GrazedEdges& grazed = {});

// The silhouette of a few triangles (all of which count that cast), appended to `out`, in time that
// follows them. `sides`: light_sides() of the mesh.
void find_silhouette_of_few(Silhouette& out, const TriMesh& mesh,
                            std::span<const std::uint32_t> triangles,
                            std::span<const std::int8_t> sides, Casting casting);

// Appends the volume of one triangle: its prism, which is convex.
void append_prism(VolumeLists& lists, const TriMesh& mesh, std::uint32_t triangle,
                  std::int8_t light_side, bool one_point, std::uint32_t caster,
                  std::span<const std::uint8_t> beyond, const GrazedEdges& grazed = {});

}  // namespace gnomon
