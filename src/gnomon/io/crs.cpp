// Based on: PROJ 9 (ISO 19111 objects and operations); the convergence by central differences, see
// kMeridianStep.
#include <gnomon/io/crs.h>

#include <proj.h>

#include <cmath>
#include <memory>
#include <optional>
#include <regex>

#include <fmt/format.h>

namespace gnomon {
namespace {

// Half the length of the piece of meridian whose direction in the grid is taken, in radians of
// latitude (640 m). The chord's direction differs from the tangent's by step^2/6 times the third
// derivative of the projected meridian relative to the first, which is below 0.1 within any grid
// that maps are made in: below 2e-10 rad. PROJ's own rounding, under 1e-8 m, turns the chord of
// 1280 m by under 1e-11 rad. Both stay well within 1e-9 rad.
constexpr double kMeridianStep = 1e-4;

// A point may lie this far (degrees) outside the CRS's area of use: projects cross borders, but a
// point farther out means nearly always that the wrong CRS was named.
constexpr double kReach = 1.0;

// A point whose way to WGS 84 and back misses it by more (metres) is outside of what the
// projection's formulas can invert.
constexpr double kRoundTrip = 0.01;

struct ContextDeleter {
  void operator()(PJ_CONTEXT* c) const { proj_context_destroy(c); }
};
struct PjDeleter {
  void operator()(PJ* p) const { proj_destroy(p); }
};
struct ListDeleter {
  void operator()(PJ_OBJ_LIST* l) const { proj_list_destroy(l); }
};
struct FactoryDeleter {
  void operator()(PJ_OPERATION_FACTORY_CONTEXT* f) const {
    proj_operation_factory_context_destroy(f);
  }
};
using ContextPtr = std::unique_ptr<PJ_CONTEXT, ContextDeleter>;
using PjPtr = std::unique_ptr<PJ, PjDeleter>;

bool is_geographic(PJ_TYPE type) {
  return type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS;
}

// A bound CRS ("+towgs84") wraps the CRS whose axes count.
PjPtr unbound(PJ_CONTEXT* context, const PJ* crs) {
  PjPtr p(proj_clone(context, crs));
  while (p && proj_get_type(p.get()) == PJ_TYPE_BOUND_CRS) {
    p.reset(proj_get_source_crs(context, p.get()));
  }
  return p;
}

// One fixed operation from `crs` to `target`, axis order east, north; the one PROJ suggests for
// `p`. Fixed, because with PROJ's usual choice per point two neighbouring points may go through
// different datum shifts, metres apart, which would ruin the direction.
PjPtr operation_at(PJ_CONTEXT* context, const PJ* crs, const PJ* target, const Vec2& p) {
  std::unique_ptr<PJ_OPERATION_FACTORY_CONTEXT, FactoryDeleter> factory(
      proj_create_operation_factory_context(context, nullptr));
  if (!factory) return nullptr;
  proj_operation_factory_context_set_spatial_criterion(context, factory.get(),
                                                       PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
  proj_operation_factory_context_set_grid_availability_use(
      context, factory.get(), PROJ_GRID_AVAILABILITY_DISCARD_OPERATION_IF_MISSING_GRID);
  std::unique_ptr<PJ_OBJ_LIST, ListDeleter> operations(
      proj_create_operations(context, crs, target, factory.get()));
  if (!operations || proj_list_get_count(operations.get()) == 0) return nullptr;
  // PROJ asks for the point in the axis order of the CRS (some have northing first).
  PjPtr bare = unbound(context, crs);
  PjPtr axes(bare ? proj_crs_get_coordinate_system(context, bare.get()) : nullptr);
  const char* axis_direction = nullptr;
  PJ_COORD at = proj_coord(p.x, p.y, 0, 0);
  if (axes && proj_cs_get_axis_info(context, axes.get(), 0, nullptr, nullptr, &axis_direction,
                                    nullptr, nullptr, nullptr, nullptr)) {
    if (std::string(axis_direction) == "north") at = proj_coord(p.y, p.x, 0, 0);
  }
  int index = proj_get_suggested_operation(context, operations.get(), PJ_FWD, at);
  if (index < 0) index = 0;
  PjPtr operation(proj_list_get(context, operations.get(), index));
  if (!operation) return nullptr;
  return PjPtr(proj_normalize_for_visualization(context, operation.get()));
}

std::optional<Vec2> transform(PJ* operation, PJ_DIRECTION way, const Vec2& p) {
  proj_errno_reset(operation);
  const PJ_COORD q = proj_trans(operation, way, proj_coord(p.x, p.y, 0, 0));
  if (proj_errno(operation) != 0 || !std::isfinite(q.xy.x) || !std::isfinite(q.xy.y)) return {};
  return Vec2{q.xy.x, q.xy.y};
}

// Longitude and latitude in degrees, to be read: "48.2082 N 16.3738 E".
std::string readable(const Vec2& lonlat) {
  return fmt::format("{:.4f} {} {:.4f} {}", std::abs(lonlat.y), lonlat.y < 0 ? 'S' : 'N',
                     std::abs(lonlat.x), lonlat.x < 0 ? 'W' : 'E');
}

Error outside(const std::string& shown, const Vec3& p, const std::string& why) {
  return {
      fmt::format("the point ({:.3f}, {:.3f}) does not fit the CRS {}: {}; name the CRS of the "
                  "coordinates with --crs, or --site LAT,LON for local coordinates",
                  p.x, p.y, shown, why)};
}

ContextPtr quiet_context() {
  ContextPtr context(proj_context_create());
  proj_log_level(context.get(), PJ_LOG_NONE);
  proj_context_set_enable_network(context.get(), 0);
  return context;
}

// For messages.
std::string shown_crs(const std::string& crs) {
  const std::string text = short_crs(crs);
  return text.size() > 60 ? "'" + text.substr(0, 57) + "...'" : "'" + text + "'";
}

Result<PjPtr> parse_crs(PJ_CONTEXT* context, const std::string& crs) {
  std::string definition = short_crs(crs);
  // The same but for the order of its axes, which is normalized anyway. PROJ lists other datum
  // shifts to the one than to the other (13 mm apart in Vienna); pieces of a scene need the same.
  if (definition == "OGC:CRS84") definition = "EPSG:4326";
  // A PROJ string is an operation unless it says that it is a CRS.
  if (definition.find("+proj=") != std::string::npos &&
      definition.find("+type=crs") == std::string::npos) {
    definition += " +type=crs";
  }
  PjPtr whole(definition.empty() ? nullptr : proj_create(context, definition.c_str()));
  if (whole && proj_is_crs(whole.get())) return whole;
  if (!proj_context_get_database_path(context)) {
    return Error{"PROJ's database proj.db is not found, so CRS " + shown_crs(crs) +
                 " cannot be looked up; install the package proj-data or set PROJ_DATA"};
  }
  return Error{"unknown CRS " + shown_crs(crs) +
               "; give a code such as EPSG:31256, an OGC URN or URL, or WKT"};
}

// Of a compound CRS, its horizontal part; else the CRS itself. Null where there is none.
PjPtr horizontal_part(PJ_CONTEXT* context, PjPtr crs) {
  while (crs && proj_get_type(crs.get()) == PJ_TYPE_COMPOUND_CRS) {
    crs.reset(proj_crs_get_sub_crs(context, crs.get(), 0));
  }
  return crs;
}

}  // namespace

Result<CrsPlace> locate(const std::string& crs, const Vec3& p) {
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
    return Error{"the point to locate is not finite; check the model's coordinates"};
  }
  const ContextPtr context = quiet_context();
  auto parsed = parse_crs(context.get(), crs);
  if (!parsed) return parsed.error();
  PjPtr whole = std::move(parsed).value();
  const std::string shown = shown_crs(crs);
  const char* own_name = proj_get_name(whole.get());
  std::string name = own_name ? own_name : "";

  const PjPtr horizontal = horizontal_part(context.get(), std::move(whole));
  if (!horizontal) return Error{"the compound CRS " + shown + " has no horizontal part"};
  const PjPtr bare = unbound(context.get(), horizontal.get());
  const PJ_TYPE type = bare ? proj_get_type(bare.get()) : PJ_TYPE_UNKNOWN;
  if (is_geographic(type)) {
    return Error{"CRS " + shown + " (" + name +
                 ") is geographic: its coordinates are degrees, which cannot be a scene; reproject "
                 "the model to a projected CRS in metres (for example with 'ogr2ogr -t_srs' or "
                 "cjio's 'reproject'), such as the UTM zone of the place"};
  }
  if (type != PJ_TYPE_PROJECTED_CRS) {
    return Error{
        "CRS " + shown + " (" + name +
        ") is not a projected CRS, so it does not say where on Earth the model stands; use a "
        "projected CRS, or --site LAT,LON for local coordinates"};
  }

  CrsPlace result{};
  result.name = name;
  const PjPtr axes(proj_crs_get_coordinate_system(context.get(), bare.get()));
  double unit = 1;
  if (!axes || !proj_cs_get_axis_info(context.get(), axes.get(), 0, nullptr, nullptr, nullptr,
                                      &unit, nullptr, nullptr, nullptr)) {
    return Error{"CRS " + shown + " (" + name + ") does not say the unit of its axes"};
  }
  result.metres_per_unit = unit;

  const PjPtr wgs84(proj_create(context.get(), "EPSG:4326"));
  if (!wgs84) return Error{"PROJ does not know WGS 84: its database proj.db is broken"};
  const PjPtr operation = operation_at(context.get(), horizontal.get(), wgs84.get(), {p.x, p.y});
  if (!operation) {
    return Error{"PROJ knows no way from CRS " + shown + " (" + name +
                 ") to WGS 84; use another CRS, or --site LAT,LON and --north"};
  }
  const Vec2 grid{p.x, p.y};
  const std::optional<Vec2> lonlat = transform(operation.get(), PJ_FWD, grid);
  if (!lonlat) return outside(shown, p, "it has no latitude and longitude there");
  const std::optional<Vec2> back = transform(operation.get(), PJ_INV, *lonlat);
  if (!back || std::hypot(back->x - grid.x, back->y - grid.y) * unit > kRoundTrip) {
    return outside(shown, p, "it is beyond the reach of the projection");
  }
  double west, south, east, north;
  const char* area = nullptr;
  if (proj_get_area_of_use(context.get(), bare.get(), &west, &south, &east, &north, &area) &&
      west > -1000) {
    // The area may cross the antimeridian (west > east), and longitudes are known only up to whole
    // turns.
    const double width = east >= west ? east - west : east - west + 360;
    const double beyond = std::remainder(lonlat->x - (west + width / 2), 360.0);
    if (std::abs(beyond) > width / 2 + kReach || lonlat->y < south - kReach ||
        lonlat->y > north + kReach) {
      return outside(shown, p,
                     fmt::format("it would lie at {}, far outside of what this CRS is for ({}; "
                                 "latitude {:.2f} to {:.2f}, longitude {:.2f} to {:.2f})",
                                 readable(*lonlat), area ? area : "its area of use", south, north,
                                 west, east));
    }
  }
  const double step = kMeridianStep / kDegree;
  if (std::abs(lonlat->y) + step >= 90) {
    return outside(shown, p, "it is at a pole, where no direction is north");
  }
  const std::optional<Vec2> up = transform(operation.get(), PJ_INV, {lonlat->x, lonlat->y + step});
  const std::optional<Vec2> down =
      transform(operation.get(), PJ_INV, {lonlat->x, lonlat->y - step});
  if (!up || !down) return outside(shown, p, "it is at the edge of the projection's reach");

  result.place = {lonlat->y * kDegree, lonlat->x * kDegree, p.z};
  result.true_north = std::atan2(up->x - down->x, up->y - down->y);
  return result;
}

std::string short_crs(const std::string& crs) {
  // std::regex goes as deep into the stack as a text is long; what is longer than this is WKT.
  constexpr std::size_t kLongestForm = 200;
  if (crs.size() > kLongestForm) return crs;
  static const std::regex forms(
      R"(\s*(?:https?://www\.opengis\.net/def/crs/epsg/[^/]*/|urn:(?:x-)?ogc:def:crs:epsg:[^:]*:|epsg:)(\d+)/?\s*)",
      std::regex::icase);
  std::smatch match;
  if (std::regex_match(crs, match, forms)) return "EPSG:" + match[1].str();
  return crs;
}

std::string crs_in_words(const std::string& crs) {
  const std::size_t bracket = crs.find_first_of("[(");  // WKT: PROJCRS["name",...
  if (bracket == std::string::npos || crs.compare(bracket + 1, 1, "\"") != 0) {
    return short_crs(crs);
  }
  const std::size_t end = crs.find('"', bracket + 2);
  return end == std::string::npos ? crs : crs.substr(bracket + 1, end - bracket);
}

bool is_geographic_crs(const std::string& crs) {
  const ContextPtr context = quiet_context();
  auto parsed = parse_crs(context.get(), crs);
  if (!parsed) return false;
  const PjPtr horizontal = horizontal_part(context.get(), std::move(parsed).value());
  const PjPtr bare = horizontal ? unbound(context.get(), horizontal.get()) : nullptr;
  return bare && is_geographic(proj_get_type(bare.get()));
}

std::string utm_crs(const Place& place) {
  const double latitude = place.latitude / kDegree, longitude = place.longitude / kDegree;
  if (latitude > 84) return "EPSG:32661";
  if (latitude < -80) return "EPSG:32761";
  const double turn = longitude - 360 * std::floor((longitude + 180) / 360) + 180;  // [0, 360)
  const int zone = static_cast<int>(turn / 6) % 60 + 1;
  return fmt::format("EPSG:{}", (latitude < 0 ? 32700 : 32600) + zone);
}

Result<std::vector<Vec2>> reproject(const std::string& from, const std::string& to,
                                    std::vector<Vec2> points) {
  const ContextPtr context = quiet_context();
  auto source = parse_crs(context.get(), from), target = parse_crs(context.get(), to);
  if (!source) return source.error();
  if (!target) return target.error();
  if (points.empty()) return points;
  const PjPtr a = horizontal_part(context.get(), std::move(source).value());
  const PjPtr b = horizontal_part(context.get(), std::move(target).value());
  const PjPtr operation =
      a && b ? operation_at(context.get(), a.get(), b.get(), points[0]) : nullptr;
  if (!operation) {
    return Error{"PROJ knows no way from CRS " + shown_crs(from) + " to " + shown_crs(to) +
                 "; reproject the data beforehand"};
  }
  for (Vec2& p : points) {
    const std::optional<Vec2> moved = transform(operation.get(), PJ_FWD, p);
    if (!moved) {
      return Error{
          fmt::format("the point ({:.9g}, {:.9g}) of CRS {} has no place in {}; check the CRS", p.x,
                      p.y, shown_crs(from), shown_crs(to))};
    }
    p = *moved;
  }
  return points;
}

}  // namespace gnomon
