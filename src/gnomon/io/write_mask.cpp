#include <gnomon/io/write_mask.h>

#include <gdal.h>
#include <gdal_frmts.h>

#include <cassert>
#include <mutex>
#include <optional>
#include <utility>

#include <gnomon/io/gdal_support.h>
#include <gnomon/io/mask_picture.h>
#include <gnomon/io/picture_map.h>
#include <gnomon/io/write_geotiff.h>

namespace gnomon {
namespace {

void set_colour(GDALColorTableH table, int value, Rgb colour, bool visible) {
  const GDALColorEntry entry{colour.r, colour.g, colour.b, static_cast<short>(visible ? 255 : 0)};
  GDALSetColorEntry(table, value, &entry);
}

}  // namespace

Result<FileWritten> write_mask_geotiff(const std::filesystem::path& path, const ShadowMask& mask,
                                       const View& view, const Frame& frame,
                                       const std::map<std::string, std::string>& metadata,
                                       int threads) {
  assert(mask.width == view.width && mask.height == view.height);
  assert(mask.width > 0 && mask.height > 0);
  static std::once_flag registered;
  std::call_once(registered, [] { GDALRegister_GTiff(); });

  GdalErrors errors;
  std::optional<Georeference> place;
  if (is_plan(view)) {
    Result<Georeference> found = georeference(view, frame, path, errors);
    if (!found) return found.error();
    place = std::move(found).value();
  }
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();

  OptionList options;
  options.set("TILED", "YES");
  options.set("COMPRESS", "DEFLATE");
  options.set("NUM_THREADS", threads > 0 ? std::to_string(threads) : "ALL_CPUS");
  options.set("BIGTIFF", "IF_SAFER");
  Dataset dataset(GDALCreate(GDALGetDriverByName("GTiff"), file.value().temporary().c_str(),
                             mask.width, mask.height, 1, GDT_Byte, options.get()));
  if (!dataset) return gdal_error(path, errors);
  if (place) {
    GDALSetGeoTransform(dataset.get(), place->transform.data());
    if (place->crs) {
      GDALSetSpatialRef(dataset.get(), OGRSpatialReference::ToHandle(&*place->crs));
    }
  }
  for (const auto& [key, value] : metadata) {
    GDALSetMetadataItem(dataset.get(), key.c_str(), value.c_str(), nullptr);
  }
  const GDALRasterBandH band = GDALGetRasterBand(dataset.get(), 1);
  GDALSetDescription(band, "shadow");
  GDALSetRasterNoDataValue(band, ShadowMask::kNoSample);
  const GDALColorTableH table = GDALCreateColorTable(GPI_RGB);
  set_colour(table, ShadowMask::kLit, kLitColour, true);
  set_colour(table, ShadowMask::kShadow, kShadowColour, true);
  set_colour(table, ShadowMask::kNoSample, kNoDataColour, false);
  GDALSetRasterColorTable(band, table);
  GDALDestroyColorTable(table);
  // GDAL does not change what it writes, but its interface takes no pointer to const.
  auto* states = const_cast<std::uint8_t*>(mask.state.data());
  const CPLErr written = GDALRasterIO(band, GF_Write, 0, 0, mask.width, mask.height, states,
                                      mask.width, mask.height, GDT_Byte, 0, 0);
  dataset.reset();  // the directory and the last tiles are written now, and may fail now
  if (written != CE_None || errors.first()) return gdal_error(path, errors);
  return file.value().commit();
}

}  // namespace gnomon
