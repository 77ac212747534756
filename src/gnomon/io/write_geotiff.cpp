#include <gnomon/io/write_geotiff.h>

#include <fmt/format.h>
#include <gdal.h>
#include <gdal_frmts.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <gnomon/core/parallel.h>
#include <gnomon/io/gdal_support.h>

namespace gnomon {
namespace {

struct Band {
  const char* description;
  std::vector<float> hours;  // kNoDataHours where there is no sample
  std::size_t valid = 0;
  double min = 0, max = 0, mean = 0, deviation = 0;  // of the valid samples
};

// Statistics from whole milliseconds and sums per row, added in row order: the same digits for any
// number of threads.
template <class Milliseconds>
Band make_band(const Profile& p, int threads, const char* description, Milliseconds milliseconds) {
  struct RowSums {
    std::size_t valid = 0;
    std::uint32_t min = 0xffffffffu, max = 0;
    double sum = 0, squares = 0;
  };
  Band band{description, std::vector<float>(p.valid.size()), 0, 0, 0, 0, 0};
  std::vector<RowSums> rows(static_cast<std::size_t>(p.height));
  parallel_for(p.height, threads, [&](int row) {
    RowSums sums;
    const std::size_t begin = static_cast<std::size_t>(row) * static_cast<std::size_t>(p.width);
    for (std::size_t k = begin; k < begin + static_cast<std::size_t>(p.width); ++k) {
      if (!p.valid[k]) {
        band.hours[k] = kNoDataHours;
        continue;
      }
      const std::uint32_t ms = milliseconds(k);
      band.hours[k] = static_cast<float>(ms / 3.6e6);
      ++sums.valid;
      sums.min = std::min(sums.min, ms);
      sums.max = std::max(sums.max, ms);
      const double hours = ms / 3.6e6;
      sums.sum += hours;
      sums.squares += hours * hours;
    }
    rows[static_cast<std::size_t>(row)] = sums;
  });
  RowSums all;
  for (const RowSums& row : rows) {
    all.valid += row.valid;
    all.min = std::min(all.min, row.min);
    all.max = std::max(all.max, row.max);
    all.sum += row.sum;
    all.squares += row.squares;
  }
  band.valid = all.valid;
  if (all.valid > 0) {
    const double n = static_cast<double>(all.valid);
    band.min = all.min / 3.6e6;
    band.max = all.max / 3.6e6;
    band.mean = all.sum / n;
    band.deviation = std::sqrt(std::max(0.0, all.squares / n - band.mean * band.mean));
  }
  return band;
}

void write_band(GDALDatasetH dataset, int index, Band& band, const Profile& p) {
  const GDALRasterBandH out = GDALGetRasterBand(dataset, index);
  GDALSetDescription(out, band.description);
  GDALSetRasterUnitType(out, "h");
  GDALSetRasterNoDataValue(out, static_cast<double>(kNoDataHours));
  if (band.valid > 0) {
    // Written into the file, so that viewers scale their colours at once and need no .aux.xml of
    // their own.
    GDALSetMetadataItem(out, "STATISTICS_MINIMUM", fmt::format("{:.9g}", band.min).c_str(),
                        nullptr);
    GDALSetMetadataItem(out, "STATISTICS_MAXIMUM", fmt::format("{:.9g}", band.max).c_str(),
                        nullptr);
    GDALSetMetadataItem(out, "STATISTICS_MEAN", fmt::format("{:.9g}", band.mean).c_str(), nullptr);
    GDALSetMetadataItem(out, "STATISTICS_STDDEV", fmt::format("{:.9g}", band.deviation).c_str(),
                        nullptr);
    const double percent =
        100.0 * static_cast<double>(band.valid) / static_cast<double>(p.valid.size());
    GDALSetMetadataItem(out, "STATISTICS_VALID_PERCENT", fmt::format("{:.4g}", percent).c_str(),
                        nullptr);
  }
  if (GDALRasterIO(out, GF_Write, 0, 0, p.width, p.height, band.hours.data(), p.width, p.height,
                   GDT_Float32, 0, 0) != CE_None) {
    return;  // the reason is in GdalErrors
  }
}

}  // namespace

bool is_plan(const View& v) {
  return v.eye.w == 0.0 && v.eye.x == 0.0 && v.eye.y == 0.0 && v.eye.z > 0.0 && v.right.z == 0.0 &&
         v.down.z == 0.0;
}

Result<FileWritten> write_profile_geotiff(const std::filesystem::path& path, const Profile& profile,
                                          const View& view, const Frame& frame,
                                          const std::map<std::string, std::string>& metadata,
                                          const GeotiffPacking& packing) {
  assert(profile.width == view.width && profile.height == view.height);
  assert(profile.width > 0 && profile.height > 0);
  // Only the one driver: registering all of them reads plugins and costs more than the writing of a
  // small file.
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
  options.set("BLOCKXSIZE", std::to_string(packing.tile));
  options.set("BLOCKYSIZE", std::to_string(packing.tile));
  options.set("INTERLEAVE", "BAND");
  options.set("COMPRESS", "DEFLATE");
  options.set("ZLEVEL", std::to_string(packing.deflate_level));
  options.set("PREDICTOR", std::to_string(packing.predictor));
  options.set("NUM_THREADS", packing.threads > 0 ? std::to_string(packing.threads) : "ALL_CPUS");
  options.set("BIGTIFF", "IF_SAFER");
  Dataset dataset(GDALCreate(GDALGetDriverByName("GTiff"), file.value().temporary().c_str(),
                             profile.width, profile.height, 2, GDT_Float32, options.get()));
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
  const auto shadow = [&](std::size_t k) { return profile.shadow_ms[k]; };
  const auto sun = [&](std::size_t k) { return profile.daylight_ms - profile.shadow_ms[k]; };
  Band band = make_band(profile, packing.threads, "hours in shadow", shadow);
  write_band(dataset.get(), 1, band, profile);
  if (!errors.first()) {
    band = make_band(profile, packing.threads, "hours of sun", sun);
    write_band(dataset.get(), 2, band, profile);
  }
  dataset.reset();  // the directory and the last tiles are written now, and may fail now
  if (errors.first()) return gdal_error(path, errors);
  return file.value().commit();
}

}  // namespace gnomon
