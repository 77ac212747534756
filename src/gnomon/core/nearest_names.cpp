#include <gnomon/core/lower_case.h>
#include <gnomon/core/nearest_names.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace gnomon {
namespace {

// Levenshtein: insertions, deletions and replacements that make b of a.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t above = row[j + 1];
      row[j + 1] = std::min({above + 1, row[j] + 1, diagonal + (a[i] == b[j] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_names(std::string_view wanted_name, const std::set<std::string_view>& names,
                          std::size_t most, std::size_t farthest) {
  std::string wanted = lower_case(wanted_name);
  std::erase_if(wanted, [](char c) { return c == '*' || c == '?'; });
  std::vector<std::pair<std::size_t, std::string_view>> ranked;
  for (const std::string_view name : names) {
    const std::string low = lower_case(name);
    const bool inside = !wanted.empty() && low.find(wanted) != std::string::npos;
    ranked.emplace_back(inside ? 0 : edit_distance(wanted, low), name);
  }
  std::sort(ranked.begin(), ranked.end());
  std::erase_if(ranked, [&](const auto& r) { return r.first > farthest; });
  std::string list;
  for (std::size_t k = 0; k < std::min(most, ranked.size()); ++k) {
    list += (k ? ", \"" : "\"") + std::string(ranked[k].second) + '"';
  }
  return list;
}

}  // namespace gnomon
