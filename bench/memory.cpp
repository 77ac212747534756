// Memory of the resident scene per triangle, and of a view per sample: counted at every allocation,
// with the system's own figure (RSS) beside it.
#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <new>

#include <gnomon/raster/count_shadows.h>
#include <gnomon/raster/visible_surfaces.h>
#include <scenes/generated_city.h>

#include "report.h"

namespace {

// What the program holds now, and the most it held since the last reset_peak(): sizes as the
// allocator rounds them.
std::atomic<std::size_t> held{0}, peak{0};

void* counted(std::size_t size, std::size_t alignment) {
  void* p = alignment <= alignof(std::max_align_t)
                ? std::malloc(size == 0 ? 1 : size)
                : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (p == nullptr) throw std::bad_alloc();
  const std::size_t now = held += malloc_usable_size(p);
  std::size_t before = peak.load();
  while (before < now && !peak.compare_exchange_weak(before, now)) {
  }
  return p;
}

void discount(void* p) {
  if (p == nullptr) return;
  held -= malloc_usable_size(p);
  std::free(p);
}

void reset_peak() { peak = held.load(); }

}  // namespace

void* operator new(std::size_t size) { return counted(size, 1); }
void* operator new[](std::size_t size) { return counted(size, 1); }
void* operator new(std::size_t size, std::align_val_t a) {
  return counted(size, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t size, std::align_val_t a) {
  return counted(size, static_cast<std::size_t>(a));
}
void operator delete(void* p) noexcept { discount(p); }
void operator delete[](void* p) noexcept { discount(p); }
void operator delete(void* p, std::size_t) noexcept { discount(p); }
void operator delete[](void* p, std::size_t) noexcept { discount(p); }
void operator delete(void* p, std::align_val_t) noexcept { discount(p); }
void operator delete[](void* p, std::align_val_t) noexcept { discount(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { discount(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { discount(p); }

namespace gnomon::bench {
namespace {

struct Options {
  std::size_t triangles = 1000000;
  int size = 2048, threads = 2, suns = 8;
  std::string out = "bench/results", name = "memory";
};

double resident_bytes() {
  malloc_trim(0);  // freed memory that the allocator keeps is not the scene's
  std::ifstream file("/proc/self/statm");
  double total = 0, resident = 0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

// Bytes since `held_before`, `rss_before`, divided by `per`.
struct Share {
  std::string what, unit;
  double counted, rss, most;  // bytes each; `most`: the highest on the way there
};

class Meter {
 public:
  Meter() : held_(held.load()), rss_(resident_bytes()) { reset_peak(); }
  Share share(const std::string& what, const std::string& unit, std::size_t per) const {
    const auto n = static_cast<double>(per);
    return {what, unit, (static_cast<double>(held.load()) - static_cast<double>(held_)) / n,
            (resident_bytes() - rss_) / n,
            (static_cast<double>(peak.load()) - static_cast<double>(held_)) / n};
  }

 private:
  std::size_t held_;
  double rss_;
};

void run(const Options& o) {
  const scenes::CityOptions city{.buildings = 0, .triangles = o.triangles};
  std::vector<Share> shares;
  const Meter whole;
  Meter meter;
  const Scene scene = scenes::generated_city(city);
  const std::size_t n = scene.mesh.triangles.size();
  shares.push_back(meter.share("scene", "triangle", n));
  meter = Meter();
  const Casters casters = prepare_casters(scene);
  shares.push_back(meter.share("prepared casters", "triangle", n));
  shares.push_back(whole.share("resident scene: both", "triangle", n));

  const Bounds2 b = scenes::city_bounds(city);
  View view = plan_view(b, (b.x1 - b.x0) / o.size, 0);
  view.width = view.height = o.size;
  const std::size_t pixels = static_cast<std::size_t>(o.size) * static_cast<std::size_t>(o.size);
  meter = Meter();
  const Receivers receivers = visible_surfaces(scene, view, o.threads);
  shares.push_back(meter.share("view: visible surfaces", "sample", pixels));
  meter = Meter();
  std::vector<Light> lights;
  for (int k = 0; k < o.suns; ++k)
    lights.emplace_back(std::cos(0.3 * k), std::sin(0.3 * k), 0.5, 0.0);
  std::atomic<std::uint64_t> dark{0};
  count_shadows(
      casters, receivers, lights,
      [&](const CountRect& part) {
        std::uint64_t sum = 0;
        for (int row = 0; row < part.rows; ++row) {
          for (int k = 0; k < part.columns; ++k)
            sum += part.counts[static_cast<std::ptrdiff_t>(row) * part.stride + k] > 0 ? 1 : 0;
        }
        dark += sum;
      },
      o.threads);
  shares.push_back(meter.share(fmt::format("counting {} suns", o.suns), "sample", pixels));

  std::string text = fmt::format(
      "# Memory\n\n{}\n\nGenerated city of {} triangles, {} vertices; a plan of {} x {} samples. "
      "Bytes, counted at every allocation "
      "(as the allocator rounds them); `highest` is the most that was held on the way; RSS is the "
      "system's figure for the same step.\n\n"
      "| what | per | bytes | RSS | highest |\n|---|---|--:|--:|--:|\n",
      to_text(this_machine()), n, scene.mesh.positions.size(), o.size, o.size);
  nlohmann::ordered_json json{{"machine", to_json(this_machine())},
                              {"triangles", n},
                              {"vertices", scene.mesh.positions.size()},
                              {"samples", pixels},
                              {"suns", o.suns},
                              {"samples_in_shadow", dark.load()}};
  for (const Share& s : shares) {
    text += fmt::format("| {} | {} | {:.1f} | {:.1f} | {:.1f} |\n", s.what, s.unit, s.counted,
                        s.rss, s.most);
    json["shares"].push_back({{"what", s.what},
                              {"per", s.unit},
                              {"bytes", s.counted},
                              {"rss", s.rss},
                              {"highest", s.most}});
  }
  fmt::print("{}", text);
  write_results(o.out, o.name, text, json);
}

}  // namespace
}  // namespace gnomon::bench

int main(int argc, char** argv) {
  gnomon::bench::Options o;
  CLI::App app{"Memory of the resident scene per triangle and of a view per sample"};
  app.add_option("--triangles", o.triangles, "Of the generated city, about")->capture_default_str();
  app.add_option("--size", o.size, "Samples per side of the plan")->capture_default_str();
  app.add_option("--suns", o.suns, "Lights counted at once")->capture_default_str();
  app.add_option("--threads", o.threads, "Threads")->capture_default_str();
  app.add_option("--out", o.out, "Folder of the results")->capture_default_str();
  app.add_option("--name", o.name, "Name of the results' files")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    gnomon::bench::run(o);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_memory: error: %s\n", e.what());
    return 1;
  }
  return 0;
}
