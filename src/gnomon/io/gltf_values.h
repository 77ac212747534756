// Lists of numbers in a glTF's JSON.
#pragma once

#include <gnomon/io/cityjson_access.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace gnomon {

inline std::size_t size_of(const nlohmann::json* list) {
  return list && list->is_array() ? list->size() : 0;
}

// `count` finite numbers; nothing if they are not.
inline std::optional<std::vector<double>> numbers_of(const nlohmann::json* list,
                                                     std::size_t count) {
  if (size_of(list) != count) return {};
  std::vector<double> out;
  for (std::size_t k = 0; k < count; ++k) {
    const auto d = cityjson::number(cityjson::element(list, k));
    if (!d) return {};
    out.push_back(*d);
  }
  return out;
}

// Three after the other.
inline std::vector<Vec3> vectors_of(const std::vector<double>& numbers) {
  std::vector<Vec3> out;
  out.reserve(numbers.size() / 3);
  for (std::size_t k = 0; k + 3 <= numbers.size(); k += 3) {
    out.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
  }
  return out;
}

}  // namespace gnomon
