// The volumes of one instance's casters for one light: which parts are counted how, their lists,
// their buffers. Kept from frame to frame while nothing that they depend on changes (Everitt and
// Kilgard 2002, section 3.4).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <gnomon/core/vec.h>
#include <gnomon/gl/gpu_mesh.h>
#include <gnomon/gl/method.h>
#include <gnomon/volume/lit_regions.h>
#include <gnomon/volume/near_clip.h>
#include <gnomon/volume/part_silhouettes.h>
#include <gnomon/volume/volume_lists.h>

namespace gnomon::gl {

// A stencil that wraps counts from here, so that what rounding counts below 0 stays lit, and holds
// so many layers.
inline constexpr int kWrapMiddle = 32, kWrapLayers = 255 - kWrapMiddle;

// The light grazes a triangle where the sine of the angle between its plane and the light, seen
// from the corner where it is least, is no more than this: 16 pixels below its edge the side is a
// 256th of a pixel off the triangle, by which corners are rounded (docs/renderer-limits.md).
inline constexpr double kGrazing = 0x1p-12;
// And nearly here: so it is a pixel below its edge.
inline constexpr double kNearlyGrazing = 0x1p-8;

// How one part is drawn, for this light and camera.
struct PartPlan {
  bool z_fail = false;
  bool by_polygon = false;
  bool left_out = false;   // it cannot shade what the light reaches
  bool by_region = false;  // each connected lit region decides for itself between z-pass and z-fail
  Casting casting = Casting::all_triangles;
  bool operator==(const PartPlan&) const = default;
};

// A receiver that casts, whose plane nearly holds the light.
struct NearlyGrazed {
  std::uint32_t triangle = 0;
  std::int8_t light_side = 0;
};

// A bound on the layers (layers.h), kept while the light stays near.
struct LayersKept {
  Light light{0, 0, 0, 0};
  double spread = 0;
  int layers = 0;
  std::size_t grid = 0;  // to begin with the next time
};

struct CasterVolumes {
  // What they were made from.
  Light light{0, 0, 0, 0};  // in the mesh's coordinates
  std::vector<PartPlan> plan;
  std::uint64_t mesh_version = 0;
  Extrusion extrusion = Extrusion::shader;
  Primitives primitives = Primitives::quads;
  std::uint32_t most_layers = 0;
  glm::mat4 project{0.0f};
  Vec4 receivers{0, 0, 0, 1};
  bool all_caps = false;
  bool one_point = false;  // behind all vertices: a directional light's at infinity
  std::vector<std::uint8_t> region_z_fail;  // per region

  Silhouette whole;                   // of all parts together, all of whose triangles cast
  std::vector<CastingSides> casting;  // per part
  PartSilhouettes silhouettes;
  // Per triangle; found where it is needed, by whole parts: caps, regions, chunks, polygons. Where
  // only sides are drawn, the silhouette is enough.
  std::vector<std::int8_t> light_side;
  std::vector<std::uint8_t> sides_known;  // per part
  bool grazed = false;       // the plane of some receiving triangle nearly holds the light
  GrazedEdges grazed_edges;  // of all triangles that the light grazes
  std::vector<NearlyGrazed> nearly_grazed;
  LitRegions regions;  // of parts by region
  LayersKept kept;
  int layers = 0;  // no ray from the light crosses more casting triangles

  VolumeLists lists;                                   // z-fail volumes first
  std::size_t z_fail_volumes = 0;                      // of lists.volumes, the first ones
  std::vector<std::uint8_t> polygon;                   // per volume: of a single polygon
  std::vector<std::uint32_t> layers_of;                // per volume: no ray enters it more often
  std::array<std::uint32_t, kListKinds> list_begin{};  // of each list in `indices`

  Buffer indices;   // the lists, one after the other
  Buffer extruded;  // Extrusion::cpu: the doubled vertices, those at w = 0 replaced
  VertexArray array;
};

// Brings silhouettes, grazed triangles, regions and layers up to date, in time that follows the
// silhouette once mesh.silhouettes has a tree. True if they were not.
bool update_silhouettes(CasterVolumes& volumes, GpuMesh& mesh, std::uint64_t mesh_version,
                        const Light& light, const std::vector<PartPlan>& plan, SilhouetteBy by);

// Brings lists and buffers up to date. `near`: in the mesh's coordinates, for parts by region.
// `project`: a vertex (x, y, z, 1) to the point behind it. `receivers`: a plane with the receivers
// and the near rectangle on its side >= 0, all points behind vertices on the other; sides beyond it
// are of the dark cap. (0, 0, 0, 1): none is. `all_caps`: also those of volumes that are counted
// z-pass. `most_layers`: volumes of more triangles
// than that are split; 0: none is. True if they were not.
bool update_lists(CasterVolumes& volumes, const GpuMesh& mesh, const Method& method,
                  const NearClip& near, const glm::mat4& project, const Vec4& receivers,
                  bool all_caps, std::uint32_t most_layers, bool sides_changed);

// The ranges of volumes first .. last - 1 in `indices`, list by list.
std::array<IndexRange, kListKinds> ranges_of(const CasterVolumes& volumes, std::size_t first,
                                             std::size_t last);

}  // namespace gnomon::gl
