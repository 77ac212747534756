// Counted warnings: what was not lost silently.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

// One kind of thing that happened `count` times. `what` is a whole sentence without the element,
// `first` names the first element (file, object, face) it happened to; may be empty.
struct Warning {
  std::string what;
  std::size_t count = 0;
  std::string first;
};

using Warnings = std::vector<Warning>;

// Adds `count` cases of `what`, merged with earlier cases of the same sentence. Nothing happens for
// count 0.
inline void warn(Warnings& warnings, std::string_view what, std::string_view element,
                 std::size_t count = 1) {
  if (count == 0) return;
  for (Warning& w : warnings) {
    if (w.what == what) {
      w.count += count;
      return;
    }
  }
  warnings.push_back({std::string(what), count, std::string(element)});
}

inline void append(Warnings& warnings, const Warnings& more) {
  for (const Warning& w : more) warn(warnings, w.what, w.first, w.count);
}

}  // namespace gnomon
