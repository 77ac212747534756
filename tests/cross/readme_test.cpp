// The README's example, as it stands there.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gnomon/gnomon.h>

namespace {

TEST(Readme, ExampleOfTheLibraryRuns) {
  const auto before = std::filesystem::current_path();
  const auto folder = std::filesystem::temp_directory_path() / "gnomon-readme-test";
  std::filesystem::create_directories(folder);
  std::filesystem::copy_file(GNOMON_SCENES "/vienna/vienna.city.jsonl",
                             folder / "vienna.city.jsonl",
                             std::filesystem::copy_options::overwrite_existing);
  std::filesystem::current_path(folder);
  const gnomon::Instant noon =
      std::chrono::sys_days(std::chrono::year(2024) / 9 / 18) + std::chrono::hours(11);

  // clang-format off
auto loaded = gnomon::load_scene({"vienna.city.jsonl"}, {.crs = "EPSG:31256"}).value();
const gnomon::Scene& scene = loaded.scene;
gnomon::View plan = gnomon::plan_view({-200, -200, 200, 200}, 0.5, 0);            // metres, scene coordinates
gnomon::Light sun = gnomon::sun_direction(gnomon::sun_position(noon, *scene.frame.place), scene.frame.true_north);

gnomon::ShadowMask mask = gnomon::cast_shadows(scene, sun, plan);                 // lit, shadow or no sample
gnomon::Profile hours = gnomon::shadow_profile(scene, plan, {.date = "2024-09-18", .from = "09:00", .to = "17:00",
                                                            .every = "1h", .zone = "Europe/Vienna"}).value();
gnomon::write_profile_geotiff("hours.tif", hours, plan, scene.frame, {}).value();
  // clang-format on

  EXPECT_TRUE(std::filesystem::exists("hours.tif"));
  std::filesystem::current_path(before);
  std::filesystem::remove_all(folder);
  EXPECT_EQ(mask.width, 800);
  std::size_t shadow = 0;
  for (const std::uint8_t s : mask.state) shadow += s == gnomon::ShadowMask::kShadow ? 1 : 0;
  EXPECT_GT(shadow, mask.state.size() / 20);
  EXPECT_LT(shadow, mask.state.size() / 2);
  EXPECT_EQ(hours.daylight_ticks, 8u * 3600000u);
}

TEST(Readme, ShowsTheExampleThatIsTested) {
  std::ifstream readme(GNOMON_SCENES "/../README.md"),
      test(GNOMON_SCENES "/../tests/cross/readme_test.cpp");
  std::stringstream r, t;
  r << readme.rdbuf();
  t << test.rdbuf();
  const std::string text = t.str();
  const std::size_t begin = text.find("auto loaded"), end = text.find("  // clang-format on");
  ASSERT_NE(begin, std::string::npos);
  EXPECT_NE(r.str().find(text.substr(begin, end - begin)), std::string::npos);
}

}  // namespace
