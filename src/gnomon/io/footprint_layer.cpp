#include <gnomon/io/footprint_layer.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <gnomon/core/lower_case.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/footprint_crs.h>
#include <gnomon/io/footprint_file.h>
#include <gnomon/io/footprint_heights.h>
#include <gnomon/io/footprint_shapes.h>
#include <gnomon/io/osm_tags.h>
#include <gnomon/io/read_text.h>

namespace gnomon {
namespace {

// Simple 3D Buildings wants the parts to cover their outline; drawn by hand, they do so but for
// some of its edge.
constexpr double kCovered = 0.9;

enum class Kind { kPlain, kOutline, kPart, kSkipped };

Kind kind_of(const FootprintFeature& f) {
  std::string_view part = value_of(f, "building:part");
  if (part.empty()) part = value_of(f, "building_p");  // in a Shapefile
  const std::string_view building = value_of(f, "building");
  if (!part.empty() && part != "no") return Kind::kPart;
  if (building == "no") return Kind::kSkipped;
  return building.empty() ? Kind::kPlain : Kind::kOutline;
}

bool is_underground(const FootprintFeature& f) {
  return value_of(f, "location") == "underground" ||
         parse_number(value_of(f, "layer")).value_or(0) < 0;
}

// One feature on its way to a solid.
struct Building {
  const FootprintFeature* feature;
  Kind kind;
  std::vector<Rings> polygons;
  FootprintHeights heights;
  bool has_heights = false;
  std::string object;
  std::size_t outline = kNoOutline;  // of a part: its outline's index
  bool replaced = false;             // an outline whose parts stand for it
};

class Reader {
 public:
  Reader(const std::filesystem::path& path, const FootprintOptions& options, FootprintFile&& file,
         const GroundAt& ground)
      : path_(path.string()),
        options_(options),
        names_(options),
        file_(std::move(file)),
        ground_(ground) {
    builder_.model.warnings = std::move(file_.warnings);
  }

  Result<Model> read(const std::string& target_crs, const std::string& fallback_crs) {
    if (auto error = check_attributes()) return *error;
    choose();
    auto placed = place_footprints(file_, path_, target_crs, fallback_crs, builder_.model.warnings);
    if (!placed) return placed.error();
    clean();
    take_heights();
    replace_outlines();
    warn_of_missing();
    for (Building& b : buildings_) {
      if (b.has_heights && !b.replaced) add(b);
    }
    if (builder_.model.polygons.empty()) return nothing();
    Model& model = builder_.model;
    model.report.path = path_;
    model.report.format = file_.format + " footprints";
    model.report.crs = placed.value().crs;
    if (const std::string& from = placed.value().moved_from; !from.empty()) {
      model.report.placed =
          fmt::format("moved from {} to {}", crs_in_words(from), model.report.crs);
    }
    model.report.surfaces = model.polygons.size();
    return std::move(model);
  }

 private:
  std::string layer() const {
    return file_.several_layers ? fmt::format("{}: layer {}", path_, in_quotes(file_.layer))
                                : path_;
  }
  static std::string name_in_layer(const FootprintFeature& f) {
    return f.id.empty() ? fmt::format("feature {}", f.number)
                        : fmt::format("feature {} (id {})", f.number, printable(f.id, 200));
  }
  std::string name(const FootprintFeature& f) const {
    return fmt::format("{}: {}", layer(), name_in_layer(f));
  }
  void warning(std::string_view what, const FootprintFeature& f, const std::string& why = {}) {
    warn(builder_.model.warnings, what, why.empty() ? name(f) : name(f) + ": " + why);
  }
  std::string attributes() const {
    return file_.attributes.empty() ? "none" : listed(file_.attributes);
  }
  std::string looked_for() const {
    constexpr std::size_t kShown = 3;  // the rest stands in docs/footprints.md
    return fmt::format("height: {}; storeys: {}", listed(names_.height, kShown),
                       listed(names_.floors, kShown));
  }

  // "; attributes of the file: ..." where none of them has one of the names of heights.
  std::string height_is_elsewhere() const {
    const bool any =
        std::any_of(file_.attributes.begin(), file_.attributes.end(), [&](const auto& a) {
          return std::find(names_.height.begin(), names_.height.end(), lower_case(a)) !=
                 names_.height.end();
        });
    return any ? std::string() : fmt::format("; attributes of the file: {}", attributes());
  }

  // Attributes that the user names must be there.
  std::optional<Error> check_attributes() const {
    for (const std::string* wanted : {&options_.height, &options_.floors, &options_.base}) {
      if (wanted->empty()) continue;
      const bool known =
          std::any_of(file_.attributes.begin(), file_.attributes.end(),
                      [&](const auto& a) { return lower_case(a) == lower_case(*wanted); });
      if (!known) {
        return Error{fmt::format("{}: there is no attribute {}; it has {}.", layer(),
                                 in_quotes(*wanted), attributes())};
      }
    }
    return std::nullopt;
  }

  // Features that are footprints of buildings above the ground.
  void choose() {
    for (FootprintFeature& f : file_.features) {
      const Kind kind = kind_of(f);
      bool finite = true;
      for (const Rings& rings : f.polygons) {
        for (const auto& ring : rings) {
          for (const Vec2& p : ring) finite = finite && std::isfinite(p.x) && std::isfinite(p.y);
        }
      }
      const bool is_footprint = kind != Kind::kSkipped && !is_underground(f);
      if (kind == Kind::kSkipped) {
        warning("Features with building=no were left out.", f);
      } else if (!is_footprint) {
        warning("Features below the ground (location=underground, layer < 0) were left out.", f);
      } else if (!f.has_geometry) {
        warning("Features without a geometry were left out.", f);
      } else if (f.has_other_geometry) {
        warning("Geometries other than polygons were left out.", f);
      }
      if (!finite) {
        warning("Footprints with coordinates that are not finite were left out.", f);
      }
      if (!is_footprint || !finite) f.polygons.clear();
      if (f.polygons.empty()) continue;
      if (f.has_heights) {
        warning("Heights in the coordinates of footprints were not used.", f);
      }
      Building& b = buildings_.emplace_back();
      b.feature = &f;
      b.kind = kind;
    }
  }

  void clean() {
    for (Building& b : buildings_) {
      CleanPolygons clean = clean_polygons(b.feature->polygons);
      b.polygons = std::move(clean.polygons);
      if (!clean.repaired.empty()) {
        warning("Footprints that are not valid polygons were repaired.", *b.feature,
                clean.repaired);
      }
      if (clean.without_area > 0) {
        warning("Rings of footprints without an area were left out.", *b.feature);
      }
    }
  }

  void take_heights() {
    for (Building& b : buildings_) {
      HeightAnswer answer = heights_of(*b.feature, names_, options_.floor_height);
      b.has_heights = answer.heights.has_value();
      if (b.has_heights) b.heights = *answer.heights;
      problems_.push_back(std::move(answer.problem));
    }
  }

  void replace_outlines() {
    std::vector<std::size_t> part_of, outline_of;  // indices of buildings
    std::vector<const std::vector<Rings>*> parts, outlines;
    for (std::size_t k = 0; k < buildings_.size(); ++k) {
      const Building& b = buildings_[k];
      if (b.kind == Kind::kPart && b.has_heights && !b.polygons.empty()) {
        part_of.push_back(k);
        parts.push_back(&b.polygons);
      } else if (b.kind == Kind::kOutline && !b.polygons.empty()) {
        outline_of.push_back(k);
        outlines.push_back(&b.polygons);
      }
    }
    const auto found = outlines_of_parts(parts, outlines);
    std::map<std::size_t, std::vector<const std::vector<Rings>*>> replacing;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (found[k] == kNoOutline) continue;
      const std::size_t outline = outline_of[found[k]];
      buildings_[part_of[k]].outline = outline;
      replacing[outline].push_back(parts[k]);
      if (buildings_[part_of[k]].heights.from == 0) grounded_.insert(outline);
    }
    for (const auto& [outline, its_parts] : replacing) {
      Building& b = buildings_[outline];
      b.replaced = true;
      warning("Outlines of buildings were replaced by the parts (building:part) in them.",
              *b.feature);
      const double share = covered_share(b.polygons, its_parts);
      if (share < kCovered) {
        warning("Building parts leave open more than a tenth of the outline they replace.",
                *b.feature, fmt::format("they cover {:.0f} %", 100 * share));
      }
    }
  }

  void warn_of_missing() {
    for (std::size_t k = 0; k < buildings_.size(); ++k) {
      const Building& b = buildings_[k];
      if (b.has_heights || b.replaced || b.polygons.empty()) continue;
      if (problems_[k].empty()) {
        warning(fmt::format("Footprints without a height were left out (looked for {}{}).",
                            looked_for(), height_is_elsewhere()),
                *b.feature);
        ++without_height_;
      } else {
        warning("Footprints whose height cannot be used were left out.", *b.feature, problems_[k]);
        if (problem_.empty()) problem_ = name_in_layer(*b.feature) + ": " + problems_[k];
      }
    }
  }

  Error nothing() const {
    if (file_.features.empty()) return {fmt::format("{}: it has no features.", layer())};
    const std::size_t count = file_.features.size();
    if (!problem_.empty()) {
      return {fmt::format("{}: {} that can be used ({}).", layer(),
                          none_of(count, "feature", "has a height", "has no height"), problem_)};
    }
    if (without_height_ > 0) {
      return {fmt::format(
          "{}: {} (looked for {}); its attributes: {}; name the one with the height "
          "(--height-attribute) or the number of storeys (--floors-attribute).",
          layer(), none_of(without_height_, "footprint", "has a height", "has no height"),
          looked_for(), attributes())};
    }
    if (std::none_of(file_.features.begin(), file_.features.end(),
                     [](const FootprintFeature& f) { return f.has_geometry; })) {
      return {fmt::format("{}: {}.", layer(),
                          none_of(count, "feature", "has a geometry", "has no geometry"))};
    }
    return {fmt::format("{}: {} the footprint of a building ({}).", layer(),
                        none_of(count, "feature", "is", "is not"), left_out())};
  }

  static std::string none_of(std::size_t count, std::string_view what, std::string_view is,
                             std::string_view is_not) {
    return count == 1 ? fmt::format("its only {} {}", what, is_not)
                      : fmt::format("none of its {} {}s {}", count, what, is);
  }

  // "2 x Features with building=no were left out".
  std::string left_out() const {
    std::string out;
    for (const Warning& w : builder_.model.warnings) {
      constexpr std::string_view kEnd = "were left out.";
      if (!w.what.ends_with(kEnd)) continue;
      out += fmt::format("{}{} x {}", out.empty() ? "" : "; ", w.count,
                         std::string_view(w.what).substr(0, w.what.size() - 1));
    }
    return out.empty() ? "there are no polygons" : out;
  }

  // A name that no other feature has.
  std::string object_of(std::size_t building) {
    Building& b = buildings_[building];
    if (!b.object.empty()) return b.object;
    std::string id = b.feature->id;
    if (id.empty()) id = fmt::format("feature {}", b.feature->number);
    if (b.outline != kNoOutline) {
      // One slash, between the outline and its part: "way/5" becomes "way:5".
      std::replace(id.begin(), id.end(), '/', ':');
      id = object_of(b.outline) + "/" + id;
    }
    if (!objects_.insert(id).second) {
      warning("Features have the name of another one; \"(feature N)\" was added to it.",
              *b.feature);
      id += fmt::format(" (feature {})", b.feature->number);
      objects_.insert(id);
    }
    return b.object = id;
  }

  // The lowest ground under the corners.
  std::optional<double> lowest_ground(const Rings& rings) const {
    std::optional<double> lowest;
    if (!ground_) return lowest;
    for (const auto& ring : rings) {
      for (const Vec2& p : ring) {
        const auto z = ground_(p.x, p.y);
        if (z && std::isfinite(*z)) lowest = std::min(lowest.value_or(*z), *z);
      }
    }
    return lowest;
  }

  // Parts of a building stand where the building stands.
  double base_of(const Building& b, const Rings& rings) {
    if (b.heights.base) return *b.heights.base;
    std::optional<double> z;
    if (b.outline != kNoOutline) {
      const Building& whole = buildings_[b.outline];
      if (whole.has_heights && whole.heights.base) return *whole.heights.base;
      for (const Rings& r : whole.polygons) {
        const auto at = lowest_ground(r);
        if (at) z = std::min(z.value_or(*at), *at);
      }
    }
    if (!z) z = lowest_ground(rings);
    if (!z && ground_)
      warning("Footprints without ground below them stand at height 0.", *b.feature);
    return z.value_or(0.0);
  }

  void add(Building& b) {
    if (b.polygons.empty()) return;
    auto shape = value_of(*b.feature, "roof:shape");
    if (shape.empty()) shape = value_of(*b.feature, "roof_shape");
    if (!shape.empty() && shape != "flat") {
      warning("Shapes of roofs (roof:shape) were not built; solids reach up to the ridge.",
              *b.feature);
    }
    const std::string object = object_of(static_cast<std::size_t>(&b - buildings_.data()));
    const std::size_t whole = b.outline != kNoOutline ? object_of(b.outline).size() : 0;
    const bool raised = b.heights.from > 0;
    // Names that ground.h understands: what is raised and does not belong to a building on the
    // ground says nothing about the ground.
    const std::string_view group =
        b.outline != kNoOutline && grounded_.count(b.outline) ? "BuildingPart"
        : raised                                              ? "BuildingInstallation"
        : b.kind == Kind::kPart && b.outline != kNoOutline    ? "BuildingPart"
                                                              : "Building";
    const auto surface = [&](std::string_view semantic) {
      return builder_.surface(object, group, "", semantic, whole);
    };
    const std::uint32_t roof = surface("RoofSurface"), wall = surface("WallSurface");
    const std::uint32_t floor = surface(raised ? "OuterCeilingSurface" : "GroundSurface");
    std::uint32_t number = 0;
    for (const Rings& rings : b.polygons) {
      const double base = base_of(b, rings);
      const double low = base + b.heights.from, high = base + b.heights.to;
      std::vector<std::vector<std::uint32_t>> up, down;
      for (const auto& ring : rings) {
        auto& u = up.emplace_back();
        auto& d = down.emplace_back();
        for (const Vec2& p : ring) {
          u.push_back(builder_.vertex({p.x, p.y, high}));
          d.push_back(builder_.vertex({p.x, p.y, low}));
        }
      }
      builder_.polygon(roof, number++, up);
      for (std::size_t r = 0; r < up.size(); ++r) {
        for (std::size_t k = 0; k < up[r].size(); ++k) {
          const std::size_t next = (k + 1) % up[r].size();  // the inside is on the edge's left
          builder_.polygon(wall, number++, {{down[r][k], down[r][next], up[r][next], up[r][k]}});
        }
      }
      for (auto& ring : down) std::reverse(ring.begin(), ring.end());
      builder_.polygon(floor, number++, down);
    }
    ++builder_.model.report.objects;
  }

  std::string path_;
  const FootprintOptions& options_;
  FootprintAttributes names_;
  FootprintFile file_;
  const GroundAt& ground_;
  ModelBuilder builder_;
  std::vector<Building> buildings_;
  std::vector<std::string> problems_;  // per building, see HeightAnswer
  std::string problem_;                // the first of those that were left out for it
  std::size_t without_height_ = 0;
  std::set<std::string> objects_;
  std::set<std::size_t> grounded_;  // outlines with a part that stands on the ground
};

}  // namespace

Result<Model> read_footprints(const std::filesystem::path& path, const FootprintOptions& options,
                              const std::string& target_crs, const std::string& fallback_crs,
                              const GroundAt& ground) {
  if (!(options.floor_height > 0 && std::isfinite(options.floor_height))) {
    return Error{fmt::format("{}: the height of a storey must be a positive number of metres.",
                             path.string())};
  }
  auto file = read_footprint_file(path, options.layer, FootprintAttributes(options).all());
  if (!file) return file.error();
  return Reader(path, options, std::move(file).value(), ground).read(target_crs, fallback_crs);
}

}  // namespace gnomon
