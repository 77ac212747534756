// Regions of the plane, cut and triangulated along given edges: steps 5 and 6 of docs/ground.md.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <gnomon/core/vec.h>
#include <gnomon/io/geos_geometry.h>

namespace gnomon {

// Cuts `region` along edges (their heights do not matter), which become edges of its polygons. Null
// if that fails.
Geom split_by(const Geos& geos, const GEOSGeometry* region,
              const std::vector<std::array<Vec3, 2>>& edges);

// Triangulates each polygon of `region` along its edges, on its vertices alone. GEOS 3.11 joins the
// holes of a polygon from left to right, and fails for some whose holes stand in columns, as houses
// in a grid do; turned by another angle they do not. Adds to `failed` how many were triangulated
// without their edges (geos.message has the reason). Null if that fails, too.
Geom triangulated(const Geos& geos, const GEOSGeometry* region, std::size_t& failed);

}  // namespace gnomon
