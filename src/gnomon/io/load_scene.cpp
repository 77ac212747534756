#include <fmt/format.h>
#include <gnomon/core/exact.h>
#include <gnomon/io/cityjson.h>
#include <gnomon/io/crs.h>
#include <gnomon/io/load_scene.h>
#include <gnomon/io/model.h>
#include <gnomon/io/obj.h>
#include <gnomon/io/read_text.h>
#include <gnomon/io/triangulate.h>
#include <gnomon/mesh/weld.h>
#include <gnomon/scene/select.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace gnomon {
namespace {

// How far the ground reaches around the model where nothing else is asked for: the shadow of a
// model is three times as long as it is high when the sun stands 18 degrees above the horizon.
constexpr double kGroundHeights = 3.0;
constexpr double kLeastGround = 20.0;  // metres, for models that are flat

enum class Format { kCityJson, kObj };

// By what is in the file; by its extension only where the text could be anything.
std::optional<Format> format_of(std::string_view text, const std::filesystem::path& path) {
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  if (start != std::string_view::npos && text[start] == '{') return Format::kCityJson;
  if (text.find('\0') != std::string_view::npos) return std::nullopt;
  while (!text.empty()) {  // an OBJ's first line that is no comment starts with one of its keywords
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(text.size(), end + 1));
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (line.empty() || line[0] == '#') continue;
    const std::string_view word = line.substr(0, line.find_first_of(" \t"));
    constexpr std::array<std::string_view, 14> kKeywords = {
        "v", "vn", "vt", "vp", "f", "o", "g", "s", "l", "p", "mtllib", "usemtl", "cstype", "mg"};
    if (std::find(kKeywords.begin(), kKeywords.end(), word) != kKeywords.end()) return Format::kObj;
    break;
  }
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  if (extension == ".obj") return Format::kObj;
  if (extension == ".json" || extension == ".jsonl") return Format::kCityJson;
  return std::nullopt;
}

std::optional<double> metres_per(const std::string& unit) {
  if (unit.empty() || unit == "m") return 1.0;
  if (unit == "cm") return 0.01;
  if (unit == "mm") return 0.001;
  if (unit == "ft") return 0.3048;
  if (unit == "in") return 0.0254;
  return std::nullopt;
}

Result<Model> read_model(const std::filesystem::path& path, const LoadOptions& options) {
  auto text = read_text(path);
  if (!text) return text.error();
  const auto format = format_of(text.value(), path);
  if (!format) {
    return Error{fmt::format("{}: the format is not known; CityJSON, CityJSONSeq and OBJ are read.",
                             path.string())};
  }
  if (*format == Format::kObj) {
    return read_obj(text.value(), path.string(), options.up ? options.up : 'y',
                    *metres_per(options.unit));
  }
  return read_cityjson(text.value(), path.string(), options.lod);
}

std::optional<Error> check_options(const LoadOptions& options) {
  if (options.up != 0 && options.up != 'y' && options.up != 'z') {
    return Error{"--up must be y or z."};
  }
  if (!metres_per(options.unit)) {
    return Error{
        fmt::format("--unit {} is not known; use m, cm, mm, ft or in.", in_quotes(options.unit))};
  }
  if (options.north && !std::isfinite(*options.north)) {
    return Error{"--north must be a finite number of degrees."};
  }
  if (const auto& e = options.ground_extent) {
    if (!(e->x0 < e->x1 && e->y0 < e->y1)) {
      return Error{"the ground's extent must have x0 < x1 and y0 < y1."};
    }
  }
  return std::nullopt;
}

std::optional<Error> check_lod(const std::vector<Model>& models, const LoadOptions& options) {
  if (options.lod.empty()) return std::nullopt;
  std::string found, files;
  bool any = false, city = false;
  for (const Model& m : models) {
    if (m.report.format == "OBJ") continue;
    city = true;
    any = any || !m.polygons.empty();
    files += (files.empty() ? "" : ", ") + m.report.path;
    for (const std::string& lod : m.report.lods) {
      if (fmt::format(", {},", found).find(fmt::format(", {},", lod)) == std::string::npos) {
        found += (found.empty() ? "" : ", ") + lod;
      }
    }
  }
  if (!city || any) return std::nullopt;
  return Error{fmt::format("{}: there is no geometry of LoD {}; found: {}.", files,
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
Vec3 origin_of(const Model& m) {
  Vec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const Vec3& v : m.vertices) {
    const Vec3 at = v * m.scale + m.translate;
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], at[k]);
      high[k] = std::max(high[k], at[k]);
    }
  }
  const Vec3 middle = (low + high) / 2.0;
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

// The one CRS of all files and of the options; empty if nobody names one.
Result<std::string> common_crs(const std::vector<Model>& models, const LoadOptions& options,
                               const Vec3& origin) {
  std::string crs = short_crs(options.crs), from = "--crs";
  for (const Model& m : models) {
    if (m.report.crs.empty()) continue;
    if (crs.empty()) {
      crs = m.report.crs;
      from = m.report.path;
    } else if (!agree(crs, m.report.crs, origin)) {
      return Error{fmt::format(
          "{}: its CRS is {}, but {} says {}; reproject one of them, or leave out --crs.",
          m.report.path, m.report.crs, from, crs)};
    }
  }
  return crs;
}

// CRS, place and true north of the scene, whose origin is known.
std::optional<Error> place_scene(Frame& frame, const LoadOptions& options) {
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
  }
  if (options.site) frame.place = *options.site;
  if (options.north) frame.true_north = *options.north;
  return std::nullopt;
}

// Appends the model's triangles to the scene.
void add_model(Scene& scene, Model& m) {
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
             ? "Polygons of fewer than 3 distinct corners were left out."
             : "Polygons that are not simple could not be triangulated exactly.",
         fmt::format("{}: {}", name_of(m, p), result.problem));
  }
  for (Surface& s : m.surfaces) scene.surfaces.push_back(std::move(s));
  append(scene.warnings, m.warnings);
}

// Welds, and warns of what went.
std::size_t weld_scene(Scene& scene) {
  const std::vector<std::uint32_t> before = scene.surface_of;
  const WeldReport report = weld(scene.mesh, scene.surface_of);
  const auto element = [&](std::size_t triangle) {
    const Surface& s = scene.surfaces[before[triangle]];
    return !s.object.empty()  ? fmt::format("object {}", in_quotes(s.object, 200))
           : !s.group.empty() ? fmt::format("group {}", in_quotes(s.group, 200))
                              : std::string();
  };
  warn(scene.warnings, "Triangles without area were dropped.",
       report.zero_area_triangles ? element(report.first_zero_area) : std::string(),
       report.zero_area_triangles);
  warn(scene.warnings, "Coordinates smaller than an atom were set to 0.", "",
       report.snapped_coordinates);
  return report.zero_area_triangles;
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

}  // namespace

Result<LoadedScene> load_scene(const std::vector<std::filesystem::path>& paths,
                               const LoadOptions& options) {
  if (paths.empty()) return Error{"no model file was given."};
  if (auto error = check_options(options)) return *error;

  std::vector<Model> models;
  for (const auto& path : paths) {
    auto model = read_model(path, options);
    if (!model) return model.error();
    models.push_back(std::move(model).value());
    if (auto error = check_coordinates(models.back())) return *error;
  }
  if (auto error = check_lod(models, options)) return *error;

  LoadedScene loaded;
  Scene& scene = loaded.scene;
  const auto first = std::find_if(models.begin(), models.end(),
                                  [](const Model& m) { return !m.polygons.empty(); });
  if (first == models.end()) {
    return Error{fmt::format("{}: there are no surfaces in it, so nothing that casts a shadow.",
                             names_of(paths))};
  }
  scene.frame.origin = origin_of(*first);
  auto crs = common_crs(models, options, scene.frame.origin);
  if (!crs) return crs.error();
  scene.frame.crs = std::move(crs).value();
  if (auto error = place_scene(scene.frame, options)) return *error;

  bool any_obj = false;
  for (Model& m : models) {
    if (m.polygons.empty()) warn(scene.warnings, "Files without surfaces.", m.report.path);
    any_obj = any_obj || m.report.format == "OBJ";
    add_model(scene, m);
    loaded.files.push_back(std::move(m.report));
  }
  if (!any_obj && (options.up || !options.unit.empty())) {
    warn(scene.warnings, "--up and --unit were not used: CityJSON files say these themselves.", "");
  }

  loaded.zero_area_triangles = weld_scene(scene);
  if (scene.mesh.triangles.empty()) {
    return Error{fmt::format("{}: none of its surfaces has an area, so nothing casts a shadow.",
                             names_of(paths))};
  }
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

  const Selection selection{options.cast, options.no_cast, options.receive};
  if (auto error = select(scene, selection)) return *error;
  return loaded;
}

}  // namespace gnomon
