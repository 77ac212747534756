// The commands of the program. Each file cmd_*.cpp adds one: arguments, progress, messages; no
// algorithm.
#pragma once

#include <stdexcept>
#include <string>

#include <gnomon/core/result.h>
#include <gnomon/core/warnings.h>
#include <CLI/CLI.hpp>

namespace gnomon::app {

// Ends a command: main prints "gnomon: error: <what>" and exits with 1.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The value, or Failure with the error's message.
template <class T>
T take(Result<T> result) {
  if (!result) throw Failure(result.error().message);
  return std::move(result).value();
}

// One line each on standard error.
void print_warnings(const Warnings& warnings);

// Checks an option's value: a number above 0, with a point.
CLI::Validator positive_number();

// Options that every command has.
struct Common {
  int threads = 0;     // 0: all
  bool quiet = false;  // only errors
  int verbose = 0;     // -v
};
void add_common(CLI::App& command, Common& common);

void add_profile(CLI::App& app);
void add_shadow(CLI::App& app);
void add_render(CLI::App& app);
void add_methods(CLI::App& app);
void add_bench(CLI::App& app);
void add_convert(CLI::App& app);
void add_inspect(CLI::App& app);
void add_sun(CLI::App& app);
void add_verify(CLI::App& app);
void add_verify_gl(CLI::App& app);

}  // namespace gnomon::app
