// Results that appear together: made in a folder of their own inside the output folder and moved
// out of it at the end, so that a run that fails or is stopped leaves the files of the run before
// it as they were.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gnomon::app {

class Staging {
 public:
  // Makes the output folder where missing. Throws Failure where it cannot be written.
  explicit Staging(const std::filesystem::path& output);
  ~Staging();  // removes what was not published
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  // Where to write the result `name` (may name a folder: "2024-03-21/plan.png"). Throws Failure.
  std::filesystem::path path(const std::string& name);
  const std::vector<std::string>& names() const { return names_; }
  const std::filesystem::path& output() const { return output_; }

  // Moves the results into place. Throws Failure.
  void publish();

 private:
  std::filesystem::path output_, folder_;
  std::vector<std::string> names_;
};

}  // namespace gnomon::app
