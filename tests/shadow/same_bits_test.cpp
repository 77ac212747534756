// From given light directions, all answers are the same bits: for plain C++ and each instruction
// set that the machine offers, for 1 to 8 threads, for every compiler and level of optimization.
// docs/exactness.md, "Proof".
//
// Within one build, every answer is compared with the first instruction set's on one thread, bit
// for bit. Between builds there is one hash a scene, written down here: the same test compiled by
// each preset (debug is -O0, release -O3, scalar has no SIMD, clang is another compiler) finds the
// same numbers. A difference is a fault of the library, not of the number. Where answers are meant
// to change (another scene, another tie rule), take the new number from one build and try it in the
// others; when these were written, all counts were those of count_shadows_reference().
//
// Scenes, lights and views are literals, whole-number arithmetic and single operations that IEEE
// 754 rounds correctly: nothing of them comes from a mathematical library, but for the town.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <hwy/targets.h>
#include <scenes/generated_city.h>
#include <scenes/random.h>

#include "shadow/answers.h"
#include "shadow/vienna_block.h"
#include "soup.h"

#include <gnomon/raster/add_in_shadow.h>

namespace gnomon {
namespace {

using scenes::Random;
using test::Answers;

std::vector<Answers> answers(const Scene& scene, std::span<const View> views,
                             std::span<const Light> lights, int threads) {
  std::vector<Answers> all;
  for (const View& v : views) all.push_back(test::answers(scene, v, lights, threads));
  return all;
}

// Instruction sets with numbers of threads: all that are offered and 1 to 8 are among them.
std::vector<std::pair<std::int64_t, int>> variants() {
  const std::vector<std::int64_t> offered = hwy::SupportedAndGeneratedTargets();
  std::vector<std::pair<std::int64_t, int>> all;
  for (std::size_t k = 0; k < std::max<std::size_t>(8, offered.size()); ++k)
    all.emplace_back(offered[k % offered.size()], 1 + static_cast<int>(k % 8));
  return all;
}

void expect_hash(std::uint64_t hash, const Scene& scene, const std::vector<View>& views,
                 const std::vector<Light>& lights) {
  std::vector<Answers> first;
  for (const auto& [target, threads] : variants()) {
    hwy::SetSupportedTargetsForTest(target);
    const std::vector<Answers> these = answers(scene, views, lights, threads);
    if (first.empty()) first = these;
    if (these != first) {
      ADD_FAILURE() << instruction_set() << ", threads: " << threads << "\n"
                    << test::hashes_of_parts(these) << "instead of\n"
                    << test::hashes_of_parts(first);
      break;
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  EXPECT_EQ(test::hash_of(first), hash) << test::hashes_of_parts(first);
}

// The picture's middle is `middle`: a point of a parallel view, a direction of a camera.
View view_of(const Vec4& eye, const Vec4& middle, const Vec3& right, const Vec3& down, int width,
             int height) {
  View v;
  v.eye = eye;
  v.right = direction(right);
  v.down = direction(down);
  v.origin = middle - v.right * (width / 2.0) - v.down * (height / 2.0);
  v.width = width;
  v.height = height;
  return v;
}

// Elevations as architects draw them: from the south, walls seen frontally, roofs edge-on.
View facade(const Vec3& middle, double pixel, int width, int height) {
  return view_of({0, -1, 0, 0}, point(middle), {pixel, 0, 0}, {0, 0, -pixel}, width, height);
}

// From above in the south-east; the vectors are at right angles.
View oblique(const Vec3& middle, double pixel, int width, int height) {
  return view_of({2, -2, 1, 0}, point(middle), Vec3(1, 1, 0) * (0.75 * pixel),
                 Vec3(1, -1, -4) * (0.25 * pixel), width, height);
}

// Looks the same way; a pixel is about a hundredth of the distance.
View camera(const Vec3& eye, int width, int height) {
  return view_of(point(eye), {-2, 2, -1, 0}, Vec3(1, 1, 0) * 0.0225, Vec3(1, -1, -4) * 0.0075,
                 width, height);
}

TEST(SameBits, OfTerracesFullOfTies) {
  TriMesh m;
  test::add_ground(m, 24);
  test::add_box(m, {-14, -6, 0}, {-6, 6, 6});
  test::add_box(m, {-14, -6, 0}, {-6, 6, 6});  // once more
  test::add_box(m, {-6, -6, 0}, {-2, 2, 3});   // against its wall
  test::add_box(m, {4, -12, 0}, {12, -4, 4});
  test::add_box(m, {6, -10, 4}, {10, -6, 8});                         // on its roof
  test::add_quad(m, {2, 2, 5}, {14, 2, 5}, {14, 12, 5}, {2, 12, 5});  // a canopy
  test::add_quad(m, {-2, 4, 6}, {4, 4, 0}, {4, 10, 0}, {-2, 10, 6});  // in the first sun's plane
  test::add_quad(m, {-12, 10, 0}, {-4, 10, 0}, {-4, 10, 7}, {-12, 10, 7});  // a fence
  const Scene scene = test::scene_of(std::move(m));
  const std::vector<Light> lights = {{-1, 0, 1, 0}, {0, 1, 1, 0},     {-1, -1, 1, 0},
                                     {0, 0, 1, 0},  {1, 2, 0, 0},     {2, -2, 1, 0},
                                     {1, 1, -1, 0}, {-6, -6, 6, 1},   {8, 7, 2, 1},
                                     {0, 0, 16, 1}, {20, -20, 10, 1}, {0.5, -0.25, 0.375, 0}};
  expect_hash(
      7338062864468222110u, scene,
      {plan_view({-14.5, -24.5, 14.5, 12.5}, 1, 0), facade({0, 0, 5}, 1, 34, 12),
       oblique({0, 0, 2}, 1, 36, 34), camera({20, -20, 10}, 12, 8), camera({12, 3, 4}, 24, 20)},
      lights);
}

TEST(SameBits, OfASoupWhereSomeTrianglesOnlyCastAndSomeOnlyReceive) {
  TriMesh m;
  Random random{1};
  for (int k = 0; k < 70; ++k) {
    const bool on_grid = k % 3 == 0;
    const auto coordinate = [&] {
      return on_grid ? static_cast<double>(random.bits() % 19) - 9 : random.between(-9, 9);
    };
    const auto v = static_cast<std::uint32_t>(m.positions.size());
    for (int corner = 0; corner < 3; ++corner) {
      const double x = coordinate(), y = coordinate(), z = coordinate();
      m.positions.push_back({x, y, z});
    }
    m.triangles.push_back({v, v + 1, v + 2});
  }
  test::add_ground(m, 12, -9);
  Scene scene = test::scene_of(std::move(m));
  scene.surfaces.resize(3);
  scene.surfaces[1].receives = false;
  scene.surfaces[2].casts = false;
  for (std::size_t t = 0; t < scene.surface_of.size(); ++t)
    scene.surface_of[t] = static_cast<std::uint32_t>(t % 3);
  const std::vector<Light> lights = {{-0.4, 0.3, 0.5, 0}, {1, 0, 1, 0},      {0.7, 0.2, -0.1, 0},
                                     {1e-7, 1e-7, 1, 0},  {0, -1, 0.125, 0}, {3, 4, 25, 1},
                                     {1, 2, 3, 1},        {2, -2, 1, 1}};
  expect_hash(10272643571790193258u, scene,
              {plan_view({-12.1, -11.3, 12, 12}, 0.7, 0), facade({0, 0, 0}, 2, 12, 12),
               oblique({0, 0, 0}, 0.8, 26, 34), camera({26, -26, 13}, 36, 34),
               camera({2.5, -2, 1.25}, 24, 20)},
              lights);
}

TEST(SameBits, OfHillsThatLowLightGrazes) {
  constexpr std::uint32_t kCells = 12;
  TriMesh m;
  Random random{2};
  for (std::uint32_t j = 0; j <= kCells; ++j) {
    for (std::uint32_t i = 0; i <= kCells; ++i) {
      const double x = 5.0 * i - 30, y = 5.0 * j - 30;
      m.positions.push_back({x, y, (400 - x * x / 9 - y * y / 4) / 64 + random.between(0, 1.5)});
    }
  }
  for (std::uint32_t j = 0; j < kCells; ++j) {
    for (std::uint32_t i = 0; i < kCells; ++i) {
      const std::uint32_t v = j * (kCells + 1) + i;
      m.triangles.push_back({v, v + 1, v + kCells + 2});
      m.triangles.push_back({v, v + kCells + 2, v + kCells + 1});
    }
  }
  test::add_box(m, {-4.2, -11.7, -2}, {3.9, -5.3, 14.1});
  const Scene scene = test::scene_of(std::move(m));
  const std::vector<Light> lights = {{1, 0.2, 0.1, 0},    {0.3, -1, 0.3, 0}, {-1, -1e-9, 0.2, 0},
                                     {-0.6, 0.8, 0.6, 0}, {0, 0, 1, 0},      {10, 11, 12, 1},
                                     {-40, 3, 7.5, 1}};
  expect_hash(17469135798380385700u, scene,
              {plan_view({-31, -32, 31, 31}, 0.9, 3), facade({0, 0, 6}, 1.5, 40, 14),
               oblique({0, 0, 4}, 1.5, 34, 34), camera({30, -30, 20}, 40, 34)},
              lights);
}

TEST(SameBits, OfHousesFarFromTheOrigin) {
  TriMesh m;
  const Vec3 o(4.0e5, 5.5e6, 120);
  test::add_quad(m, o + Vec3(-20, -20, 0), o + Vec3(20, -20, 1), o + Vec3(20, 20, 2),
                 o + Vec3(-20, 20, 1));
  test::add_box(m, o + Vec3(-5, -4, 0), o + Vec3(3, 6, 11));
  test::add_box(m, o + Vec3(6.01, -9, 0), o + Vec3(6.02, 9, 5));
  const Scene scene = test::scene_of(std::move(m));
  const std::vector<Light> lights = {{-0.4, 0.3, 0.5, 0},
                                     {1, 0, 1, 0},
                                     {-1, -1, 0.05, 0},
                                     {0.25, 2, 3, 0},
                                     point(o + Vec3(9, 12, 7))};
  expect_hash(13132344461321728218u, scene,
              {plan_view({o.x - 20, o.y - 20, o.x + 20, o.y + 20}, 0.6, o.z),
               facade(o + Vec3(0, 0, 5), 1, 34, 16), oblique(o + Vec3(0, 0, 4), 1.2, 26, 34),
               camera(o + Vec3(24, -24, 14), 26, 20)},
              lights);
}

TEST(SameBits, OfSoManySunsThatTheirSilhouettesComeFromATree) {
  TriMesh m;
  test::add_ground(m, 12);
  test::add_box(m, {-5, -3, 0}, {1.5, 2.5, 6.1});
  test::add_box(m, {3.2, -7, 0}, {6.3, 4, 3});
  test::add_quad(m, {-8, 5, 2}, {7, 5.5, 3}, {7, 9, 4}, {-8, 9, 3});
  const Scene scene = test::scene_of(std::move(m));
  Random random{3};
  std::vector<Light> lights;
  for (int k = 0; k < 512; ++k) {
    const double x = random.between(-1, 1), y = random.between(-1, 1), z = random.between(0, 1);
    lights.push_back({x, y, z, 0});
  }
  expect_hash(13110619262186633644u, scene, {plan_view({-8, -8, 8, 8}, 0.9, 0)}, lights);
}

TEST(SameBits, OfABlockOfVienna) {
  const Scene scene =
      test::vienna_block(GNOMON_SCENES "/vienna/vienna.city.jsonl", 215, 235, 240, 265);
  ASSERT_GT(scene.mesh.triangles.size(), 1000u);
  const std::vector<Light> lights = {{-0.5, -0.6, 0.4, 0}, {0.1, -0.8, 0.7, 0}, {0.8, 0.1, 0.2, 0},
                                     {-0.7, 0.2, 0.05, 0}, {0, 0, 1, 0},        {221, 250, 52, 1}};
  expect_hash(13817180954477924224u, scene,
              {plan_view({215, 235, 240, 265}, 0.8, 15), facade({227, 250, 18}, 1.5, 20, 14),
               oblique({227, 250, 15}, 1, 32, 34), camera({242, 235, 42}, 32, 20)},
              lights);
}

// Its corners are made with sines, but rounded to whole millimetres.
TEST(SameBits, OfAGeneratedTown) {
  scenes::CityOptions options;
  options.buildings = 40;
  const Scene town = scenes::generated_city(options);
  const Bounds2 b = scenes::city_bounds(options);
  const std::vector<Light> lights = {
      {0.5, -0.5, 0.25, 0}, {-0.75, 0.125, 0.5, 0}, {1, 1, 2, 0}, {0, -1, 0.0625, 0}};
  expect_hash(18419001908836418694u, town,
              {plan_view(b, (b.x1 - b.x0) / 66, 0), camera({120, -120, 70}, 40, 24)}, lights);
}

}  // namespace
}  // namespace gnomon
