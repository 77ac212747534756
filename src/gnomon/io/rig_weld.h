// Vertices of a rig that are one at all times.
#pragma once

#include <cstdint>
#include <vector>

#include <gnomon/io/rig.h>

namespace gnomon {

struct RigWeld {
  std::vector<std::uint32_t> vertex_of;  // per point of the rig: its vertex
  std::vector<Vec3> positions;           // per vertex, at rest
  std::vector<std::uint32_t> point_of;   // per vertex: the first of its points
};

// Points become one vertex where their positions at rest (`positions`, per point) are equal and
// everything that moves them is: the same numbers go through the same arithmetic, so that they stay
// equal bit for bit.
RigWeld weld_rig(const Rig& rig, const std::vector<Vec3>& positions);

// Leaves one point of each vertex in the rig, and in its parts nothing but these. Returns the
// vertex of each point that is left.
std::vector<std::uint32_t> keep_points(Rig& rig, const RigWeld& weld);

}  // namespace gnomon
