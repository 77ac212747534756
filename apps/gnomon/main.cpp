#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <exception>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gnomon/core/nearest_names.h>

#include "commands.h"
#include "signals.h"
#include "staging.h"

namespace gnomon::app {

void add_common(CLI::App& command, Common& common) {
  command.add_option("--threads", common.threads, "Number of threads (default: all cores)")
      ->check(CLI::Range(1, 1024))
      ->group("General");
  command.add_flag("-q,--quiet", common.quiet, "Print errors only")->group("General");
  command.add_flag("-v,--verbose", common.verbose, "Say more; twice: even more")->group("General");
}

CLI::Validator positive_number() {
  return CLI::Validator(
      [](std::string& text) {
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool good = error == std::errc() && end == text.data() + text.size() && value > 0;
        return good ? std::string() : "'" + text + "' is not a number above 0, such as 0.5";
      },
      "NUMBER");
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

namespace {

// What people write for an option that has another name here.
constexpr std::pair<std::string_view, std::string_view> kSynonyms[] = {
    {"--timezone", "--tz"},    {"--time-zone", "--tz"},   {"--zone", "--tz"},
    {"--time", "--at"},        {"--time", "--from"},      {"--start", "--from"},
    {"--begin", "--from"},     {"--end", "--to"},         {"--step", "--every"},
    {"--interval", "--every"}, {"--out", "--output"},     {"--resolution", "--pixel"},
    {"--latitude", "--site"},  {"--longitude", "--site"}, {"--lat", "--site"},
    {"--lon", "--site"},       {"--location", "--site"},  {"--place", "--site"}};

// ". Did you mean --date?" for the first thing on the command line that is no option or command.
std::string did_you_mean(const CLI::App& app) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  std::set<std::string> names;
  std::string wanted;
  for (const std::string& word : app.remaining(true)) {
    const bool option = word.starts_with("--");
    if (!option && !chosen.empty() && chosen.front()->get_name() == "sun") {
      return ". A place is said by its latitude and longitude: --site LAT,LON, such as --site "
             "48.2,16.37";
    }
    if (option != !chosen.empty()) continue;
    wanted = word.substr(0, word.find('='));
    break;
  }
  if (wanted.empty()) return "";
  if (chosen.empty()) {
    for (const CLI::App* c : app.get_subcommands([](const CLI::App*) { return true; }))
      names.insert(c->get_name());
  } else {
    for (const CLI::Option* o : chosen.front()->get_options()) {
      for (const std::string& name : o->get_lnames()) names.insert("--" + name);
    }
  }
  const std::set<std::string_view> views(names.begin(), names.end());
  for (const auto& [said, meant] : kSynonyms) {
    if (said == wanted && views.contains(meant))
      return ". Did you mean " + std::string(meant) + (meant == "--site" ? " LAT,LON?" : "?");
  }
  // What is farther away is no slip of the keys.
  const std::size_t farthest = std::max<std::size_t>(2, wanted.size() / 3);
  const std::string near = nearest_names(wanted, views, 1, farthest);
  if (near.empty()) return chosen.empty() ? ": there is no '" + wanted + "'" : std::string();
  return (chosen.empty() ? ": there is no '" + wanted + "'" : std::string()) + ". Did you mean " +
         near.substr(1, near.size() - 2) + "?";
}

// What to do about an error of the command line.
std::string hint(const CLI::App& app, const CLI::ParseError& error) {
  if (std::string_view(error.what()) == "--output is required") return ", such as -o scene.glb";
  return did_you_mean(app);
}

}  // namespace
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
#ifdef GNOMON_HAVE_GL
  gnomon::app::add_render(app);
  gnomon::app::add_methods(app);
#endif
  gnomon::app::add_bench(app);
#ifdef GNOMON_HAVE_TRACE
  gnomon::app::add_verify(app);
#ifdef GNOMON_HAVE_GL
  gnomon::app::add_verify_gl(app);
#endif
#endif
  gnomon::app::stop_on_signals();
  std::signal(SIGXFSZ, SIG_IGN);  // a file size limit is then an error of the write, with a message
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    std::fprintf(
        stderr,
        "gnomon: error: %s%s\nRun gnomon --help, or gnomon COMMAND --help, for what there is.\n",
        e.what(), gnomon::app::hint(app, e).c_str());
    return 2;
  } catch (const std::exception& e) {
    const gnomon::app::SignalsWait wait;  // a program that is being stopped says so, and no more
    std::fprintf(stderr, "gnomon: error: %s\n", gnomon::app::as_published(e.what()).c_str());
    return 1;
  }
  return 0;
}
