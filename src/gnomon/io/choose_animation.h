// Which of a file's animations is meant.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/io/read_options.h>

namespace gnomon {

// True where the model is not to stand at rest.
inline bool asks_for_animation(const ReadOptions& options) {
  return options.time || !options.animation.empty() || options.rig;
}

// Names as people can give them: an animation without one has its number from 0.
std::vector<std::string> animation_names(std::vector<std::string> names);

// Index of the one that options.animation names (by name, else by number; empty: the first).
// Nothing where there are no names, or nobody asks. Errors: no such name (lists those there are), a
// time that is no number of seconds from 0 on.
Result<std::optional<std::size_t>> choose_animation(const std::vector<std::string>& names,
                                                    const ReadOptions& options,
                                                    const std::string& path);

}  // namespace gnomon
