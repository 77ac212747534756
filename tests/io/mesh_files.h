// Mesh files made for a test, in a folder of their own that goes with it.
#pragma once

#include <gnomon/io/assimp_model.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace gnomon {

class MeshFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("gnomon_mesh_") + test->name() + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

  Model read(const std::string& name, const std::string& bytes, char up = 0, double unit = 0) {
    auto model = read_assimp(write(name, bytes), up, unit);
    if (!model) {
      ADD_FAILURE() << model.error().message;
      return {};
    }
    return std::move(model).value();
  }

  // The message starts with the file's path and has all of `parts`.
  void expect_failure(const std::string& name, const std::string& bytes,
                      const std::vector<std::string>& parts) {
    const auto path = write(name, bytes);
    const auto model = read_assimp(path, 0, 0);
    ASSERT_FALSE(model) << bytes;
    const std::string& message = model.error().message;
    EXPECT_TRUE(message.starts_with(path.string() + ": ")) << message;
    for (const std::string& part : parts) {
      EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks: " << part;
    }
  }

  std::filesystem::path folder_;
};

inline std::vector<Vec3> corners_of(const Model& m, std::size_t polygon) {
  const ModelPolygon& p = m.polygons.at(polygon);
  std::vector<Vec3> corners;
  for (std::uint32_t c = m.ring_begin[p.first_ring]; c < m.ring_begin[p.last_ring]; ++c) {
    corners.push_back(m.vertices[m.corners[c]] * m.scale + m.translate);
  }
  return corners;
}

inline std::size_t warned(const Model& m, const std::string& part) {
  for (const Warning& w : m.warnings) {
    if (w.what.find(part) != std::string::npos) return w.count;
  }
  return 0;
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

}  // namespace gnomon
