// Footprints in the plane: made valid, and which of them are parts of which.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <gnomon/io/footprint_file.h>

namespace gnomon {

struct CleanPolygons {
  std::vector<Rings> polygons;   // valid; outer rings counter-clockwise, holes clockwise
  std::string repaired;          // why one of them had to be made valid; empty if none
  std::size_t without_area = 0;  // rings that enclose nothing, left out
};

// Polygons as GEOS calls them valid. Those that are keep their points; those that are not are made
// so (GEOSMakeValid, method "structure": both sides of a bow tie are inside, overlaps are joined).
// Rings are not closed, in and out. Precondition: finite coordinates.
CleanPolygons clean_polygons(const std::vector<Rings>& polygons);

// Of each part, the outline that more than half of the part's area lies in, or kNoOutline; where
// there are several, the one with the most. Each is a footprint's clean polygons.
inline constexpr std::size_t kNoOutline = static_cast<std::size_t>(-1);
std::vector<std::size_t> outlines_of_parts(const std::vector<const std::vector<Rings>*>& parts,
                                           const std::vector<const std::vector<Rings>*>& outlines);

// Share of the outline's area that the parts cover, 0..1.
double covered_share(const std::vector<Rings>& outline,
                     const std::vector<const std::vector<Rings>*>& parts);

}  // namespace gnomon
