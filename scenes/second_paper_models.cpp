// The second paper's scenes as OBJ files with the names of their objects, so that --cast and
// --no-cast choose among them: second_paper_models FOLDER writes tower.obj, industry.obj and
// office.obj, with their colours in .mtl files beside them. OBJ holds no place: --site.
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <system_error>

#include <gnomon/io/write_obj.h>
#include <scenes/second_paper_scenes.h>

namespace gnomon {
namespace {

// write_obj() gives materials the colours of its own pictures; these are the scene's.
std::string mtl_of(const Scene& scene) {
  std::string text = "# Materials of a scene that Gnomon wrote\n";
  for (const Material& m : scene.appearance.materials) {
    char kd[96];
    std::snprintf(kd, sizeof kd, "Kd %.4f %.4f %.4f\n", m.base_colour.x, m.base_colour.y,
                  m.base_colour.z);
    text += "\nnewmtl " + m.name + "\n" + kd + "Ka 0 0 0\nKs 0 0 0\nillum 1\n";
  }
  return text;
}

bool write(const std::filesystem::path& folder, const std::string& name, const Scene& scene) {
  const auto written = write_obj(folder / (name + ".obj"), scene, "second_paper_models");
  if (!written) {
    std::fprintf(stderr, "second_paper_models: %s\n", written.error().message.c_str());
    return false;
  }
  const auto colours = write_text_file(folder / (name + ".mtl"), mtl_of(scene));
  if (!colours) {
    std::fprintf(stderr, "second_paper_models: %s\n", colours.error().message.c_str());
    return false;
  }
  std::size_t casting = 0;
  for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t)
    casting += casts(scene, t) ? 1 : 0;
  std::printf("%s.obj: %zu triangles, %zu cast\n", name.c_str(), scene.mesh.triangles.size(),
              casting);
  std::map<std::string, std::size_t> of_object;
  for (const std::uint32_t s : scene.surface_of) ++of_object[scene.surfaces[s].object];
  for (const auto& [object, n] : of_object) std::printf("  %7zu %s\n", n, object.c_str());
  return true;
}

}  // namespace
}  // namespace gnomon

int main(int count, char** words) {
  using namespace gnomon;
  if (count != 2 || words[1][0] == '-') {
    std::fprintf(stderr,
                 "second_paper_models FOLDER: writes tower.obj, industry.obj and office.obj, which "
                 "stand in for the models of \"Geometry of shadows in real time\", and their "
                 "colours\n");
    return count == 2 && (words[1] == std::string("--help") || words[1] == std::string("-h")) ? 0
                                                                                              : 2;
  }
  const std::filesystem::path folder = words[1];
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);  // write_obj says what is wrong with it
  const bool written =
      write(folder, "tower", scenes::lattice_tower()) &&
      write(folder, "industry", scenes::industry_area()) &&
      write(folder, "office", scenes::office_building(scenes::OfficeCasters::facade_and_concrete));
  return written ? 0 : 1;
}
