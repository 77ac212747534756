#include <fmt/format.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/ifc_map.h>
#include <gnomon/io/ifc_units.h>
#include <gnomon/io/read_text.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <regex>
#include <vector>

namespace gnomon {
namespace {

using Kind = StepValue::Kind;

// Map projections for building change lengths by less (UTM: 0.04 %, at 6 km above the sea 0.1 %);
// what is further from 1 is a unit or a mistake.
constexpr double kMapScale = 0.01;

// As written: lengths in `unit`, or not said.
struct Written {
  std::optional<double> eastings, northings, height, abscissa, ordinate, scale;
  std::optional<double> unit;  // metres
  std::string crs;
};

std::optional<double> finite(const std::string& text) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

// 12., IFCLENGTHMEASURE(12.), IFCLABEL('12.0').
std::optional<double> number(const StepValue& v) {
  if (v.kind == Kind::kNumber) return v.number;
  if (v.kind == Kind::kString) return finite(v.text);
  if (v.kind == Kind::kTyped && v.items.size() == 1) return number(v.items[0]);
  return std::nullopt;
}

std::string text(const StepValue& v) {
  if (v.kind == Kind::kString) return v.text;
  if (v.kind == Kind::kEnumeration) return v.text;
  if (v.kind == Kind::kTyped && v.items.size() == 1) return text(v.items[0]);
  return {};
}

std::string id_of(const StepFile& file, const StepInstance& i) {
  return fmt::format("{}#{}", where(file, i), i.id);
}

// IfcProjectedCRS(Name, Description, GeodeticDatum, VerticalDatum, MapProjection, MapZone, MapUnit)
void read_crs(const StepFile& file, const StepInstance& crs, Written& out, Warnings& warnings) {
  const auto a = arguments_of(crs);
  if (!a.empty()) out.crs = text(a[0]);
  if (out.crs == "WKT" && a.size() > 1) out.crs = text(a[1]);
  if (a.size() < 7 || a[6].kind != Kind::kReference) return;
  const auto unit = ifc_length_unit(file, a[6].reference);
  if (unit) out.unit = unit->metres;
  if (!unit) {
    warn(warnings, "The map unit cannot be read; the project's length unit was taken.",
         id_of(file, crs));
  }
}

// IfcMapConversion(SourceCRS, TargetCRS, Eastings, Northings, OrthogonalHeight, XAxisAbscissa,
// XAxisOrdinate, Scale)
std::optional<Written> from_entity(const StepFile& file, std::uint64_t context,
                                   Warnings& warnings) {
  const StepInstance* best = nullptr;
  std::size_t count = 0;
  for (const StepInstance& i : file.instances) {
    if (same_keyword(i.keyword, "IFCRIGIDOPERATION")) {
      warn(warnings, "IfcRigidOperation is not read; use IfcMapConversion.", id_of(file, i));
    }
    if (!same_keyword(i.keyword, "IFCMAPCONVERSION") &&
        !same_keyword(i.keyword, "IFCMAPCONVERSIONSCALED")) {
      continue;
    }
    const auto a = arguments_of(i);
    if (a.size() < 5) {
      warn(warnings, "A map conversion has too few attributes and was not used.", id_of(file, i));
      continue;
    }
    ++count;
    if (!best || a[0].reference == context) best = &i;
  }
  if (!best) return std::nullopt;
  if (count > 1) {
    warn(warnings, "There are several map conversions; that of the model's context was taken.",
         id_of(file, *best));
  }
  const auto a = arguments_of(*best);
  const auto at = [&](std::size_t k) { return k < a.size() ? number(a[k]) : std::nullopt; };
  Written out{at(2), at(3), at(4), at(5), at(6), at(7), {}, {}};
  const StepInstance* crs = find(file, a[1].reference);
  if (crs && same_keyword(crs->keyword, "IFCPROJECTEDCRS")) read_crs(file, *crs, out, warnings);
  return out;
}

// The property set with this name; null where there is none.
const StepInstance* property_set(const StepFile& file, std::string_view name, Warnings& warnings) {
  const StepInstance* found = nullptr;
  for (const StepInstance& i : file.instances) {
    if (!same_keyword(i.keyword, "IFCPROPERTYSET")) continue;
    const auto a = arguments_of(i);
    if (a.size() < 5 || !same_keyword(text(a[2]), name)) continue;  // ePset_..., EPset_... as well
    if (found) {
      warn(warnings, "A property set for the map is there several times; the first was taken.",
           id_of(file, i));
    } else {
      found = &i;
    }
  }
  return found;
}

// Calls use(name, value, unit) for each IfcPropertySingleValue(Name, Description, NominalValue,
// Unit) that has a value.
template <class Use>
void each_property(const StepFile& file, const StepInstance& set, Use use) {
  const auto arguments = arguments_of(set);  // by name: a loop does not keep what it is a part of
  for (const StepValue& reference : arguments[4].items) {
    const StepInstance* property = find(file, reference.reference);
    if (!property || !same_keyword(property->keyword, "IFCPROPERTYSINGLEVALUE")) continue;
    const auto a = arguments_of(*property);
    if (a.size() < 3 || a[2].kind == Kind::kNull) continue;
    const bool unit = a.size() > 3 && a[3].kind == Kind::kReference;
    use(*property, text(a[0]), a[2], unit ? ifc_length_unit(file, a[3].reference) : std::nullopt);
  }
}

std::optional<Written> from_property_sets(const StepFile& file, Warnings& warnings) {
  const StepInstance* conversion = property_set(file, "ePSet_MapConversion", warnings);
  if (!conversion) return std::nullopt;
  Written out;
  std::optional<double> own_unit;
  each_property(
      file, *conversion,
      [&](const StepInstance& property, const std::string& name, const StepValue& value,
          std::optional<IfcLengthUnit> unit) {
        std::optional<double>* target = same_keyword(name, "Eastings")           ? &out.eastings
                                        : same_keyword(name, "Northings")        ? &out.northings
                                        : same_keyword(name, "OrthogonalHeight") ? &out.height
                                        : same_keyword(name, "XAxisAbscissa")    ? &out.abscissa
                                        : same_keyword(name, "XAxisOrdinate")    ? &out.ordinate
                                        : same_keyword(name, "Scale")            ? &out.scale
                                                                                 : nullptr;
        if (!target) {
          if (same_keyword(name, "TargetCRS")) out.crs = text(value);
          return;
        }
        *target = number(value);
        if (!*target)
          warn(warnings, "A number of the map conversion cannot be read.", id_of(file, property));
        if (unit) own_unit = unit->metres;
      });
  if (const StepInstance* crs = property_set(file, "ePSet_ProjectedCRS", warnings)) {
    std::string description;
    each_property(file, *crs,
                  [&](const StepInstance& property, const std::string& name, const StepValue& value,
                      std::optional<IfcLengthUnit>) {
                    if (same_keyword(name, "Name")) out.crs = text(value);
                    if (same_keyword(name, "Description")) description = text(value);
                    if (!same_keyword(name, "MapUnit")) return;
                    out.unit = ifc_length_unit_named(text(value));
                    if (!out.unit) {
                      warn(warnings,
                           "The map unit cannot be read; the project's length unit was taken.",
                           id_of(file, property));
                    }
                  });
    if (out.crs == "WKT") out.crs = description;
  }
  if (own_unit) out.unit = own_unit;
  return out;
}

bool near_one(double scale) { return std::abs(scale - 1) <= kMapScale; }

// Map metres per local metre. As written it also turns the project's unit into the map's.
double map_scale(double written, double map_unit, double project_unit, Warnings& warnings) {
  const double whole = written * map_unit / project_unit;
  if (near_one(whole)) return whole;
  if (near_one(written)) {
    warn(warnings,
         "The map conversion's Scale does not turn the project's length unit into that of the map, "
         "as IFC asks; it was taken for the map's scale alone.",
         fmt::format("Scale {:g}", written));
    return written;
  }
  warn(warnings,
       "The map conversion's Scale would change the model's size; it was not used, the model keeps "
       "the size that its length unit gives.",
       fmt::format("Scale {:g}", written));
  return 1;
}

}  // namespace

std::string ifc_crs(std::string_view name) {
  // std::regex goes as deep into the stack as a text is long.
  constexpr std::size_t kLongestCode = 64;
  static const std::regex code(R"(\s*(?:epsg[\s:_-]*)?(\d{4,6})\s*)", std::regex::icase);
  const std::string own(name);
  std::smatch match;
  if (own.size() <= kLongestCode && std::regex_match(own, match, code))
    return "EPSG:" + match[1].str();
  return short_crs(own);
}

std::optional<IfcMapConversion> ifc_map_conversion(const StepFile& file, std::uint64_t context,
                                                   double project_unit, Warnings& warnings) {
  auto written = from_entity(file, context, warnings);
  if (!written) written = from_property_sets(file, warnings);
  if (!written) return std::nullopt;
  if (!written->eastings || !written->northings) {
    warn(warnings, "The map conversion has no eastings or northings and was not used.", file.path);
    return std::nullopt;
  }

  IfcMapConversion out;
  out.crs = ifc_crs(written->crs);
  if (written->crs.empty()) {
    warn(warnings, "The map conversion does not name its CRS; name it with --crs.", file.path);
  } else if (const auto known = reproject(out.crs, out.crs, {}); !known) {
    warn(warnings, "The CRS of the map conversion is not known to PROJ; name it with --crs.",
         in_quotes(written->crs));
    out.crs.clear();
  }

  double unit = written->unit.value_or(project_unit);
  const auto fits = [&](double metres) {
    const auto at = locate(out.crs, {*written->eastings * metres, *written->northings * metres, 0});
    return static_cast<bool>(at);
  };
  if (!out.crs.empty() && !fits(unit)) {
    // Files in millimetres often have the map's metres without saying so, and the other way round.
    for (const double other : {1.0, project_unit}) {
      if (other == unit || !fits(other)) continue;
      warn(warnings,
           "The map conversion lies outside of its CRS in the unit that it should have; another "
           "unit was taken.",
           fmt::format("1 is {:g} m instead of {:g} m", other, unit));
      unit = other;
      break;
    }
  }
  out.eastings = *written->eastings * unit;
  out.northings = *written->northings * unit;
  out.height = written->height.value_or(0) * unit;
  if (!std::isfinite(out.eastings) || !std::isfinite(out.northings) || !std::isfinite(out.height)) {
    warn(warnings, "The map conversion moves the model beyond all numbers and was not used.",
         file.path);
    return std::nullopt;
  }
  out.scale = map_scale(written->scale.value_or(1), unit, project_unit, warnings);

  const double x = written->abscissa.value_or(written->ordinate ? 0 : 1);
  const double y = written->ordinate.value_or(0);
  const double length = std::hypot(x, y);
  if (length > 0 && std::isfinite(length)) {
    out.x_axis_abscissa = x / length;
    out.x_axis_ordinate = y / length;
  } else {
    warn(warnings, "The map conversion's x axis has no direction; the model was not turned.",
         file.path);
  }
  return out;
}

}  // namespace gnomon
