#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <ogr_api.h>
#include <ogrsf_frmts.h>

#include <memory>
#include <mutex>

#include <gnomon/io/gdal_support.h>
#include <gnomon/io/isolines.h>

namespace gnomon {
namespace {

constexpr const char* kLayer = "shadow hours isolines";

void add_field(OGRLayerH layer, const char* name, OGRFieldType type) {
  const OGRFieldDefnH field = OGR_Fld_Create(name, type);
  OGR_L_CreateField(layer, field, TRUE);
  OGR_Fld_Destroy(field);
}

// A setting of GDAL for this thread, while it lives.
class ThreadSetting {
 public:
  ThreadSetting(const char* key, const char* value) : key_(key) {
    CPLSetThreadLocalConfigOption(key, value);
  }
  ~ThreadSetting() { CPLSetThreadLocalConfigOption(key_, nullptr); }
  ThreadSetting(const ThreadSetting&) = delete;
  ThreadSetting& operator=(const ThreadSetting&) = delete;

 private:
  const char* key_;
};

// False where the reason is in `errors`, or GDAL gave none.
bool write_features(OGRLayerH layer, const std::vector<Isoline>& lines, int days,
                    const Vec3& origin, double units, const GdalErrors& errors) {
  const OGRFeatureDefnH definition = OGR_L_GetLayerDefn(layer);
  for (const Isoline& line : lines) {
    const OGRFeatureH feature = OGR_F_Create(definition);
    OGR_F_SetFieldDouble(feature, 0, static_cast<double>(line.level_ms) / 3.6e6);
    OGR_F_SetFieldInteger(feature, 1, static_cast<int>((line.level_ms + 30000) / 60000));
    OGR_F_SetFieldInteger(feature, 2, days);
    const OGRGeometryH geometry = OGR_G_CreateGeometry(wkbLineString);
    OGR_G_SetPointCount(geometry, static_cast<int>(line.points.size()));
    int k = 0;
    for (const Vec2& p : line.points) {
      OGR_G_SetPoint_2D(geometry, k++, (origin.x + p.x) * units, (origin.y + p.y) * units);
    }
    OGR_F_SetGeometryDirectly(feature, geometry);
    const bool written = OGR_L_CreateFeature(layer, feature) == OGRERR_NONE;
    OGR_F_Destroy(feature);
    if (!written || errors.first()) return false;
  }
  return true;
}

// Writes the new file `file` with the driver; `path` is for messages. Nothing: all is well.
std::optional<Error> write_lines(const char* driver, const std::string& file,
                                 const std::filesystem::path& path,
                                 const std::vector<Isoline>& lines, int days, const Frame& frame,
                                 const OptionList& layer_options) {
  static std::once_flag registered;
  std::call_once(registered, [] {
    RegisterOGRGeoJSON();
    RegisterOGRGeoPackage();
  });
  GdalErrors errors;
  auto found = horizontal_crs(frame, path, errors);
  if (!found) return found.error();
  std::optional<OGRSpatialReference> crs = std::move(found).value();

  // Nothing is promised about power cuts; see AtomicFile.
  const ThreadSetting no_sync("OGR_SQLITE_SYNCHRONOUS", "OFF");
  Dataset dataset(
      GDALCreate(GDALGetDriverByName(driver), file.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!dataset) return gdal_error(path, errors);
  const OGRLayerH layer = GDALDatasetCreateLayer(
      dataset.get(), kLayer, crs ? OGRSpatialReference::ToHandle(&*crs) : nullptr, wkbLineString,
      layer_options.get());
  if (layer == nullptr) return gdal_error(path, errors);
  add_field(layer, "hours", OFTReal);
  add_field(layer, "minutes", OFTInteger);
  add_field(layer, "days", OFTInteger);
  const bool transaction = GDALDatasetTestCapability(dataset.get(), ODsCTransactions) != 0;
  if (transaction) GDALDatasetStartTransaction(dataset.get(), FALSE);
  const bool written =
      write_features(layer, lines, days, frame.origin, units_per_metre(crs), errors);
  if (transaction && written) GDALDatasetCommitTransaction(dataset.get());
  dataset.reset();  // what is left is written now, and may fail now
  if (!written || errors.first()) return gdal_error(path, errors);
  return {};
}

}  // namespace

Result<FileWritten> write_isolines_geojson(const std::filesystem::path& path,
                                           const std::vector<Isoline>& lines, int days,
                                           const Frame& frame) {
  OptionList options;
  options.set("RFC7946", "NO");
  options.set("COORDINATE_PRECISION", "3");
  // In memory first: GDAL's GeoJSON driver does not notice a disk that is full.
  const std::string memory =
      fmt::format("/vsimem/gnomon/{}.geojson", static_cast<const void*>(&lines));
  const std::optional<Error> error =
      write_lines("GeoJSON", memory, path, lines, days, frame, options);
  vsi_l_offset size = 0;
  const std::unique_ptr<GByte, decltype(&VSIFree)> bytes(
      VSIGetMemFileBuffer(memory.c_str(), &size, TRUE), &VSIFree);
  if (error) return *error;
  if (!bytes) return gdal_error(path, {});
  return write_text_file(path, {reinterpret_cast<const char*>(bytes.get()), size});
}

Result<FileWritten> write_isolines_gpkg(const std::filesystem::path& path,
                                        const std::vector<Isoline>& lines, int days,
                                        const Frame& frame) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  const std::filesystem::path temporary = file.value().temporary();
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);  // GDAL refuses a file that is there
  if (const std::optional<Error> error =
          write_lines("GPKG", temporary.string(), path, lines, days, frame, OptionList())) {
    for (const char* journal : {"-journal", "-wal", "-shm"})
      std::filesystem::remove(temporary.string() + journal, ignored);
    return *error;
  }
  return file.value().commit();
}

}  // namespace gnomon
