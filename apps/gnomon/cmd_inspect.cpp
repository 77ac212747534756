// gnomon inspect: what is in the models, and what is wrong with them.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <gnomon/io/crs.h>
#include <gnomon/io/load_scene.h>
#include <gnomon/io/read_text.h>
#include <gnomon/mesh/report.h>

#include "commands.h"
#include "model_options.h"

namespace gnomon::app {
namespace {

// Rows of a table on the terminal; all of them are in the JSON.
constexpr std::size_t kMostRows = 12;
// Components that are named one by one.
constexpr std::size_t kMostWorst = 10;
constexpr std::array<SurfaceKind, 5> kKinds = {SurfaceKind::solid, SurfaceKind::inside_out,
                                               SurfaceKind::non_manifold, SurfaceKind::mis_wound,
                                               SurfaceKind::open};

struct Options {
  Common common;
  ModelOptions model;
  bool json = false;
};

// Surfaces that share a name (a type, a semantic surface, a material).
struct Share {
  std::string name;  // empty: those that have none
  std::size_t objects = 0;
  std::size_t triangles = 0;
  double area = 0;  // square metres
};

struct Inspection {
  LoadedScene loaded;
  std::string crs_name;                                          // empty without CRS
  double metres_low[3] = {0, 0, 0}, metres_high[3] = {0, 0, 0};  // the model's box, in its CRS
  std::size_t vertices = 0;
  std::vector<Share> types, semantics, materials;
  std::size_t casting = 0, receiving = 0;  // triangles, ground included
  MeshReport mesh;                         // of the model without the ground
  std::array<std::size_t, 5> triangles_of_kind{};
  std::vector<std::uint32_t> worst;      // components with faults, most faulty edges first
  std::vector<std::string> worst_names;  // the objects that they belong to
  double load_ms = 0;                    // milliseconds from the files to the scene
};

double triangle_area(const TriMesh& mesh, const Triangle& t) {
  const Vec3 a = mesh.positions[t[1]] - mesh.positions[t[0]],
             b = mesh.positions[t[2]] - mesh.positions[t[0]];
  return std::hypot(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x) / 2;
}

struct Gathered {
  std::set<std::string> objects;
  std::size_t triangles = 0;
  double area = 0;
};

std::vector<Share> sorted_shares(const std::map<std::string, Gathered>& by_name) {
  std::vector<Share> shares;
  for (const auto& [name, g] : by_name) {
    shares.push_back({name, g.objects.size(), g.triangles, g.area});
  }
  std::stable_sort(shares.begin(), shares.end(),
                   [](const Share& a, const Share& b) { return a.triangles > b.triangles; });
  return shares;
}

std::size_t faults(const EdgeCounts& c) { return c.boundary + c.non_manifold + c.mis_wound; }

// The object of the component's first triangle, and how many others it has.
std::vector<std::string> names_of(const Scene& scene, const MeshReport& report,
                                  const std::vector<std::uint32_t>& surface_of,
                                  const std::vector<std::uint32_t>& components) {
  std::map<std::uint32_t, std::set<std::string>> objects;
  for (const std::uint32_t c : components) objects[c];
  for (std::size_t t = 0; t < surface_of.size(); ++t) {
    const auto at = objects.find(report.component_of[t]);
    if (at == objects.end()) continue;
    const Surface& s = scene.surfaces[surface_of[t]];
    at->second.insert(!s.object.empty() ? s.object : s.group);
  }
  std::vector<std::string> names;
  for (const std::uint32_t c : components) {
    const Surface& s = scene.surfaces[surface_of[report.components[c].first_triangle]];
    std::string name = !s.object.empty() ? s.object : s.group;
    name = name.empty() ? "(no name)" : in_quotes(name, 100);
    const std::size_t n = objects[c].size();
    if (n > 1) name += fmt::format(" and {} more", n - 1);
    names.push_back(name);
  }
  return names;
}

Inspection inspect(LoadedScene loaded) {
  Inspection out;
  out.loaded = std::move(loaded);
  const Scene& scene = out.loaded.scene;
  if (!scene.frame.crs.empty()) {
    if (const auto at = locate(scene.frame.crs, scene.frame.origin)) out.crs_name = at.value().name;
  }

  TriMesh model;  // without the ground
  model.positions = scene.mesh.positions;
  std::vector<std::uint32_t> surface_of;
  std::map<std::string, Gathered> types, semantics, materials;
  for (int k = 0; k < 3; ++k) {
    out.metres_low[k] = std::numeric_limits<double>::infinity();
    out.metres_high[k] = -out.metres_low[k];
  }
  std::vector<std::uint8_t> used(model.positions.size(), 0);
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    out.casting += casts(scene, t);
    out.receiving += receives(scene, t);
    if (is_made_ground(scene.surfaces[scene.surface_of[t]])) continue;
    const Triangle& v = scene.mesh.triangles[t];
    const Surface& s = scene.surfaces[scene.surface_of[t]];
    model.triangles.push_back(v);
    surface_of.push_back(scene.surface_of[t]);
    const double area = triangle_area(scene.mesh, v);
    const auto gather = [&](Gathered& g) {
      ++g.triangles;
      g.area += area;
      g.objects.insert(s.object);
    };
    gather(types[s.group]);
    gather(semantics[s.semantic]);
    gather(materials[s.material]);
    for (const std::uint32_t i : v) {
      if (!used[i]) ++out.vertices;
      used[i] = 1;
      for (int k = 0; k < 3; ++k) {
        const double c = model.positions[i][k] + scene.frame.origin[k];
        out.metres_low[k] = std::min(out.metres_low[k], c);
        out.metres_high[k] = std::max(out.metres_high[k], c);
      }
    }
  }
  out.types = sorted_shares(types);
  out.semantics = sorted_shares(semantics);
  out.materials = sorted_shares(materials);

  out.mesh = report_mesh(model, build_edge_table(model));
  for (std::uint32_t c = 0; c < out.mesh.components.size(); ++c) {
    const Component& component = out.mesh.components[c];
    out.triangles_of_kind[static_cast<std::size_t>(component.kind)] += component.counts.triangles;
    if (faults(component.counts) > 0 || component.kind == SurfaceKind::inside_out) {
      out.worst.push_back(c);
    }
  }
  std::stable_sort(out.worst.begin(), out.worst.end(), [&](std::uint32_t a, std::uint32_t b) {
    return faults(out.mesh.components[a].counts) > faults(out.mesh.components[b].counts);
  });
  if (out.worst.size() > kMostWorst) out.worst.resize(kMostWorst);
  out.worst_names = names_of(scene, out.mesh, surface_of, out.worst);
  return out;
}

// ---- for people ------------------------------------------------------------------------------

std::string row(const std::string& label, const std::string& value) {
  return fmt::format("  {:<14}{}\n", label, value);
}

std::string counted(std::size_t n, const std::string& what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : ", ") + w;
  return text;
}

std::string table(const std::string& title, const std::vector<Share>& shares) {
  // A table that only says that nothing has a name says nothing.
  if (shares.size() == 1 && shares[0].name.empty()) return "";
  std::size_t width = 24;
  for (std::size_t k = 0; k < std::min(kMostRows, shares.size()); ++k) {
    width = std::max(width, std::min<std::size_t>(40, shares[k].name.size() + 2));
  }
  std::string text =
      fmt::format("\n{:<{}}{:>10}{:>12}{:>16}\n", title, width + 2, "objects", "triangles", "area");
  for (std::size_t k = 0; k < shares.size(); ++k) {
    if (k == kMostRows) {
      text += fmt::format("  and {} more (all of them: --json)\n", shares.size() - k);
      break;
    }
    const Share& s = shares[k];
    std::string name = s.name.empty() ? "(none)" : in_quotes(s.name, 36);
    if (name.size() > 2 && name.front() == '"') name = name.substr(1, name.size() - 2);
    text += fmt::format("  {:<{}}{:>10}{:>12}{:>13.1f} m2\n", name, width, s.objects, s.triangles,
                        s.area);
  }
  return text;
}

std::string file_text(const FileReport& f) {
  std::string text = f.path + "\n" + row("format", f.format);
  text += row("CRS", f.crs.empty() ? "none in the file" : f.crs);
  if (!f.axes.empty()) text += row("axes", f.axes);
  if (!f.placed.empty()) text += row("placed", f.placed);
  if (!f.lods.empty()) text += row("LoD", joined(f.lods) + " found; " + f.lod_used + " used");
  text += row("contents", counted(f.objects, "object") + ", " + counted(f.surfaces, "polygon") +
                              ", " + counted(f.triangles, "triangle"));
  if (f.stored_twice > 0) {
    text += row("stored twice", counted(f.stored_twice, "polygon") + ", counted once");
  }
  return text + "\n";
}

std::string place_text(const Inspection& in) {
  const Frame& frame = in.loaded.scene.frame;
  std::string text;
  if (frame.crs.empty()) {
    text += row("CRS", "none: local coordinates; name it with --crs EPSG:...");
  } else {
    text += row("CRS", frame.crs.size() > 60
                           ? in.crs_name
                           : frame.crs + (in.crs_name.empty() ? "" : "  " + in.crs_name));
  }
  if (frame.place) {
    const double latitude = frame.place->latitude / kDegree;
    const double longitude = frame.place->longitude / kDegree;
    text += row("place",
                fmt::format("{:.6f} {}, {:.6f} {}, height {:.1f} m{}", std::abs(latitude),
                            latitude < 0 ? 'S' : 'N', std::abs(longitude),
                            longitude < 0 ? 'W' : 'E', frame.place->height,
                            in.loaded.place_by.empty() ? "" : " (" + in.loaded.place_by + ")"));
  } else {
    text += row("place", "none: the sun needs one; give --crs, or --site LAT,LON");
  }
  const double north = frame.true_north / kDegree;
  std::string way = north < 0 ? "counter-clockwise" : "clockwise";
  text += row("true north", fmt::format("{:.4f} degrees {} from +y ({})", std::abs(north), way,
                                        in.loaded.north_by));
  const double* a = in.metres_low;
  const double* b = in.metres_high;
  text += row("size", fmt::format("{:.2f} m east, {:.2f} m north, {:.2f} m high", b[0] - a[0],
                                  b[1] - a[1], b[2] - a[2]));
  const char* names[3] = {"x (east)", "y (north)", "z (height)"};
  for (int k = 0; k < 3; ++k) {
    text += row(names[k], fmt::format("{:.3f} to {:.3f} m", a[k], b[k]));
  }
  return text;
}

std::string mesh_text(const Inspection& in) {
  const MeshReport& m = in.mesh;
  std::string text =
      fmt::format("\n{:<26}{:>10}{:>12}\n", "Mesh, without the ground", "components", "triangles");
  const char* meaning[5] = {"closed, outwards: can be counted with weight 1", "closed, inwards",
                            "more than two triangles at an edge",
                            "neighbours wound against each other", "has a boundary"};
  for (const SurfaceKind kind : kKinds) {
    const auto k = static_cast<std::size_t>(kind);
    if (m.of_kind[k] == 0) continue;
    text += fmt::format("  {:<24}{:>10}{:>12}   {}\n", name_of(kind), m.of_kind[k],
                        in.triangles_of_kind[k], meaning[k]);
  }
  text += fmt::format("  {:<24}{:>10}{:>12}\n", "all", m.components.size(), m.total.triangles);
  text += fmt::format(
      "  {} edges: {} boundary, {} non-manifold, {} mis-wound. Shadows are exact for all of "
      "them.\n",
      m.total.edges, m.total.boundary, m.total.non_manifold, m.total.mis_wound);
  if (in.worst.empty()) return text;
  text += fmt::format("\n{:<15}{:>10}{:>10}{:>14}{:>11}   {}\n", "Worst components", "triangles",
                      "boundary", "non-manifold", "mis-wound", "object");
  for (std::size_t k = 0; k < in.worst.size(); ++k) {
    const Component& c = m.components[in.worst[k]];
    text += fmt::format("  {:<14}{:>10}{:>10}{:>14}{:>11}   {}\n", name_of(c.kind),
                        c.counts.triangles, c.counts.boundary, c.counts.non_manifold,
                        c.counts.mis_wound, in.worst_names[k]);
  }
  return text;
}

std::string as_text(const Inspection& in) {
  const Scene& scene = in.loaded.scene;
  std::string text;
  for (const FileReport& f : in.loaded.files) text += file_text(f);
  text += "Scene\n" + place_text(in);
  text += row("triangles", fmt::format("{} over {} vertices, after welding",
                                       in.mesh.total.triangles, in.vertices));
  const GroundReport& ground = in.loaded.ground;
  text += row(
      "ground",
      ground.kind + (ground.triangles > 0 ? fmt::format(", {} triangles", ground.triangles) : ""));
  const std::size_t all = scene.mesh.triangles.size();
  if (in.casting != all || in.receiving != all) {
    text += row("selected", fmt::format("{} of {} triangles cast, {} receive (ground included)",
                                        in.casting, all, in.receiving));
  }
  const bool any_city =
      std::any_of(in.loaded.files.begin(), in.loaded.files.end(),
                  [](const FileReport& f) { return f.format.starts_with("CityJSON"); });
  text += table(any_city ? "Objects by type" : "Groups", in.types);
  text += table("Semantic surfaces", in.semantics);
  text += table("Materials", in.materials);
  text += mesh_text(in);

  if (scene.warnings.empty()) return text + "\nNo warnings.\n";
  text += "\nWarnings\n";
  for (const Warning& w : scene.warnings) {
    text += fmt::format("  {:>7} x  {}\n", w.count, w.what);
    if (!w.first.empty()) text += fmt::format("             first: {}\n", w.first);
  }
  return text;
}

// ---- for programs ----------------------------------------------------------------------------

using Json = nlohmann::ordered_json;

Json shares_json(const std::vector<Share>& shares) {
  Json all = Json::array();
  for (const Share& s : shares) {
    all.push_back({{"name", s.name},
                   {"objects", s.objects},
                   {"triangles", s.triangles},
                   {"area_m2", s.area}});
  }
  return all;
}

Json edges_json(const EdgeCounts& c) {
  return {{"triangles", c.triangles}, {"edges", c.edges},
          {"boundary", c.boundary},   {"non_manifold", c.non_manifold},
          {"mis_wound", c.mis_wound}, {"unbalanced", c.unbalanced}};
}

Json mesh_json(const Inspection& in) {
  Json mesh = edges_json(in.mesh.total);
  mesh["components"] = in.mesh.components.size();
  mesh["weight_one_triangles"] = in.mesh.weight_one_triangles;
  for (const SurfaceKind kind : kKinds) {
    const auto k = static_cast<std::size_t>(kind);
    mesh["kinds"][name_of(kind)] = {{"components", in.mesh.of_kind[k]},
                                    {"triangles", in.triangles_of_kind[k]}};
  }
  mesh["classification"] = classification(in.mesh);
  mesh["worst"] = Json::array();
  for (std::size_t k = 0; k < in.worst.size(); ++k) {
    const Component& c = in.mesh.components[in.worst[k]];
    Json one = edges_json(c.counts);
    one["kind"] = name_of(c.kind);
    one["object"] = in.worst_names[k];
    // The volume of a surface that is not closed depends on where it is measured from.
    one["volume_m3"] = c.counts.unbalanced == 0 ? Json(c.volume) : Json();
    mesh["worst"].push_back(one);
  }
  return mesh;
}

std::string as_json(const Inspection& in) {
  const Scene& scene = in.loaded.scene;
  const Frame& frame = scene.frame;
  Json json;
  json["files"] = Json::array();
  for (const FileReport& f : in.loaded.files) {
    json["files"].push_back({{"path", f.path},
                             {"format", f.format},
                             {"crs", f.crs.empty() ? Json() : Json(f.crs)},
                             {"axes", f.axes},
                             {"placed", f.placed},
                             {"lods", f.lods},
                             {"lod_used", f.lod_used},
                             {"objects", f.objects},
                             {"polygons", f.surfaces},
                             {"triangles", f.triangles},
                             {"stored_twice", f.stored_twice}});
  }
  json["crs"] = frame.crs.empty() ? Json() : Json(frame.crs);
  json["crs_name"] = in.crs_name.empty() ? Json() : Json(in.crs_name);
  json["place"] = frame.place ? Json({{"latitude_deg", frame.place->latitude / kDegree},
                                      {"longitude_deg", frame.place->longitude / kDegree},
                                      {"height_m", frame.place->height}})
                              : Json();
  json["origin"] = {frame.origin.x, frame.origin.y, frame.origin.z};
  json["true_north_deg"] = frame.true_north / kDegree;
  json["extent"] = {{"low", in.metres_low}, {"high", in.metres_high}};
  json["triangles"] = in.mesh.total.triangles;
  json["vertices"] = in.vertices;
  json["ground"] = {{"kind", in.loaded.ground.kind}, {"triangles", in.loaded.ground.triangles}};
  json["casting_triangles"] = in.casting;
  json["receiving_triangles"] = in.receiving;
  json["groups"] = shares_json(in.types);
  json["semantics"] = shares_json(in.semantics);
  json["materials"] = shares_json(in.materials);
  json["mesh"] = mesh_json(in);
  json["warnings"] = Json::array();
  for (const Warning& w : scene.warnings) {
    json["warnings"].push_back({{"what", w.what}, {"count", w.count}, {"first", w.first}});
  }
  json["milliseconds"] = {{"load", in.load_ms}};
  json["version"] = GNOMON_VERSION;
  // Names in files need not be UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void run(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  LoadedScene loaded = read_models(options.model, options.common.quiet);
  const std::chrono::duration<double, std::milli> load = std::chrono::steady_clock::now() - start;
  Inspection in = inspect(std::move(loaded));
  in.load_ms = load.count();
  fmt::print("{}", options.json ? as_json(in) : as_text(in));
}

}  // namespace

void add_inspect(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("inspect", "What is in model files, and what is wrong with them");
  add_model_options(*command, options->model);
  command->add_flag("--json", options->json, "JSON")->group("Output");
  add_common(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace gnomon::app
