#include <gnomon/io/footprint_file.h>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <set>

#include <gnomon/core/lower_case.h>
#include <gnomon/io/gdal_support.h>
#include <gnomon/io/geojson_fault.h>
#include <gnomon/io/geojson_values.h>
#include <gnomon/io/osm_tags.h>
#include <gnomon/io/read_text.h>

namespace gnomon {
namespace {

// Attributes that name a feature, the best first.
constexpr std::array<const char*, 13> kIds = {
    "id",   "@id",    "gml_id",   "osm_id", "osm_way_id", "full_id", "identificatie",
    "uuid", "gml:id", "globalid", "gmlid",  "name",       "nom"};

struct Driver {
  const char* name;    // GDAL's
  const char* format;  // for people
};
// No driver but these is asked, so that no file can send GDAL elsewhere (VRT, WFS, ...).
constexpr std::array<Driver, 7> kDrivers = {{{"GeoJSON", "GeoJSON"},
                                             {"GeoJSONSeq", "GeoJSON text sequence"},
                                             {"GPKG", "GeoPackage"},
                                             {"ESRI Shapefile", "Shapefile"},
                                             {"FlatGeobuf", "FlatGeobuf"},
                                             {"GML", "GML"},
                                             {"LIBKML", "KML"}}};

struct DestroyFeature {
  void operator()(void* feature) const { OGR_F_Destroy(static_cast<OGRFeatureH>(feature)); }
};
struct DestroyGeometry {
  void operator()(void* g) const { OGR_G_DestroyGeometry(static_cast<OGRGeometryH>(g)); }
};
using Feature = std::unique_ptr<std::remove_pointer_t<OGRFeatureH>, DestroyFeature>;
using Geometry = std::unique_ptr<std::remove_pointer_t<OGRGeometryH>, DestroyGeometry>;

constexpr std::size_t kMostOfGdal = 500;  // bytes of a message, which may quote the file

// What GDAL said, as a part of a sentence.
std::string reason_of(const GdalErrors& errors) {
  std::string text = errors.first()              ? *errors.first()
                     : errors.warnings().empty() ? "GDAL gives no reason"
                                                 : errors.warnings().front();
  while (!text.empty() && (text.back() == '.' || text.back() == '\n')) text.pop_back();
  return printable(text, kMostOfGdal);
}

Error cannot_open(const std::filesystem::path& path, const GdalErrors& errors) {
  return {fmt::format(
      "{}: cannot be read as GeoJSON, GeoPackage, Shapefile, FlatGeobuf, GML or KML ({}); check "
      "that the file is whole{}.",
      path.string(), reason_of(errors),
      lower_case(path.extension().string()) == ".shp"
          ? " and that its .shx and .dbf stand beside it"
          : "")};
}

Dataset open_with_drivers(const std::string& name) {
  static std::once_flag registered;
  std::call_once(registered, [] {
    RegisterOGRGeoJSON();
    RegisterOGRGeoJSONSeq();
    RegisterOGRGeoPackage();
    RegisterOGRShape();
    RegisterOGRFlatGeobuf();
    RegisterOGRGML();
    RegisterOGRLIBKML();
  });
  std::array<const char*, kDrivers.size() + 1> drivers{};
  for (std::size_t k = 0; k < kDrivers.size(); ++k) drivers[k] = kDrivers[k].name;
  // Drivers ignore each other's options, but warn of them; these are GML's.
  const std::array<const char*, 3> gml = {"WRITE_GFS=NO", "DOWNLOAD_SCHEMA=NO", nullptr};
  return Dataset(GDALOpenEx(name.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, drivers.data(),
                            lower_case(name).ends_with(".gml") ? gml.data() : nullptr, nullptr));
}

Result<Dataset> open(const std::filesystem::path& path, const GdalErrors& errors) {
  // GDAL takes some names for addresses ("GPKG:...", "http://...", "/vsicurl/..."): a path from the
  // root that is a file on this disk is none.
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    return Error{fmt::format("{}: there is no such file.", path.string())};
  }
  const std::string absolute = std::filesystem::absolute(path).lexically_normal().string();
  if (absolute.starts_with("/vsi")) {
    return Error{
        fmt::format("{}: paths that start with /vsi mean something else to GDAL; move the "
                    "file to another folder.",
                    path.string())};
  }
  Dataset dataset = open_with_drivers(absolute);
  if (dataset) return dataset;
  return cannot_open(path, errors);
}

std::string driver_of(GDALDatasetH dataset) {
  return GDALGetDriverShortName(GDALGetDatasetDriver(dataset));
}

// A text as a file of GDAL's in memory. The text must live longer, and datasets be closed before.
class FileInMemory {
 public:
  FileInMemory(std::string& text, const std::string& file_name)
      : name_(fmt::format("/vsimem/gnomon-{}/{}", static_cast<void*>(text.data()), file_name)) {
    VSIFCloseL(VSIFileFromMemBuffer(name_.c_str(), reinterpret_cast<GByte*>(text.data()),
                                    text.size(), FALSE));
  }
  ~FileInMemory() { VSIUnlink(name_.c_str()); }
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

bool may_hold_polygons(OGRwkbGeometryType type, bool declared) {
  switch (wkbFlatten(type)) {
    case wkbPolygon:
    case wkbMultiPolygon:
    case wkbCurvePolygon:
    case wkbMultiSurface:
    case wkbSurface:
    case wkbTriangle:
      return true;
    case wkbUnknown:
    case wkbGeometryCollection:
      return !declared;
    default:
      return false;
  }
}

// The layer to read. Layers that are declared to hold polygons go before those that may hold
// anything.
Result<OGRLayerH> choose_layer(GDALDatasetH dataset, const std::string& path,
                               const std::string& name) {
  const int n = GDALDatasetGetLayerCount(dataset);
  std::vector<std::string> all;
  for (int k = 0; k < n; ++k) {
    const OGRLayerH layer = GDALDatasetGetLayer(dataset, k);
    all.emplace_back(OGR_L_GetName(layer));
    if (!name.empty() && all.back() == name) return layer;
  }
  if (!name.empty()) {
    return Error{fmt::format("{}: there is no layer {}; it has {}.", path, in_quotes(name),
                             all.empty() ? "none" : listed(all))};
  }
  for (const bool declared : {true, false}) {
    std::vector<std::string> names;
    OGRLayerH found = nullptr;
    for (int k = 0; k < n; ++k) {
      const OGRLayerH layer = GDALDatasetGetLayer(dataset, k);
      if (!may_hold_polygons(OGR_L_GetGeomType(layer), declared)) continue;
      found = layer;
      names.emplace_back(OGR_L_GetName(layer));
    }
    if (names.size() > 1) {
      return Error{
          fmt::format("{}: it has several layers with polygons, {}; name the one with the "
                      "buildings with --layer.",
                      path, listed(names))};
    }
    if (found) return found;
  }
  return Error{
      fmt::format("{}: it has no layer with polygons{}; footprints of buildings are "
                  "polygons.",
                  path, all.empty() ? "" : " (its layers: " + listed(all) + ")")};
}

struct LayerCrs {
  std::string name;            // empty: none
  double metres_per_unit = 1;  // where there is no name but a unit
  bool swapped = false;        // coordinates are stored north first
};

LayerCrs crs_of(OGRLayerH layer) {
  const OGRSpatialReferenceH own = OGR_L_GetSpatialRef(layer);
  LayerCrs out;
  if (!own) return out;
  OGRSpatialReference crs = *OGRSpatialReference::FromHandle(own);
  if (crs.IsLocal()) out.metres_per_unit = crs.GetLinearUnits();
  // GeoPackage says so of layers of unknown place.
  const char* const own_name = crs.GetName();
  const bool undefined = own_name && std::string_view(own_name).starts_with("Undefined ");
  if (undefined || crs.IsLocal()) return out;
  const std::vector<int> stored = crs.GetDataAxisToSRSAxisMapping();
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::vector<int> axes = crs.GetDataAxisToSRSAxisMapping();
  out.swapped = axes.size() >= 2 && stored.size() >= 2 && stored[0] != axes[0];
  out.name = name_of_crs(std::move(crs));
  return out;
}

// Adds the polygons of a geometry, deep inside too.
void add_polygons(OGRGeometryH g, bool swapped, FootprintFeature& feature) {
  const OGRwkbGeometryType type = wkbFlatten(OGR_G_GetGeometryType(g));
  if (OGR_GT_IsNonLinear(type)) {
    const Geometry linear(OGR_G_GetLinearGeometry(g, 0, nullptr));
    if (linear) add_polygons(linear.get(), swapped, feature);
    return;
  }
  const int parts = OGR_G_GetGeometryCount(g);
  if (type == wkbMultiPolygon || type == wkbGeometryCollection) {
    for (int k = 0; k < parts; ++k) add_polygons(OGR_G_GetGeometryRef(g, k), swapped, feature);
    return;
  }
  if (type != wkbPolygon && type != wkbTriangle) {
    feature.has_other_geometry = true;
    return;
  }
  Rings rings;
  for (int k = 0; k < parts; ++k) {
    const OGRGeometryH ring = OGR_G_GetGeometryRef(g, k);
    const bool heights = OGR_G_Is3D(ring) != 0;
    auto& points = rings.emplace_back();
    for (int p = 0; p < OGR_G_GetPointCount(ring); ++p) {
      const double x = OGR_G_GetX(ring, p), y = OGR_G_GetY(ring, p);
      const Vec2 at = swapped ? Vec2(y, x) : Vec2(x, y);
      if (points.empty() || points.back() != at) points.push_back(at);
      if (heights && OGR_G_GetZ(ring, p) != 0) feature.has_heights = true;
    }
    while (points.size() > 1 && points.front() == points.back()) points.pop_back();
  }
  if (!rings.empty() && !rings[0].empty()) feature.polygons.push_back(std::move(rings));
}

struct Field {
  int index;
  std::string name;  // in lower case
  bool wanted, packed;
};

std::string text_of(OGRFeatureH feature, int index) {
  const OGRFieldDefnH field = OGR_F_GetFieldDefnRef(feature, index);
  if (OGR_Fld_GetSubType(field) == OFSTBoolean) {
    return OGR_F_GetFieldAsInteger(feature, index) ? "true" : "false";
  }
  // Without the rounding of OGR's own text.
  if (OGR_Fld_GetType(field) == OFTReal) {
    return fmt::format("{}", OGR_F_GetFieldAsDouble(feature, index));
  }
  return OGR_F_GetFieldAsString(feature, index);
}

void add_attributes(OGRFeatureH source, const std::vector<Field>& fields,
                    const std::vector<std::string>& wanted, std::set<std::string>& packed_names,
                    FootprintFeature& feature) {
  const auto add = [&](const std::string& name, std::string value) {
    const bool known = std::any_of(feature.attributes.begin(), feature.attributes.end(),
                                   [&](const auto& a) { return a.first == name; });
    if (!known) feature.attributes.emplace_back(name, std::move(value));
  };
  for (const bool packed : {false, true}) {
    for (const Field& f : fields) {
      if (!(packed ? f.packed : f.wanted) || !OGR_F_IsFieldSetAndNotNull(source, f.index)) continue;
      std::string value = text_of(source, f.index);
      if (!packed) {
        add(f.name, std::move(value));
        continue;
      }
      for (auto& [name, text] : parse_tags(value).value_or(Tags{})) {
        const std::string lower = lower_case(name);
        packed_names.insert(name);
        if (std::binary_search(wanted.begin(), wanted.end(), lower)) add(lower, std::move(text));
      }
    }
  }
}

void name_feature(FootprintFeature& feature) {
  for (const char* name : kIds) {
    for (const auto& [attribute, value] : feature.attributes) {
      if (attribute != name || value.empty()) continue;
      feature.id = value;
      return;
    }
  }
}

}  // namespace

std::string listed(const std::vector<std::string>& names, std::size_t most) {
  std::string out;
  for (std::size_t k = 0; k < std::min(most, names.size()); ++k) {
    out += (out.empty() ? "" : ", ") + printable(names[k], 200);
  }
  if (names.size() > most) out += fmt::format(", ... ({} more)", names.size() - most);
  return out;
}

Result<std::string> crs_of_footprint_file(const std::filesystem::path& path,
                                          const std::string& layer) {
  GdalErrors errors;
  const auto dataset = open(path, errors);
  if (!dataset) return dataset.error();
  const auto chosen = choose_layer(dataset.value().get(), path.string(), layer);
  if (!chosen) return chosen.error();
  return crs_of(chosen.value()).name;
}

Result<FootprintFile> read_footprint_file(const std::filesystem::path& path,
                                          const std::string& layer_name,
                                          const std::vector<std::string>& wanted_names) {
  GdalErrors errors;
  std::vector<std::string> wanted = wanted_names;
  wanted.insert(wanted.end(), kIds.begin(), kIds.end());
  std::sort(wanted.begin(), wanted.end());

  auto opened = open(path, errors);
  if (!opened) return opened.error();
  // GDAL takes true for the number 1 where other features have numbers, and these for lists where
  // another feature has one.
  std::string text;
  std::optional<FileInMemory> in_memory;
  Dataset dataset = std::move(opened).value();
  if (driver_of(dataset.get()).starts_with("GeoJSON")) {
    const auto whole = read_text(path);
    if (whole) text = odd_values_as_text(whole.value(), wanted);
    if (!text.empty()) {
      in_memory.emplace(text, path.filename().string());
      dataset = open_with_drivers(in_memory->name());
    }
    if (!dataset) return cannot_open(path, errors);
  }
  auto chosen = choose_layer(dataset.get(), path.string(), layer_name);
  if (!chosen) return chosen.error();
  const OGRLayerH layer = chosen.value();

  FootprintFile file;
  const std::string driver = driver_of(dataset.get());
  for (const Driver& d : kDrivers) {
    if (driver == d.name) file.format = d.format;
  }
  file.layer = OGR_L_GetName(layer);
  file.several_layers = GDALDatasetGetLayerCount(dataset.get()) > 1;
  const LayerCrs crs = crs_of(layer);
  file.crs = crs.name;
  file.metres_per_unit = crs.metres_per_unit;

  std::vector<Field> fields;
  const OGRFeatureDefnH definition = OGR_L_GetLayerDefn(layer);
  for (int k = 0; k < OGR_FD_GetFieldCount(definition); ++k) {
    file.attributes.emplace_back(OGR_Fld_GetNameRef(OGR_FD_GetFieldDefn(definition, k)));
    Field f{k, lower_case(file.attributes.back()), false, false};
    f.wanted = std::binary_search(wanted.begin(), wanted.end(), f.name);
    f.packed = f.name == "tags" || f.name == "other_tags" || f.name == "all_tags";
    fields.push_back(std::move(f));
  }

  std::set<std::string> packed_names;
  std::vector<GIntBig> fids;
  OGR_L_ResetReading(layer);
  while (const Feature source{OGR_L_GetNextFeature(layer)}) {
    if (errors.first()) break;
    FootprintFeature& feature = file.features.emplace_back();
    feature.number = file.features.size();
    fids.push_back(OGR_F_GetFID(source.get()));
    add_attributes(source.get(), fields, wanted, packed_names, feature);
    name_feature(feature);
    const OGRGeometryH geometry = OGR_F_GetGeometryRef(source.get());
    feature.has_geometry = geometry && !OGR_G_IsEmpty(geometry);
    if (feature.has_geometry) add_polygons(geometry, crs.swapped, feature);
  }
  if (errors.first()) {
    std::string where = fmt::format("it cannot be read beyond feature {}", file.features.size());
    if (file.features.empty()) {  // GDAL reads all of GeoJSON at once
      const auto whole = read_text(path);
      where = whole ? first_bad_feature(whole.value()) : "";
      where = (where.empty() ? "one of its features" : where) + " cannot be read";
    }
    return Error{fmt::format("{}: layer {}: {} ({}); repair it, or check that the file is whole.",
                             path.string(), in_quotes(file.layer), where, reason_of(errors))};
  }
  // GDAL numbers features where the file does not.
  bool numbered = true;
  for (std::size_t k = 0; k < fids.size(); ++k) {
    const auto ordinal = static_cast<GIntBig>(k);
    numbered = numbered && fids[k] == fids[0] + ordinal && fids[0] >= 0 && fids[0] <= 1;
  }
  if (!numbered) {
    for (std::size_t k = 0; k < fids.size(); ++k) {
      if (file.features[k].id.empty()) file.features[k].id = std::to_string(fids[k]);
    }
  }
  file.attributes.insert(file.attributes.end(), packed_names.begin(), packed_names.end());
  for (const std::string& what : errors.warnings()) {
    warn(file.warnings, "GDAL was not content with a file.",
         fmt::format("{}: {}", path.string(), printable(what, kMostOfGdal)));
  }
  return file;
}

}  // namespace gnomon
