// What writers through GDAL share: its errors, owners of its handles, the CRS of what is written.
// For .cpp files of this room only: GDAL's types stay inside.
#pragma once

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal.h>
#include <ogr_spatialref.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <gnomon/core/result.h>
#include <gnomon/scene/scene.h>

namespace gnomon {

// GDAL reports through a handler per thread; while one of these lives, its errors come here instead
// of stderr.
class GdalErrors {
 public:
  GdalErrors() { CPLPushErrorHandlerEx(&GdalErrors::collect, this); }
  ~GdalErrors() { CPLPopErrorHandler(); }
  GdalErrors(const GdalErrors&) = delete;
  GdalErrors& operator=(const GdalErrors&) = delete;

  // The first failure is the cause, later ones are its consequences.
  const std::optional<std::string>& first() const { return first_; }

 private:
  static void CPL_STDCALL collect(CPLErr severity, CPLErrorNum, const char* message) {
    if (severity < CE_Failure) return;
    auto* self = static_cast<GdalErrors*>(CPLGetErrorHandlerUserData());
    if (!self->first_) self->first_ = message;
  }
  std::optional<std::string> first_;
};

struct CloseDataset {
  void operator()(void* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, CloseDataset>;

class OptionList {
 public:
  ~OptionList() { CSLDestroy(list_); }
  OptionList() = default;
  OptionList(const OptionList&) = delete;
  OptionList& operator=(const OptionList&) = delete;
  void set(const char* key, const std::string& value) {
    list_ = CSLSetNameValue(list_, key, value.c_str());
  }
  char** get() const { return list_; }

 private:
  char** list_ = nullptr;
};

// The horizontal part of the frame's CRS (hours have no height); nothing where it has none.
// Errors: a CRS that PROJ does not know. `errors` must be alive meanwhile.
inline Result<std::optional<OGRSpatialReference>> horizontal_crs(const Frame& frame,
                                                                 const std::filesystem::path& path,
                                                                 const GdalErrors& errors) {
  std::optional<OGRSpatialReference> none;
  if (frame.crs.empty()) return none;
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

// Units of the file's coordinates in a metre: scene coordinates are metres, the file's are in the
// CRS's own unit.
inline double units_per_metre(const std::optional<OGRSpatialReference>& crs) {
  return crs && crs->IsProjected() ? 1.0 / crs->GetLinearUnits() : 1.0;
}

inline Error gdal_error(const std::filesystem::path& path,
                        const std::optional<std::string>& reason) {
  return {
      fmt::format("Cannot write {}: {}; check the space on the disk and the folder's permissions.",
                  path.string(), reason.value_or("GDAL gave no reason"))};
}

}  // namespace gnomon
