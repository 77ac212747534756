#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fuzz/targets.h"

namespace gnomon::fuzz {
namespace {

struct Target {
  const char* name;
  void (*run)(std::string_view);
};

class Fuzz : public testing::TestWithParam<Target> {};

// Where a sanitizer or a signal ends this test, the last file that its output names did it.
TEST_P(Fuzz, EveryFileOfTheCorpusIsReadOrRefused) {
  const std::filesystem::path folder = std::filesystem::path(GNOMON_FUZZ_CORPUS) / GetParam().name;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  ASSERT_FALSE(files.empty()) << folder;
  std::sort(files.begin(), files.end());
  for (const auto& path : files) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    std::fprintf(stderr, "%s\n", path.filename().c_str());
    try {
      GetParam().run(bytes);
    } catch (const std::exception& e) {
      ADD_FAILURE() << path << ": " << e.what();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Readers, Fuzz,
                         testing::Values(Target{"cityjson", cityjson}, Target{"obj", obj},
                                         Target{"footprints", footprints}, Target{"mesh", mesh},
                                         Target{"step", step}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace gnomon::fuzz
