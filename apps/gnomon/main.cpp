#include <csignal>
#include <cstdio>
#include <exception>

#include "commands.h"

namespace gnomon::app {

void add_common(CLI::App& command, Common& common) {
  command.add_option("--threads", common.threads, "Number of threads (default: all cores)")
      ->check(CLI::Range(1, 1024))
      ->group("General");
  command.add_flag("-q,--quiet", common.quiet, "Print errors only")->group("General");
  command.add_flag("-v,--verbose", common.verbose, "Say more; twice: even more")->group("General");
}

void print_warnings(const Warnings& warnings) {
  for (const Warning& w : warnings) {
    std::string line = "gnomon: warning: " + w.what;
    if (w.count > 1) line += " (" + std::to_string(w.count) + " times";
    if (!w.first.empty()) line += (w.count > 1 ? ", first: " : " (") + w.first;
    if (w.count > 1 || !w.first.empty()) line += ")";
    std::fprintf(stderr, "%s\n", line.c_str());
  }
}

}  // namespace gnomon::app

int main(int argc, char** argv) {
  CLI::App app{"Gnomon computes exact shadows from 3D models."};
  app.name("gnomon");
  app.set_version_flag("--version", std::string("gnomon ") + GNOMON_VERSION);
  app.require_subcommand(1);
  gnomon::app::add_profile(app);
  gnomon::app::add_shadow(app);
  gnomon::app::add_convert(app);
  gnomon::app::add_inspect(app);
  gnomon::app::add_sun(app);
#ifdef GNOMON_HAVE_TRACE
  gnomon::app::add_verify(app);
#endif
  std::signal(SIGXFSZ, SIG_IGN);  // a file size limit is then an error of the write, with a message
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    std::fprintf(
        stderr,
        "gnomon: error: %s\nRun gnomon --help, or gnomon COMMAND --help, for what there is.\n",
        e.what());
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "gnomon: error: %s\n", e.what());
    return 1;
  }
  return 0;
}
