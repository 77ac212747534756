#include <fmt/format.h>
#include <gnomon/core/exact.h>
#include <gnomon/io/add_model.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/file_place.h>
#include <gnomon/io/load_scene.h>
#include <gnomon/io/model.h>
#include <gnomon/io/place_model.h>
#include <gnomon/io/read_text.h>
#include <gnomon/io/scene_check.h>
#include <gnomon/io/scene_file.h>
#include <gnomon/io/scene_ground.h>
#include <gnomon/mesh/weld.h>
#include <gnomon/scene/select.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace gnomon {
namespace {

// How far the ground reaches around the model where nothing else is asked for: the shadow of a
// model is 1/tan(10 degrees) = 5.7 times as long as it is high when the sun stands 10 degrees above
// the horizon, the lowest that the program's default map makes room for.
constexpr double kGroundHeights = 6.0;
constexpr double kLeastGround = 20.0;  // metres, for models that are flat

// Files farther apart than this are not one scene (metres): a scene is flat and has one sun, but
// over 100 km the Earth falls away by 785 m and the sun stands almost a degree elsewhere.
constexpr double kFarthestApart = 100e3;

std::optional<Error> check_lod(const std::vector<SceneFile>& files, const LoadOptions& options) {
  if (options.lod.empty()) return std::nullopt;
  std::string found, names;
  bool any = false, city = false;
  for (const SceneFile& f : files) {
    if (f.format != FileFormat::city_json) continue;
    const Model& m = *f.model;
    city = true;
    any = any || !m.polygons.empty();
    names += (names.empty() ? "" : ", ") + m.report.path;
    for (const std::string& lod : m.report.lods) {
      if (fmt::format(", {},", found).find(fmt::format(", {},", lod)) == std::string::npos) {
        found += (found.empty() ? "" : ", ") + lod;
      }
    }
  }
  if (!city || any) return std::nullopt;
  return Error{fmt::format("{}: there is no geometry of LoD {}; found: {}.", names,
                           in_quotes(options.lod), found.empty() ? "none" : found)};
}

// |c| <= kLargestCoordinate, in metres of the CRS. NaN fails too.
std::optional<Error> check_coordinates(const Model& m) {
  for (const ModelPolygon& p : m.polygons) {
    for (std::uint32_t c = m.ring_begin[p.first_ring]; c < m.ring_begin[p.last_ring]; ++c) {
      const Vec3 at = m.vertices[m.corners[c]] * m.scale + m.translate;
      for (int k = 0; k < 3; ++k) {
        if (!(std::fabs(at[k]) <= kLargestCoordinate)) {
          return Error{fmt::format(
              "{}: the coordinate {} is too large (beyond {:g} m); check the file's transform and "
              "unit.",
              name_of(m, p), at[k], kLargestCoordinate)};
        }
      }
    }
  }
  return std::nullopt;
}

// The centre of the model's box, in whole metres, so that coordinates in files stay recognisable.
Vec3 origin_of(const ModelBox& box) {
  const Vec3 middle = (box.low + box.high) / 2.0;
  return Vec3(std::round(middle.x), std::round(middle.y), std::round(middle.z)) +
         Vec3(0.0);  // no -0
}

std::string element_of(const Scene& scene, std::uint32_t surface) {
  const Surface& s = scene.surfaces[surface];
  return !s.object.empty()  ? fmt::format("object {}", in_quotes(s.object, 200))
         : !s.group.empty() ? fmt::format("group {}", in_quotes(s.group, 200))
                            : std::string();
}

// Welds, and warns of what went.
std::size_t weld_scene(Scene& scene) {
  const std::vector<std::uint32_t> before = scene.surface_of;
  WeldReport report;
  if (scene.appearance.material_of.empty()) {
    report = weld(scene.mesh, scene.surface_of);
  } else {
    std::vector<std::uint32_t> kept(before.size());
    std::iota(kept.begin(), kept.end(), 0u);
    report = weld(scene.mesh, kept);
    keep_triangles(scene.appearance, kept);
    for (std::size_t t = 0; t < kept.size(); ++t) scene.surface_of[t] = before[kept[t]];
    scene.surface_of.resize(kept.size());
  }
  warn(scene.warnings, "Triangles without area were dropped.",
       report.zero_area_triangles ? element_of(scene, before[report.first_zero_area])
                                  : std::string(),
       report.zero_area_triangles);
  warn(scene.warnings, "Coordinates smaller than an atom were set to 0.", "",
       report.snapped_coordinates);
  return report.zero_area_triangles;
}

void warn_of_coincident(Scene& scene) {
  const Coincident found = find_coincident(scene.mesh);
  if (found.triangles == 0) return;
  warn(scene.warnings,
       "Triangles lie exactly on others; all were kept: each casts, and none shades another.",
       element_of(scene, scene.surface_of[found.first]), found.triangles);
}

Bounds2 ground_extent(const Scene& scene, const LoadOptions& options) {
  const Vec3& o = scene.frame.origin;
  if (const auto& e = options.ground_extent) {
    return {e->x0 - o.x, e->y0 - o.y, e->x1 - o.x, e->y1 - o.y};
  }
  Vec3 low = scene.mesh.positions[0], high = low;
  for (const Vec3& p : scene.mesh.positions) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  const double margin = std::max(kLeastGround, kGroundHeights * (high.z - low.z));
  return {low.x - margin, low.y - margin, high.x + margin, high.y + margin};
}

// The files' names, for errors about all of them.
std::string names_of(const std::vector<std::filesystem::path>& paths) {
  std::string names;
  for (const auto& path : paths) names += (names.empty() ? "" : ", ") + path.string();
  return names;
}

// A scene under construction.
struct Builder {
  LoadedScene loaded;
  std::string crs;                 // empty: local coordinates
  std::optional<ModelBox> box;     // of what is in it, CRS coordinates
  std::string first;               // the file that came first, for messages
  bool first_is_placed = true;     // by a CRS or a site
  std::size_t beside_terrain = 0;  // how often a height was asked where the terrain has none
};

// `placed`: by a CRS or a site. Of two files that are far apart, one that is not is to blame.
std::optional<Error> check_near(const Builder& b, const ModelBox& box, const std::string& path,
                                bool placed) {
  const double dx = std::max({b.box->low.x - box.high.x, 0.0, box.low.x - b.box->high.x});
  const double dy = std::max({b.box->low.y - box.high.y, 0.0, box.low.y - b.box->high.y});
  if (std::hypot(dx, dy) <= kFarthestApart) return std::nullopt;
  const bool blame_first = placed && !b.first_is_placed;
  const std::string &to_blame = blame_first ? b.first : path, &other = blame_first ? path : b.first;
  const std::string name = std::filesystem::path(to_blame).filename().string();
  return Error{fmt::format(
      "{}: it lies {:.0f} km from {}: say where it stands with --site {}=LAT,LON or --crs "
      "{}=EPSG:..., or leave it out.",
      to_blame, std::hypot(dx, dy) / 1000, other, name, name)};
}

std::optional<Error> add_file(Builder& b, SceneFile& f, std::uint32_t number, bool placed) {
  Scene& scene = b.loaded.scene;
  Model& m = *f.model;
  if (auto error = check_coordinates(m)) return error;
  if (const auto box = box_of(m)) {
    if (!b.box) {
      scene.frame.origin = origin_of(*box);
      b.box = box;
      b.first = m.report.path;
      b.first_is_placed = placed;
    } else {
      if (auto error = check_near(b, *box, m.report.path, placed)) return error;
      for (int k = 0; k < 3; ++k) {
        b.box->low[k] = std::min(b.box->low[k], box->low[k]);
        b.box->high[k] = std::max(b.box->high[k], box->high[k]);
      }
    }
  } else {
    warn(scene.warnings, "Files without surfaces.", m.report.path);
  }
  add_model(scene, m, number, is_georeferenced(f.format));
  return std::nullopt;
}

// A model that is read goes to its place among the others.
std::optional<Error> place(SceneFile& f, const Builder& b, bool georeferenced,
                           const GroundAt& ground) {
  Model& m = *f.model;
  const std::string crs = is_read_first(f) ? crs_of(f, georeferenced) : m.report.crs;
  if (!crs.empty()) {
    if (b.crs.empty()) return std::nullopt;
    const auto box = box_of(m);
    if (box && !agree(crs, b.crs, (box->low + box->high) / 2.0)) {
      m.report.placed = fmt::format("moved from {} to {}", crs, b.crs);
      return move_to_crs(m, crs, b.crs);
    }
    if (m.report.placed.empty()) m.report.placed = "coordinates of " + crs;
    return std::nullopt;
  }
  const auto site = site_of(f);
  if (b.crs.empty() || !site) {
    m.report.placed = b.crs.empty() ? "local coordinates" : "taken as coordinates of " + b.crs;
    return std::nullopt;
  }
  return place_at_site(m, *site, north_of(f).value_or(0), b.crs, ground);
}

void tell(const LoadOptions& options, const std::string& what) {
  if (options.progress) options.progress(what);
}

// Rasters and footprints come in the scene's CRS, and stand on its ground. Those in local
// coordinates at a site have to be moved there yet.
Result<Model> read_map(const SceneFile& f, const Builder& b, bool georeferenced,
                       const LoadOptions& options, const GroundAt& ground) {
  if (b.crs.empty() || !crs_of(f, georeferenced).empty() || !site_of(f)) {
    return read_model(f, options, b.crs, ground);
  }
  const Site site = *site_of(f);
  const double north = north_of(f).value_or(0);
  const auto turn = site_turn(f.path.string(), site.place, north, b.crs);
  if (!turn) return turn.error();
  SceneFile local = f;
  local.told.crs.clear();
  auto model = read_model(local, options, "",
                          site.on_ground ? ground_from(turn.value(), ground) : GroundAt());
  if (!model) return model;
  // Surfaces have heights of their own, and what stands on the ground has them from it.
  Site level = site;
  level.on_ground = false;
  if (auto error = place_at_site(model.value(), level, north, b.crs, {})) return *error;
  model.value().report.crs = b.crs;
  return model;
}

// Reads what does not wait for others, and the names of the CRSs of the rest.
std::optional<Error> read_first(std::vector<SceneFile>& files, const LoadOptions& options) {
  for (SceneFile& f : files) {
    if (!is_read_first(f)) {
      auto crs = crs_named_by(f, options);
      if (!crs) return crs.error();
      f.named_crs = std::move(crs).value();
      continue;
    }
    tell(options, "reading " + f.path.filename().string());
    auto model = read_model(f, options, "", {});
    if (!model) return model.error();
    f.model = std::move(model).value();
    f.named_crs = f.model->report.crs;
    if (auto error = check_coordinates(*f.model)) return error;
  }
  return std::nullopt;
}

// Reads and places all files, those that stand on others last.
std::optional<Error> build(Builder& b, std::vector<SceneFile>& files, const LoadOptions& options) {
  if (auto error = read_first(files, options)) return error;
  if (auto error = check_lod(files, options)) return error;
  const bool georeferenced = has_georeferenced(files);
  auto crs = scene_crs(files, options);
  if (!crs) return crs.error();
  b.crs = std::move(crs).value();
  const bool in_crs = georeferenced || !b.crs.empty();
  std::vector<int> ranks;
  for (const SceneFile& f : files) {
    if (auto error = check_told_place(f, georeferenced, in_crs)) return error;
    ranks.push_back(rank_of(f, georeferenced, in_crs));
  }
  for (int now = 0; now < kRanks; ++now) {
    if (std::find(ranks.begin(), ranks.end(), now) == ranks.end()) continue;
    const GroundAt ground =
        now < kAboveGround || !b.box ? GroundAt() : ground_of(b.loaded.scene, b.beside_terrain);
    for (std::size_t k = 0; k < files.size(); ++k) {
      SceneFile& f = files[k];
      if (ranks[k] != now) continue;
      const std::size_t beside = b.beside_terrain;
      if (!f.model) {
        tell(options, "reading " + f.path.filename().string());
        auto model = read_map(f, b, georeferenced, options, ground);
        if (!model) return model.error();
        f.model = std::move(model).value();
        if (b.crs.empty()) b.crs = f.model->report.crs;
      }
      if (auto error = place(f, b, georeferenced, ground)) return error;
      if (b.beside_terrain > beside) {
        warn(b.loaded.scene.warnings,
             "Some of what stands on the terrain has none below it; the height of the nearest was "
             "taken.",
             f.path.filename().string());
      }
      const bool placed = !crs_of(f, georeferenced).empty() || site_of(f).has_value();
      if (auto error = add_file(b, f, static_cast<std::uint32_t>(k), placed)) return error;
    }
  }
  return std::nullopt;
}

// CRS, place and true north of the scene, whose origin is known. In a scene with a CRS, the site
// and north of local models have done their work; where there is no local model they override the
// CRS's.
std::optional<Error> place_scene(LoadedScene& loaded, const std::vector<SceneFile>& files,
                                 bool georeferenced, const LoadOptions& options) {
  Frame& frame = loaded.scene.frame;
  bool any_at_site = false;
  std::string named_by;  // the file that the CRS is from
  for (const SceneFile& f : files) {
    const bool local = crs_of(f, georeferenced).empty();
    any_at_site = any_at_site || (local && site_of(f));
    if (named_by.empty() && !local) named_by = f.path.string() + ": ";
  }
  if (!frame.crs.empty()) {
    const auto found = locate(frame.crs, frame.origin);
    if (!found) return Error{named_by + found.error().message};
    const CrsPlace& at = found.value();
    if (at.metres_per_unit != 1.0) {
      return Error{fmt::format(
          "{}the CRS {} ({}) is not in metres (its unit is {} m), which Gnomon does not read yet; "
          "reproject the model to a CRS in metres.",
          named_by, frame.crs, at.name, at.metres_per_unit)};
    }
    frame.place = at.place;
    frame.true_north = at.true_north;
    loaded.place_by = "the CRS";
    loaded.north_by = "meridian convergence of the CRS";
    if (any_at_site) return std::nullopt;
    if (options.site) {
      const double apart = distance_between(at.place, options.site->place);
      if (apart > kFarthestApart) {
        return Error{fmt::format(
            "{}--site lies {:.0f} km from where {} puts the model; leave out --site, or check "
            "whether latitude and longitude are swapped.",
            named_by, apart / 1000, frame.crs)};
      }
      frame.place = options.site->place;
      loaded.place_by = "--site";
      warn(loaded.scene.warnings,
           "--site was used for the sun alone: the files say themselves where they lie.",
           files[0].model->report.path);
    }
    if (options.north) frame.true_north = *options.north, loaded.north_by = "--north";
    return std::nullopt;
  }
  for (const SceneFile& f : files) {  // all local ones that say something agree
    if (const auto site = site_of(f); site && !frame.place) {
      frame.place = site->place;
      loaded.place_by = f.told.site ? "--site" : f.model->report.path;
    }
    if (const auto north = north_of(f)) {
      frame.true_north = *north;
      loaded.north_by = f.told.north ? "--north" : f.model->report.path;
    }
  }
  return std::nullopt;
}

// Ground that was made is a little darker than the white of models without looks: else a flat roof
// under a sun is as bright as the ground below it.
void paint_made_ground(Appearance& a, std::size_t triangles) {
  constexpr Vec3 kColour{0.74, 0.75, 0.71};
  const std::size_t before = a.material_of.size();
  if (before == 0 || before == triangles) return;
  fill_up(a, triangles);
  Material ground;
  ground.name = "made ground";
  ground.base_colour = kColour;
  std::fill(a.material_of.begin() + static_cast<std::ptrdiff_t>(before), a.material_of.end(),
            static_cast<std::uint32_t>(a.materials.size()));
  a.materials.push_back(std::move(ground));
}

}  // namespace

Result<LoadedScene> load_scene(const std::vector<std::filesystem::path>& paths,
                               const LoadOptions& options) {
  if (paths.empty()) return Error{"no model file was given."};
  if (const auto& e = options.ground_extent) {
    if (!(e->x0 < e->x1 && e->y0 < e->y1)) {
      return Error{"the ground's extent must have x0 < x1 and y0 < y1."};
    }
  }
  auto found = scene_files(paths, options);
  if (!found) return found.error();
  std::vector<SceneFile> files = std::move(found).value();

  Builder builder;
  if (auto error = build(builder, files, options)) return *error;
  LoadedScene& loaded = builder.loaded;
  Scene& scene = loaded.scene;
  if (!builder.box) {
    return Error{fmt::format("{}: there are no surfaces in it, so nothing that casts a shadow.",
                             names_of(paths))};
  }
  const bool georeferenced = has_georeferenced(files);
  if (auto error = check_sizes(files, scene.warnings)) return *error;
  if (auto error = check_crs_used(files, georeferenced, builder.crs, options)) return *error;
  warn_of_overlapping_surfaces(files, scene.warnings);
  warn_of_unused_options(files, options, scene.warnings);
  warn_of_heights(scene, files);
  scene.frame.crs = builder.crs;
  if (auto error = place_scene(loaded, files, georeferenced, options)) return *error;

  for (SceneFile& f : files) loaded.files.push_back(std::move(f.model->report));

  if (options.appearance) finish_looks(scene.appearance, scene.mesh.triangles.size());
  tell(options, "joining vertices");
  loaded.zero_area_triangles = weld_scene(scene);
  if (scene.mesh.triangles.empty()) {
    return Error{fmt::format("{}: none of its surfaces has an area, so nothing casts a shadow.",
                             names_of(paths))};
  }
  tell(options, "making the ground");
  auto ground = add_ground(scene, {options.ground, ground_extent(scene, options)});
  if (!ground) return ground.error();
  loaded.ground = std::move(ground).value();
  paint_made_ground(scene.appearance, scene.mesh.triangles.size());
  for (const Vec3& v : scene.mesh.positions) {
    if (!(std::fabs(v.x) <= kLargestCoordinate && std::fabs(v.y) <= kLargestCoordinate &&
          std::fabs(v.z) <= kLargestCoordinate)) {
      return Error{
          fmt::format("--ground {}: the ground would reach beyond {:g} m; give a height in metres "
                      "of the model's "
                      "coordinates, and bounds near the model",
                      options.ground, kLargestCoordinate)};
    }
  }
  if (loaded.ground.triangles > 0) loaded.zero_area_triangles += weld_scene(scene);
  warn_of_coincident(scene);

  const Selection selection{options.cast, options.no_cast, options.receive};
  if (auto error = select(scene, selection)) return *error;
  return loaded;
}

}  // namespace gnomon
