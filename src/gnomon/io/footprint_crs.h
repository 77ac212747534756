// Footprints from their file's CRS to metres.
#pragma once

#include <string>

#include <gnomon/core/result.h>
#include <gnomon/core/warnings.h>
#include <gnomon/io/footprint_file.h>

namespace gnomon {

// Moves all polygons of the file to target_crs (or where that is empty to what docs/footprints.md
// says) and returns the CRS they are in then; empty: local metres. `path` is for messages; see
// read_footprints(). Precondition: finite coordinates.
Result<std::string> place_footprints(FootprintFile& file, const std::string& path,
                                     const std::string& target_crs, const std::string& fallback_crs,
                                     Warnings& warnings);

}  // namespace gnomon
