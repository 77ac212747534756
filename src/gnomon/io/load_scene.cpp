#include <fmt/format.h>
#include <gnomon/core/exact.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/load_scene.h>
#include <gnomon/io/model.h>
#include <gnomon/io/place_model.h>
#include <gnomon/io/read_text.h>
#include <gnomon/io/scene_file.h>
#include <gnomon/io/scene_ground.h>
#include <gnomon/io/triangulate.h>
#include <gnomon/mesh/weld.h>
#include <gnomon/scene/select.h>

#include <algorithm>
#include <cmath>
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

// Two CRSs agree if they are the same text, or put the same point at the same place: EPSG:28992 and
// EPSG:7415, which adds heights to it.
bool agree(const std::string& a, const std::string& b, const Vec3& at) {
  if (a == b) return true;
  const auto in_a = locate(a, at), in_b = locate(b, at);
  return in_a && in_b && in_a.value().place.latitude == in_b.value().place.latitude &&
         in_a.value().place.longitude == in_b.value().place.longitude;
}

bool is_triangle(const Model& m, const ModelPolygon& p) {
  const std::uint32_t first = m.ring_begin[p.first_ring];
  if (p.last_ring - p.first_ring != 1 || m.ring_begin[p.last_ring] - first != 3) return false;
  const std::uint32_t* c = m.corners.data() + first;
  return c[0] != c[1] && c[1] != c[2] && c[2] != c[0];
}

// Appends the model's triangles to the scene. `file`: its number among the scene's files.
void add_model(Scene& scene, Model& m, std::uint32_t file) {
  TriMesh& mesh = scene.mesh;
  const auto first_vertex = static_cast<std::uint32_t>(mesh.positions.size());
  const auto first_surface = static_cast<std::uint32_t>(scene.surfaces.size());
  // Equal numbers in the file must give equal positions, and small ones exact differences: the
  // large offsets are subtracted from each other first.
  const Vec3 offset = m.translate - scene.frame.origin;
  mesh.positions.reserve(mesh.positions.size() + m.vertices.size());
  for (const Vec3& v : m.vertices) mesh.positions.push_back(v * m.scale + offset);

  std::vector<std::vector<std::uint32_t>> rings;
  for (const ModelPolygon& p : m.polygons) {
    if (is_triangle(m, p)) {  // as triangulate() has it; surface models have millions of them
      const std::uint32_t* c = m.corners.data() + m.ring_begin[p.first_ring];
      mesh.triangles.push_back({first_vertex + c[0], first_vertex + c[1], first_vertex + c[2]});
      scene.surface_of.push_back(first_surface + p.surface);
      ++m.report.triangles;
      continue;
    }
    rings.clear();
    for (std::uint32_t r = p.first_ring; r < p.last_ring; ++r) {
      auto& ring = rings.emplace_back();
      for (std::uint32_t c = m.ring_begin[r]; c < m.ring_begin[r + 1]; ++c) {
        ring.push_back(first_vertex + m.corners[c]);
      }
    }
    const Triangulation result = triangulate(mesh.positions, rings);
    for (const Triangle& t : result.triangles) {
      mesh.triangles.push_back(t);
      scene.surface_of.push_back(first_surface + p.surface);
    }
    m.report.triangles += result.triangles.size();
    if (result.problem.empty()) continue;
    warn(scene.warnings,
         result.triangles.empty()
             ? "Polygons of fewer than 3 distinct corners or without an area were left out."
             : "Polygons that are not simple could not be triangulated exactly.",
         fmt::format("{}: {}", name_of(m, p), result.problem));
  }
  for (Surface& s : m.surfaces) {
    s.file = file;
    scene.surfaces.push_back(std::move(s));
  }
  append(scene.warnings, m.warnings);
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
  const WeldReport report = weld(scene.mesh, scene.surface_of);
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

// What a local file says, or is told, of its site and of true north.
std::optional<Site> site_of(const SceneFile& f) {
  if (f.told.site) return f.told.site;
  if (f.model->site) return Site(*f.model->site);
  return std::nullopt;
}
std::optional<double> north_of(const SceneFile& f) {
  return f.told.north ? f.told.north : f.model->north;
}

bool is_read_first(const SceneFile& f) {
  return f.format != FileFormat::footprints && f.format != FileFormat::raster;
}

// Footprints and heights above ground need a ground to stand on, so that all else comes first.
bool stands_on_others(const SceneFile& f) {
  return f.format == FileFormat::footprints || f.above_ground;
}

// The CRS of a file's coordinates: its own, or the one it is told; empty for a local model. A local
// format that has a site is not told the CRS that is meant for the others.
std::string crs_of(const SceneFile& f, bool others_georeferenced) {
  if (!f.model->report.crs.empty()) return f.model->report.crs;
  if (f.crs_of_its_own) return short_crs(f.told.crs);
  if (!is_georeferenced(f.format) && (f.site_of_its_own || (site_of(f) && others_georeferenced))) {
    return "";
  }
  return short_crs(f.told.crs);
}

// True if some file has the coordinates of a map, so that local ones have to be placed among them.
// What is not read yet are maps.
bool has_georeferenced(const std::vector<SceneFile>& files) {
  return std::any_of(files.begin(), files.end(), [](const SceneFile& f) {
    return !f.model || !f.model->report.crs.empty() || f.crs_of_its_own ||
           (is_georeferenced(f.format) && !f.told.crs.empty());
  });
}

// A CRS in which a scene can be: the one given, or for maps in degrees the UTM zone of the point.
// Other models have one unit for all three axes, which cannot be degrees.
Result<std::string> projected(const std::string& crs, const SceneFile& f, const Vec3& at) {
  if (!is_georeferenced(f.format) || !is_geographic_crs(crs)) return crs;
  return utm_crs(Place{at.y * kDegree, at.x * kDegree, 0});
}

// A scene under construction.
struct Builder {
  LoadedScene loaded;
  std::string crs;              // empty: local coordinates
  std::optional<ModelBox> box;  // of what is in it, CRS coordinates
  std::string first;            // the file that came first, for messages
  bool first_is_placed = true;  // by a CRS or a site
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
  add_model(scene, m, number);
  return std::nullopt;
}

// The CRS of the scene, or none; what a raster or footprints alone have is known once they are
// read.
Result<std::string> scene_crs(const std::vector<SceneFile>& files, bool georeferenced) {
  std::optional<Site> site;
  std::optional<double> north;
  bool differ = false;
  for (const SceneFile& f : files) {
    if (!f.model) continue;
    const std::string crs = crs_of(f, georeferenced);
    if (!crs.empty()) {
      const auto box = box_of(*f.model);
      return projected(crs, f, box ? (box->low + box->high) / 2.0 : Vec3(0));
    }
    const auto here = site_of(f);
    if (!here) continue;
    const double turned = north_of(f).value_or(0);
    if (site && (here->place.latitude != site->place.latitude ||
                 here->place.longitude != site->place.longitude || turned != *north)) {
      differ = true;
    }
    if (!site) site = here, north = turned;
  }
  return differ ? utm_crs(site->place) : std::string();
}

// A model that is read goes to its place among the others.
std::optional<Error> place(SceneFile& f, const Builder& b, bool georeferenced,
                           const GroundAt& ground) {
  Model& m = *f.model;
  const std::string crs = crs_of(f, georeferenced);
  if (!crs.empty()) {
    if (f.site_of_its_own) {
      return Error{fmt::format(
          "{}: its coordinates are in {}, so that it cannot stand at a site as well; leave out its "
          "--site.",
          m.report.path, crs)};
    }
    if (b.crs.empty()) return std::nullopt;
    const auto box = box_of(m);
    if (!box || agree(crs, b.crs, (box->low + box->high) / 2.0)) {
      m.report.placed = "coordinates of " + crs;
      return std::nullopt;
    }
    m.report.placed = fmt::format("moved from {} to {}", crs, b.crs);
    return move_to_crs(m, crs, b.crs);
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

// Reads and places all files, those that stand on others last.
std::optional<Error> build(Builder& b, std::vector<SceneFile>& files, const LoadOptions& options) {
  for (SceneFile& f : files) {
    if (!is_read_first(f)) continue;
    tell(options, "reading " + f.path.filename().string());
    auto model = read_model(f, options, "", {});
    if (!model) return model.error();
    f.model = std::move(model).value();
    if (auto error = check_coordinates(*f.model)) return error;
  }
  if (auto error = check_lod(files, options)) return error;
  const bool georeferenced = has_georeferenced(files);
  auto crs = scene_crs(files, georeferenced);
  if (!crs) return crs.error();
  b.crs = std::move(crs).value();

  // Files that know their coordinates come first, then those that are put at a site, then those
  // that stand on the others.
  const auto rank = [&](const SceneFile& f) {
    const bool local = f.model && crs_of(f, georeferenced).empty();
    const auto site = local ? site_of(f) : std::nullopt;
    return stands_on_others(f) || (site && site->on_ground && georeferenced) ? 2 : site ? 1 : 0;
  };
  std::vector<int> ranks;
  for (const SceneFile& f : files) ranks.push_back(rank(f));
  for (const int now : {0, 1, 2}) {
    const GroundAt ground = now == 2 && b.box ? ground_of(b.loaded.scene) : GroundAt();
    for (std::size_t k = 0; k < files.size(); ++k) {
      SceneFile& f = files[k];
      if (ranks[k] != now) continue;
      if (!f.model) {
        tell(options, "reading " + f.path.filename().string());
        auto model = read_model(f, options, b.crs, ground);
        if (!model) return model.error();
        f.model = std::move(model).value();
        if (b.crs.empty()) b.crs = f.model->report.crs;
      } else if (b.crs.empty() && georeferenced && site_of(f)) {
        b.crs = utm_crs(site_of(f)->place);
      }
      if (auto error = place(f, b, georeferenced, ground)) return error;
      const bool placed = !crs_of(f, georeferenced).empty() || site_of(f).has_value();
      if (auto error = add_file(b, f, static_cast<std::uint32_t>(k), placed)) return error;
    }
  }
  return std::nullopt;
}

// Heights above the ground that nobody calls so are taken for absolute ones, which looks right at
// the sea.
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
           "above the "
           "ground, name it with --above-ground.",
           lower.path.filename().string());
    }
  }
}

// A model this small, in metres, has the wrong unit: nothing is left of it at any pixel size.
constexpr double kSmallestModel = 1e-3;
// And one this small most likely.
constexpr double kSmallModel = 0.5;

std::optional<Error> check_size(const Builder& b, Warnings& warnings) {
  const Vec3 size = b.box->high - b.box->low;
  const double largest = std::max({size.x, size.y, size.z});
  if (largest < kSmallestModel) {
    return Error{fmt::format("{}: the model is {:.3g} m large; say its unit with --unit.", b.first,
                             largest)};
  }
  if (largest < kSmallModel) {
    warn(warnings,
         fmt::format("The model is {:.3g} m large; if that is not so, say its unit with --unit.",
                     largest),
         b.first);
  }
  return std::nullopt;
}

// A CRS that was named for the files that name none, where all of them do.
std::optional<Error> check_crs_used(const std::vector<SceneFile>& files, const Builder& b,
                                    const LoadOptions& options) {
  if (options.crs.empty()) return std::nullopt;
  for (const SceneFile& f : files) {
    if (f.model->report.crs.empty()) return std::nullopt;
  }
  const std::string given = short_crs(options.crs);
  if (b.box && agree(given, b.crs, (b.box->low + b.box->high) / 2.0)) return std::nullopt;
  return Error{fmt::format("{}: its CRS is {}, but --crs says {}; leave out --crs.",
                           files[0].model->report.path, files[0].model->report.crs, given)};
}

// CRS, place and true north of the scene, whose origin is known. In a scene with a CRS, the site
// and north of local models have done their work; where there is no local model they override the
// CRS's.
std::optional<Error> place_scene(LoadedScene& loaded, const std::vector<SceneFile>& files,
                                 bool georeferenced, const LoadOptions& options) {
  Frame& frame = loaded.scene.frame;
  bool any_at_site = false;
  for (const SceneFile& f : files) {
    const bool local = crs_of(f, georeferenced).empty() && f.model->report.crs.empty();
    any_at_site = any_at_site || (local && site_of(f));
  }
  if (!frame.crs.empty()) {
    const auto found = locate(frame.crs, frame.origin);
    if (!found) return found.error();
    const CrsPlace& at = found.value();
    if (at.metres_per_unit != 1.0) {
      return Error{fmt::format(
          "the CRS {} ({}) is not in metres (its unit is {} m), which Gnomon does not read yet; "
          "reproject the model to a CRS in metres.",
          frame.crs, at.name, at.metres_per_unit)};
    }
    frame.place = at.place;
    frame.true_north = at.true_north;
    loaded.place_by = "the CRS";
    loaded.north_by = "meridian convergence of the CRS";
    if (any_at_site) return std::nullopt;
    if (options.site) {
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
  if (auto error = check_size(builder, scene.warnings)) return *error;
  if (auto error = check_crs_used(files, builder, options)) return *error;
  warn_of_overlapping_surfaces(files, scene.warnings);
  scene.frame.crs = builder.crs;
  if (auto error = place_scene(loaded, files, has_georeferenced(files), options)) return *error;

  bool any_local = false;
  for (SceneFile& f : files) {
    any_local = any_local || !is_georeferenced(f.format);
    loaded.files.push_back(std::move(f.model->report));
  }
  if (!any_local && (options.up || !options.unit.empty())) {
    warn(scene.warnings,
         "--up and --unit were not used: these files say themselves what their axes are.", "");
  }

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
