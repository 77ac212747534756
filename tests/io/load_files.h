// Small model files, and scenes made of them.
#pragma once

#include <gnomon/io/load_scene.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace gnomon::testing_files {

// Files of one test, gone with it.
struct Files {
  std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) /
      (std::string("gnomon_load_") + testing::UnitTest::GetInstance()->current_test_info()->name());
  Files() { std::filesystem::create_directories(folder); }
  ~Files() { std::filesystem::remove_all(folder); }
  std::filesystem::path operator()(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
  }
};

inline LoadOptions without_ground() {
  LoadOptions options;
  options.ground = "none";
  return options;
}

inline LoadedScene load(const std::vector<std::filesystem::path>& paths,
                        const LoadOptions& options) {
  auto loaded = load_scene(paths, options);
  if (!loaded) {
    ADD_FAILURE() << loaded.error().message;
    return {};
  }
  return std::move(loaded).value();
}

inline void expect_failure(const std::vector<std::filesystem::path>& paths,
                           const LoadOptions& options, const std::vector<std::string>& parts) {
  const auto loaded = load_scene(paths, options);
  ASSERT_FALSE(loaded);
  for (const std::string& part : parts) {
    EXPECT_NE(loaded.error().message.find(part), std::string::npos)
        << part << " is not in: " << loaded.error().message;
  }
}

inline bool warns(const Scene& scene, const std::string& what, std::size_t count) {
  return std::any_of(scene.warnings.begin(), scene.warnings.end(), [&](const Warning& w) {
    return w.what.find(what) != std::string::npos && w.count == count;
  });
}

// A box on the ground as CityJSON: `crs` may be empty; the lower left corner is `translate`.
inline std::string box(const std::string& crs = "EPSG:31256",
                       const std::string& translate = "[1200,340700,40]",
                       const std::string& lod = "2") {
  return R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.5,0.5,0.5],"translate":)" +
         translate + "}," +
         (crs.empty() ? "" : R"("metadata":{"referenceSystem":")" + crs + "\"},") +
         R"("CityObjects":{"Box":{"type":"Building","geometry":[{"type":"Solid","lod":")" + lod +
         R"(","boundaries":[[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]],)"
         R"("semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"RoofSurface"},{"type":"WallSurface"}],)"
         R"("values":[[0,1,2,2,2,2]]}}]}},)"
         R"("vertices":[[0,0,0],[20,0,0],[20,20,0],[0,20,0],[0,0,40],[20,0,40],[20,20,40],[0,20,40]]})";
}
inline const std::string kObj =
    "o Tower\nusemtl steel\nv 0 0 0\nv 4 0 0\nv 0 8 0\nv 0 0 6\nf 1 2 3\nf 1 2 4\n";

}  // namespace gnomon::testing_files
