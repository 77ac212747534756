// The commands of docs/first-profile.md, as they stand there.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <apps/program.h>

namespace {

namespace fs = std::filesystem;

class FirstProfile : public gnomon::testing::Program {
 protected:
  // Lines of the blocks that are marked as shell.
  static std::vector<std::string> commands() {
    std::vector<std::string> out;
    std::istringstream page(text(GNOMON_SCENES "/../docs/first-profile.md"));
    bool inside = false;
    for (std::string line; std::getline(page, line);) {
      if (line.starts_with("```")) {
        inside = line == "```sh";
      } else if (inside && !line.empty()) {
        out.push_back(line);
      }
    }
    return out;
  }
};

TEST_F(FirstProfile, EveryCommandOfThePageRuns) {
  fs::create_directory_symlink(GNOMON_SCENES, folder_ / "scenes");
  const auto all = commands();
  ASSERT_GE(all.size(), 10u);
  for (const std::string& command : all) {
    ASSERT_TRUE(command.starts_with("gnomon ")) << command;
    const std::string line = "cd \"" + folder_.string() + "\" && \"" GNOMON_PROGRAM "\" " +
                             command.substr(7) + " > out 2> err < /dev/null";
    EXPECT_EQ(std::system(line.c_str()), 0) << command << "\n" << text(folder_ / "err");
  }
  for (const char* file :
       {"my-first-profile/report.html", "my-first-profile/plan.png",
        "my-first-profile/isolines.gpkg", "my-first-profile/summary.csv", "three-dates/report.html",
        "three-dates/2024-12-21/plan.png", "season/profile.tif", "at-three/outlines.geojson",
        "with-design.glb", "with-design/profile.tif", "without-design/profile.tif"}) {
    EXPECT_TRUE(fs::exists(folder_ / file)) << file;
  }
  const auto view = [&](const char* folder) {
    return nlohmann::json::parse(text(folder_ / folder / "summary.json"))["view"];
  };
  const auto size = [&](const char* folder) {
    return std::pair(view(folder)["width"], view(folder)["bounds"]);
  };
  EXPECT_EQ(size("with-design"), size("without-design")) << "else they cannot be compared";
}

}  // namespace
