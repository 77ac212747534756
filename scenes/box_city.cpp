#include <scenes/box_city.h>

#include <array>
#include <cmath>
#include <string>

#include <gnomon/mesh/weld.h>
#include <scenes/random.h>

namespace gnomon::scenes {
namespace {

constexpr double kNarrowest = 8, kWidest = kBoxPitch - kBoxStreet;

double millimetres(double x) { return std::round(x * 1000) / 1000; }

struct Builder {
  Scene& scene;
  std::uint32_t surface = 0;

  std::uint32_t vertex(double x, double y, double z) {
    scene.mesh.positions.push_back({x, y, z});
    return static_cast<std::uint32_t>(scene.mesh.positions.size() - 1);
  }
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    scene.mesh.triangles.insert(scene.mesh.triangles.end(), {{a, b, c}, {a, c, d}});
    scene.surface_of.insert(scene.surface_of.end(), {surface, surface});
  }
  void begin(const std::string& name, const std::string& material) {
    surface = static_cast<std::uint32_t>(scene.surfaces.size());
    scene.surfaces.push_back({.object = name, .group = name, .material = material, .semantic = {}});
  }
  std::array<std::uint32_t, 4> rectangle(double x, double y, double half_x, double half_y,
                                         double z) {
    return {vertex(x - half_x, y - half_y, z), vertex(x + half_x, y - half_y, z),
            vertex(x + half_x, y + half_y, z), vertex(x - half_x, y + half_y, z)};
  }
};

}  // namespace

Scene box_city(std::uint64_t seed) {
  Scene scene;
  Builder b{scene};
  b.begin("ground", "ground");
  constexpr double kGround = kBoxCityHalf + kBoxCityMargin;
  const auto ground = b.rectangle(0, 0, kGround, kGround, 0);
  b.quad(ground[0], ground[1], ground[2], ground[3]);
  Random random{seed};
  for (int k = 0; k < kBoxesAcross * kBoxesAcross; ++k) {
    b.begin("box_" + std::to_string(k), "box");
    const double x = (k % kBoxesAcross + 0.5) * kBoxPitch - kBoxCityHalf;
    const double y = (k / kBoxesAcross + 0.5) * kBoxPitch - kBoxCityHalf;
    const double half_x = millimetres(random.between(kNarrowest, kWidest) / 2);
    const double half_y = millimetres(random.between(kNarrowest, kWidest) / 2);
    const double u = random.between(0, 1);
    const double height = millimetres(kBoxLowest + (kBoxTallest - kBoxLowest) * u * u * u);
    const auto low = b.rectangle(x, y, half_x, half_y, 0);
    const auto high = b.rectangle(x, y, half_x, half_y, height);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) % 4;
      b.quad(low[i], low[j], high[j], high[i]);
    }
    b.quad(high[0], high[1], high[2], high[3]);
    b.quad(low[3], low[2], low[1], low[0]);
  }
  weld(scene.mesh, scene.surface_of);
  return scene;
}

}  // namespace gnomon::scenes
