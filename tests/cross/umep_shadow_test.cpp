// A raster shadow caster (UMEP, shadowingfunction_wallheight_23) and Gnomon on the same surface
// model: where they differ, and why. docs/surface-models.md states the numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gnomon/io/surface_raster.h>
#include <gnomon/mesh/weld.h>
#include <gnomon/shadow/cast_shadows.h>

namespace gnomon {
namespace {

constexpr int kSize = 400;  // cells of 1 m
constexpr std::size_t at(int row, int column) {
  return static_cast<std::size_t>(row) * kSize + static_cast<std::size_t>(column);
}

// The values of a .npy file (version 1) of kSize x kSize little-endian floats or doubles, C order.
std::vector<double> read_npy(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string file{std::istreambuf_iterator<char>(in), {}};
  if (file.size() < 10 || file.compare(0, 6, "\x93NUMPY") != 0) return {};
  const std::size_t begin = 10 + static_cast<unsigned char>(file[8]) +
                            256 * static_cast<std::size_t>(static_cast<unsigned char>(file[9]));
  const std::string header = file.substr(10, begin - 10);
  const bool wide = header.find("'<f8'") != std::string::npos;
  const std::size_t bytes = wide ? 8 : 4, count = std::size_t{kSize} * kSize;
  if ((!wide && header.find("'<f4'") == std::string::npos) ||
      header.find("'fortran_order': False") == std::string::npos ||
      header.find("(400, 400)") == std::string::npos || file.size() != begin + bytes * count) {
    return {};
  }
  std::vector<double> values(count);
  for (std::size_t k = 0; k < count; ++k) {
    float narrow = 0;
    if (wide) std::memcpy(&values[k], &file[begin + 8 * k], 8);
    if (!wide) std::memcpy(&narrow, &file[begin + 4 * k], 4), values[k] = narrow;
  }
  return values;
}

Scene scene_of(const Model& model) {
  Scene scene;
  scene.surfaces = model.surfaces;
  scene.mesh.positions = model.vertices;
  for (std::size_t k = 0; k < model.corners.size(); k += 3) {
    scene.mesh.triangles.push_back({model.corners[k], model.corners[k + 1], model.corners[k + 2]});
  }
  scene.surface_of.assign(scene.mesh.triangles.size(), 0);
  weld(scene.mesh, scene.surface_of);
  return scene;
}

// Whether some cell to the south of each, k cells away, is higher by more than (k - nearer) tan 60.
std::vector<bool> shaded_by_columns(const std::vector<double>& dsm, double nearer) {
  const double rise = std::tan(60 * kDegree);
  std::vector<bool> shaded(dsm.size(), false);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      for (int k = 1; row + k < kSize && !shaded[at(row, column)]; ++k) {
        shaded[at(row, column)] =
            dsm[at(row + k, column)] - dsm[at(row, column)] > (k - nearer) * rise;
      }
    }
  }
  return shaded;
}

// Whether a cell or one of the eight around it has the other value in the mask.
bool beside_border(const std::vector<double>& mask, int row, int column) {
  for (int y = std::max(0, row - 1); y <= std::min(kSize - 1, row + 1); ++y) {
    for (int x = std::max(0, column - 1); x <= std::min(kSize - 1, column + 1); ++x) {
      if (mask[at(y, x)] != mask[at(row, column)]) return true;
    }
  }
  return false;
}

TEST(UmepShadow, BuildingMaskAtNoonAgreesButForItsHalfCell) {
  const std::filesystem::path data = std::string(GNOMON_DATA) + "/reference/umep_shadow";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "skipped: no " << data;
  const std::vector<double> dsm = read_npy(data / "input_dsm.npy");
  const std::vector<double> umep = read_npy(data / "shadow_noon_bldg_sh.npy");  // 1: sunlit
  ASSERT_EQ(dsm.size(), std::size_t{kSize} * kSize);
  ASSERT_EQ(umep.size(), dsm.size());

  RasterGrid grid;
  grid.columns = grid.rows = kSize;
  grid.transform = {0, 1, 0, kSize, 0, -1};
  grid.z = dsm;
  const Model model =
      surface_of_grid(grid, "umep", {.mesh = RasterMesh::cells}, "", "", nullptr).value();
  Scene scene = scene_of(model);
  for (Vec3& p : scene.mesh.positions) p += model.translate;
  const View view = plan_view({0, 0, kSize, kSize}, 1.0, 0);  // its samples are the cells' middles
  const Light noon(0, -std::cos(60 * kDegree), std::sin(60 * kDegree), 0);
  const ShadowMask ours = cast_shadows(scene, noon, view);

  // What both compute, column by column: the sun stands in the south, so that rays run along the
  // columns. UMEP moves the raster by whole cells and asks a cell's middle; the cell of a mesh
  // begins half a cell before its middle.
  const std::vector<bool> middles = shaded_by_columns(dsm, 0.0);
  const std::vector<bool> cells = shaded_by_columns(dsm, 0.5);
  std::size_t equal = 0, only_ours = 0, only_umep = 0, away = 0, low_steps = 0, umep_is_middles = 0,
              ours_is_cells = 0;
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const std::size_t k = at(row, column);
      ASSERT_NE(ours.state[k], ShadowMask::kNoSample);
      const bool we = ours.state[k] == ShadowMask::kShadow, they = umep[k] == 0;
      equal += we == they ? 1 : 0;
      only_ours += we && !they ? 1 : 0;
      only_umep += they && !we ? 1 : 0;
      if (we != they && !beside_border(umep, row, column)) {
        // A step in the next cell that is too low to reach this one's middle from that one's: UMEP
        // sees no shadow of it at all, so there is no border.
        ++away;
        const double step = row + 1 < kSize ? dsm[at(row + 1, column)] - dsm[k] : 0;
        low_steps += step > 0.5 * std::tan(60 * kDegree) && step <= std::tan(60 * kDegree) ? 1 : 0;
      }
      umep_is_middles += they == middles[k] ? 1 : 0;
      ours_is_cells += we == cells[k] ? 1 : 0;
    }
  }
  // The numbers of docs/surface-models.md.
  EXPECT_EQ(ours_is_cells, dsm.size());
  EXPECT_EQ(umep_is_middles, dsm.size());
  EXPECT_EQ(equal, 158547u);
  EXPECT_EQ(only_ours, 1453u);
  EXPECT_EQ(only_umep, 0u);
  EXPECT_EQ(away, low_steps);
  EXPECT_EQ(away, 164u);
}

}  // namespace
}  // namespace gnomon
