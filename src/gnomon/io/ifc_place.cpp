#include <fmt/format.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/ifc_check.h>
#include <gnomon/io/ifc_map.h>
#include <gnomon/io/ifc_place.h>
#include <gnomon/io/ifc_units.h>
#include <gnomon/io/read_text.h>

#include <cmath>

namespace gnomon {
namespace {

using Kind = StepValue::Kind;

// TrueNorth and a map that say the same may differ by rounding, or by taking grid north for true
// north (mostly below 3 degrees, but then the difference is what a user wants to hear).
constexpr double kSameNorth = 1.0 * kDegree;
// A site's whole seconds are 30 m; surveys give the town's middle at times.
constexpr double kSamePlace = 1000;       // metres
constexpr double kEarthRadius = 6371000;  // metres, mean

// The numbers of an IfcCartesianPoint or IfcDirection; missing ones are 0.
std::optional<Vec3> vector_at(const StepFile& file, const StepValue& reference) {
  const StepInstance* i =
      reference.kind == Kind::kReference ? find(file, reference.reference) : nullptr;
  if (!i) return std::nullopt;
  const auto a = arguments_of(*i);
  if (a.size() != 1 || a[0].items.empty() || a[0].items.size() > 3) return std::nullopt;
  Vec3 v(0, 0, 0);
  for (std::size_t k = 0; k < a[0].items.size(); ++k) {
    if (a[0].items[k].kind != Kind::kNumber) return std::nullopt;
    v[static_cast<int>(k)] = a[0].items[k].number;
  }
  return v;
}

// The project's context for the model: (Identifier, ContextType, Dimension, Precision,
// WorldCoordinateSystem, TrueNorth).
const StepInstance* model_context(const StepFile& file) {
  const StepInstance* project = ifc_project(file);
  const auto a = project ? arguments_of(*project) : std::vector<StepValue>();
  const StepInstance* first = nullptr;
  const auto better = [&](const StepInstance& i) {
    if (!same_keyword(i.keyword, "IFCGEOMETRICREPRESENTATIONCONTEXT")) return false;
    if (!first) first = &i;
    const auto own = arguments_of(i);
    return own.size() > 1 && same_keyword(own[1].text, "Model");
  };
  if (a.size() > 7) {
    for (const StepValue& reference : a[7].items) {
      const StepInstance* i = find(file, reference.reference);
      if (i && better(*i)) return i;
    }
  }
  if (first) return first;
  for (const StepInstance& i : file.instances) {
    if (better(i)) return &i;
  }
  return first;
}

// How far the WorldCoordinateSystem turns x and y, counter-clockwise; Assimp has applied it.
double world_rotation(const StepFile& file, const StepInstance& context, const StepValue& reference,
                      Warnings& warnings) {
  const StepInstance* world = find(file, reference.reference);
  const auto a = world ? arguments_of(*world) : std::vector<StepValue>();
  const bool three = world && same_keyword(world->keyword, "IFCAXIS2PLACEMENT3D") && a.size() >= 3;
  const bool two = world && same_keyword(world->keyword, "IFCAXIS2PLACEMENT2D") && a.size() >= 2;
  if (!three && !two) return 0;
  const Vec3 origin = vector_at(file, a[0]).value_or(Vec3(0, 0, 0));
  const Vec3 x = vector_at(file, a[three ? 2 : 1]).value_or(Vec3(1, 0, 0));
  const Vec3 z = (three ? vector_at(file, a[1]) : std::nullopt).value_or(Vec3(0, 0, 1));
  const double angle = std::atan2(x.y, x.x);
  const std::string element = fmt::format("{}#{}", where(file, context), context.id);
  if (z.x != 0 || z.y != 0 || z.z <= 0) {
    warn(warnings, "The WorldCoordinateSystem is tilted; the model may not stand upright.",
         element);
  }
  if (origin != Vec3(0, 0, 0) || angle != 0) {
    warn(warnings,
         "The WorldCoordinateSystem is not the origin; the model was moved by it, as IFC says, but "
         "programs differ: check where it stands.",
         element);
  }
  return angle;
}

std::optional<double> true_north(const StepFile& file, const StepInstance& context,
                                 Warnings& warnings) {
  const auto a = arguments_of(context);
  if (a.size() < 6) return std::nullopt;
  const double turned = world_rotation(file, context, a[4], warnings);
  if (a[5].kind != Kind::kReference) return std::nullopt;
  const auto north = vector_at(file, a[5]);
  const double length = north ? std::hypot(north->x, north->y) : 0;
  if (length == 0 || !std::isfinite(length)) {
    warn(warnings, "TrueNorth is no direction and was not used.",
         fmt::format("{}#{}", where(file, context), context.id));
    return std::nullopt;
  }
  return std::remainder(std::atan2(north->x, north->y) - turned, 2 * kPi);
}

// Radians of (degrees, minutes, seconds, millionths of seconds), which all have the same sign.
std::optional<double> compound_angle(const StepValue& list, double most_degrees,
                                     const std::string& element, Warnings& warnings) {
  if (list.kind != Kind::kList || list.items.size() < 3 || list.items.size() > 4) return {};
  double sum = 0, part = 1;
  bool negative = false, positive = false, first_negative = false;
  for (std::size_t k = 0; k < list.items.size(); ++k) {
    const StepValue& v = list.items[k];
    if (v.kind != Kind::kNumber || v.number != std::trunc(v.number)) return {};
    const double limit = k == 0 ? most_degrees + 1 : k < 3 ? 60 : 1e6;
    if (std::abs(v.number) >= limit) return {};
    if (v.number < 0 && !positive) first_negative = true;
    negative = negative || v.number < 0;
    positive = positive || v.number > 0;
    part /= k == 0 ? 1 : k < 3 ? 60 : 1e6;
    sum += std::abs(v.number) * part;
  }
  if (negative && positive) {
    warn(warnings,
         "The parts of a latitude or longitude have different signs; the first one's was taken.",
         element);
  }
  if (sum > most_degrees) return {};
  return (first_negative ? -sum : sum) * kDegree;
}

// Of the first IfcSite that has them: RefLatitude, RefLongitude, RefElevation.
std::optional<Place> site_place(const StepFile& file, double metres_per_unit, Warnings& warnings) {
  std::optional<Place> found;
  for (const StepInstance& i : file.instances) {
    if (!same_keyword(i.keyword, "IFCSITE")) continue;
    const auto a = arguments_of(i);
    if (a.size() < 11 || (a[9].kind == Kind::kNull && a[10].kind == Kind::kNull)) continue;
    const std::string element = fmt::format("{}#{}", where(file, i), i.id);
    const auto latitude = compound_angle(a[9], 90, element, warnings);
    const auto longitude = compound_angle(a[10], 180, element, warnings);
    if (!latitude || !longitude) {
      warn(warnings, "The site's latitude and longitude cannot be read.", element);
    } else if (*latitude == 0 && *longitude == 0) {
      warn(warnings, "The site's latitude and longitude are 0; they were taken as not given.",
           element);
    } else if (found) {
      warn(warnings, "There are several sites; the place of the first was taken.", element);
    } else {
      const bool given = a.size() > 11 && a[11].kind == Kind::kNumber;
      double height = given ? a[11].number * metres_per_unit : 0;
      if (!std::isfinite(height)) {
        warn(warnings, "The site's elevation is beyond all numbers; 0 was taken.", element);
        height = 0;
      }
      found = Place{*latitude, *longitude, height};
    }
  }
  return found;
}

double distance(const Place& a, const Place& b) {
  const double east = std::remainder(a.longitude - b.longitude, 2 * kPi) * std::cos(a.latitude);
  return kEarthRadius * std::hypot(east, a.latitude - b.latitude);
}

// Where the conversion and the other two say where the model stands, and do not agree.
void compare(const IfcPlace& place, Warnings& warnings) {
  const IfcMapConversion& c = *place.conversion;
  const double turned = std::atan2(c.x_axis_ordinate, c.x_axis_abscissa);
  const auto at = c.crs.empty() ? Result<CrsPlace>(Error{""})
                                : locate(c.crs, {c.eastings, c.northings, c.height});
  if (place.true_north) {
    const double from_map = turned + (at ? at.value().true_north : 0);
    const double differ = std::remainder(*place.true_north - from_map, 2 * kPi);
    if (std::abs(differ) > kSameNorth) {
      warn(warnings,
           "The map conversion and TrueNorth do not agree; the map conversion was used, TrueNorth "
           "not.",
           fmt::format("{:.2f} and {:.2f} degrees", std::remainder(from_map, 2 * kPi) / kDegree,
                       *place.true_north / kDegree));
    }
  }
  if (place.site && at && distance(*place.site, at.value().place) > kSamePlace) {
    warn(warnings,
         "The map conversion and the site's latitude and longitude do not agree; the map "
         "conversion was used.",
         fmt::format("{:.0f} km apart", distance(*place.site, at.value().place) / 1000));
  }
}

}  // namespace

Result<IfcPlace> read_ifc_place(std::string_view text, const std::string& path) {
  auto step = read_step(text, path);
  if (!step) return step.error();
  const StepFile file = std::move(step).value();
  if (auto error = check_ifc(file)) return *error;

  IfcPlace place;
  place.schema = ifc_schema(file);
  if (!place.schema.starts_with("IFC2X3")) {
    warn(place.warnings, "The file's schema is not IFC2x3; what IFC2x3 does not have was left out.",
         fmt::format("{}: {}", path, in_quotes(place.schema)));
  }
  if (const auto unit = ifc_project_unit(file)) {
    place.metres_per_unit = unit->metres;
    place.assimp_metres_per_unit = unit->si ? 1 : unit->metres;
  } else {
    warn(place.warnings, "The project has no length unit that can be read; metres were taken.",
         path);
  }
  const StepInstance* context = model_context(file);
  if (context) place.true_north = true_north(file, *context, place.warnings);
  place.site = site_place(file, place.metres_per_unit, place.warnings);
  place.conversion =
      ifc_map_conversion(file, context ? context->id : 0, place.metres_per_unit, place.warnings);
  if (place.conversion) compare(place, place.warnings);
  return place;
}

void place_ifc(Model& model, const IfcPlace& place) {
  append(model.warnings, place.warnings);
  model.scale *= place.assimp_metres_per_unit;
  model.translate *= place.assimp_metres_per_unit;
  if (!place.conversion) {
    model.site = place.site;
    model.north = place.true_north;
    return;
  }
  const IfcMapConversion& c = *place.conversion;
  turn_normals(model, -std::atan2(c.x_axis_ordinate, c.x_axis_abscissa));
  const double a = c.scale * c.x_axis_abscissa, o = c.scale * c.x_axis_ordinate;
  for (Vec3& v : model.vertices) {
    const Vec3 local = v * model.scale + model.translate;
    v = {a * local.x - o * local.y, o * local.x + a * local.y, c.scale * local.z};
  }
  model.scale = {1, 1, 1};
  model.translate = {c.eastings, c.northings, c.height};
  model.report.crs = c.crs;
  if (!c.crs.empty()) return;
  model.site = place.site;
  if (place.true_north) {
    const double turned = std::atan2(c.x_axis_ordinate, c.x_axis_abscissa);
    model.north = std::remainder(*place.true_north - turned, 2 * kPi);
  }
}

}  // namespace gnomon
