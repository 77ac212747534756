#include "bench_silhouettes.h"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <gnomon/core/exact.h>
#include <gnomon/silhouette/edge_tree.h>
#include <gnomon/silhouette/hextree.h>
#include <gnomon/silhouette/light_sides.h>

#include <bench/report.h>

#include "bench_tables.h"
#include "commands.h"

namespace gnomon::app {
namespace {

// Only what casts: no method is to look at the rest.
TriMesh casters_of(const Scene& scene) {
  constexpr std::uint32_t kNone = ~0u;
  TriMesh out;
  std::vector<std::uint32_t> now(scene.mesh.positions.size(), kNone);
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (!casts(scene, t)) continue;
    Triangle corners = scene.mesh.triangles[t];
    for (std::uint32_t& v : corners) {
      if (now[v] == kNone) {
        now[v] = static_cast<std::uint32_t>(out.positions.size());
        out.positions.push_back(scene.mesh.positions[v]);
      }
      v = now[v];
    }
    out.triangles.push_back(corners);
  }
  return out;
}

struct Way {
  std::string name;
  std::function<void(Silhouette&, const Light&)> find;
  bool exact = true;
  double milliseconds = 0;  // mean over the suns
};
constexpr std::size_t kBrute = 0;
constexpr int kBuilds = 5;  // times at most that tables and trees are built, to take the median

// What a row says beside its times.
struct Found {
  double edges = 0, edges_by_vertices = 0, both = 0;  // means over the suns
};

bool before(const SilhouetteEdge& a, const SilhouetteEdge& b) {
  return std::pair(a.a, a.b) < std::pair(b.a, b.b);
}

// Untimed, which also warms up. Throws Failure where an exact way differs from brute force.
Found compare(const std::vector<Way>& ways, const std::vector<Light>& suns,
              const std::string& name) {
  Found sum;
  Silhouette expected, found, scratch;
  for (std::size_t k = 0; k < suns.size(); ++k) {
    ways[kBrute].find(expected, suns[k]);
    sum.edges += double(expected.size());
    for (const Way& way : ways) {
      if (&way == &ways[kBrute]) continue;
      way.find(found, suns[k]);
      sort_as_table(found, scratch);
      if (way.exact) {
        const bool same =
            std::equal(found.begin(), found.end(), expected.begin(), expected.end(),
                       [](const SilhouetteEdge& a, const SilhouetteEdge& b) {
                         return a.a == b.a && a.b == b.b && a.multiplicity == b.multiplicity;
                       });
        if (!same) {
          throw Failure(fmt::format(
              "{}: under sun {} of {}, {} finds {} silhouette edges that are not the {} of brute "
              "force; this is an error of Gnomon, please report it with the model",
              name, k + 1, suns.size(), way.name, found.size(), expected.size()));
        }
        continue;
      }
      Silhouette both;
      std::set_intersection(found.begin(), found.end(), expected.begin(), expected.end(),
                            std::back_inserter(both), before);
      sum.edges_by_vertices += double(found.size());
      sum.both += double(both.size());
    }
  }
  for (double* s : {&sum.edges, &sum.edges_by_vertices, &sum.both}) *s /= double(suns.size());
  return sum;
}

// All suns by one way, then by the next, round after round: each meets what else the machine does.
void measure(std::vector<Way>& ways, const std::vector<Light>& suns, int rounds) {
  std::vector<std::vector<std::vector<double>>> seconds(
      ways.size(), std::vector<std::vector<double>>(suns.size()));
  Silhouette out;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t w = 0; w < ways.size(); ++w) {
      for (std::size_t k = 0; k < suns.size(); ++k) {
        const bench::Watch watch;
        ways[w].find(out, suns[k]);
        seconds[w][k].push_back(watch.seconds());
      }
    }
  }
  for (std::size_t w = 0; w < ways.size(); ++w) {
    for (const std::vector<double>& of_sun : seconds[w])
      ways[w].milliseconds += 1e3 * bench::median(of_sun) / double(suns.size());
  }
}

struct Lines {
  std::string times, rest;
};

Lines measure_row(const PaperScene& r, int rounds) {
  const TriMesh mesh = casters_of(r.scene);
  if (mesh.triangles.empty()) throw Failure(r.name + ": nothing casts; choose another model");
  const std::vector<Light> suns = suns_of(r.day);
  std::vector<std::string> built;
  const auto timed = [&](auto make) {
    std::vector<double> seconds;
    for (int round = 0;; ++round) {
      const bench::Watch watch;
      auto made = make();
      seconds.push_back(watch.seconds());
      if (round + 1 < std::min(rounds, kBuilds)) continue;
      built.push_back(fmt::format("{:.1f}", 1e3 * bench::median(seconds)));
      return made;
    }
  };
  const EdgeTable edges = timed([&] { return build_edge_table(mesh); });
  const Hextree vertices = timed([&] { return build_hextree(mesh, edges, DualForm::vertices); });
  const Hextree facets = timed([&] { return build_hextree(mesh, edges, DualForm::facets); });
  const EdgeTree tree = timed([&] { return build_edge_tree(mesh, edges); });
  ExtractionScratch scratch;
  std::vector<Way> ways;
  ways.push_back({"brute force", [&](Silhouette& out, const Light& sun) {
                    out = find_silhouette(edges, light_sides(mesh, sun));
                  }});
  ways.push_back(
      {"dual space, vertices",
       [&](Silhouette& out, const Light& sun) { find_silhouette(out, vertices, mesh, sun); },
       false});
  ways.push_back({"dual space, facets", [&](Silhouette& out, const Light& sun) {
                    find_silhouette(out, facets, mesh, sun);
                  }});
  ways.push_back({"tree of edges", [&](Silhouette& out, const Light& sun) {
                    find_silhouette(out, tree, mesh, sun, scratch);
                  }});
  ways.push_back({"brute force, vectors", [&](Silhouette& out, const Light& sun) {
                    find_silhouette_linear(out, tree, mesh, sun, scratch);
                  }});
  const Found found = compare(ways, suns, r.name);
  measure(ways, suns, rounds);

  std::vector<std::string> cells{
      fmt::format("{} ({})", r.scene.mesh.triangles.size(), mesh.triangles.size())};
  for (const Way& way : ways) {
    cells.push_back(significant(way.milliseconds));
    if (&way != &ways[kBrute]) cells.push_back(ratio(way.milliseconds, ways[kBrute].milliseconds));
  }
  cells.push_back(r.paper ? fmt::format("{:.3f}", r.paper->brute) : "");
  cells.push_back(r.paper ? fmt::format("{:.3f}", r.paper->dual) : "");
  cells.push_back(r.paper ? ratio(r.paper->dual, r.paper->brute) : "");

  std::vector<std::string> rest{fmt::format("{:.1f} N, {}-{} {}, {} suns", r.day.latitude,
                                            r.day.from, r.day.to, r.day.zone, suns.size()),
                                fmt::format("{:.0f}", found.edges),
                                fmt::format("{:.0f}", found.edges_by_vertices),
                                fmt::format("{:.0f}", found.both)};
  for (const Hextree* t : {&vertices, &facets}) {
    const std::size_t all = t->edges.size();
    rest.push_back(
        all == 0 ? ""
                 : fmt::format("{:.0f} %", 100 * double(t->nodes[0].edges.size()) / double(all)));
  }
  rest.insert(rest.end(), built.begin(), built.end());
  return {row(r.name, cells), row(r.name, rest)};
}

}  // namespace

std::string bench_silhouettes(std::span<const PaperScene> scenes, int rounds, ProgressBar& bar,
                              double from, double to) {
  const double share = (to - from) / double(scenes.size());
  std::string times, rest;
  for (const PaperScene& scene : scenes) {
    const Lines lines = measure_row(scene, rounds);
    times += lines.times;
    rest += lines.rest;
    bar.show(from += share);
  }
  std::vector<std::string> columns{"number of triangles (casting)", "brute force, ms"};
  for (const char* way :
       {"dual space, vertices", "dual space, facets", "tree of edges", "brute force, vectors"}) {
    columns.push_back(std::string(way) + ", ms");
    columns.push_back("over brute force");
  }
  columns.insert(columns.end(),
                 {"*paper: brute force, ms*", "*dual space, ms*", "*over brute force*"});
  return fmt::format(
             "\n## Silhouettes: Geometry of shadows in real time, Tables 1 and 2\n\n"
             "A time is that of the silhouette alone, of the triangles that cast, on one thread: "
             "by brute force (light sides, then all edges); by the paper's dual space, a tree of "
             "depth {} as there, with duals of vertices as it prints them and with duals of "
             "facets; by Gnomon's tree of edges; and by brute force over that tree's leaves, in "
             "vectors. The sun is in the middle of each minute of the paper's hours. All suns by "
             "one method, then by the next, {} times over; a sun's time is the median of its {}, "
             "a scene's the mean of its suns. In this run, every method but the one with vertices "
             "found brute force's edges and multiplicities under every sun; vertices find the "
             "contour of a smooth surface, which are other edges.\n\n"
             "Paper: Pentium 4 3.4 GHz, 1 GB. Its text calls its times those \"needed for\" "
             "silhouette detection and does not say what else they hold. They are tens of times "
             "what brute force takes on a processor of the 2020s, more than the processors differ "
             "by, so they are probably whole frames, with volumes and picture: compare the ratios "
             "with that in mind, and not the milliseconds. Its models are not published; "
             "scenes/second_paper_scenes.h says what "
             "is known of them and what stands in for them. Rows without its numbers are files "
             "of models, without a ground, that it does not have.\n\n",
             Hextree::kDepth, rounds, rounds) +
         header("scene", columns) + times +
         fmt::format(
             "\nSilhouette edges are means over the suns, {}; \"of these\": how many of "
             "those by vertices are edges of the silhouette. In the root: what share of its edges "
             "the tree of dual space holds there, as no smaller cube encloses both duals; they are "
             "tested under every sun. Built: once for a scene, ms, median of "
             "{}; trees after the table of edges.\n\n",
             kPaperDate, std::min(rounds, kBuilds)) +
         header("scene",
                {"suns", "silhouette edges", "by vertices", "of these on the silhouette",
                 "in the root, vertices", "in the root, facets", "table of edges built, ms",
                 "dual space, vertices", "dual space, facets", "tree of edges"}) +
         rest;
}

}  // namespace gnomon::app
