// Silhouettes by every method on real meshes: all of GNOMON_DATA that the formats' readers take and
// that is not too large for a test. scripts/verification-silhouettes runs it on the others.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <random>
#include <utility>

#include <glm/geometric.hpp>

#include <gnomon/io/load_scene.h>
#include <gnomon/silhouette/edge_tree.h>
#include <gnomon/silhouette/hextree.h>
#include <gnomon/silhouette/light_sides.h>

namespace gnomon {
namespace {

namespace fs = std::filesystem;

// Random ones, at vertices, in planes and along edges, within and far away.
Light light_for(const TriMesh& mesh, std::mt19937& random, int k) {
  std::normal_distribution<double> g;
  std::uniform_int_distribution<std::size_t> one(0, mesh.triangles.size() - 1);
  const Triangle& t = mesh.triangles[one(random)];
  const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
  const Vec3 v(g(random), g(random), g(random));
  const double size = glm::length(a) + glm::length(b - a);
  switch (k % 8) {
    case 0:
      return snapped(direction(v));
    case 1:
      return snapped(point(a + v * size));
    case 2:
      return snapped(point(a + v * glm::length(b - a)));
    case 3:
      return snapped(point(a));
    case 4:
      return snapped(direction(b - a));
    case 5:
      return snapped(point((a + b + c) / 3.0));
    case 6:
      return Light(0, 0, k % 16 == 6 ? 1 : -1, 0);
    default:
      return snapped(point(v * size * 1e3));
  }
}

// Independent of the order.
std::uint64_t sum_of(const Silhouette& s) {
  std::uint64_t sum = 0;
  for (const SilhouetteEdge& e : s)
    sum += ((e.a * 0x9e3779b97f4a7c15ull) ^ (e.b * 0xc2b2ae3d27d4eb4full)) *
           static_cast<std::uint64_t>(static_cast<std::int64_t>(e.multiplicity) * 2 + 1);
  return sum;
}

std::size_t from_environment(const char* name, std::size_t usual) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::strtoull(text, nullptr, 10) : usual;
}

TEST(Silhouettes, OfRealMeshesAreThoseOfBruteForceByEveryMethod) {
  const fs::path root = GNOMON_DATA;
  if (!fs::exists(root)) GTEST_SKIP() << "skipped: no data in " << root;
  // Triangles times lights that one mesh may take, and the most lights. All files, whatever their
  // size: scripts/verification-silhouettes.
  const std::size_t work = from_environment("GNOMON_SILHOUETTE_WORK", 1'000'000);
  const std::size_t most = from_environment("GNOMON_SILHOUETTE_LIGHTS", 1000);
  const bool all = from_environment("GNOMON_SILHOUETTE_ALL", 0) != 0;
  constexpr std::size_t kLargest = 1'000'000;  // bytes
  std::size_t meshes = 0, lights = 0, edges = 0;
  std::vector<fs::path> files;
  for (const fs::directory_entry& file : fs::recursive_directory_iterator(root)) {
    if (!file.is_regular_file()) continue;
    const bool large = file.file_size() > kLargest || file.path().extension() == ".tif";
    if (all || !large) files.push_back(file.path());
  }
  // The smallest first: what takes long comes last.
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return std::pair(fs::file_size(a), a) < std::pair(fs::file_size(b), b);
  });
  for (const fs::path& file : files) {
    LoadOptions usual;
    const Result<LoadedScene> loaded = load_scene({file}, usual);
    if (!loaded || loaded.value().scene.mesh.triangles.empty()) continue;
    const TriMesh& mesh = loaded.value().scene.mesh;
    const std::size_t n = std::clamp<std::size_t>(work / mesh.triangles.size(), 4, most);
    const EdgeTable table = build_edge_table(mesh);
    const EdgeTree tree = build_edge_tree(mesh, table);
    const Hextree hextree = build_hextree(mesh, table, DualForm::facets);
    ExtractionScratch scratch;
    Silhouette ours, linear, paper;
    std::mt19937 random(1);
    for (std::size_t k = 0; k < n; ++k) {
      const Light light = light_for(mesh, random, static_cast<int>(k));
      const Silhouette expected = find_silhouette(table, light_sides(mesh, light));
      find_silhouette(ours, tree, mesh, light, scratch);
      find_silhouette_linear(linear, tree, mesh, light, scratch);
      find_silhouette(paper, hextree, mesh, light);
      const std::uint64_t sum = sum_of(expected);
      ASSERT_EQ(sum_of(ours), sum) << file << ", light " << k;
      ASSERT_EQ(sum_of(linear), sum) << file << ", light " << k << ", every leaf";
      ASSERT_EQ(sum_of(paper), sum) << file << ", light " << k << ", the paper's tree";
      edges += expected.size();
    }
    ++meshes;
    lights += n;
    if (all) {
      std::printf("%s: %zu triangles, %zu lights\n", file.filename().c_str(), mesh.triangles.size(),
                  n);
      std::fflush(stdout);
    }
  }
  std::printf("%zu meshes, %zu lights, %zu silhouette edges\n", meshes, lights, edges);
  EXPECT_GT(meshes, 50u);
}

}  // namespace
}  // namespace gnomon
