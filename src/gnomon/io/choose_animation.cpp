#include <fmt/format.h>
#include <gnomon/io/choose_animation.h>
#include <gnomon/io/mesh_text.h>
#include <gnomon/io/read_text.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gnomon {

std::vector<std::string> animation_names(std::vector<std::string> names) {
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k].empty()) names[k] = std::to_string(k);
  }
  return names;
}

Result<std::optional<std::size_t>> choose_animation(const std::vector<std::string>& names,
                                                    const ReadOptions& options,
                                                    const std::string& path) {
  using Choice = std::optional<std::size_t>;
  if (options.time && !(*options.time >= 0 && std::isfinite(*options.time))) {
    return Error{
        fmt::format("{}: the time {} must be a number of seconds from 0 on.", path, *options.time)};
  }
  if (names.empty() || !asks_for_animation(options)) return Choice();
  if (options.animation.empty()) return Choice(0);
  const auto at = std::find(names.begin(), names.end(), options.animation);
  if (at != names.end()) return Choice(static_cast<std::size_t>(at - names.begin()));
  const auto number = whole_number(options.animation);
  if (number && *number < names.size()) return Choice(static_cast<std::size_t>(*number));
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + in_quotes(name, 100);
  return Error{fmt::format("{}: there is no animation {}; the file has {}.", path,
                           in_quotes(options.animation, 100), all)};
}

}  // namespace gnomon
