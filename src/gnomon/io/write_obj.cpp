#include <gnomon/io/write_obj.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <vector>

#include <gnomon/core/place.h>
#include <gnomon/io/scene_parts.h>

namespace gnomon {
namespace {

constexpr const char* kMtlFirstLine = "# Materials of a scene that Gnomon wrote";

// What a line of an OBJ can carry: no line breaks or other control characters, no backslash (it
// would join lines), no blanks at the ends.
std::string obj_name(const std::string& name, std::size_t& changed) {
  std::string out = name;
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '\\') c = '_';
  }
  const std::size_t begin = std::min(out.find_first_not_of(' '), out.size());
  out.erase(0, begin);
  while (out.ends_with(' ')) out.pop_back();
  if (out != name) ++changed;
  return out;
}

// The rounding of a + b, exactly (Knuth's two-sum).
double rounding_of_sum(double a, double b) {
  const double sum = a + b, back = sum - a;
  return (a - (sum - back)) + (b - back);
}

struct Positions {
  std::vector<std::array<double, 3>> written;
  double largest_rounding = 0;
  std::size_t merged = 0;  // vertices that equal an earlier one once rounded
};

Positions crs_positions(const Scene& scene) {
  Positions out;
  const Vec3& o = scene.frame.origin;
  out.written.reserve(scene.mesh.positions.size());
  for (const Vec3& p : scene.mesh.positions) {
    out.written.push_back({p.x + o.x, p.y + o.y, p.z + o.z});
    for (int k = 0; k < 3; ++k) {
      out.largest_rounding = std::max(out.largest_rounding, std::fabs(rounding_of_sum(p[k], o[k])));
    }
  }
  std::vector<std::array<double, 3>> sorted = out.written;
  std::sort(sorted.begin(), sorted.end());
  out.merged = static_cast<std::size_t>(sorted.end() - std::unique(sorted.begin(), sorted.end()));
  return out;
}

void add(fmt::memory_buffer& out, const std::string& line) { out.append(line + "\n"); }

// A comment must not leave its line: a CRS may be WKT over many lines.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  while (text.ends_with('\\')) text.pop_back();
  return text;
}

void add_header(fmt::memory_buffer& out, const Frame& f, const std::string& software,
                double largest_rounding) {
  add(out, "# Scene as read by " + one_line(software) + ": placed, triangulated, welded");
  add(out, "# CRS: " + (f.crs.empty() ? "none (local coordinates)" : one_line(f.crs)));
  add(out, "# axes: x east, y north, z up; unit: metre");
  add(out,
      fmt::format("# origin of scene coordinates: {} {} {}", f.origin.x, f.origin.y, f.origin.z));
  add(out, fmt::format("# true north: {:.9g} degrees clockwise from +y", f.true_north / kDegree));
  add(out, fmt::format("# rounding of coordinates: at most {:.3g} m", largest_rounding));
  add(out, "# read with: gnomon ... --up z --ground none" +
               (f.crs.empty() ? "" : " --crs " + one_line(f.crs)));
}

std::string mtl_text(const std::vector<std::string>& names, const SceneParts& parts) {
  std::string text = std::string(kMtlFirstLine) + "\n";
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Rgb c = parts.materials[k].colour;
    text += fmt::format("\nnewmtl {}\nKd {:.4f} {:.4f} {:.4f}\nKa 0 0 0\nKs 0 0 0\nillum 1\n",
                        names[k], c.r / 255.0, c.g / 255.0, c.b / 255.0);
  }
  return text;
}

// True if there is a file that somebody else may still need.
bool foreign_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return false;
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  return line != kMtlFirstLine;
}

}  // namespace

Result<ObjWritten> write_obj(const std::filesystem::path& path, const Scene& scene,
                             const std::string& software) {
  if (scene.mesh.positions.size() >
      static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    return Error{fmt::format("Cannot write {}: {} vertices are more than OBJ's readers count.",
                             path.string(), scene.mesh.positions.size())};
  }
  std::filesystem::path mtl_path = path;
  mtl_path.replace_extension(".mtl");
  if (foreign_file(mtl_path)) {
    return Error{fmt::format(
        "Cannot write {}: the colours would go to {}, which is there and was not written by "
        "Gnomon; choose another name.",
        path.string(), mtl_path.string())};
  }

  const SceneParts parts = scene_parts(scene);
  const Positions positions = crs_positions(scene);
  ObjWritten written;
  written.objects = parts.objects.size();
  written.largest_rounding = positions.largest_rounding;
  std::size_t changed = 0;
  std::vector<std::string> materials;
  for (const PartMaterial& m : parts.materials) materials.push_back(obj_name(m.name, changed));

  fmt::memory_buffer out;
  add_header(out, scene.frame, software, positions.largest_rounding);
  add(out, "mtllib " + one_line(mtl_path.filename().string()));
  for (const auto& [x, y, z] : positions.written) {
    fmt::format_to(std::back_inserter(out), "v {} {} {}\n", x, y, z);
  }
  for (const SceneObject& object : parts.objects) {
    const std::string name = obj_name(object.name, changed);
    if (!name.empty()) add(out, "o " + name);
    for (const ScenePart& part : object.parts) {
      const std::string group = obj_name(scene.surfaces[part.surface].group, changed);
      add(out, group.empty() ? "g" : "g " + group);
      add(out, "usemtl " + materials[part.material]);
      for (const std::uint32_t t : part.triangles) {
        const Triangle& v = scene.mesh.triangles[t];
        fmt::format_to(std::back_inserter(out), "f {} {} {}\n", v[0] + 1, v[1] + 1, v[2] + 1);
      }
    }
  }
  warn(written.warnings, "Names were changed to what an OBJ file can carry.", "", changed);
  warn(written.warnings,
       "Vertices lie so close together that the coordinates of the CRS do not tell them apart.", "",
       positions.merged);

  // Both or none: the materials are on the disk before the model appears, and appear after it.
  Result<AtomicFile> mtl_file = AtomicFile::create(mtl_path);
  if (!mtl_file) return mtl_file.error();
  std::ofstream mtl_stream(mtl_file.value().temporary(), std::ios::binary);
  mtl_stream << mtl_text(materials, parts) << std::flush;
  if (!mtl_stream) return file_error("write", mtl_path, errno != 0 ? errno : EIO);
  mtl_stream.close();
  Result<FileWritten> obj = write_text_file(path, {out.data(), out.size()});
  if (!obj) return obj.error();
  Result<FileWritten> mtl = mtl_file.value().commit();
  if (!mtl) return mtl.error();
  written.mtl = std::move(mtl).value();
  written.obj = std::move(obj).value();
  return written;
}

}  // namespace gnomon
