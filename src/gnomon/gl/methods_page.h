// docs/methods.md: which methods go together, made by asking decide() for every case.
#pragma once

#include <string>

namespace gnomon::gl {

// The page as Markdown. `gnomon methods` prints it; docs/methods.md is this text.
std::string methods_page();

}  // namespace gnomon::gl
