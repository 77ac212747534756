#include <gnomon/core/nearest_names.h>
#include <gnomon/scene/select.h>

#include <algorithm>
#include <array>
#include <set>

namespace gnomon {
namespace {

std::array<std::string_view, 4> names_of(const Surface& s) {
  return {s.object, s.group, s.material, s.semantic};
}

}  // namespace

bool glob_matches(std::string_view glob, std::string_view text) {
  // On a mismatch the last '*' takes one byte more; earlier ones never need to, so this is O(glob *
  // text).
  constexpr std::size_t kNone = std::string_view::npos;
  std::size_t g = 0, t = 0, star = kNone, star_text = 0;
  while (t < text.size()) {
    if (g < glob.size() && glob[g] == '*') {
      star = g++;
      star_text = t;
    } else if (g < glob.size() && (glob[g] == '?' || glob[g] == text[t])) {
      ++g;
      ++t;
    } else if (star != kNone) {
      g = star + 1;
      t = ++star_text;
    } else {
      return false;
    }
  }
  while (g < glob.size() && glob[g] == '*') ++g;
  return g == glob.size();
}

bool glob_matches(std::string_view glob, const Surface& surface) {
  const auto names = names_of(surface);
  return std::any_of(names.begin(), names.end(), [&](std::string_view name) {
    return !name.empty() && glob_matches(glob, name);
  });
}

std::optional<Error> select(Scene& scene, const Selection& selection) {
  std::vector<std::uint8_t> used(scene.surfaces.size(), 0);
  for (const std::uint32_t s : scene.surface_of) used[s] = 1;

  // Flags of the surfaces that any of the globs matches.
  std::vector<std::uint8_t> matched;
  const auto match = [&](const std::vector<std::string>& globs,
                         std::string_view option) -> std::optional<Error> {
    matched.assign(scene.surfaces.size(), 0);
    for (const std::string& glob : globs) {
      bool any = false;
      for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        if (!glob_matches(glob, scene.surfaces[s])) continue;
        matched[s] = 1;
        any = any || used[s];
      }
      if (any) continue;
      std::set<std::string_view> names;
      for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        for (const std::string_view name : names_of(scene.surfaces[s])) {
          if (used[s] && !name.empty()) names.insert(name);
        }
      }
      std::string message = std::string(option) + " \"" + glob +
                            "\" matches no object, group, material or semantic surface";
      message += names.empty() ? "; the model has no names, leave the option out."
                               : "; the nearest names are " + nearest_names(glob, names) + ".";
      return Error{message};
    }
    return std::nullopt;
  };

  if (auto error = match(selection.cast, "--cast")) return error;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    scene.surfaces[s].casts = selection.cast.empty() || matched[s];
  }
  if (auto error = match(selection.no_cast, "--no-cast")) return error;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    if (matched[s]) scene.surfaces[s].casts = false;
  }
  if (auto error = match(selection.receive, "--receive")) return error;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    scene.surfaces[s].receives = selection.receive.empty() || matched[s];
  }

  bool any = false;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) any |= used[s] && scene.surfaces[s].casts;
  if (!any) {
    return Error{
        "nothing is left that casts a shadow; take back some of the --cast and --no-cast "
        "patterns."};
  }
  return std::nullopt;
}

}  // namespace gnomon
