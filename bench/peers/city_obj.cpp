// Writes the box city as two OBJ files, boxes.obj and ground.obj, for the programs that draw it.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>

#include <gnomon/io/write_obj.h>
#include <scenes/box_city.h>

namespace gnomon::bench {
namespace {

// The triangles of the ground (surface 0), or all others, with the vertices that they use.
Scene part_of(const Scene& city, bool ground) {
  Scene part;
  part.surfaces = city.surfaces;
  part.frame = city.frame;
  constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::uint32_t> vertex(city.mesh.positions.size(), kNone);
  for (std::size_t t = 0; t < city.mesh.triangles.size(); ++t) {
    if ((city.surface_of[t] == 0) != ground) continue;
    Triangle triangle = city.mesh.triangles[t];
    for (std::uint32_t& v : triangle) {
      if (vertex[v] == kNone) {
        vertex[v] = static_cast<std::uint32_t>(part.mesh.positions.size());
        part.mesh.positions.push_back(city.mesh.positions[v]);
      }
      v = vertex[v];
    }
    part.mesh.triangles.push_back(triangle);
    part.surface_of.push_back(city.surface_of[t]);
  }
  return part;
}

int run(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);  // write_obj says what is wrong with it
  const Scene city = scenes::box_city();
  for (const bool ground : {false, true}) {
    const auto written = write_obj(folder / (ground ? "ground.obj" : "boxes.obj"),
                                   part_of(city, ground), "bench_city_obj");
    if (!written) {
      std::fprintf(stderr, "bench_city_obj: %s\n", written.error().message.c_str());
      return 1;
    }
  }
  return 0;
}

}  // namespace
}  // namespace gnomon::bench

int main(int argc, char** argv) {
  std::string folder;
  CLI::App app{"The box city as boxes.obj and ground.obj"};
  app.add_option("FOLDER", folder, "Where to (it is made)")->required();
  CLI11_PARSE(app, argc, argv);
  return gnomon::bench::run(folder);
}
