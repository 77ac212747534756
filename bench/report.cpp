#include "report.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <sched.h>

namespace gnomon::bench {
namespace {

// The value of the first line "key : value" of /proc/cpuinfo.
std::string cpu_info(const std::string& key) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || line.compare(0, key.size(), key) != 0) continue;
    return colon + 2 <= line.size() ? line.substr(colon + 2) : std::string();
  }
  return {};
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path.string() + ": cannot be written; choose another --out");
}

}  // namespace

Machine this_machine() {
  Machine m;
  m.cpu = cpu_info("model name");
  if (m.cpu.empty()) m.cpu = "unknown processor";
  cpu_set_t cores;
  m.cores = sched_getaffinity(0, sizeof(cores), &cores) == 0
                ? CPU_COUNT(&cores)
                : static_cast<int>(std::thread::hardware_concurrency());
  std::istringstream flags(cpu_info("flags"));
  for (std::string flag; flags >> flag;) {
    if (flag == "sse4_2" || flag == "avx" || flag == "avx2" || flag == "avx512f" ||
        flag == "avx512bw" || flag == "avx512vl") {
      m.simd += (m.simd.empty() ? "" : " ") + flag;
    }
  }
#ifdef __clang__
  m.compiler = "clang " __clang_version__;
#else
  m.compiler = "gcc " __VERSION__;
#endif
  return m;
}

std::string to_text(const Machine& m) {
  return m.cpu + ", " + std::to_string(m.cores) + " cores, " + m.simd + ", " + m.compiler;
}

nlohmann::ordered_json to_json(const Machine& m) {
  return {{"cpu", m.cpu}, {"cores", m.cores}, {"simd", m.simd}, {"compiler", m.compiler}};
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

void write_results(const std::string& folder, const std::string& name, const std::string& markdown,
                   const nlohmann::ordered_json& json) {
  std::filesystem::create_directories(folder);
  write(std::filesystem::path(folder) / (name + ".md"), markdown);
  write(std::filesystem::path(folder) / (name + ".json"), json.dump(2) + "\n");
}

}  // namespace gnomon::bench
