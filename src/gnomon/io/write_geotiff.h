// profile.tif: hours in shadow, hours of sun, first and last sun as a GeoTIFF.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include <gnomon/core/result.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/profile/profile.h>
#include <gnomon/scene/scene.h>
#include <gnomon/view/view.h>

namespace gnomon {

// What stands where there is no sample. Not NaN: many readers (gdal_calc, web maps) compare with ==
// and then take the NaN for data. Neither hours nor clock times come near it.
inline constexpr float kNoDataHours = -9999.0F;

// How the file is packed. The defaults were measured: docs/outputs.md.
struct GeotiffPacking {
  int deflate_level = 4;  // 1 (fast) .. 12 (small)
  int predictor = 1;      // 1 none, 2 horizontal differences, 3 floating point
  int tile = 256;         // samples; a multiple of 16
  int threads = 0;        // 0: as many as the machine has
};

// Float32 bands, row 0 at the top, unit "h", nodata kNoDataHours, with their exact statistics: 1
// "hours in shadow" and 2 "hours of sun" (their names end in " per day" where the profile is a mean
// over several days; metadata item DAYS always); where the profile has them, 3 "first sun" and 4
// "last sun", clock times in hours (9.25 is 9:15), nodata also where the sun never comes. A plan
// view (seen from straight above) is georeferenced: CRS coordinates = scene coordinates +
// frame.origin, upper left corner of the upper left pixel as GDAL has it, and frame.crs (its
// horizontal part) where it is set. Other views carry neither. `metadata`: key -> value, into the
// file's default domain as it is; TIFFTAG_SOFTWARE and the like become TIFF tags. Precondition:
// profile.width x profile.height == view.width x view.height > 0. Errors: as AtomicFile; a CRS that
// PROJ does not know; anything GDAL reports, in its words. On an error there is no new file and an
// older one stays as it was. No .aux.xml is written.
Result<FileWritten> write_profile_geotiff(const std::filesystem::path& path, const Profile& profile,
                                          const View& view, const Frame& frame,
                                          const std::map<std::string, std::string>& metadata,
                                          const GeotiffPacking& packing = {});

// True for views whose pixels are a grid on the ground: straight down, all rays vertical.
bool is_plan(const View& view);

}  // namespace gnomon
