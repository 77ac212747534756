#include <gnomon/io/outlines.h>

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal.h>
#include <gdal_alg.h>
#include <gdal_frmts.h>
#include <ogr_api.h>
#include <ogrsf_frmts.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>

#include <gnomon/io/gdal_support.h>
#include <gnomon/io/write_geotiff.h>

namespace gnomon {
namespace {

void register_drivers() {
  static std::once_flag registered;
  std::call_once(registered, [] {
    GDALRegister_MEM();
    RegisterOGRMEM();
    RegisterOGRGeoJSON();
    RegisterOGRGeoPackage();
  });
}

struct DestroyFeature {
  void operator()(void* feature) const { OGR_F_Destroy(static_cast<OGRFeatureH>(feature)); }
};
using Feature = std::unique_ptr<void, DestroyFeature>;

OGRFeatureH handle(const Feature& feature) { return static_cast<OGRFeatureH>(feature.get()); }

// A ring of GDAL's in pixels: whole numbers, so that its area is exact.
struct PixelRing {
  std::vector<std::pair<std::int64_t, std::int64_t>> corners;  // closed
  std::int64_t twice_area = 0;  // positive: counter-clockwise on the map, where y is up
};

PixelRing pixel_ring(OGRGeometryH ring) {
  PixelRing out;
  const int n = OGR_G_GetPointCount(ring);
  for (int k = 0; k < n; ++k) {
    out.corners.emplace_back(std::llround(OGR_G_GetX(ring, k)), std::llround(OGR_G_GetY(ring, k)));
  }
  for (std::size_t k = 0; k + 1 < out.corners.size(); ++k) {
    const auto& [x0, y0] = out.corners[k];
    const auto& [x1, y1] = out.corners[k + 1];
    out.twice_area -= x0 * y1 - x1 * y0;  // y is down in pixels
  }
  return out;
}

// A file in memory, gone at the end: OGR's writers get a name of their own, and the bytes go
// through AtomicFile as all results do.
class MemoryFile {
 public:
  explicit MemoryFile(const char* extension) {
    static std::atomic<unsigned> next{0};
    name_ = fmt::format("/vsimem/gnomon-outlines-{}-{}.{}", getpid(), next++, extension);
  }
  ~MemoryFile() { VSIUnlink(name_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  const std::string& name() const { return name_; }
  std::string_view bytes() const {
    vsi_l_offset size = 0;
    const GByte* data = VSIGetMemFileBuffer(name_.c_str(), &size, FALSE);
    return {reinterpret_cast<const char*>(data), data != nullptr ? size : 0};
  }

 private:
  std::string name_;
};

OGRGeometryH polygon_of(const Outline& outline, double unit) {
  OGRGeometryH polygon = OGR_G_CreateGeometry(wkbPolygon);
  for (const std::vector<Vec2>& ring : outline.rings) {
    OGRGeometryH line = OGR_G_CreateGeometry(wkbLinearRing);
    OGR_G_SetPointCount(line, static_cast<int>(ring.size()));
    for (std::size_t k = 0; k < ring.size(); ++k) {
      OGR_G_SetPoint_2D(line, static_cast<int>(k), ring[k].x * unit, ring[k].y * unit);
    }
    OGR_G_AddGeometryDirectly(polygon, line);
  }
  return polygon;
}

bool add_field(OGRLayerH layer, const std::string& name, OGRFieldType type) {
  const OGRFieldDefnH field = OGR_Fld_Create(name.c_str(), type);
  const bool added = OGR_L_CreateField(layer, field, TRUE) == OGRERR_NONE;
  OGR_Fld_Destroy(field);
  return added;
}

// False: the reason is in GdalErrors.
bool fill(OGRLayerH layer, const std::vector<Outline>& outlines, double pixel_area, double unit,
          const std::vector<OutlineProperty>& properties) {
  if (!add_field(layer, "area_m2", OFTReal)) return false;
  for (const auto& [name, value] : properties) {
    const bool number = std::holds_alternative<double>(value);
    if (!add_field(layer, name, number ? OFTReal : OFTString)) return false;
  }
  // One transaction: a commit for each polygon would take most of the time.
  const bool transaction = OGR_L_TestCapability(layer, OLCTransactions) != 0;
  if (transaction && OGR_L_StartTransaction(layer) != OGRERR_NONE) return false;
  for (const Outline& outline : outlines) {
    const Feature feature(OGR_F_Create(OGR_L_GetLayerDefn(layer)));
    OGR_F_SetFieldDouble(handle(feature), 0, static_cast<double>(outline.samples) * pixel_area);
    int column = 1;
    for (const auto& [name, value] : properties) {
      if (const double* number = std::get_if<double>(&value)) {
        OGR_F_SetFieldDouble(handle(feature), column, *number);
      } else if (const auto& text = std::get<std::string>(value); !text.empty()) {
        OGR_F_SetFieldString(handle(feature), column, text.c_str());
      } else {
        OGR_F_SetFieldNull(handle(feature), column);
      }
      ++column;
    }
    OGR_F_SetGeometryDirectly(handle(feature), polygon_of(outline, unit));
    if (OGR_L_CreateFeature(layer, handle(feature)) != OGRERR_NONE) return false;
  }
  return !transaction || OGR_L_CommitTransaction(layer) == OGRERR_NONE;
}

}  // namespace

Result<std::vector<Outline>> shadow_outlines(const ShadowMask& mask, const View& view,
                                             const Frame& frame) {
  assert(is_plan(view));
  assert(mask.width == view.width && mask.height == view.height);
  register_drivers();
  GdalErrors errors;
  const auto failed = [&] {
    return Error{fmt::format("Cannot trace the shadows' outlines: {}.",
                             errors.first().value_or("GDAL gave no reason"))};
  };
  // 1 where there is shadow, 0 elsewhere: the band is its own mask, and 0 is left out.
  std::vector<std::uint8_t> shadow(mask.state.size());
  for (std::size_t k = 0; k < shadow.size(); ++k) {
    shadow[k] = mask.state[k] == ShadowMask::kShadow ? 1 : 0;
  }
  const Dataset raster(
      GDALCreate(GDALGetDriverByName("MEM"), "", mask.width, mask.height, 1, GDT_Byte, nullptr));
  const Dataset vector(
      GDALCreate(GDALGetDriverByName("Memory"), "", 0, 0, 0, GDT_Unknown, nullptr));
  if (!raster || !vector) return failed();
  const GDALRasterBandH band = GDALGetRasterBand(raster.get(), 1);
  if (GDALRasterIO(band, GF_Write, 0, 0, mask.width, mask.height, shadow.data(), mask.width,
                   mask.height, GDT_Byte, 0, 0) != CE_None) {
    return failed();
  }
  const OGRLayerH layer =
      GDALDatasetCreateLayer(vector.get(), "shadows", nullptr, wkbPolygon, nullptr);
  // No geotransform: rings come in whole pixels, so that nothing is rounded before the map.
  if (layer == nullptr ||
      GDALPolygonize(band, band, layer, -1, nullptr, nullptr, nullptr) != CE_None) {
    return failed();
  }

  const Vec3& o = frame.origin;
  std::vector<Outline> outlines;
  for (Feature feature(OGR_L_GetNextFeature(layer)); feature;
       feature.reset(OGR_L_GetNextFeature(layer))) {
    const OGRGeometryH polygon = OGR_F_GetGeometryRef(handle(feature));
    Outline& outline = outlines.emplace_back();
    std::int64_t twice = 0;
    for (int r = 0; r < OGR_G_GetGeometryCount(polygon); ++r) {
      const PixelRing ring = pixel_ring(OGR_G_GetGeometryRef(polygon, r));
      const bool outer = r == 0;
      twice += outer ? std::abs(ring.twice_area) : -std::abs(ring.twice_area);
      std::vector<Vec2>& corners = outline.rings.emplace_back();
      for (const auto& [column, row] : ring.corners) {
        const Vec4 at = view.origin + static_cast<double>(column) * view.right +
                        static_cast<double>(row) * view.down;
        corners.emplace_back(at.x + o.x, at.y + o.y);
      }
      if ((ring.twice_area > 0) != outer) std::reverse(corners.begin(), corners.end());
    }
    outline.samples = static_cast<std::uint64_t>(twice / 2);
  }
  if (errors.first()) return failed();
  return outlines;
}

Result<FileWritten> write_outlines(const std::filesystem::path& path, OutlineFormat format,
                                   const std::vector<Outline>& outlines, double pixel_area,
                                   const View& view, const Frame& frame,
                                   const std::vector<OutlineProperty>& properties) {
  register_drivers();
  GdalErrors errors;
  Result<Georeference> found = georeference(view, frame, path, errors);
  if (!found) return found.error();
  Georeference& place = found.value();
  const double unit = place.crs && place.crs->IsProjected() ? 1.0 / place.crs->GetLinearUnits() : 1;

  const bool geojson = format == OutlineFormat::geojson;
  const MemoryFile file(geojson ? "geojson" : "gpkg");
  Dataset dataset(GDALCreate(GDALGetDriverByName(geojson ? "GeoJSON" : "GPKG"), file.name().c_str(),
                             0, 0, 0, GDT_Unknown, nullptr));
  if (!dataset) return gdal_error(path, errors);
  OptionList options;
  if (geojson) {
    options.set("COORDINATE_PRECISION", "9");  // a nanometre: without digits that are rounding
    options.set("SIGNIFICANT_FIGURES", "15");  // of the properties, for the same reason
  }
  const OGRSpatialReferenceH crs = place.crs ? OGRSpatialReference::ToHandle(&*place.crs) : nullptr;
  const OGRLayerH layer =
      GDALDatasetCreateLayer(dataset.get(), "shadows", crs, wkbPolygon, options.get());
  const bool filled = layer != nullptr && fill(layer, outlines, pixel_area, unit, properties);
  dataset.reset();  // the end of the file is written now
  if (!filled || errors.first()) return gdal_error(path, errors);
  return write_text_file(path, file.bytes());
}

}  // namespace gnomon
