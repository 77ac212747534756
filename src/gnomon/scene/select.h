// Who casts and who receives, chosen by names.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/scene/scene.h>

namespace gnomon {

// True if the whole of `text` matches; '*' is any text, '?' any one byte; case matters, nothing
// else is special.
bool glob_matches(std::string_view glob, std::string_view text);

// True if the object, group, material or semantic name matches. An empty name matches nothing, not
// even "*", so that
// "*" means every surface that has a name.
bool glob_matches(std::string_view glob, const Surface& surface);

struct Selection {
  std::vector<std::string> cast;     // globs; if any, only matching surfaces cast
  std::vector<std::string> no_cast;  // matching surfaces do not cast (stronger than `cast`)
  std::vector<std::string> receive;  // if any, only matching surfaces receive
};

// Sets Surface::casts and Surface::receives. Errors: a glob that matches no surface that has
// triangles (names the nearest existing names); nothing left that casts.
std::optional<Error> select(Scene& scene, const Selection& selection);

}  // namespace gnomon
