// Hours in shadow around a model: read it, compute the shadows of a day, write a GeoTIFF, say the
// mean.
//
//   profile_report MODEL OUT.tif     e.g. house.obj (beside this file) hours.tif
#include <algorithm>
#include <cstdio>
#include <exception>

#include <gnomon/gnomon.h>

static void report(const char* model, const char* out) {
  // A file of local coordinates says neither which axis is up nor where on Earth it stands. For a
  // model with a CRS (CityJSON) leave `site` away: {.crs = "EPSG:..."} where the file does not name
  // it.
  const gnomon::Place berlin{52.52 * gnomon::kDegree, 13.40 * gnomon::kDegree, 34};
  // value() throws with a sentence for the user; or test the Result and read error().
  const gnomon::LoadedScene loaded =
      gnomon::load_scene({model}, {.up = 'z', .site = berlin}).value();
  const gnomon::Scene& scene = loaded.scene;
  for (const gnomon::Warning& w : scene.warnings)
    std::fprintf(stderr, "warning: %s (%zu)\n", w.what.c_str(), w.count);

  // A plan over everything, ground included, a sample every 20 cm.
  gnomon::Bounds2 bounds{1e9, 1e9, -1e9, -1e9};
  for (const gnomon::Vec3& p : scene.mesh.positions) {
    bounds.x0 = std::min(bounds.x0, p.x), bounds.y0 = std::min(bounds.y0, p.y);
    bounds.x1 = std::max(bounds.x1, p.x), bounds.y1 = std::max(bounds.y1, p.y);
  }
  const gnomon::View plan = gnomon::plan_view(bounds, 0.2, 0);

  // From sunrise to sunset, every half hour: each step's middle stands for it.
  const gnomon::Profile hours =
      gnomon::shadow_profile(scene, plan,
                             {.date = "2024-03-21", .every = "30min", .zone = "Europe/Berlin"})
          .value();
  gnomon::write_profile_geotiff(out, hours, plan, scene.frame, {}).value();

  double sum = 0;
  std::size_t samples = 0;
  for (std::size_t k = 0; k < hours.valid.size(); ++k) {
    if (!hours.valid[k]) continue;
    sum += gnomon::shadow_hours(hours, k);
    ++samples;
  }
  std::printf("%s: %zu triangles, %zu samples, %.2f h of daylight, %.2f h in shadow on average\n",
              model, scene.mesh.triangles.size(), samples, gnomon::daylight_hours(hours),
              sum / static_cast<double>(samples));
}

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: profile_report MODEL OUT.tif\n");
    return 2;
  }
  try {
    report(argv[1], argv[2]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  return 0;
}
