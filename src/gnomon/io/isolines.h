// isolines.geojson, isolines.gpkg: lines of equal hours in shadow on a plan.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/core/vec.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/profile/profile.h>
#include <gnomon/scene/scene.h>
#include <gnomon/view/view.h>

namespace gnomon {

// A line between samples with at least so much shadow per day and those with less.
struct Isoline {
  std::uint64_t level_ms = 0;  // milliseconds per day
  std::vector<Vec2> points;    // scene coordinates, metres; a closed line ends where it begins
};

// Lines at step_ms, 2 step_ms, ... up to the daylight per day, ascending; the same for any number
// of threads. Hours jump by whole steps at the edges of shadows, so that hours themselves,
// contoured, give stairs of pixels, shifted by how much they jump. Instead, for each level, the
// samples that reach it (exactly, as in profile.tif) are averaged over 3 x 3 samples with the
// weights 1 2 1 each way, those without a surface left out, and the line is drawn where the mean is
// one half; then points are left out as long as none is more than three quarters of a sample from
// the line: more than the stairs of a slanting edge, which become straight. So lines lie within two
// samples of where profile.tif changes, lines of different levels may cross by less than two, and
// spots and gaps one sample wide may have no line of their own. Lines end where there is no
// surface. Preconditions: is_plan(plan), of the profile's size; step_ms > 0.
std::vector<Isoline> find_isolines(const Profile& profile, const View& plan, std::uint64_t step_ms,
                                   int threads = 0);

// Layer "shadow hours isolines" of line strings with the attributes "hours" (real) and "minutes"
// (integer) of the level, per day, and "days" (integer) the mean is taken over. Coordinates as in
// profile.tif, rounded to a millimetre in GeoJSON. GeoJSON names the CRS in its member "crs" (as
// before RFC 7946, whose only CRS is WGS 84; GIS programs read it); a CRS without a code cannot be
// named there and stands in the GeoPackage alone. Errors: as write_profile_geotiff.
Result<FileWritten> write_isolines_geojson(const std::filesystem::path& path,
                                           const std::vector<Isoline>& lines, int days,
                                           const Frame& frame);
Result<FileWritten> write_isolines_gpkg(const std::filesystem::path& path,
                                        const std::vector<Isoline>& lines, int days,
                                        const Frame& frame);

}  // namespace gnomon
