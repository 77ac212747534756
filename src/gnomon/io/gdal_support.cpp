#include <gnomon/io/gdal_support.h>

#include <fmt/format.h>

#include <cassert>
#include <utility>

#include <gnomon/io/write_geotiff.h>

namespace gnomon {

Result<std::optional<OGRSpatialReference>> horizontal_crs(const Frame& frame,
                                                          const std::filesystem::path& path,
                                                          const GdalErrors& errors) {
  if (frame.crs.empty()) return std::optional<OGRSpatialReference>();
  OGRSpatialReference crs;
  if (crs.SetFromUserInput(frame.crs.c_str()) != OGRERR_NONE) {
    return Error{
        fmt::format("Cannot georeference {}: the coordinate reference system '{}' is not known "
                    "({}); give one that PROJ knows with --crs, such as EPSG:31256.",
                    path.string(), frame.crs, errors.first().value_or("PROJ gave no reason"))};
  }
  if (crs.IsCompound()) crs.StripVertical();
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return std::optional<OGRSpatialReference>(std::move(crs));
}

std::string name_of_crs(OGRSpatialReference crs) {
  if (crs.IsCompound()) crs.StripVertical();
  const char *authority = crs.GetAuthorityName(nullptr), *code = crs.GetAuthorityCode(nullptr);
  if (authority && code) return fmt::format("{}:{}", authority, code);
  const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
  char* text = nullptr;
  std::string wkt;
  if (crs.exportToWkt(&text, options) == OGRERR_NONE && text) wkt = text;
  CPLFree(text);
  return wkt;
}

double units_per_metre(const std::optional<OGRSpatialReference>& crs) {
  return crs && crs->IsProjected() ? 1.0 / crs->GetLinearUnits() : 1.0;
}

Result<Georeference> georeference(const View& view, const Frame& frame,
                                  const std::filesystem::path& path, const GdalErrors& errors) {
  assert(is_plan(view));
  auto crs = horizontal_crs(frame, path, errors);
  if (!crs) return crs.error();
  Georeference out;
  out.crs = std::move(crs).value();
  const double s = units_per_metre(out.crs);
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
