// Results that appear together: made in a folder of their own inside the output folder,
// `unfinished-<pid>.tmp`, and moved out of it at the end.
//
// What is promised:
// - A run that fails, or is stopped by Ctrl-C or SIGTERM, leaves the files of the run before it as
//   they were, no file of its own, and no folder that was not there before.
// - A run that is killed (SIGKILL, power) leaves whole files, and at most its unfinished folder,
//   which the next run into the same output folder removes. It knows the folders of runs that are
//   still alive by their locks.
// - Each file appears by rename: whole, or as it was. The renames of a run follow each other with
//   nothing in between, and a signal waits for the last of them; a kill between two of them leaves
//   files of both runs, each of them whole.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gnomon::app {

class Staging {
 public:
  // Makes the output folder where missing. Throws Failure where it cannot be written.
  explicit Staging(const std::filesystem::path& output);
  ~Staging();  // removes what was not published, and the folders made for it
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  // Where to write the result `name` (may name a folder: "2024-03-21/plan.png"). Throws Failure.
  std::filesystem::path path(const std::string& name);
  const std::vector<std::string>& names() const { return names_; }
  const std::filesystem::path& output() const { return output_; }

  // A result that an earlier run may have left and that this one does not have: publish() removes
  // it.
  void obsolete(const std::string& name) { obsolete_.push_back(name); }

  // Moves the results into place. Throws Failure.
  void publish();

 private:
  std::filesystem::path output_, folder_;
  std::vector<std::string> names_, obsolete_;
  int lock_ = -1;  // the open unfinished folder; its lock tells other runs that this one is alive
};

// The message with results named as they would be once published: users know no other name.
std::string as_published(std::string message);

}  // namespace gnomon::app
