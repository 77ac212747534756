// Footprints from their file's CRS to metres.
#pragma once

#include <string>

#include <gnomon/core/result.h>
#include <gnomon/core/warnings.h>
#include <gnomon/io/footprint_file.h>

namespace gnomon {

struct PlacedFootprints {
  std::string crs;         // that they are in now; empty: local metres
  std::string moved_from;  // the CRS that they were in before; empty: they were not moved
};

// Moves all polygons of the file to target_crs (or where that is empty to what docs/footprints.md
// says). `path` is for messages; see
// read_footprints(). Precondition: finite coordinates.
Result<PlacedFootprints> place_footprints(FootprintFile& file, const std::string& path,
                                          const std::string& target_crs,
                                          const std::string& fallback_crs, Warnings& warnings);

}  // namespace gnomon
