// The volumes of one instance's casters for one light: which parts are counted how, their lists,
// their buffers. Kept from frame to frame while nothing that they depend on changes (Everitt and
// Kilgard 2002, section 3.4).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec4.hpp>

#include <gnomon/core/vec.h>
#include <gnomon/gl/gpu_mesh.h>
#include <gnomon/gl/method.h>
#include <gnomon/volume/volume_lists.h>

namespace gnomon::gl {

// How one part is drawn, for this light and camera.
struct PartPlan {
  bool z_fail = false;
  bool by_polygon = false;
  Casting casting = Casting::all_triangles;
  bool operator==(const PartPlan&) const = default;
};

struct CasterVolumes {
  // What they were made from.
  Light light{0, 0, 0, 0};  // in the mesh's coordinates
  std::vector<PartPlan> plan;
  Extrusion extrusion = Extrusion::shader;
  Primitives primitives = Primitives::quads;
  std::uint64_t mesh_version = 0;

  VolumeLists lists;               // z-fail volumes first
  std::size_t z_fail_volumes = 0;  // of lists.volumes, the first ones
  std::array<IndexRange, kListKinds> z_fail{},
      z_pass{};  // in `indices`: the lists one after the other
  std::array<std::uint32_t, kListKinds> list_begin{};  // where each list begins in `indices`
  std::vector<std::uint8_t> polygon;                   // per volume: of a single polygon

  Buffer indices;
  Buffer extruded;  // Extrusion::cpu: the doubled vertices, those at w = 0 replaced
  VertexArray array;
};

// Makes `volumes` what the rest says, unless it is that already. True if it was made anew.
bool update_volumes(CasterVolumes& volumes, const GpuMesh& mesh, std::uint64_t mesh_version,
                    const Light& light, const std::vector<PartPlan>& plan, const Method& method);

}  // namespace gnomon::gl
