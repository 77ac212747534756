// gnomon verify: the counter against the oracles, sample by sample.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>

#include <gnomon/raster/count_shadows.h>
#include <gnomon/raster/visible_surfaces.h>
#include <gnomon/trace/embree_masks.h>
#include <gnomon/trace/exact_count.h>
#include <gnomon/trace/verification_cases.h>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "model_options.h"
#include "verify_lights.h"

namespace gnomon::app {
namespace {

constexpr double kLift = 1e-3;  // metres: how far "lifted" rays of Embree start before their sample
constexpr std::size_t kDescribed = 5;  // differing samples that are described

struct VerifyOptions {
  Common common;
  ModelOptions model;
  int suns = 8, points = 4, size = 512;
  std::vector<std::string> lights;
  std::vector<std::string> views = {"plan", "camera", "shadow"};
  std::string json;
};

// Sums over the lights of one kind in one view.
struct Row {
  std::string view, kind;
  int lights = 0;
  std::uint64_t samples = 0, shadow = 0;
  std::int32_t most = 0;        // the highest count
  std::int32_t before_eye = 0;  // the highest C(e)
  std::uint64_t ties = 0, exact_oracle = 0;
  std::uint64_t exact_ours = 0;
  std::uint64_t count_differences = 0, mask_differences = 0, receiver_differences = 0;
  // Of Embree, with and without lift; and how many of the lifted ones are samples whose receiver is
  // exactly edge-on to the light, where only the tie rule says which side is lit.
  std::uint64_t embree_lifted = 0, embree = 0, embree_edge_on = 0;
  double seconds_ours = 0, seconds_oracle = 0;
};

struct Difference {
  std::string view, light;
  int column, row;
  std::uint32_t triangle;
  std::int32_t ours, exact;
};

class Watch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::vector<NamedView> views_of(const VerifyOptions& o, const Oracle& oracle,
                                const std::vector<NamedLight>& lights) {
  std::vector<NamedView> views;
  for (const std::string& name : o.views) {
    if (name == "plan") views.push_back(whole_plan(*oracle.scene, o.size));
    if (name == "camera") views.push_back(aerial_camera(*oracle.scene, o.size));
    if (name != "shadow") continue;
    bool found = false;
    for (const NamedLight& light : lights) {
      const std::optional<NamedView> view = shaded_camera(oracle, light.light, o.size);
      if (!view) continue;
      views.push_back(*view);
      found = true;
      break;
    }
    if (!found && !o.common.quiet) {
      fmt::print(stderr,
                 "gnomon: none of the lights shades a place near the model's middle; no camera "
                 "stands in shadow\n");
    }
  }
  return views;
}

// The counts of all lights, each row-major.
std::vector<std::vector<std::int32_t>> our_counts(const Casters& casters,
                                                  const Receivers& receivers,
                                                  const std::vector<Light>& lights, int threads,
                                                  CountStats& stats) {
  std::vector<std::vector<std::int32_t>> counts(
      lights.size(), std::vector<std::int32_t>(receivers.triangle.size()));
  std::vector<std::int32_t*> to;
  for (std::vector<std::int32_t>& c : counts) to.push_back(c.data());
  stats = count_shadows(casters, receivers, lights, to, threads);
  return counts;
}

bool is_edge_on(const Scene& scene, std::uint32_t triangle, const Light& light) {
  const Triangle& t = scene.mesh.triangles[triangle];
  ExactStats stats;
  light_side(scene.mesh.positions[t[0]], scene.mesh.positions[t[1]], scene.mesh.positions[t[2]],
             snapped(light), stats);
  return stats.ties > 0;
}

struct Bench {  // what all views share
  const VerifyOptions& options;
  const Scene& scene;
  const Oracle& oracle;
  const Casters& casters;
  const EmbreeScene& embree;
};

void verify_view(const Bench& bench, const NamedView& view, const std::string& kind,
                 const std::vector<NamedLight>& lights, std::vector<Row>& rows,
                 std::vector<Difference>& differences) {
  const int threads = bench.options.common.threads;
  Row row;
  row.view = view.name;
  row.kind = kind;
  row.lights = static_cast<int>(lights.size());
  const Watch ours;
  const Receivers receivers = visible_surfaces(bench.scene, view.view, threads);
  std::vector<Light> all;
  for (const NamedLight& l : lights) all.push_back(l.light);
  CountStats stats;
  const std::vector<std::vector<std::int32_t>> counts =
      our_counts(bench.casters, receivers, all, threads, stats);
  row.seconds_ours = ours.seconds();
  row.exact_ours = stats.signs.exact + stats.spans.exact + stats.depths.exact;

  const Watch oracle;
  OracleStats oracle_stats;
  const std::vector<std::uint32_t> first = exact_receivers(bench.oracle, view.view, threads);
  for (std::size_t k = 0; k < first.size(); ++k)
    row.receiver_differences += first[k] != receivers.triangle[k] ? 1 : 0;
  const RayOrigins lifted = ray_origins(bench.scene, receivers, kLift, threads);
  const RayOrigins touching = ray_origins(bench.scene, receivers, 0, threads);
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const Light& light = lights[l].light;
    row.before_eye = std::max(row.before_eye, casters_before_eye(bench.oracle, view.view, light));
    const std::vector<std::int32_t> exact =
        exact_counts(bench.oracle, receivers, light, threads, &oracle_stats);
    const std::vector<std::uint8_t> with_lift =
        embree_mask(bench.embree, lifted, light, 8, threads);
    const std::vector<std::uint8_t> without =
        embree_mask(bench.embree, touching, light, 8, threads);
    for (std::size_t k = 0; k < exact.size(); ++k) {
      const std::int32_t n = counts[l][k];
      const bool dark = exact[k] > 0;
      row.shadow += dark ? 1 : 0;
      row.most = std::max(row.most, exact[k]);
      row.mask_differences += (n > 0) != dark ? 1 : 0;
      if ((with_lift[k] != 0) != dark) {
        ++row.embree_lifted;
        row.embree_edge_on += is_edge_on(bench.scene, receivers.triangle[k], light) ? 1 : 0;
      }
      row.embree += (without[k] != 0) != dark ? 1 : 0;
      if (n == exact[k]) continue;
      ++row.count_differences;
      if (differences.size() < kDescribed) {
        const int width = receivers.view.width;
        differences.push_back({view.name, lights[l].name, static_cast<int>(k) % width,
                               static_cast<int>(k) / width, receivers.triangle[k], n, exact[k]});
      }
    }
  }
  row.seconds_oracle = oracle.seconds();
  row.samples = oracle_stats.samples;
  row.ties = oracle_stats.signs.ties;
  row.exact_oracle = oracle_stats.signs.exact;
  rows.push_back(row);
}

std::string table(const std::string& model, std::size_t triangles, const std::vector<Row>& rows) {
  std::string text =
      "| model | triangles | view | lights | samples | in shadow | highest count | highest C(e) | "
      "ties | exact: ours | exact: oracle | "
      "other receivers | other counts | other masks | Embree, lifted 1 mm | of these "
      "edge-on | Embree | s ours | s oracles |\n"
      "|---|--:|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
  for (const Row& r : rows) {
    text += fmt::format(
        "| {} | {} | {} | {} {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | "
        "{} | {:.2f} | {:.2f} |\n",
        model, triangles, r.view, r.lights, r.kind, r.samples, r.shadow, r.most, r.before_eye,
        r.ties, r.exact_ours, r.exact_oracle, r.receiver_differences, r.count_differences,
        r.mask_differences, r.embree_lifted, r.embree_edge_on, r.embree, r.seconds_ours,
        r.seconds_oracle);
  }
  return text;
}

void write_json(const std::string& path, const std::string& model, std::size_t triangles,
                const std::vector<Row>& rows, const std::vector<Difference>& differences) {
  nlohmann::ordered_json out;
  out["model"] = model;
  out["triangles"] = triangles;
  out["lift_m"] = kLift;
  for (const Row& r : rows) {
    out["rows"].push_back({{"view", r.view},
                           {"lights", r.kind},
                           {"light_count", r.lights},
                           {"samples", r.samples},
                           {"shadow", r.shadow},
                           {"highest_count", r.most},
                           {"highest_eye_count", r.before_eye},
                           {"ties", r.ties},
                           {"exact_ours", r.exact_ours},
                           {"exact_oracle", r.exact_oracle},
                           {"receiver_differences", r.receiver_differences},
                           {"count_differences", r.count_differences},
                           {"mask_differences", r.mask_differences},
                           {"embree_lifted_differences", r.embree_lifted},
                           {"embree_lifted_edge_on", r.embree_edge_on},
                           {"embree_differences", r.embree},
                           {"seconds_ours", r.seconds_ours},
                           {"seconds_oracles", r.seconds_oracle}});
  }
  out["differences"] = nlohmann::ordered_json::array();
  for (const Difference& d : differences) {
    out["differences"].push_back({{"view", d.view},
                                  {"light", d.light},
                                  {"column", d.column},
                                  {"row", d.row},
                                  {"triangle", d.triangle},
                                  {"ours", d.ours},
                                  {"exact", d.exact}});
  }
  const std::string part = path + ".part";
  std::ofstream file(part);
  file << out.dump(2) << "\n";
  file.close();
  if (!file || std::rename(part.c_str(), path.c_str()) != 0) {
    throw Failure("--json " + path +
                  ": cannot be written; choose a folder that exists and is writable");
  }
}

std::string name_of(const std::vector<std::filesystem::path>& models) {
  std::string name;
  for (const std::filesystem::path& m : models)
    name += (name.empty() ? "" : " + ") + m.filename().string();
  return name;
}

void run(const VerifyOptions& o) {
  const LoadedScene loaded = read_models(o.model, o.common.quiet);
  const Scene& scene = loaded.scene;
  if (!o.common.quiet) print_warnings(scene.warnings);
  const Oracle oracle = build_oracle(scene);
  const Casters casters = prepare_casters(scene);
  Result<EmbreeScene> embree =
      EmbreeScene::build(scene, {.robust = true, .threads = o.common.threads});
  if (!embree) throw Failure(embree.error().message);

  std::vector<NamedLight> suns, points;
  if (o.lights.empty()) {
    suns = choose_suns(scene, o.suns);
    points = choose_points(oracle, o.points);
  }
  for (const std::string& text : o.lights) {
    const NamedLight light = parse_light(text);
    (light.light.w == 0 ? suns : points).push_back(light);
  }
  std::vector<NamedLight> all = suns;
  all.insert(all.end(), points.begin(), points.end());
  if (all.empty()) throw Failure("no lights: give --suns, --points or --light");

  const Bench bench{o, scene, oracle, casters, embree.value()};
  std::vector<Row> rows;
  std::vector<Difference> differences;
  for (const NamedView& view : views_of(o, oracle, all)) {
    if (!suns.empty()) verify_view(bench, view, "suns", suns, rows, differences);
    if (!points.empty()) verify_view(bench, view, "points", points, rows, differences);
  }
  const std::string model = name_of(o.model.models);
  if (!o.common.quiet) fmt::print("{}", table(model, scene.mesh.triangles.size(), rows));
  if (!o.json.empty()) write_json(o.json, model, scene.mesh.triangles.size(), rows, differences);

  std::uint64_t counts = 0, receivers = 0, compared = 0;
  for (const Row& r : rows) {
    counts += r.count_differences;
    receivers += r.receiver_differences;
    compared += r.samples;
  }
  for (const Difference& d : differences) {
    const Surface& s = scene.surfaces[scene.surface_of[d.triangle]];
    fmt::print(stderr,
               "gnomon: {}, {}: pixel column {}, row {}, triangle {} of object \"{}\": counted {}, "
               "exact count {}\n",
               d.view, d.light, d.column, d.row, d.triangle, s.object, d.ours, d.exact);
  }
  if (counts + receivers > 0) {
    throw Failure(fmt::format("{} of {} counts and {} receivers of {} differ from the exact ones",
                              counts, compared, receivers, model));
  }
  if (!o.common.quiet) fmt::print("\nAll {} counts equal the exact ones.\n", compared);
}

}  // namespace

void add_verify(CLI::App& app) {
  auto options = std::make_shared<VerifyOptions>();
  VerifyOptions& o = *options;
  CLI::App* command = app.add_subcommand(
      "verify", "Compare the counter with exact and ray-cast shadows, sample by sample");
  add_model_options(*command, o.model);
  command->add_option("--suns", o.suns, "Number of suns, chosen automatically")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_option("--points", o.points, "Number of point lights, chosen automatically")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_option("--light", o.lights,
                      "Instead of these: X,Y,Z[,sun|point], towards a sun or the place of a lamp, "
                      "in scene coordinates");
  command->add_option("--size", o.size, "Samples per side of each view")
      ->check(CLI::Range(1, 16384))
      ->capture_default_str();
  command
      ->add_option("--views", o.views,
                   "Any of plan, camera (outside), shadow (a camera inside a shadow)")
      ->delimiter(',')
      ->check(CLI::IsMember({"plan", "camera", "shadow"}));
  command->add_option("--json", o.json, "Also write the table to this file");
  add_common(*command, o.common);
  command->callback([options] { run(*options); });
}

}  // namespace gnomon::app
