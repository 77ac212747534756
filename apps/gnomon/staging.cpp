#include "staging.h"

#include <fmt/format.h>
#include <gnomon/io/atomic_file.h>
#include <unistd.h>

#include "commands.h"

namespace gnomon::app {

Staging::Staging(const std::filesystem::path& output)
    : output_(take(make_output_folder(output))),
      folder_(output_ / fmt::format("unfinished-{}.tmp", getpid())) {
  take(make_output_folder(folder_));
}

Staging::~Staging() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::filesystem::path Staging::path(const std::string& name) {
  const std::filesystem::path path = folder_ / name;
  if (path.parent_path() != folder_) take(make_output_folder(path.parent_path()));
  names_.push_back(name);
  return path;
}

void Staging::publish() {
  for (const std::string& name : names_) {
    const std::filesystem::path target = output_ / name;
    if (target.parent_path() != output_) take(make_output_folder(target.parent_path()));
    std::error_code error;
    std::filesystem::rename(folder_ / name, target, error);
    if (error)
      throw Failure(fmt::format("cannot move {} into place: {}", target.string(), error.message()));
  }
}

}  // namespace gnomon::app
