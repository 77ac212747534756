#include <gnomon/io/gdal_support.h>
#include <gnomon/io/raster_grid.h>

#include <cpl_error.h>
#include <fmt/format.h>
#include <gdal.h>
#include <gdal_frmts.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include <gnomon/core/lower_case.h>

namespace gnomon {
namespace {

// The drivers that may open a file. All of them read one local file (and what lies beside it): VRT
// and the like, which name other files and addresses, are not among them.
constexpr const char* kDrivers[] = {"GTiff", "AAIGrid", "HFA",  "USGSDEM", "SRTMHGT", "DTED",
                                    "EHdr",  "GSAG",    "GSBG", "GS7BG",   nullptr};

// Only these: registering all of GDAL's drivers reads plugins and costs more than a small file.
void register_drivers() {
  static std::once_flag registered;
  std::call_once(registered, [] {
    GDALRegister_GTiff();
    GDALRegister_AAIGrid();
    GDALRegister_HFA();
    GDALRegister_USGSDEM();
    GDALRegister_SRTMHGT();
    GDALRegister_DTED();
    GDALRegister_EHdr();
    GDALRegister_GSAG();
    GDALRegister_GSBG();
    GDALRegister_GS7BG();
  });
}

// Values that files without a declared nodata value often have in its place. None is a height.
constexpr double kUsualNoData[] = {-9999, -32767, -32768, -99999};

// Cells smaller than this (in the file's unit) in a file that names no CRS are degrees, not metres:
// 0.001 degrees are 111 m, a millimetre is finer than any surface model of a building.
constexpr double kLeastCell = 1e-3;

Error refuse(const std::filesystem::path& path, const std::string& why) {
  return {path.string() + ": " + why};
}

std::optional<double> metres_per(const std::string& unit) {
  const std::string u = lower_case(unit);
  for (const char* name : {"m", "metre", "metres", "meter", "meters"}) {
    if (u == name) return 1.0;
  }
  for (const char* name : {"us survey foot", "us_survey_foot", "foot_us", "us-ft", "us foot",
                           "us survey feet", "sft", "ftus", "survey foot"}) {
    if (u == name) return 1200.0 / 3937.0;
  }
  for (const char* name : {"ft", "foot", "feet", "international foot", "foot (international)"}) {
    if (u == name) return 0.3048;
  }
  if (u == "cm" || u == "centimetre" || u == "centimeter") return 0.01;
  if (u == "dm") return 0.1;
  if (u == "mm") return 0.001;
  return {};
}

// Metres that one unit of the band's heights is.
double height_unit(const std::filesystem::path& path, GDALRasterBandH band,
                   const OGRSpatialReference* crs, Warnings& warnings) {
  const char* named = GDALGetRasterUnitType(band);
  const std::string unit = named ? named : "";
  if (!unit.empty()) {
    if (const auto metres = metres_per(unit)) return *metres;
    warn(warnings, "The unit of a raster's heights is not understood; they are taken as metres.",
         fmt::format("{}: unit '{}'", path.string(), unit));
    return 1.0;
  }
  if (crs && crs->IsCompound()) return crs->GetTargetLinearUnits("COMPD_CS|VERT_CS");
  if (crs && crs->IsProjected() && crs->GetLinearUnits() != 1.0) {
    warn(warnings,
         "A raster in a CRS in feet does not name the unit of its heights; they are taken as "
         "metres (declare feet with 'gdal_edit.py -setunittype ft', or a vertical CRS).",
         path.string());
  }
  return 1.0;
}

// How another band becomes the first, which is the one that is read.
constexpr const char* kTakeBand = "'gdal_translate -b N in.tif out.tif' takes band N out of a file";

std::optional<Error> check_band(const std::filesystem::path& path, GDALRasterBandH band) {
  if (GDALDataTypeIsComplex(GDALGetRasterDataType(band))) {
    return refuse(path, fmt::format("its first band holds complex numbers, which are no heights; "
                                    "give a raster of heights ({}).",
                                    kTakeBand));
  }
  switch (GDALGetRasterColorInterpretation(band)) {
    case GCI_PaletteIndex:
    case GCI_RedBand:
    case GCI_GreenBand:
    case GCI_BlueBand:
    case GCI_AlphaBand:
      return refuse(
          path,
          fmt::format("its first band is a colour of a picture ({}), not heights; give a raster of "
                      "heights ({}).",
                      GDALGetColorInterpretationName(GDALGetRasterColorInterpretation(band)),
                      kTakeBand));
    default:
      return {};
  }
}

std::optional<Error> check_placed(const std::filesystem::path& path, const RasterGrid& grid) {
  const auto& t = grid.transform;
  for (const double c : t) {
    if (!std::isfinite(c)) return refuse(path, "its geotransform is not finite; georeference it.");
  }
  if (t[1] * t[5] - t[2] * t[4] == 0.0) {
    return refuse(path, "its cells have no area, by its geotransform; georeference it anew.");
  }
  if (grid.crs.empty() && std::hypot(t[1], t[4]) < kLeastCell) {
    return refuse(path, fmt::format("it names no CRS and its cells are {:.3g} wide, so these are "
                                    "degrees rather than metres; name its CRS with --crs, such as "
                                    "EPSG:4326.",
                                    std::hypot(t[1], t[4])));
  }
  return {};
}

// What is not data becomes NaN; the rest is scaled, and checked.
std::optional<Error> finish_values(const std::filesystem::path& path, RasterGrid& grid,
                                   const std::vector<std::uint8_t>& mask, double scale,
                                   double offset, bool declared) {
  for (std::size_t k = 0; k < grid.z.size(); ++k) {
    double& z = grid.z[k];
    if (std::isnan(z) || (!mask.empty() && mask[k] == 0)) {
      z = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    const double raw = z;
    z = raw * scale + offset;
    const bool usual = !declared && std::find(std::begin(kUsualNoData), std::end(kUsualNoData),
                                              raw) != std::end(kUsualNoData);
    if (std::fabs(z) <= kHighestHeight && !usual) continue;
    const auto n = static_cast<std::size_t>(grid.columns);
    return refuse(
        path,
        fmt::format("the value {:g} at column {}, row {} (from 0) is no height; if it stands for "
                    "'no data', declare it: gdal_edit.py -a_nodata {:.17g} FILE.",
                    raw, k % n, k / n, raw));
  }
  return {};
}

Result<Dataset> open(const std::filesystem::path& path, const GdalErrors& errors) {
  std::error_code ignored;
  // A name that is no file may still mean something to GDAL: "/vsicurl/http://...".
  if (!std::filesystem::is_regular_file(path, ignored)) {
    return refuse(path, "there is no such file; check the name.");
  }
  if (lower_case(path.extension().string()) == ".vrt") {
    return refuse(path,
                  "a VRT only names other files and is not read; make one file of it with "
                  "'gdal_translate in.vrt out.tif'.");
  }
  register_drivers();
  const std::string whole_path = std::filesystem::absolute(path).string();
  Dataset dataset(GDALOpenEx(whole_path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, kDrivers,
                             nullptr, nullptr));
  if (dataset) return dataset;
  return refuse(path,
                fmt::format("it cannot be read as a raster ({}); GeoTIFF, ASCII grid (.asc), "
                            "Erdas Imagine, DTED, SRTM (.hgt), USGS (.dem), ESRI (.bil, .flt) "
                            "and Surfer grids are read.",
                            errors.first().value_or("no driver knows its content")));
}

std::optional<OGRSpatialReference> crs_of(GDALDatasetH dataset) {
  const OGRSpatialReferenceH named = GDALGetSpatialRef(dataset);
  if (!named) return {};
  return *OGRSpatialReference::FromHandle(named);
}

std::string name_in_file(const std::optional<OGRSpatialReference>& crs) {
  // A "local" CRS (engineering) says no more than that there is none.
  return crs && !crs->IsEmpty() && !crs->IsLocal() ? name_of_crs(*crs) : std::string();
}

}  // namespace

bool is_raster_file(const std::filesystem::path& path, std::string_view first_bytes) {
  using namespace std::string_view_literals;
  for (const std::string_view magic :
       {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv, "EHFA_HEADER_TAG"sv, "UHL1"sv, "DSAA"sv,
        "DSBB"sv, "DSRB"sv}) {
    if (first_bytes.starts_with(magic)) return true;
  }
  std::string start = lower_case(first_bytes.substr(0, 32));
  start.erase(0, std::min(start.find_first_not_of(" \t\r\n"), start.size()));
  for (const char* word : {"ncols", "nrows", "xllcorner", "xllcenter", "yllcorner", "yllcenter"}) {
    if (start.starts_with(word)) return true;
  }
  const std::string extension = lower_case(path.extension().string());
  for (const char* known : {".tif", ".tiff", ".asc", ".hgt", ".dem", ".bil", ".flt", ".img", ".dt0",
                            ".dt1", ".dt2", ".grd", ".vrt"}) {
    if (extension == known) return true;
  }
  return false;
}

Result<std::string> crs_of_raster_file(const std::filesystem::path& path) {
  GdalErrors errors;
  const auto dataset = open(path, errors);
  if (!dataset) return dataset.error();
  return name_in_file(crs_of(dataset.value().get()));
}

Result<RasterGrid> read_raster_grid(
    const std::filesystem::path& path, const std::string& fallback_crs,
    const std::function<std::optional<Error>(const RasterGrid&)>& check, Warnings& warnings) {
  GdalErrors errors;
  auto opened = open(path, errors);
  if (!opened) return opened.error();
  const Dataset dataset = std::move(opened).value();
  const int bands = GDALGetRasterCount(dataset.get());
  if (bands < 1) return refuse(path, "there is no band of values in it.");
  const GDALRasterBandH band = GDALGetRasterBand(dataset.get(), 1);
  if (auto error = check_band(path, band)) return *error;
  if (bands > 1) {
    warn(warnings, fmt::format("Of a raster with several bands the first is read; {}.", kTakeBand),
         fmt::format("{}: {} bands", path.string(), bands));
  }

  RasterGrid grid;
  grid.format = GDALGetDriverLongName(GDALGetDatasetDriver(dataset.get()));
  grid.columns = GDALGetRasterXSize(dataset.get());
  grid.rows = GDALGetRasterYSize(dataset.get());
  if (GDALGetGeoTransform(dataset.get(), grid.transform.data()) != CE_None) {
    return refuse(
        path, GDALGetGCPCount(dataset.get()) > 0
                  ? "it is placed by ground control points; rectify it with gdalwarp."
                  : "it has no georeference, so the size of its cells is not known; give it one, "
                    "as 'gdal_translate -a_srs EPSG:25832 -a_ullr WEST NORTH EAST SOUTH in.tif "
                    "out.tif' does, or a world file beside it.");
  }
  const std::optional<OGRSpatialReference> crs = crs_of(dataset.get());
  grid.crs = name_in_file(crs);
  if (grid.crs.empty()) grid.crs = fallback_crs;
  if (auto error = check_placed(path, grid)) return *error;

  if (auto error = check(grid)) return *error;

  const int columns = grid.columns, rows = grid.rows;
  const std::size_t cells = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  grid.z.resize(cells);
  std::vector<std::uint8_t> mask;
  CPLErr read = GDALRasterIO(band, GF_Read, 0, 0, columns, rows, grid.z.data(), columns, rows,
                             GDT_Float64, 0, 0);
  if (read == CE_None && !(GDALGetMaskFlags(band) & GMF_ALL_VALID)) {
    mask.resize(cells);
    read = GDALRasterIO(GDALGetMaskBand(band), GF_Read, 0, 0, columns, rows, mask.data(), columns,
                        rows, GDT_Byte, 0, 0);
  }
  if (read != CE_None || errors.first()) {
    return refuse(path, fmt::format("its values cannot be read ({}); the file may be cut off, so "
                                    "copy it anew.",
                                    errors.first().value_or("GDAL gave no reason")));
  }
  const double unit = height_unit(path, band, crs ? &*crs : nullptr, warnings);
  int has_scale = 0, has_offset = 0, declared = 0;
  const double scale = GDALGetRasterScale(band, &has_scale);
  const double offset = GDALGetRasterOffset(band, &has_offset);
  GDALGetRasterNoDataValue(band, &declared);
  if (auto error = finish_values(path, grid, mask, (has_scale ? scale : 1.0) * unit,
                                 (has_offset ? offset : 0.0) * unit, declared != 0)) {
    return *error;
  }
  return grid;
}

}  // namespace gnomon
