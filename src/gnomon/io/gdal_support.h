// GDAL objects with an owner, its errors, and where a view's pixels lie on the map; for the sources
// of this room only: no other room sees a type of GDAL.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <cpl_error.h>
#include <cpl_string.h>
#include <gdal.h>
#include <ogr_spatialref.h>

#include <gnomon/core/result.h>
#include <gnomon/scene/scene.h>
#include <gnomon/view/view.h>

namespace gnomon {

// GDAL reports through a handler per thread; while one of these lives, its messages come here
// instead of stderr.
class GdalErrors {
 public:
  GdalErrors() { CPLPushErrorHandlerEx(&GdalErrors::collect, this); }
  ~GdalErrors() { CPLPopErrorHandler(); }
  GdalErrors(const GdalErrors&) = delete;
  GdalErrors& operator=(const GdalErrors&) = delete;

  // The first failure is the cause, later ones are its consequences.
  const std::optional<std::string>& first() const { return first_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  static void CPL_STDCALL collect(CPLErr severity, CPLErrorNum, const char* message) {
    auto* self = static_cast<GdalErrors*>(CPLGetErrorHandlerUserData());
    if (severity == CE_Warning) self->warnings_.emplace_back(message);
    if (severity >= CE_Failure && !self->first_) self->first_ = message;
  }
  std::optional<std::string> first_;
  std::vector<std::string> warnings_;
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

// The horizontal part of the frame's CRS (hours and shadows have no height); nothing where it has
// none. Errors: a CRS that PROJ does not know (`path` is named as what cannot be written).
Result<std::optional<OGRSpatialReference>> horizontal_crs(const Frame& frame,
                                                          const std::filesystem::path& path,
                                                          const GdalErrors& errors);

// The horizontal part of a CRS as "EPSG:25830" (or another authority's code) where it has a code,
// else WKT.
std::string name_of_crs(OGRSpatialReference crs);

// Units of a file's coordinates in a metre: scene coordinates are metres, a file's are in its CRS's
// own unit.
double units_per_metre(const std::optional<OGRSpatialReference>& crs);

// Where the pixels of a plan lie on the map.
struct Georeference {
  // GDAL's order: x = t[0] + column t[1] + row t[2], y = t[3] + column t[4] + row t[5], of the
  // upper left corner of a pixel, in the CRS's own unit.
  std::array<double, 6> transform{};
  std::optional<OGRSpatialReference> crs;  // its horizontal part; empty: local metres
};

// Precondition: is_plan(view). Errors: as horizontal_crs.
Result<Georeference> georeference(const View& view, const Frame& frame,
                                  const std::filesystem::path& path, const GdalErrors& errors);

// "Cannot write <path>: <GDAL's reason>; ...".
Error gdal_error(const std::filesystem::path& path, const GdalErrors& errors);

}  // namespace gnomon
