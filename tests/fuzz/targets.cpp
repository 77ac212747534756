#include "fuzz/targets.h"

#include <gnomon/io/cityjson.h>
#include <gnomon/io/file_format.h>
#include <gnomon/io/footprint_layer.h>
#include <gnomon/io/gltf.h>
#include <gnomon/io/ifc_place.h>
#include <gnomon/io/key_frames.h>
#include <gnomon/io/mtl.h>
#include <gnomon/io/obj.h>
#include <gnomon/io/off.h>
#include <gnomon/io/ply.h>
#include <gnomon/io/rig_weld.h>
#include <gnomon/io/stl.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "fuzz/check.h"

namespace gnomon::fuzz {
namespace {

// A file that read_footprints can open; of this process, in memory where the system has that.
class FileInMemory {
 public:
  explicit FileInMemory(std::string_view bytes) {
    std::error_code code;
    const std::filesystem::path memory = "/dev/shm";
    const auto folder = std::filesystem::is_directory(memory, code)
                            ? memory
                            : std::filesystem::temp_directory_path();
    path = folder / ("gnomon-fuzz-" + std::to_string(getpid())) / "footprints.geojson";
    std::filesystem::create_directories(path.parent_path());
    std::ofstream file(path, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    require(bool(file.flush()), "the test can write " + path.string());
  }
  ~FileInMemory() {
    std::error_code code;
    std::filesystem::remove_all(path.parent_path(), code);
  }
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;

  std::filesystem::path path;
};

// A slope that ends at x = 0.
std::optional<double> ground(double x, double y) {
  require(std::isfinite(x) && std::isfinite(y), "the ground is asked at finite coordinates");
  if (x < 0) return std::nullopt;
  return 100 + 1e-3 * std::remainder(x + y, 1e5);
}

}  // namespace

void cityjson(std::string_view bytes) {
  const std::string path = "model.json";
  format_of(path, bytes);
  const auto highest = read_cityjson(bytes, path, "");
  check(highest, path);
  if (!highest || highest.value().report.lods.empty()) return;
  const auto lowest = read_cityjson(bytes, path, highest.value().report.lods.front());
  check(lowest, path);
  check(read_cityjson(bytes, path, "", {.appearance = true}), path);
}

void obj(std::string_view bytes) {
  const std::string path = "model.obj";
  format_of(path, bytes);
  check(read_obj(bytes, path, 'y', 1.0), path);
  check(read_obj(bytes, path, 'z', 1.0, {.appearance = true}), path);
  Model materials;
  materials.report.path = path;
  materials.looks.emplace();
  ModelPictures pictures(materials);
  MtlNames names;
  read_mtl_text(bytes, "model.mtl", materials, pictures, names);
  check_model(materials);
}

void footprints(std::string_view bytes) {
  if (bytes.empty()) return;
  const bool no_crs = (bytes.front() & 1) != 0;  // of '{' and of ' '
  const FileInMemory file(bytes);
  format_of(file.path, bytes);
  const auto read =
      read_footprints(file.path, FootprintOptions{}, no_crs ? "" : "EPSG:25832", "", ground);
  check(read, file.path.string());
}

namespace {

void gltf(std::string_view bytes, const std::string& path) {
  check(read_gltf(bytes, path), path);
  check(read_gltf(bytes, path, {.appearance = true, .time = 0.7}), path);
  Rig rig;
  const auto read = read_gltf(bytes, path, {.appearance = true, .rig = &rig});
  check(read, path);
  if (!read) return;
  require(rig.points.size() == read.value().vertices.size(), "a vertex is a point of the rig");
  const RigWeld weld = weld_rig(rig, read.value().vertices);
  const auto vertex_of = keep_points(rig, weld);
  require(vertex_of.size() == weld.positions.size(), "one point stays of each vertex");
  const RigPose pose = rig.clip ? pose_at(rig.nodes, *rig.clip, 1e3) : pose_at_rest(rig.nodes);
  for (const RigPart& part : rig.parts) {
    require(posed(part, pose).points.size() == part.shape.points.size(), "points stay as many");
  }
}

// Frames of an MD2; the first byte is none of it.
void frames(std::string_view bytes, const std::string& path) {
  const auto read = read_md2_frames(bytes, path);
  if (!read) return check_message(read.error(), path);
  for (std::size_t k = 0; k < read.value().names.size(); ++k) read.value().shapes(k, true);
}

}  // namespace

void mesh(std::string_view bytes) {
  if (bytes.empty()) return;
  const int reader = static_cast<unsigned char>(bytes.front()) % 4;
  bytes.remove_prefix(1);
  const std::string path = "no-such-folder/model";  // nothing stands beside it
  format_of(path, bytes);
  if (bytes.starts_with("IDP2")) return frames(bytes, path);
  if (reader == 3) return gltf(bytes, path);
  check(reader == 0   ? read_stl(bytes, path, 'z', 0.001)
        : reader == 1 ? read_ply(bytes, path, 'z', 1.0)
                      : read_off(bytes, path, 'y', 1.0),
        path);
}

void step(std::string_view bytes) {
  const std::string path = "model.ifc";
  format_of(path, bytes);
  const auto read = read_ifc_place(bytes, path);
  if (!read) return check_message(read.error(), path);
  const IfcPlace& place = read.value();
  check_warnings(place.warnings);
  const auto positive = [](double d) { return std::isfinite(d) && d > 0; };
  require(positive(place.metres_per_unit) && positive(place.assimp_metres_per_unit),
          "a unit has a length");
  require(!place.true_north || std::isfinite(*place.true_north), "true north is finite");
  if (const auto& site = place.site) {
    require(std::fabs(site->latitude) <= 90 * kDegree && std::fabs(site->longitude) <= kPi &&
                std::isfinite(site->height),
            "a site is on the Earth");
  }
  if (const auto& c = place.conversion) {
    require(std::isfinite(c->eastings) && std::isfinite(c->northings) && std::isfinite(c->height),
            "a map conversion moves to finite coordinates");
    require(positive(c->scale), "a map conversion's scale is positive");
    require(std::fabs(std::hypot(c->x_axis_abscissa, c->x_axis_ordinate) - 1) < 1e-9,
            "a map conversion's axis is a unit vector");
  }
  Model model;
  model.vertices = {{0, 0, 0}, {1, 2, 3}};
  place_ifc(model, place);
  check_warnings(model.warnings);
}

}  // namespace gnomon::fuzz
