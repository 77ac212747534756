// The oldest instrument: a stick of 2 m in level ground, in Vienna, at true noon of 18 September
// 2024. How long is its shadow? By the mask of Gnomon, and by height / tan(altitude).
#include <cmath>
#include <cstdio>

#include <gnomon/gnomon.h>
#include <gnomon/mesh/weld.h>

// An upright box between two corners, as 12 triangles of surface `surface`.
static void add_box(gnomon::Scene& scene, gnomon::Vec3 low, gnomon::Vec3 high,
                    std::uint32_t surface) {
  const auto first = static_cast<std::uint32_t>(scene.mesh.positions.size());
  for (int k = 0; k < 8; ++k)  // bit 0 chooses x, bit 1 y, bit 2 z
    scene.mesh.positions.push_back(
        {k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z});
  const std::uint32_t faces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  for (const auto& f : faces) {  // the winding does not matter for shadows
    scene.mesh.triangles.push_back({first + f[0], first + f[1], first + f[2]});
    scene.mesh.triangles.push_back({first + f[0], first + f[2], first + f[3]});
    scene.surface_of.insert(scene.surface_of.end(), 2, surface);
  }
}

int main() {
  // A scene by hand: x east, y north, z up, metres. The stick's north face stands at y = 0.
  const double height = 2;
  gnomon::Scene scene;
  scene.surfaces = {{.object = "ground"}, {.object = "stick"}};
  add_box(scene, {-10, -10, -1}, {10, 10, 0}, 0);
  add_box(scene, {-0.05, -0.1, 0}, {0.05, 0, height}, 1);
  gnomon::weld(scene.mesh, scene.surface_of);  // equal vertices become one: the library asks for it

  // The sun: where, when, towards where.
  const gnomon::Place vienna{48.2085 * gnomon::kDegree, 16.3721 * gnomon::kDegree, 170};
  using namespace std::chrono;
  const gnomon::SunDay day = gnomon::sun_day(sys_days(2024y / September / 18), vienna);
  const gnomon::SunPosition sun = gnomon::sun_position(day.transit, vienna);
  const gnomon::Light light = gnomon::sun_direction(sun, scene.frame.true_north);

  // A plan of one square metre by five, seen from above, a sample every centimetre.
  const double pixel = 0.01;
  const gnomon::View plan = gnomon::plan_view({-0.5, -0.5, 0.5, 4.5}, pixel, 0);
  const gnomon::ShadowMask mask = gnomon::cast_shadows(scene, light, plan);

  // Row 0 is the northernmost; count the samples in shadow along the line north of the stick.
  int dark = 0;
  for (int row = 0; row * pixel < 4.5; ++row)
    if (mask.state[static_cast<std::size_t>(row * mask.width + mask.width / 2)] ==
        gnomon::ShadowMask::kShadow)
      ++dark;

  const double measured = dark * pixel;
  const double expected = height / std::tan(sun.altitude_apparent);
  std::printf("sun: azimuth %.3f, altitude %.3f degrees\n", sun.azimuth / gnomon::kDegree,
              sun.altitude_apparent / gnomon::kDegree);
  std::printf("shadow: %.2f m in the mask, %.4f m by height / tan(altitude)\n", measured, expected);
  return std::fabs(measured - expected) <= pixel ? 0 : 1;
}
