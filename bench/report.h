// What every benchmark reports: the machine, medians, and a Markdown table and JSON beside each
// other.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace gnomon::bench {

struct Machine {
  std::string cpu;       // as the system names it
  int cores = 0;         // that this process may use
  std::string simd;      // the vector extensions it has, e.g. "avx2 avx512f avx512bw"
  std::string compiler;  // of this program
};
Machine this_machine();
std::string to_text(const Machine& machine);  // one line
nlohmann::ordered_json to_json(const Machine& machine);

// Of an even number of values the mean of the middle two. Precondition: not empty.
double median(std::vector<double> values);

class Watch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Writes folder/name.md and folder/name.json (the folder is made). Throws std::runtime_error where
// that fails.
void write_results(const std::string& folder, const std::string& name, const std::string& markdown,
                   const nlohmann::ordered_json& json);

}  // namespace gnomon::bench
