#include <gnomon/io/write_geotiff.h>

#include <fmt/format.h>
#include <gdal_frmts.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gnomon/core/parallel.h>
#include <gnomon/io/gdal_support.h>

namespace gnomon {
namespace {

struct Band {
  std::string description;
  std::vector<float> hours;  // kNoDataHours where there is no sample
  std::size_t valid = 0;
  double min = 0, max = 0, mean = 0, deviation = 0;  // of the valid samples
};

// value(k): hours of sample k; has(k): whether there are any. Sums per row, added in row order: the
// same digits for any number of threads.
template <class Has, class Value>
Band make_band(const Profile& p, int threads, std::string description, Has has, Value value) {
  struct RowSums {
    std::size_t valid = 0;
    double min = std::numeric_limits<double>::infinity(), max = -min;
    double sum = 0, squares = 0;
  };
  Band band{std::move(description), std::vector<float>(p.valid.size()), 0, 0, 0, 0, 0};
  std::vector<RowSums> rows(static_cast<std::size_t>(p.height));
  parallel_for(p.height, threads, [&](int row) {
    RowSums sums;
    const std::size_t begin = static_cast<std::size_t>(row) * static_cast<std::size_t>(p.width);
    for (std::size_t k = begin; k < begin + static_cast<std::size_t>(p.width); ++k) {
      if (!has(k)) {
        band.hours[k] = kNoDataHours;
        continue;
      }
      const double hours = value(k);
      band.hours[k] = static_cast<float>(hours);
      ++sums.valid;
      sums.min = std::min(sums.min, hours);
      sums.max = std::max(sums.max, hours);
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
    band.min = all.min;
    band.max = all.max;
    band.mean = all.sum / n;
    band.deviation = std::sqrt(std::max(0.0, all.squares / n - band.mean * band.mean));
  }
  return band;
}

void write_band(GDALDatasetH dataset, int index, Band& band, const Profile& p) {
  const GDALRasterBandH out = GDALGetRasterBand(dataset, index);
  GDALSetDescription(out, band.description.c_str());
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

  const bool clock = !profile.first_lit.empty();
  const int bands = clock ? 4 : 2;
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
                             profile.width, profile.height, bands, GDT_Float32, options.get()));
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
  GDALSetMetadataItem(dataset.get(), "DAYS", std::to_string(profile.days).c_str(), nullptr);
  int index = 0;
  // One band in memory at a time.
  const auto write = [&](const std::string& description, auto has, auto value) {
    ++index;
    if (errors.first()) return;
    Band band = make_band(profile, packing.threads, description, has, value);
    write_band(dataset.get(), index, band, profile);
  };
  const std::string per_day = profile.days > 1 ? " per day" : "";
  const auto valid = [&](std::size_t k) { return profile.valid[k] != 0; };
  const auto lit = [&](std::size_t k) {
    return profile.valid[k] != 0 && profile.first_lit[k] != kNeverLit;
  };
  write("hours in shadow" + per_day, valid,
        [&](std::size_t k) { return shadow_hours(profile, k); });
  write("hours of sun" + per_day, valid, [&](std::size_t k) { return sun_hours(profile, k); });
  if (clock) {
    write("first sun", lit, [&](std::size_t k) { return first_sun_clock(profile, k); });
    write("last sun", lit, [&](std::size_t k) { return last_sun_clock(profile, k); });
  }
  dataset.reset();  // the directory and the last tiles are written now, and may fail now
  if (errors.first()) return gdal_error(path, errors);
  return file.value().commit();
}

}  // namespace gnomon
