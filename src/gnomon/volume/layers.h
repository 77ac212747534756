// How many casters one light ray can cross, at most: a proof, per light, that a stencil of 8 bits
// holds every shadow count of a picture. (Wrapping increments and decrements give the count modulo
// 256, whatever values come in between; if no count exceeds 255, that is the count.)
//
// Casters are drawn into a grid of light directions, each into every cell that its shadow can
// touch; the fullest cell is the bound. docs/volumes.md has the proof.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <gnomon/core/vec.h>
#include <gnomon/mesh/tri_mesh.h>
#include <gnomon/volume/part_silhouettes.h>
#include <gnomon/volume/parts.h>

namespace gnomon {

// What counts along a ray: one triangle, or triangles of which any ray from the light crosses only
// so many. Item k: triangles[first[k] .. first[k+1]), indices into the mesh; crossing it counts
// halves[k] half layers.
struct LayerItems {
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t> first{0};  // CSR
  std::vector<std::uint8_t> halves;
  std::vector<std::uint32_t> convex_part;  // of the parts they were made of; kNoPart: a triangle
  Vec3 lo{HUGE_VAL}, hi{-HUGE_VAL};        // box round all
};

// The items of all parts, the same for every light: every triangle for itself, but those of a
// convex part together (a ray meets its lit and its unlit ones at most once each). Where one side
// of a part casts, every triangle counts one half, whatever its side. `sides`: per part; empty:
// both of all.
LayerItems layer_items(const Parts& parts, std::span<const CastingSides> sides = {});

// Cells along one side of the grid of a directional light, or of each of the six faces of a point
// light's cube. Finer is tighter and slower; 256 keeps the grid at 3 MB.
inline constexpr int kLayerCells = 256;

// At least the number of layers that any one segment from the light crosses, so at least every
// shadow count n(p), wherever p is. Items that touch the light, or come closer to it than 2^-25 of
// the largest coordinate, count everywhere. Movements by the infinitesimals of the tie rule are
// included. Light: w > 0 a point, w = 0 a direction; snapped. `spread`: the bound holds for every
// light that is near() as well. `outlines`: silhouettes of the convex parts, which saves a sun's
// bound from looking at their triangles. Preconditions: 1 <= cells <= 1024, spread >= 0.
// Time: items, their triangles and the cells they touch; memory: 8 bytes a cell.
int layer_bound(const TriMesh& mesh, const LayerItems& items, const Light& light,
                int cells = kLayerCells, double spread = 0,
                const PartSilhouettes* outlines = nullptr);

// Both are directions, and as points on the plane where the largest component of `light` is 1 (or
// -1) they differ by no more than `spread` in each coordinate; or they are the same light.
bool near(const Light& light, const Light& other, double spread);

}  // namespace gnomon
