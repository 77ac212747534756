#include <gnomon/io/scene_check.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <gnomon/io/box_finder.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/file_place.h>
#include <gnomon/io/footprints.h>
#include <gnomon/io/place_model.h>
#include <gnomon/io/read_text.h>
#include <gnomon/io/scene_ground.h>
#include <gnomon/scene/objects.h>
#include <glm/common.hpp>

namespace gnomon {
namespace {

// A scene this small, in metres, has the wrong unit: nothing is left of it at any pixel size.
constexpr double kSmallestModel = 1e-3;
// And a file this small most likely.
constexpr double kSmallModel = 0.5;
// Nothing that is built is higher, in metres; terrain is, but at least kFlat times as wide.
constexpr double kHighestBuilding = 1000, kFlat = 5;

// Bottoms of buildings and terrain differ by a metre or two, and those of a design by a cellar;
// other reference heights, units or axes make tens of metres (the geoid: 25 to 50 in Europe).
constexpr double kWrongHeight = 5;

std::string file_name(const SceneFile& f) { return f.path.filename().string(); }

// Heights in models are whole millimetres: vertices within one of the lowest are as low.
constexpr double kLevelBottom = 1e-3;

// What stands on the ground as one: a building with its parts, or a file that names no city
// objects.
struct Thing {
  Vec3 low{std::numeric_limits<double>::infinity()};  // box
  Vec3 high{-std::numeric_limits<double>::infinity()};
  std::vector<Vec3> feet;  // its lowest vertices
  std::string name;
  std::uint32_t file = 0;
  bool city = false;
};

// Trees, lamps and bridges may begin in the air.
bool is_judged(const Surface& s) {
  if (is_terrain(s)) return false;
  return !s.city || (s.group.starts_with("Building") && stands_on_ground(s));
}

std::vector<Thing> things_of(const Scene& scene, const std::vector<SceneFile>& files) {
  const Objects whole = whole_objects(scene);
  std::vector<Thing> things(whole.names.size() + files.size());
  std::vector<std::size_t> thing_of(scene.surfaces.size(), things.size());
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const Surface& surface = scene.surfaces[s];
    if (!is_judged(surface)) continue;
    thing_of[s] = surface.city ? whole.of_surface[s] : whole.names.size() + surface.file;
    Thing& thing = things[thing_of[s]];
    thing.file = surface.file;
    thing.city = surface.city;
    thing.name = file_name(files[surface.file]);
    if (surface.city) thing.name += ": object " + in_quotes(whole.names[whole.of_surface[s]], 200);
  }
  const auto each_vertex = [&](const auto& visit) {
    for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
      const std::size_t number = thing_of[scene.surface_of[t]];
      if (number == things.size()) continue;
      for (const std::uint32_t v : scene.mesh.triangles[t]) {
        visit(things[number], scene.mesh.positions[v]);
      }
    }
  };
  each_vertex([](Thing& thing, const Vec3& p) {
    thing.low = glm::min(thing.low, p);
    thing.high = glm::max(thing.high, p);
  });
  each_vertex([](Thing& thing, const Vec3& p) {
    if (p.z <= thing.low.z + kLevelBottom) thing.feet.push_back(p);
  });
  std::erase_if(things, [](const Thing& t) { return t.feet.empty(); });
  return things;
}

// Below the first of its feet that has terrain below: terrain often ends between neighbours' walls.
std::optional<double> terrain_below(const Thing& one, const GroundAt& terrain) {
  for (const Vec3& p : one.feet) {
    if (const auto z = terrain(p.x, p.y)) return z;
  }
  return std::nullopt;
}

class Neighbours {
 public:
  explicit Neighbours(const std::vector<Thing>& things) : things_(things), finder_(boxes(things)) {}

  // The thing of another file whose box is nearest to a foot of `one`.
  const Thing* nearest(const Thing& one) const {
    const auto k = finder_.nearest(one.feet[0].x, one.feet[0].y, [&](std::size_t other) {
      return things_[other].file != one.file;
    });
    return k ? &things_[*k] : nullptr;
  }

  // A storey on top of an existing building stands on no ground.
  bool carry(const Thing& one) const {
    const Vec3& p = one.feet[0];
    const auto k = finder_.nearest(p.x, p.y, [&](std::size_t other) {
      return things_[other].file != one.file && things_[other].high.z + kWrongHeight >= p.z;
    });
    return k && things_[*k].low.x <= p.x && p.x <= things_[*k].high.x && things_[*k].low.y <= p.y &&
           p.y <= things_[*k].high.y;
  }

 private:
  static std::vector<Bounds2> boxes(const std::vector<Thing>& things) {
    std::vector<Bounds2> all;
    for (const Thing& t : things) all.push_back({t.low.x, t.low.y, t.high.x, t.high.y});
    return all;
  }
  const std::vector<Thing>& things_;
  BoxFinder finder_;
};

// What to do about a file of a strange size.
std::string advice(const SceneFile& f, const Vec3& size) {
  const AxesKnown known = axes_known(f);
  if (!known.up && size.z > kFlat * std::min(size.x, size.y)) {
    return fmt::format("--up {}={}?", file_name(f), known.usual_up == 'y' ? 'z' : 'y');
  }
  return known.unit ? "export it in metres" : fmt::format("--unit {}=mm?", file_name(f));
}

// A time for all files is meant for those that have animations, if any does.
void warn_of_unused_times(const std::vector<SceneFile>& files, const LoadOptions& options,
                          Warnings& warnings) {
  constexpr const char* kUnused = "--time and --animation were not used: there are no animations.";
  bool any = false;
  for (const SceneFile& f : files) {
    const bool has = f.model->animations > 0;
    any = any || has;
    if (f.time_of_its_own && !has) warn(warnings, kUnused, file_name(f));
  }
  if (!any && (options.time || !options.animation.empty())) warn(warnings, kUnused, "");
}

}  // namespace

std::optional<Error> check_sizes(const std::vector<SceneFile>& files, Warnings& warnings) {
  double largest = 0;
  for (const SceneFile& f : files) {
    const auto box = box_of(*f.model);
    if (!box) continue;
    const Vec3 size = box->high - box->low;
    const double width = std::max(size.x, size.y), all = std::max(width, size.z);
    largest = std::max(largest, all);
    if (is_georeferenced(f.format)) continue;
    const std::string name = file_name(f);
    if (all < kSmallModel) {
      warn(warnings, "Models are very small; if they are not, their unit is another one.",
           fmt::format("{}: {:.3g} m large; {}", name, all,
                       axes_known(f).unit ? "export it in metres" : "say it with --unit"));
    } else if (size.z > kHighestBuilding && size.z * kFlat > width) {
      warn(warnings, "Models are very high; if they are not, their unit or up axis is another one.",
           fmt::format("{}: {:.0f} m high; {}", name, size.z, advice(f, size)));
    }
  }
  if (largest >= kSmallestModel) return std::nullopt;
  return Error{fmt::format("{}: the model is {:.3g} m large; say its unit with --unit.",
                           files[0].path.string(), largest)};
}

std::optional<Error> check_crs_used(const std::vector<SceneFile>& files, bool georeferenced,
                                    const std::string& crs, const LoadOptions& options) {
  if (options.crs.empty()) return std::nullopt;
  const SceneFile* named = nullptr;
  for (const SceneFile& f : files) {
    if (!f.named_crs.empty()) {
      if (named == nullptr) named = &f;
    } else if (!f.crs_of_its_own && !crs_of(f, georeferenced).empty()) {
      return std::nullopt;  // it needs it
    }
  }
  if (named == nullptr) return std::nullopt;
  const std::string given = short_crs(options.crs);
  const auto box = box_of(*named->model);
  if (given == named->named_crs || (box && agree(given, crs, (box->low + box->high) / 2.0))) {
    return std::nullopt;
  }
  return Error{fmt::format("{}: its CRS is {}, but --crs says {}; leave out --crs.",
                           named->path.string(), named->named_crs, given)};
}

void warn_of_unused_options(const std::vector<SceneFile>& files, const LoadOptions& options,
                            Warnings& warnings) {
  const auto any = [&](auto is) { return std::any_of(files.begin(), files.end(), is); };
  const auto has = [&](FileFormat format) {
    return any([&](const SceneFile& f) { return f.format == format; });
  };
  const char* axes =
      "--up and --unit were not used: these files say themselves what their axes are.";
  bool all = options.up || !options.unit.empty();
  for (const SceneFile& f : files) {
    all = all && is_georeferenced(f.format);
    if (f.axes_of_its_own && is_georeferenced(f.format)) warn(warnings, axes, file_name(f));
  }
  if (all) warn(warnings, axes, "");
  warn_of_unused_times(files, options, warnings);
  const FootprintOptions& o = options.footprints;
  const bool footprints = !o.layer.empty() || !o.height.empty() || !o.floors.empty() ||
                          !o.base.empty() || o.floor_height != FootprintOptions{}.floor_height;
  const auto unused = [&](bool given, FileFormat format, const char* what) {
    if (given && !has(format)) warn(warnings, what, "");
  };
  unused(!options.lod.empty(), FileFormat::city_json,
         "--lod was not used: none of the files is CityJSON.");
  unused(footprints, FileFormat::footprints,
         "Options for footprints were not used: none of the files holds any.");
  unused(options.surface != LoadOptions{}.surface, FileFormat::raster,
         "--surface was not used: none of the files is a surface model.");
}

void warn_of_overlapping_surfaces(const std::vector<SceneFile>& files, Warnings& warnings) {
  std::vector<std::pair<const SceneFile*, ModelBox>> surfaces;
  for (const SceneFile& f : files) {
    if (f.format != FileFormat::raster || f.above_ground) continue;
    if (const auto box = box_of(*f.model)) surfaces.emplace_back(&f, *box);
  }
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const ModelBox &a = surfaces[i].second, &b = surfaces[j].second;
      const double dx = std::min(a.high.x, b.high.x) - std::max(a.low.x, b.low.x);
      const double dy = std::min(a.high.y, b.high.y) - std::max(a.low.y, b.low.y);
      if (dx <= 0 || dy <= 0) continue;
      const SceneFile& lower = a.low.z < b.low.z ? *surfaces[i].first : *surfaces[j].first;
      warn(warnings,
           "Surface models lie over each other, all with absolute heights; if one holds heights "
           "above the ground, name it with --above-ground.",
           file_name(lower));
    }
  }
}

void warn_of_heights(Scene& scene, const std::vector<SceneFile>& files) {
  const std::vector<Thing> things = things_of(scene, files);
  if (things.empty()) return;
  const GroundAt terrain = terrain_at(scene);
  const Neighbours neighbours(things);
  for (const Thing& one : things) {
    std::optional<double> ground;
    if (terrain) {
      ground = terrain_below(one, terrain);
      if (!ground) {
        warn(scene.warnings,
             "Buildings stand where the terrain has no surface: beyond its border, or in a hole; "
             "what is around them receives no shadows.",
             one.name);
        continue;
      }
    } else if (const Thing* other = one.city ? nullptr : neighbours.nearest(one)) {
      ground = other->low.z;
    }
    if (!ground) continue;
    const double above = one.low.z - *ground;
    if (above > kWrongHeight && !neighbours.carry(one)) {
      warn(scene.warnings, "Buildings float above the ground: check their heights.",
           fmt::format("{}: {:.1f} m above the ground there", one.name, above));
    } else if (one.high.z < *ground) {
      warn(scene.warnings, "Buildings lie below the ground: check their heights.",
           fmt::format("{}: its top is {:.1f} m below the ground there", one.name,
                       *ground - one.high.z));
    } else if (!one.city && above < -kWrongHeight) {
      warn(scene.warnings,
           "Models reach below the ground; if these are no cellars, check --up and the height of "
           "--site.",
           fmt::format("{}: {:.1f} m below the ground there", one.name, -above));
    }
  }
}

}  // namespace gnomon
