#include <gnomon/io/gdal_support.h>

#include <fmt/format.h>

#include <cassert>
#include <utility>

#include <gnomon/io/write_geotiff.h>

namespace gnomon {
namespace {

// The horizontal part of a CRS, if it is known; hours and shadows have no height.
std::optional<OGRSpatialReference> horizontal_crs(const std::string& text) {
  OGRSpatialReference crs;
  if (crs.SetFromUserInput(text.c_str()) != OGRERR_NONE) return {};
  if (crs.IsCompound()) crs.StripVertical();
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

}  // namespace

Result<Georeference> georeference(const View& view, const Frame& frame,
                                  const std::filesystem::path& path, const GdalErrors& errors) {
  assert(is_plan(view));
  Georeference out;
  if (!frame.crs.empty()) {
    out.crs = horizontal_crs(frame.crs);
    if (!out.crs) {
      return Error{
          fmt::format("Cannot georeference {}: the coordinate reference system '{}' is not known "
                      "({}); give one that PROJ knows with --crs, such as EPSG:31256.",
                      path.string(), frame.crs, errors.first().value_or("PROJ gave no reason"))};
    }
  }
  // Scene coordinates are metres; the file's are in the CRS's own unit.
  const double s = out.crs && out.crs->IsProjected() ? 1.0 / out.crs->GetLinearUnits() : 1.0;
  out.transform = {(frame.origin.x + view.origin.x) * s, view.right.x * s, view.down.x * s,
                   (frame.origin.y + view.origin.y) * s, view.right.y * s, view.down.y * s};
  return out;
}

Error gdal_error(const std::filesystem::path& path, const GdalErrors& errors) {
  return {
      fmt::format("Cannot write {}: {}; check the space on the disk and the folder's permissions.",
                  path.string(), errors.first().value_or("GDAL gave no reason"))};
}

}  // namespace gnomon
