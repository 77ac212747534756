// Every file of the data folders with hard and malformed models, all the way to a scene. Nothing
// may crash, leak or overflow: the sanitizers watch this test too.
#include <gnomon/io/load_scene.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(const std::string& folder) {
  std::vector<fs::path> found;
  const fs::path root = fs::path(GNOMON_DATA) / folder;
  if (!fs::exists(root)) return found;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.is_regular_file()) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(HardFiles, EachGivesASceneThatIsWholeOrAnErrorThatNamesIt) {
  std::size_t loaded = 0, refused = 0;
  for (const char* folder : {"hard", "malformed"}) {
    for (const fs::path& path : files_of(folder)) {
      SCOPED_TRACE(path);
      LoadOptions options;
      options.ground = "none";
      const auto result = load_scene({path}, options);
      if (!result) {
        ++refused;
        EXPECT_NE(result.error().message.find(path.string()), std::string::npos)
            << result.error().message;
        continue;
      }
      ++loaded;
      const Scene& s = result.value().scene;
      EXPECT_FALSE(s.mesh.triangles.empty());
      ASSERT_EQ(s.surface_of.size(), s.mesh.triangles.size());
      for (const Triangle& t : s.mesh.triangles) {
        for (const std::uint32_t v : t) ASSERT_LT(v, s.mesh.positions.size());
      }
      for (const std::uint32_t surface : s.surface_of) ASSERT_LT(surface, s.surfaces.size());
      for (const Vec3& p : s.mesh.positions)
        ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    }
  }
  if (loaded + refused == 0) GTEST_SKIP() << "skipped: no models in " << GNOMON_DATA;
  EXPECT_GT(loaded, 60u);
  EXPECT_GT(refused, 20u);
}

TEST(HardFiles, TheFaceThatTwoTetrahedraShareIsCountedAsStoredTwice) {
  const fs::path path = fs::path(GNOMON_DATA) / "hard/trimesh/joined_tetrahedra.obj";
  if (!fs::exists(path)) GTEST_SKIP() << "skipped: no " << path;
  LoadOptions options;
  options.ground = "none";
  const auto result = load_scene({path}, options);
  ASSERT_TRUE(result) << result.error().message;
  const Warnings& warnings = result.value().scene.warnings;
  EXPECT_EQ(result.value().scene.mesh.triangles.size(), 8u) << "all are kept";
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const Warning& w) {
    return w.count == 1 && w.what.find("lie exactly on others") != std::string::npos;
  }));
}

}  // namespace
}  // namespace gnomon
