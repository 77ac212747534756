// How many casters one light ray can cross, at most: a proof, per light, that a stencil of 8 bits
// holds every shadow count of a picture. (Wrapping increments and decrements give the count modulo
// 256, whatever values come in between; if no count exceeds 255, that is the count.)
//
// Casters are drawn into a grid of light directions, each into every cell that its shadow can
// touch; the fullest cell is the bound. docs/volumes.md has the proof.
#pragma once

#include <cstdint>
#include <vector>

#include <gnomon/core/vec.h>
#include <gnomon/mesh/tri_mesh.h>
#include <gnomon/volume/parts.h>

namespace gnomon {

// What counts once along a ray: one triangle, or triangles of which any ray from the light crosses
// at most one. Item k: triangles[first[k] .. first[k+1]), indices into the mesh.
struct LayerItems {
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t> first{0};  // CSR
};

// The items of the triangles with cap[t] != 0 (empty: all in a part), each of which counts 1: every
// triangle for itself, but those of a convex part together, its lit and its unlit ones (a ray meets
// either at most once). `sides`: light_sides() of the mesh and light.
LayerItems layer_items(const Parts& parts, const std::vector<std::int8_t>& sides,
                       const std::vector<std::uint8_t>& cap = {});

// Cells along one side of the grid of a directional light, or of each of the six faces of a point
// light's cube. Finer is tighter and slower; 256 keeps the grid at 3 MB.
inline constexpr int kLayerCells = 256;

// At least the number of items that any one segment from the light crosses, so at least every
// shadow count n(p), wherever p is. Items that touch the light, or come closer to it than 2^-25 of
// the largest coordinate, count everywhere. Movements by the infinitesimals of the tie rule are
// included. Light: w > 0 a point, w = 0 a direction; snapped. Preconditions: 1 <= cells <= 1024.
// Time: items, their triangles and the cells they touch; memory: 8 bytes a cell.
int layer_bound(const TriMesh& mesh, const LayerItems& items, const Light& light,
                int cells = kLayerCells);

}  // namespace gnomon
