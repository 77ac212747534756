// Based on: OpenStreetMap wiki, "Simple 3D Buildings" (height, min_height, building:levels,
// building:min_level, roof:levels, roof:height).
#include <gnomon/io/footprint_heights.h>

#include <fmt/format.h>

#include <initializer_list>

#include <gnomon/core/lower_case.h>
#include <gnomon/io/osm_tags.h>
#include <gnomon/io/read_text.h>

namespace gnomon {
namespace {

using Names = std::vector<std::string>;

// Metres above the ground. Names that are cut after 10 letters are those of Shapefiles.
const Names kHeight = {"height",          "building:height",
                       "building_height", "buildingheight",
                       "building_h",      "building:h",
                       "bldg_height",     "bldg_hgt",
                       "bldgheight",      "measuredheight",
                       "measuredhe",      "render_height",
                       "height_m",        "hgt",
                       "relhmax",         "bouwhoogte",
                       "gebouwhoogte",    "hoogte",
                       "hoehe",           "h\u00f6he",
                       "gebaeudehoehe",   "hauteur",
                       "altura",          "altezza"};
const Names kFloors = {
    "building:levels", "building_levels", "building_l",      "building:l",         "levels",
    "floors",          "num_floors",      "numfloors",       "n_floors",           "no_floors",
    "floor",           "storeys",         "stories",         "storeysaboveground", "storeysabo",
    "bouwlagen",       "geschosse",       "nombre_d_etages", "nb_etages",          "plantas"};
// Absolute heights of the footprint. Not "base_height": to some that is above the ground.
const Names kBase = {"base_elevation", "ground_elevation",
                     "elevation_base", "elevation_ground",
                     "base_z",         "z_base",
                     "ground_z",       "z_ground",
                     "b3_h_maaiveld",  "altitude_minimale_sol",
                     "z_min_sol",      "abshmin"};
const Names kMinHeight = {"min_height", "building:min_height", "render_min_height"};
const Names kMinLevel = {"building:min_level", "min_level"};
const Names kRoofHeight = {"roof:height", "roof_heigh"};
const Names kRoofLevels = {"roof:levels", "roof_level"};
const Names kRules = {"building", "building:part", "building_p", "location",
                      "layer",    "roof:shape",    "roof_shape"};

Names chosen(const std::string& name, const Names& usual) {
  return name.empty() ? usual : Names{lower_case(name)};
}

struct Found {
  std::string_view name, value;
};

std::optional<Found> first_of(const FootprintFeature& feature, const Names& names) {
  for (const std::string& name : names) {
    const std::string_view value = value_of(feature, name);
    if (!value.empty()) return Found{name, value};
  }
  return std::nullopt;
}

std::string is(const Found& found) {
  return fmt::format("{} is {}", found.name, in_quotes(found.value));
}

}  // namespace

std::string usual_height_attributes() { return listed(kHeight); }
std::string usual_floor_attributes() { return listed(kFloors); }
std::string usual_base_attributes() { return listed(kBase); }

FootprintAttributes::FootprintAttributes(const FootprintOptions& options)
    : height(chosen(options.height, kHeight)),
      floors(chosen(options.floors, kFloors)),
      base(chosen(options.base, kBase)) {}

std::vector<std::string> FootprintAttributes::all() const {
  Names out;
  for (const Names* names :
       {&height, &floors, &base, &kMinHeight, &kMinLevel, &kRoofHeight, &kRoofLevels, &kRules}) {
    out.insert(out.end(), names->begin(), names->end());
  }
  return out;
}

std::string_view value_of(const FootprintFeature& feature, std::string_view name) {
  for (const auto& [attribute, text] : feature.attributes) {
    if (attribute != name) continue;
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    if (begin == std::string::npos) return {};
    return std::string_view(text).substr(begin, text.find_last_not_of(" \t\r\n") + 1 - begin);
  }
  return {};
}

HeightAnswer heights_of(const FootprintFeature& feature, const FootprintAttributes& names,
                        double floor_height) {
  HeightAnswer answer;
  FootprintHeights h;
  // Each of these returns false, with the problem, where a value is there but cannot be read.
  const auto metres = [&](const Names& of, std::optional<double>& out) {
    const auto found = first_of(feature, of);
    if (found && !(out = parse_metres(found->value))) answer.problem = is(*found);
    return answer.problem.empty();
  };
  const auto storeys = [&](const Names& of, std::optional<double>& out) {
    const auto found = first_of(feature, of);
    if (found && !(out = parse_number(found->value))) answer.problem = is(*found);
    if (out) *out *= floor_height;
    return answer.problem.empty();
  };

  std::optional<double> to;
  if (!metres(names.height, to)) return answer;
  std::optional<Found> source = first_of(feature, names.height);
  if (!to) {
    if (!storeys(names.floors, to)) return answer;
    if (!to) return answer;
    source = first_of(feature, names.floors);
    // The height includes the roof; the number of storeys does not.
    std::optional<double> roof;
    if (!metres(kRoofHeight, roof)) return answer;
    if (!roof && !storeys(kRoofLevels, roof)) return answer;
    *to += roof.value_or(0);
  }
  std::optional<double> from;
  if (!metres(kMinHeight, from)) return answer;
  if (!from && !storeys(kMinLevel, from)) return answer;
  if (!metres(names.base, h.base)) return answer;

  h.to = *to;
  h.from = from.value_or(0);
  if (!(h.to > 0)) {
    answer.problem = is(*source);
  } else if (!(h.from >= 0 && h.from < h.to)) {
    answer.problem = fmt::format("it would reach from {} to {} m above the ground", h.from, h.to);
  } else {
    answer.heights = h;
  }
  return answer;
}

}  // namespace gnomon
