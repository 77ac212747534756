// Cameras, lamps, and plans whose receivers lie behind casters: sides over squares of the picture
// (raster/side.h, raster/fill_tiles.h) against the specification, sample by sample, on every
// instruction set that the machine offers.
#include <gtest/gtest.h>

#include <limits>

#include <hwy/targets.h>

#include "soup.h"

#include <gnomon/raster/add_in_shadow.h>
#include <gnomon/raster/count_shadows.h>
#include <gnomon/raster/fill_tiles.h>
#include <gnomon/raster/visible_surfaces.h>

namespace gnomon {
namespace {

using test::scene_of;

void expect_counts(const Casters& casters, const Receivers& r, std::span<const Light> lights,
                   const std::vector<std::vector<std::int32_t>>& expected) {
  const std::size_t samples = r.triangle.size();
  std::vector<std::vector<std::int32_t>> counts(lights.size(),
                                                std::vector<std::int32_t>(samples, -1));
  std::vector<std::vector<std::uint8_t>> masks(lights.size(),
                                               std::vector<std::uint8_t>(samples, 7));
  std::vector<std::int32_t*> to_counts;
  std::vector<std::uint8_t*> to_masks;
  for (auto& c : counts) to_counts.push_back(c.data());
  for (auto& m : masks) to_masks.push_back(m.data());
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    count_shadows(casters, r, lights, to_counts, 2);
    mask_shadows(casters, r, lights, to_masks, 2);
    for (std::size_t l = 0; l < lights.size(); ++l) {
      EXPECT_EQ(counts[l], expected[l]) << instruction_set() << ", light " << l;
      std::size_t wrong = 0;
      for (std::size_t k = 0; k < samples; ++k)
        wrong += masks[l][k] != (expected[l][k] > 0 ? 1 : 0) ? 1 : 0;
      EXPECT_EQ(wrong, 0u) << instruction_set() << ", mask of light " << l;
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

// How many samples are dark, over all lights.
std::size_t expect_the_specification(const Scene& scene, const View& view,
                                     std::span<const Light> lights) {
  const Casters casters = prepare_casters(scene);
  const Receivers r = visible_surfaces(scene, view);
  std::vector<std::vector<std::int32_t>> expected;
  std::size_t dark = 0;
  for (const Light& l : lights) {
    expected.push_back(count_shadows_reference(casters, r, l));
    for (const std::int32_t n : expected.back()) dark += n > 0 ? 1 : 0;
  }
  expect_counts(casters, r, lights, expected);
  return dark;
}

// Suns and lamps: along axes and diagonals, slanting, from below; lamps on the grid and off it.
std::vector<Light> lights_of_all_kinds() {
  return {{-1, 0, 1, 0}, {0.3, 0.5, 0.2, 0}, {0.7, -0.7, -0.3, 0}, {1, 1, 0, 0},
          {0, 0, 1, 0},  {2, 2, 2, 1},       {2.5, 3.5, 7.25, 1},  {-3, 4, -6, 1}};
}

// Rows and columns run along axes, one unit a pixel at distance 4: pixels' centres on the grid of
// half units tie.
View camera_on_grid(const Vec3& eye, int width, int height) {
  View v;
  v.eye = point(eye);
  v.origin = Vec4(-width / 2.0, 4, height / 2.0, 0);
  v.right = Vec4(1, 0, 0, 0);
  v.down = Vec4(0, 0, -1, 0);
  v.width = width;
  v.height = height;
  return v;
}

// The first triangles receive and do not cast, the next ones cast and do not receive, the rest does
// both.
Scene with_parts(Scene s, std::size_t only_receive, std::size_t only_cast) {
  s.surfaces.resize(3);
  s.surfaces[1].casts = false;
  s.surfaces[2].receives = false;
  for (std::size_t t = 0; t < s.surface_of.size(); ++t)
    s.surface_of[t] = t < only_receive ? 1 : t < only_receive + only_cast ? 2 : 0;
  return s;
}

Scene box_on_ground() {
  TriMesh m;
  test::add_ground(m, 12);
  test::add_box(m, {-3, -2, 0}, {2, 4, 5});
  return scene_of(std::move(m));
}

// A window of a picture, with the samples that it has there. Precondition: the view's vectors are
// short numbers, so that its corner moves exactly.
Receivers window_of(const Receivers& r, int column, int row, int width, int height) {
  Receivers out;
  out.view = r.view;
  out.nearness_floor = r.nearness_floor;
  out.view.origin += double(column) * r.view.right + double(row) * r.view.down;
  out.view.width = width;
  out.view.height = height;
  for (int y = row; y < row + height; ++y) {
    for (int x = column; x < column + width; ++x) {
      const auto k = static_cast<std::size_t>(y) * static_cast<std::size_t>(r.view.width) +
                     static_cast<std::size_t>(x);
      out.triangle.push_back(r.triangle[k]);
      out.nearness.push_back(r.nearness[k]);
    }
  }
  return out;
}

TEST(Sides, OfSoupsWithAndWithoutTiesCountAsTheSpecification) {
  std::size_t dark = 0;
  for (const double grid : {0.0, 1.0}) {
    TriMesh m;
    test::add_soup(m, 7, 8, grid, 3);
    test::add_ground(m, 10, -8);
    test::add_box(m, {-4, -2, -8}, {2, 4, 2});
    const Scene scene = scene_of(std::move(m));
    for (const View& view :
         {perspective_view({14.2, -17.3, 9.1}, {0, 0, 0}, {0, 0, 1}, 0.9, 17, 13),
          camera_on_grid({1, -12, 0}, 16, 12), plan_view({-9, -9, 9, 9}, 1, 0),
          orthographic_view({14.2, -17.3, 9.1}, {0, 0, 0}, {0, 0, 1}, 22, 18, 15)}) {
      dark += expect_the_specification(scene, view, lights_of_all_kinds());
    }
  }
  EXPECT_GT(dark, 1000u);
}

TEST(Sides, AndCastersInFrontOfReceiversCountAsTheSpecification) {
  std::size_t dark = 0;
  for (const double grid : {0.0, 2.0}) {
    TriMesh m;
    test::add_ground(m, 10, -8);
    test::add_box(m, {-4, -2, -8}, {2, 4, 2});
    test::add_soup(m, 6, 8, grid, 5);
    const Scene scene = with_parts(scene_of(std::move(m)), 6, 10);
    for (const View& view :
         {perspective_view({14.2, -17.3, 9.1}, {0, 0, 0}, {0, 0, 1}, 0.9, 17, 13),
          camera_on_grid({1, -12, 0}, 16, 12), plan_view({-9, -9, 9, 9}, 1, 0),
          orthographic_view({0, -20, 0}, {0, 0, 0}, {0, 0, 1}, 16, 16, 16)}) {
      dark += expect_the_specification(scene, view, lights_of_all_kinds());
    }
  }
  EXPECT_GT(dark, 1000u);
}

TEST(Sides, SeenFromWithinTheirPlanesFromVerticesAndFromInsideABoxCountAsTheSpecification) {
  // From the planes of faces and of sides, a corner, the middle of an edge and of a face, inside.
  const Scene scene = box_on_ground();
  for (const Vec3& eye : {Vec3(2, -12, 5), Vec3(5, -9, 5), Vec3(2, -2, 5), Vec3(2, 1, 5),
                          Vec3(0, 1, 5), Vec3(0, 0, 2), Vec3(0, -12, 0)}) {
    expect_the_specification(
        scene, camera_on_grid(eye, 14, 12),
        std::vector<Light>{{-1, -1, 1, 0}, {0, -1, 0.5, 0}, {5, -2, 8, 1}, point(eye)});
  }
}

TEST(Sides, UnderLampsAtTheEyeOnVerticesAndEdgesBehindTheCameraAndInThePictureCountAsSpecified) {
  const Vec3 eye(7, -9, 6);
  const std::vector<Light> lamps = {point(eye),    {2, 4, 5, 1},     {2, 1, 5, 1},  {0, 1, 5, 1},
                                    {0, 0, 2, 1},  {14, -18, 12, 1}, {5, -6, 0, 1}, {5, -6, 1, 1},
                                    {2, -2, 9, 1}, {7, -9, 20, 1}};
  const View view = perspective_view(eye, {0, 0, 2}, {0, 0, 1}, 1, 17, 13);
  expect_the_specification(box_on_ground(), view, lamps);
  expect_the_specification(with_parts(box_on_ground(), 2, 6), view, lamps);
  expect_the_specification(box_on_ground(), plan_view({-8, -8, 8, 8}, 1, 0), lamps);
}

TEST(Sides, UnderALampAtTheEyeAreLeftOut) {
  const Vec3 eye(7, -9, 6);
  const View view = perspective_view(eye, {0, 0, 2}, {0, 0, 1}, 1, 40, 30);
  const Scene scene = box_on_ground();
  const Light light = point(eye);
  const Receivers r = visible_surfaces(scene, view);
  std::vector<std::int32_t> counts(r.triangle.size());
  std::int32_t* const to = counts.data();
  const CountStats stats =
      count_shadows(prepare_casters(scene), r, std::span(&light, 1), std::span(&to, 1), 1);
  EXPECT_EQ(stats.spans.exact, 0u);
  EXPECT_EQ(stats.close, 0u);
}

TEST(Sides, UnderALampOverAVertexAskForTilesNotForSamples) {
  // Seen from above, the edges from the vertex towards the lamp are points: no float knows which
  // side of them a sample lies on.
  TriMesh m;
  test::add_ground(m, 40);
  test::add_box(m, {-20, -20, 0}, {0.25, 0.25, 5});
  m.positions.push_back({0.25, 0.25, 12});
  m.positions.push_back({9, 3, 3});
  m.positions.push_back({-4, 9, 4});
  const auto k = static_cast<std::uint32_t>(m.positions.size());
  m.triangles.push_back({k - 3, k - 2, k - 1});
  const Scene scene = scene_of(std::move(m));
  const Light light(0.25, 0.25, 17, 1);
  const Receivers r = visible_surfaces(scene, plan_view({-32, -32, 32, 32}, 0.25, 0));
  std::vector<std::int32_t> counts(r.triangle.size());
  std::int32_t* const to = counts.data();
  const CountStats stats =
      count_shadows(prepare_casters(scene), r, std::span(&light, 1), std::span(&to, 1), 1);
  EXPECT_GT(stats.spans.exact, 0u);
  EXPECT_LT(stats.spans.exact, counts.size() / 4);
}

TEST(Sides, UnderSunsAlongTheAxisAndThroughVerticesCountAsTheSpecification) {
  const Vec3 eye(6, -8, 7);
  std::vector<Light> suns;
  for (const Vec3& to : {Vec3(0, 1, 0), Vec3(2, -2, 5) - eye, Vec3(-3, 4, 5) - eye,
                         Vec3(2, 4, 0) - eye, Vec3(-12, -12, 0) - eye}) {
    suns.push_back(direction(to));
    suns.push_back(direction(-to));
  }
  expect_the_specification(box_on_ground(), camera_on_grid(eye, 16, 18), suns);
}

TEST(Sides, OverEdgesSeenEndOnCountAsTheSpecification) {
  // A box whose edges along y run towards the eye, one of them exactly, and one behind it.
  TriMesh m;
  test::add_ground(m, 15, -3);
  test::add_box(m, {1, -2, 0}, {4, 3, 2});
  test::add_box(m, {-4, -14, 0}, {1, -11, 2});
  const Scene scene = scene_of(std::move(m));
  const std::vector<Light> lights = {{-1, -1, 1, 0}, {1, 0, 2, 0},   {0, -1, 1, 0},
                                     {-3, -6, 5, 1}, {1, -20, 2, 1}, {1, 7, 2, 1}};
  expect_the_specification(scene, camera_on_grid({1, -8, 2}, 13, 13), lights);
}

TEST(Sides, InPicturesOfAllSizesCountAsTheSpecification) {
  TriMesh m;
  test::add_ground(m, 12);
  test::add_box(m, {-3, -2, 0.5}, {2, 4, 5});
  const Scene scene = scene_of(std::move(m));
  const std::vector<Light> lights = {{4, -6, 7, 1}};
  for (const auto& [width, height] :
       {std::pair(1, 1), std::pair(7, 9), std::pair(8, 8), std::pair(33, 31), std::pair(129, 127),
        std::pair(2100, 2), std::pair(3, 530), std::pair(8200, 1)}) {
    View view = perspective_view({9, -11, 8}, {0, 0, 1}, {0, 0, 1}, 0.9, 64, 64);
    view.right *= 64.0 / width;
    view.down *= 64.0 / height;
    view.width = width;
    view.height = height;
    expect_the_specification(scene, view, lights);
  }
}

TEST(Sides, OverWholeBlocksAndFieldsCountAsTheSpecification) {
  // A wide roof and its shadow cover and miss squares of every size. The reference looks at windows
  // across their borders.
  TriMesh m;
  test::add_ground(m, 40);
  test::add_quad(m, {-20, -20, 9}, {6, -20, 9}, {6, 20, 9}, {-20, 20, 9});
  test::add_box(m, {2, 3, 0}, {7, 8, 11});
  const Scene scene = scene_of(std::move(m));
  const Casters casters = prepare_casters(scene);
  View view;
  view.eye = Vec4(0.5, 0.25, 32, 1);
  view.origin = Vec4(-0.8125, 0.765625, -1, 0);
  view.right = Vec4(0x1p-10, 0, 0, 0);
  view.down = Vec4(0, -0x1p-10, 0, 0);
  view.width = 1664;
  view.height = 1568;
  const Receivers r = visible_surfaces(scene, view);
  for (const Light& light : {Light(-1, 0.25, 1, 0), Light(3, 2, 30, 1), Light(0, 0, -1, 0)}) {
    std::vector<std::int32_t> counts(r.triangle.size());
    std::int32_t* const to = counts.data();
    count_shadows(casters, r, std::span(&light, 1), std::span(&to, 1), 2);
    std::size_t wrong = 0;
    for (int row = 2; row < view.height - 8; row += 170) {
      for (int column = 4; column < view.width - 8; column += 126) {
        const Receivers window = window_of(r, column, row, 8, 4);
        const auto expected = count_shadows_reference(casters, window, light);
        for (int y = 0; y < 4; ++y) {
          for (int x = 0; x < 8; ++x) {
            wrong += counts[static_cast<std::size_t>((row + y) * view.width + column + x)] !=
                             expected[static_cast<std::size_t>(y * 8 + x)]
                         ? 1
                         : 0;
          }
        }
      }
    }
    EXPECT_EQ(wrong, 0u);
  }
}

TEST(Sides, FarFromTheOriginCountAsTheSpecification) {
  const Vec3 o(4.0e5, 5.5e6, 120);
  TriMesh m;
  test::add_quad(m, o + Vec3(-20, -20, 0), o + Vec3(20, -20, 1), o + Vec3(20, 20, 2),
                 o + Vec3(-20, 20, 1));
  test::add_box(m, o + Vec3(-5, -4, 0), o + Vec3(3, 6, 11));
  test::add_box(m, o + Vec3(6.01, -9, 0), o + Vec3(6.02, 9, 5));
  const Scene scene = scene_of(std::move(m));
  const std::vector<Light> lights = {{-0.4, 0.3, 0.5, 0},
                                     point(o + Vec3(8, -9, 12)),
                                     point(o + Vec3(3, 6, 11)),
                                     {1, 1e-9, 0.5, 0}};
  expect_the_specification(scene, perspective_view(o + Vec3(9, -21, 8), o, {0, 0, 1}, 1, 31, 23),
                           lights);
  expect_the_specification(scene, plan_view({o.x - 20, o.y - 20, o.x + 20, o.y + 20}, 1.5, o.z),
                           lights);
}

TEST(Sides, OfSliversAndNeedlesCountAsTheSpecification) {
  TriMesh m;
  test::add_ground(m, 15, -4);
  double at = -8;
  for (const double hair : {0x1p-90, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3}) {
    const auto k = static_cast<std::uint32_t>(m.positions.size());
    m.positions.insert(m.positions.end(), {{-8, at, 0}, {8, at + 1, hair}, {8 + hair, at + 1, 0}});
    m.triangles.push_back({k, k + 1, k + 2});
    test::add_quad(m, {at, -8, 1}, {at + hair, -8, 1}, {at + hair, 8, 2}, {at, 8, 2});
    at += 2.5;
  }
  const Scene scene = scene_of(std::move(m));
  const std::vector<Light> lights = {
      {-0.4, 0.3, 0.5, 0}, {0, 0, 1, 0}, {3, -4, 6, 1}, {8, -7, 0, 1}};
  expect_the_specification(scene, perspective_view({9, -14, 8}, {0, 0, 0}, {0, 0, 1}, 0.8, 29, 21),
                           lights);
  expect_the_specification(scene, camera_on_grid({0, -12, 0}, 16, 10), lights);
}

TEST(Sides, OfScenesFromAtomsToPlanetsAndUnderLightsOfAnyLengthAreTheSame) {
  std::vector<std::vector<std::int32_t>> of_metres;
  for (const double scale : {1.0, 0x1p-90, 0x1p-40, 0x1p30}) {
    TriMesh m;
    test::add_ground(m, 12);
    test::add_box(m, {-3, -2, 0}, {2, 4, 5});
    test::add_soup(m, 5, 6, 0.25, 8);
    for (Vec3& p : m.positions) p *= scale;
    const Scene scene = scene_of(std::move(m));
    View view = camera_on_grid(Vec3(1, -12, 3) * scale, 16, 14);
    for (const double length : {1.0, 0x1p-98, 0x1p36}) {
      view.right.x = length;
      view.down.z = -length;
      view.origin = Vec4(-8, 4, 7, 0) * length;
      const std::vector<Light> lights = {Light(-1, -0.5, 2, 0) * length,
                                         Light(Vec3(3, -6, 7) * scale, 1)};
      const Casters casters = prepare_casters(scene);
      const Receivers r = visible_surfaces(scene, view);
      if (of_metres.empty()) {
        for (const Light& l : lights) of_metres.push_back(count_shadows_reference(casters, r, l));
      }
      expect_counts(casters, r, lights, of_metres);
    }
  }
}

TEST(Sides, NearnessThatNoFloatHoldsIsDecidedExactly) {
  // An eye at infinity by a vector of a few atoms' length: heights are many of it.
  TriMesh m;
  const double far = 0x1p39, up = 0x1p38;
  test::add_ground(m, far, -up);
  test::add_box(m, Vec3(-3, -2, -8) * (far / 16), Vec3(2, 4, 5) * (far / 16));
  const Scene scene = scene_of(std::move(m));
  View view = plan_view({-far, -far, far, far}, far / 8, 0);
  view.eye = Vec4(0, 0, 0x1p-99, 0);
  EXPECT_GT(expect_the_specification(
                scene, view, std::vector<Light>{{-1, 0.5, 1, 0}, {far / 2, -far, far / 2, 1}}),
            0u);
}

TEST(Sides, WhoseEdgesPassTheEyeByLessThanFloatHoldsAreDecidedExactly) {
  // An edge that passes the eye by 2^-99, in a scene that reaches 10^12: its edge function is known
  // to no float. Above 45 degrees the side passes the eye, below it does not.
  const double hair = 0x1p-99;
  TriMesh m;
  test::add_quad(m, {-40, 10, -40}, {40, 10, -40}, {40, 10, 40}, {-40, 10, 40});
  m.positions.insert(m.positions.end(), {{16, hair, hair}, {-8, hair, hair}, {9e11, 9e11, 9e11}});
  m.triangles.push_back({4, 5, 6});
  const Scene scene = scene_of(std::move(m));
  View view = camera_on_grid({0, 0, 0}, 16, 16);
  view.origin.y = 4;
  expect_the_specification(scene, view, std::vector<Light>{{0, -1, 0, 0}, {0, -100, 0, 1}});
}

TEST(Sides, OverPicturesWithoutSamplesOrWithOneCornerOfThemCountAsTheSpecification) {
  TriMesh m;
  test::add_box(m, {-3, -2, 0}, {2, 4, 5});
  test::add_soup(m, 4, 4, 0, 3);
  const Scene scene = scene_of(std::move(m));
  const std::vector<Light> lights = {{-0.4, -0.3, 0.5, 0}, {4, -6, 7, 1}};
  const Vec3 eye(2, -30, 4);
  EXPECT_EQ(expect_the_specification(
                scene, perspective_view(eye, {0, -60, 0}, {0, 0, 1}, 1, 21, 17), lights),
            0u);
  for (const Vec3& beside :
       {Vec3(14, 0, -10), Vec3(-14, 0, -10), Vec3(14, 0, 14), Vec3(-14, 0, 14)})
    expect_the_specification(scene, perspective_view(eye, beside, {0, 0, 1}, 0.9, 41, 37), lights);
}

TEST(Sides, BeforeSamplesOfUnknownNearnessAreDecidedExactly) {
  const Scene scenes[] = {box_on_ground(), with_parts(box_on_ground(), 2, 6)};
  for (const Scene& scene : scenes) {
    const Casters casters = prepare_casters(scene);
    for (const View& view : {perspective_view({9, -11, 8}, {0, 0, 1}, {0, 0, 1}, 0.9, 23, 19),
                             plan_view({-9, -9, 9, 9}, 1, 0)}) {
      Receivers r = visible_surfaces(scene, view);
      const std::vector<Light> lights = {{-0.4, -0.3, 0.5, 0}, {4, -6, 7, 1}};
      std::vector<std::vector<std::int32_t>> expected;
      for (const Light& l : lights) expected.push_back(count_shadows_reference(casters, r, l));
      for (const std::size_t step : {3u, 1u}) {
        for (std::size_t k = 0; k < r.nearness.size(); k += step) {
          if (r.triangle[k] != kNoTriangle) r.nearness[k] = std::numeric_limits<float>::quiet_NaN();
        }
        r.cells = {};
        r.tiles = {};
        expect_counts(casters, r, lights, expected);
      }
    }
  }
}

TEST(Sides, OfUnknownNearnessAskNothingOfPixelsWithoutSamples) {
  // A tile that the picture's right and lower border cut, with a hole; a side of which nothing is
  // known. Pixels outside the picture were once asked for, beyond the end of the samples.
  class Asked final : public ExactSideDecisions {
   public:
    bool covers(const Side&, int column, int row) override {
      ++at[static_cast<std::size_t>(row * kTile + column)];
      return true;
    }
    int covers_tile(const Side&, int, int) override { return 0; }
    bool in_front(const Side&, int, int) override { return true; }
    int at[kTile * kTile] = {};
  };
  Receivers r;
  r.view = camera_on_grid({0, 0, 0}, 5, 3);
  r.triangle.assign(15, 0);
  r.nearness.assign(15, 0.5F);
  r.nearness[7] = std::numeric_limits<float>::infinity();
  const NearnessTiles tiles = nearness_tiles(r, 1);
  Side side{};
  for (float& s : side.slack) s = 1;
  side.c[kNearness] = side.c[kUpper] = side.c[kLower] = std::numeric_limits<double>::quiet_NaN();
  side.add = 1;
  const std::uint32_t index = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    Asked asked;
    BlockCounts counts;
    fill_block({&side, &index, 1, &tiles, 0, &counts, &asked});
    for (int row = 0; row < kTile; ++row) {
      for (int column = 0; column < kTile; ++column) {
        const bool sample = column < 5 && row < 3 && row * 5 + column != 7;
        EXPECT_EQ(asked.at[row * kTile + column], sample ? 1 : 0) << column << " " << row;
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace
}  // namespace gnomon
