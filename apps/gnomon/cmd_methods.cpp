// gnomon methods: which shadow methods go together; docs/methods.md.
#include <cstdio>

#include <gnomon/gl/methods_page.h>

#include "commands.h"

namespace gnomon::app {

void add_methods(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "methods", "Print which shadow methods of `gnomon render` go together, as Markdown");
  command->group("");  // for who makes the manual
  command->callback([] { std::fputs(gl::methods_page().c_str(), stdout); });
}

}  // namespace gnomon::app
