// Silhouettes of random and of coherent lights: brute force, scalar and over all leaves of the tree
// of edges, the second paper's tree, and the tree of edges. What is timed: bench/README.md.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <random>

#include <glm/geometric.hpp>

#include <gnomon/io/load_scene.h>
#include <gnomon/profile/study_times.h>
#include <gnomon/silhouette/edge_tree.h>
#include <gnomon/silhouette/hextree.h>
#include <gnomon/silhouette/light_sides.h>
#include <scenes/generated_city.h>
#include <scenes/generated_sphere.h>

#include "report.h"

namespace gnomon::bench {
namespace {

struct Options {
  std::string data = "../shared/data", scenes = "scenes", out = "bench/results",
              name = "silhouettes";
  int lights = 200, rounds = 3;
  std::size_t most = 10500000;  // triangles; larger meshes are left out
};

struct Model {
  std::string name;
  std::function<TriMesh()> make;
  std::size_t about;  // triangles
};

// Loop's subdivision of a closed mesh, once: each triangle becomes four, vertices move to where the
// limit surface is smooth. (Charles Loop, Smooth subdivision surfaces based on triangles, 1987.)
TriMesh subdivided(const TriMesh& mesh) {
  const EdgeTable edges = build_edge_table(mesh);
  const auto n = static_cast<std::uint32_t>(mesh.positions.size());
  std::vector<Vec3> around(n, Vec3(0.0));
  std::vector<int> valence(n, 0);
  TriMesh out;
  out.positions.resize(n + edges.vertices.size());
  std::vector<std::uint32_t> of_edge(mesh.triangles.size() * 3);
  for (std::uint32_t e = 0; e < edges.vertices.size(); ++e) {
    const auto [a, b] = edges.vertices[e];
    Vec3 opposite(0.0);
    int sides = 0;
    for (std::uint32_t i = edges.first[e]; i < edges.first[e + 1]; ++i) {
      const std::uint32_t t = edges.incidence[i] >> 1;
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t v = mesh.triangles[t][k], w = mesh.triangles[t][(k + 1) % 3];
        if (std::min(v, w) == a && std::max(v, w) == b)
          of_edge[t * 3 + static_cast<std::uint32_t>(k)] = e;
        if (v != a && v != b) opposite += mesh.positions[v];
      }
      ++sides;
    }
    const Vec3 ends = mesh.positions[a] + mesh.positions[b];
    out.positions[n + e] = sides == 2 ? ends * 0.375 + opposite * 0.125 : ends * 0.5;
    around[a] += mesh.positions[b];
    around[b] += mesh.positions[a];
    ++valence[a];
    ++valence[b];
  }
  for (std::uint32_t v = 0; v < n; ++v) {
    const double k = valence[v], c = 0.375 + 0.25 * std::cos(2 * M_PI / k);
    const double beta = (0.625 - c * c) / k;
    out.positions[v] = mesh.positions[v] * (1 - k * beta) + around[v] * beta;
  }
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    const std::uint32_t m[3] = {n + of_edge[t * 3], n + of_edge[t * 3 + 1], n + of_edge[t * 3 + 2]};
    out.triangles.insert(
        out.triangles.end(),
        {{c[0], m[0], m[2]}, {m[0], c[1], m[1]}, {m[2], m[1], c[2]}, {m[0], m[1], m[2]}});
  }
  return out;
}

TriMesh loaded(const std::string& file) {
  LoadOptions alone;
  alone.ground = "none";
  Result<LoadedScene> scene = load_scene({std::filesystem::path(file)}, alone);
  if (!scene) throw std::runtime_error(scene.error().message);
  return std::move(scene.value().scene.mesh);
}

std::vector<Model> models(const Options& o) {
  std::vector<Model> out;
  const std::string spot = o.data + "/architecture/spot/spot_triangulated.obj";
  for (int level = 5; level <= 9; ++level) {
    out.push_back({fmt::format("sphere, level {}", level),
                   [=] { return scenes::generated_sphere(level, 10).mesh; },
                   std::size_t(20) << (2 * level)});
  }
  for (int times = 0; times <= 5; ++times) {
    out.push_back({times == 0 ? "Spot" : fmt::format("Spot, subdivided {} times", times),
                   [=] {
                     TriMesh m = loaded(spot);
                     for (int k = 0; k < times; ++k) m = subdivided(m);
                     return m;
                   },
                   std::size_t(5856) << (2 * times)});
  }
  for (const std::size_t triangles : {10000u, 100000u, 1000000u, 10000000u}) {
    out.push_back({"generated city",
                   [=] { return scenes::generated_city({.triangles = triangles}).mesh; },
                   triangles});
  }
  out.push_back({"Vienna", [=] { return loaded(o.scenes + "/vienna/vienna.city.jsonl"); }, 53892});
  out.push_back(
      {"propeller", [=] { return loaded(o.data + "/architecture/occt/propeller.stl"); }, 7403});
  return out;
}

// Suns and lamps in turn, lamps within three radii.
std::vector<Light> random_lights(const TriMesh& mesh, int count) {
  Vec3 lo = mesh.positions[0], hi = lo;
  for (const Vec3& p : mesh.positions) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  const double radius = glm::distance(lo, hi) / 2;
  std::mt19937 random(7);
  std::normal_distribution<double> g;
  std::vector<Light> out;
  for (int k = 0; k < count; ++k) {
    const Vec3 v(g(random), g(random), g(random));
    out.push_back(snapped(k % 2 == 0 ? direction(v) : point((lo + hi) * 0.5 + v * radius)));
  }
  return out;
}

// The sun over Vienna on a September day, minute by minute.
std::vector<Light> coherent_lights(int count) {
  const StudyTimes times{"2024-09-18", "09:00", "17:00", "60s", "Europe/Vienna"};
  const Samples samples = study_samples(times, {48.2 * kDegree, 16.37 * kDegree, 171}, 0).value();
  std::vector<Light> out;
  for (const TimeSample& s : samples.midpoints) {
    if (s.up && static_cast<int>(out.size()) < count) out.push_back(snapped(s.light));
  }
  return out;
}

template <class T>
std::size_t held(const std::vector<T>& v) {
  return v.capacity() * sizeof(T);
}
std::size_t memory(const EdgeTable& t) {
  return held(t.vertices) + held(t.first) + held(t.incidence);
}
std::size_t memory(const EdgeTree& t) {
  return held(t.nodes) + held(t.lines) + held(t.leaves) + held(t.triangle) + held(t.edges) +
         held(t.irregular_leaves) + held(t.irregular) + held(t.irregular_first) +
         held(t.irregular_plane);
}
std::size_t memory(const Hextree& t) {
  std::size_t sum = held(t.nodes) + held(t.duals) + held(t.edges) + memory(t.always);
  for (const Hextree::Node& n : t.nodes) sum += held(n.edges);
  return sum;
}

// Bytes a second that one thread reads, as fast as it can: the best of several rounds.
double read_bandwidth() {
  std::vector<std::uint64_t> data(std::size_t(32) << 20, 1);  // 256 MB, far above all caches
  double best = 0;
  std::uint64_t sum = 0;
  for (int round = 0; round < 8; ++round) {
    const Watch watch;
    std::uint64_t lanes[8] = {};
    for (std::size_t k = 0; k < data.size(); k += 8)
      for (std::size_t i = 0; i < 8; ++i) lanes[i] += data[k + i];
    best = std::max(best, double(data.size() * sizeof(data[0])) / watch.seconds());
    for (const std::uint64_t lane : lanes) sum += lane;
  }
  if (sum == 0) throw std::runtime_error("nothing was read");
  return best;
}

struct Method {
  std::string name;
  std::function<void(Silhouette&, const Light&, ExtractionStats*)> find;
  double build_seconds = 0;
  std::size_t bytes_held = 0;
  std::map<std::string, double> microseconds{}, bytes{};  // by kind of lights
};

std::uint64_t sum_of(const Silhouette& s) {
  std::uint64_t sum = 0;
  for (const SilhouetteEdge& e : s)
    sum += (e.a * 0x9e3779b97f4a7c15ull ^ e.b) * 0xd6e8feb86659fd93ull *
           static_cast<std::uint64_t>(static_cast<std::int64_t>(e.multiplicity));
  return sum;
}

void run(const Options& o) {
  const double bandwidth = read_bandwidth();
  std::string table = fmt::format(
      "# Silhouettes\n\nMicroseconds a light, one thread, medians of {} rounds over {} lights. "
      "random: suns and lamps in turn; coherent: the sun "
      "over Vienna, minute by minute. kB: read and written a light. Every method's edges were "
      "compared with brute force's in this run.\n\n"
      "Machine: {}; one thread reads {:.1f} GB/s at most (256 MB, in order).\n\n"
      "| model | triangles | silhouette edges, random | method | random, us | kB | coherent, us | "
      "kB | times faster than brute SIMD, random | coherent "
      "| GB/s, random | of the bandwidth | built in, ms | holds, bytes a triangle "
      "|\n|---|--:|--:|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
      o.rounds, o.lights, to_text(this_machine()), bandwidth / 1e9);
  nlohmann::ordered_json json{{"machine", to_json(this_machine())},
                              {"read_bandwidth", bandwidth},
                              {"models", nlohmann::ordered_json::array()}};
  for (const Model& model : models(o)) {
    if (model.about > o.most) continue;
    const TriMesh mesh = model.make();
    std::fprintf(stderr, "%s, %zu triangles\n", model.name.c_str(), mesh.triangles.size());
    const Watch table_watch;
    const EdgeTable edges = build_edge_table(mesh);
    const double table_seconds = table_watch.seconds();
    const Watch tree_watch;
    const EdgeTree tree = build_edge_tree(mesh, edges);
    const double tree_seconds = tree_watch.seconds();
    const Watch facets_watch;
    const Hextree facets = build_hextree(mesh, edges, DualForm::facets);
    const double facets_seconds = facets_watch.seconds();
    const Watch vertices_watch;
    const Hextree vertices = build_hextree(mesh, edges, DualForm::vertices);
    const double vertices_seconds = vertices_watch.seconds();
    ExtractionScratch scratch;
    std::vector<Method> methods;
    methods.push_back({"brute force, scalar",
                       [&](Silhouette& out, const Light& light, ExtractionStats* stats) {
                         out = find_silhouette(edges, light_sides(mesh, light));
                         if (stats == nullptr) return;
                         stats->bytes += mesh.triangles.size() * (sizeof(Triangle) + 1) +
                                         mesh.positions.size() * sizeof(Vec3) +
                                         edges.vertices.size() * 12 + edges.incidence.size() * 5 +
                                         out.size() * sizeof(SilhouetteEdge);
                       },
                       table_seconds, memory(edges)});
    methods.push_back({"brute force, SIMD",
                       [&](Silhouette& out, const Light& light, ExtractionStats* stats) {
                         find_silhouette_linear(out, tree, mesh, light, scratch, stats);
                       },
                       tree_seconds, memory(tree)});
    methods.push_back({"the paper's tree, facets",
                       [&](Silhouette& out, const Light& light, ExtractionStats* stats) {
                         find_silhouette(out, facets, mesh, light, stats);
                       },
                       facets_seconds, memory(facets)});
    methods.push_back({"the paper's tree, vertices",
                       [&](Silhouette& out, const Light& light, ExtractionStats* stats) {
                         find_silhouette(out, vertices, mesh, light, stats);
                       },
                       vertices_seconds, memory(vertices)});
    methods.push_back({"ours",
                       [&](Silhouette& out, const Light& light, ExtractionStats* stats) {
                         find_silhouette(out, tree, mesh, light, scratch, stats);
                       },
                       tree_seconds, memory(tree)});

    const std::map<std::string, std::vector<Light>> kinds{{"random", random_lights(mesh, o.lights)},
                                                          {"coherent", coherent_lights(o.lights)}};
    double found = 0;
    for (const auto& [kind, lights] : kinds) {
      std::vector<std::vector<double>> seconds(methods.size());
      Silhouette out;
      // Slow methods see fewer lights: every so many.
      for (int round = 0; round < o.rounds; ++round) {
        for (std::size_t m = 0; m < methods.size(); ++m) {
          const bool fast = methods[m].name == "ours";
          const std::size_t step =
              fast ? 1 : std::max<std::size_t>(1, mesh.triangles.size() / 50000);
          for (std::size_t k = 0; k < lights.size(); k += step) {
            const Watch watch;
            methods[m].find(out, lights[k], nullptr);
            seconds[m].push_back(watch.seconds());
          }
        }
      }
      for (std::size_t m = 0; m < methods.size(); ++m)
        methods[m].microseconds[kind] = 1e6 * median(seconds[m]);
      // What was read, and whether it is right.
      const std::size_t step = std::max<std::size_t>(1, lights.size() / 10);
      std::size_t looks = 0;
      for (std::size_t k = 0; k < lights.size(); k += step, ++looks) {
        std::uint64_t expected = 0;
        for (std::size_t m = 0; m < methods.size(); ++m) {
          ExtractionStats stats;
          methods[m].find(out, lights[k], &stats);
          methods[m].bytes[kind] += double(stats.bytes);
          if (m == 0) expected = sum_of(out);
          if (m == 0 && kind == "random") found += double(out.size());
          if (m != 3 && sum_of(out) != expected)
            throw std::runtime_error(methods[m].name + " finds another silhouette of " +
                                     model.name);
        }
      }
      for (Method& m : methods) m.bytes[kind] /= double(looks);
      if (kind == "random") found /= double(looks);
    }
    for (const Method& m : methods) {
      const double rate = m.bytes.at("random") / (m.microseconds.at("random") * 1e-6);
      table += fmt::format(
          "| {} | {} | {:.0f} | {} | {:.1f} | {:.0f} | {:.1f} | {:.0f} | {:.2f} | {:.2f} | {:.1f} "
          "| {:.0f} % | {:.0f} | {:.1f} |\n",
          model.name, mesh.triangles.size(), found, m.name, m.microseconds.at("random"),
          m.bytes.at("random") / 1e3, m.microseconds.at("coherent"), m.bytes.at("coherent") / 1e3,
          methods[1].microseconds.at("random") / m.microseconds.at("random"),
          methods[1].microseconds.at("coherent") / m.microseconds.at("coherent"), rate / 1e9,
          100 * rate / bandwidth, 1e3 * m.build_seconds,
          double(m.bytes_held) / double(mesh.triangles.size()));
      json["models"].push_back({{"model", model.name},
                                {"triangles", mesh.triangles.size()},
                                {"silhouette_edges", found},
                                {"method", m.name},
                                {"microseconds", m.microseconds},
                                {"bytes", m.bytes},
                                {"build_seconds", m.build_seconds},
                                {"bytes_held", m.bytes_held}});
    }
  }
  write_results(o.out, o.name, table, json);
}

}  // namespace
}  // namespace gnomon::bench

int main(int argc, char** argv) {
  gnomon::bench::Options o;
  CLI::App app("Silhouettes of random and of coherent lights, by every method.");
  app.add_option("--data", o.data, "Folder of real models");
  app.add_option("--scenes", o.scenes, "This project's scenes");
  app.add_option("--out", o.out, "Folder for the results");
  app.add_option("--name", o.name, "Name of the results");
  app.add_option("--lights", o.lights, "Lights of each kind")->check(CLI::Range(10, 480));
  app.add_option("--rounds", o.rounds, "Rounds, of which medians are taken")
      ->check(CLI::Range(1, 99));
  app.add_option("--most", o.most, "Leave out meshes of more triangles");
  CLI11_PARSE(app, argc, argv);
  try {
    gnomon::bench::run(o);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_silhouettes: %s\n", e.what());
    return 1;
  }
  return 0;
}
