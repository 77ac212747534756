// The program as a user runs it, in a folder for one test.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

namespace gnomon::testing {

class Program : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("gnomon-program-test-" + std::to_string(getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // Exit code; what it printed is in out_ and err_.
  int run(const std::string& arguments) {
    const std::string command = "\"" GNOMON_PROGRAM "\" " + arguments + " > \"" +
                                (folder_ / "out").string() + "\" 2> \"" +
                                (folder_ / "err").string() + "\" < /dev/null";
    const int status = std::system(command.c_str());
    out_ = text(folder_ / "out");
    err_ = text(folder_ / "err");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  static std::string text(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::stringstream s;
    s << file.rdbuf();
    return s.str();
  }
  std::string results() const { return (folder_ / "results").string(); }
  // A box in local metres, 10 x 10 x 5 m, which can stand anywhere.
  std::string house() const {
    const std::string path = (folder_ / "house.obj").string();
    std::ofstream(path)
        << "v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nv 0 0 5\nv 9 0 5\nv 9 9 5\nv 0 9 5\n"
           "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    return path + " --up z";
  }
  std::string profile(const std::string& more) const {
    return "profile " + vienna_ + " " + more + " -o " + results();
  }

  const std::string vienna_ = GNOMON_SCENES "/vienna/vienna.city.jsonl --crs EPSG:31256";
  const std::string day_ = "--date 2024-09-18 --from 09:00 --to 17:00 --tz Europe/Vienna";
  std::filesystem::path folder_;
  std::string out_, err_;
};

}  // namespace gnomon::testing
