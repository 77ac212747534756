// mask.tif: the shadow of one light as a GeoTIFF.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include <gnomon/core/result.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/scene/scene.h>
#include <gnomon/view/shadow_mask.h>
#include <gnomon/view/view.h>

namespace gnomon {

// One byte band "shadow", row 0 at the top: the mask's own values, 0 lit, 1 shadow, 255 declared as
// nodata; a colour table, so that a viewer shows shadows dark. Georeferenced as profile.tif is
// (write_geotiff.h). `metadata`: key -> value, into the file's default domain as it is;
// TIFFTAG_SOFTWARE and the like become TIFF tags. `threads`: 0 for all; the bytes do not depend on
// their number. Precondition: mask and view have the same size > 0. Errors: as AtomicFile; a CRS
// that PROJ does not know; anything GDAL reports, in its words.
Result<FileWritten> write_mask_geotiff(const std::filesystem::path& path, const ShadowMask& mask,
                                       const View& view, const Frame& frame,
                                       const std::map<std::string, std::string>& metadata,
                                       int threads = 0);

}  // namespace gnomon
