// Checked access to JSON values of unknown shape: a wrong type is nothing, never an exception.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include <gnomon/core/vec.h>

namespace gnomon::cityjson {

using Json = nlohmann::json;

// Member `key`; nothing if `value` is nothing or no object, or the member is absent or null.
inline const Json* member(const Json* value, const char* key) {
  if (!value || !value->is_object()) return nullptr;
  const auto at = value->find(key);
  return at == value->end() || at->is_null() ? nullptr : &*at;
}

// Element `k`; nothing if `value` is nothing or no array, or the element is absent or null.
inline const Json* element(const Json* value, std::size_t k) {
  if (!value || !value->is_array() || k >= value->size() || (*value)[k].is_null()) return nullptr;
  return &(*value)[k];
}

// The text, or empty.
inline std::string text(const Json* value) {
  return value && value->is_string() ? value->get<std::string>() : std::string();
}

// A whole number in [0, count).
inline std::optional<std::size_t> index_below(const Json* value, std::size_t count) {
  if (!value || !value->is_number_unsigned()) return {};
  const auto k = value->get<std::uint64_t>();
  if (k >= count) return {};
  return static_cast<std::size_t>(k);
}

inline std::optional<double> number(const Json* value) {
  if (!value || !value->is_number()) return {};
  const double d = value->get<double>();
  if (!std::isfinite(d)) return {};
  return d;
}

// Exactly three finite numbers.
inline std::optional<Vec3> vec3(const Json* value) {
  if (!value || !value->is_array() || value->size() != 3) return {};
  Vec3 v;
  for (int k = 0; k < 3; ++k) {
    const auto d = number(&(*value)[static_cast<std::size_t>(k)]);
    if (!d) return {};
    v[k] = *d;
  }
  return v;
}

// For messages: "a text", "an object", ...
inline std::string kind_of(const Json* value) {
  if (!value) return "missing";
  if (value->is_array()) return "a list of " + std::to_string(value->size());
  if (value->is_object()) return "an object";
  if (value->is_string()) return "a text";
  std::string dump = value->dump(-1, ' ', true, Json::error_handler_t::replace);
  return dump;
}

}  // namespace gnomon::cityjson
