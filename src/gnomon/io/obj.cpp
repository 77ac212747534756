#include <fmt/format.h>
#include <gnomon/io/obj.h>
#include <gnomon/io/obj_lines.h>
#include <gnomon/io/obj_looks.h>
#include <gnomon/io/read_text.h>
#include <tiny_obj_loader.h>

#include <istream>
#include <map>
#include <optional>
#include <set>
#include <streambuf>
#include <type_traits>
#include <utility>

namespace gnomon {
namespace {

static_assert(std::is_same_v<tinyobj::real_t, double>,
              "georeferenced coordinates need tinyobjloader's double build");

// A stream over text in memory, without a copy.
class TextBuffer : public std::streambuf {
 public:
  explicit TextBuffer(std::string& text) {
    setg(text.data(), text.data(), text.data() + text.size());
  }
};

// tinyobjloader's LoadObj makes one list of `o` and `g`; its callbacks keep them apart.
struct Building {
  char up = 'y';
  ModelBuilder builder;
  std::vector<double> coordinates;            // of ObjLines
  std::vector<Vec3> vertices;                 // z up, in the file's unit
  std::vector<std::vector<long long>> faces;  // indices into vertices, which may still be to come
  std::vector<std::uint32_t> surfaces;        // per face
  std::string object, group, material;
  std::optional<ObjLooks> looks;
};

std::string trimmed(const char* name) {
  const std::string_view all = name ? name : "";
  const std::size_t begin = all.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return std::string(all.substr(begin, all.find_last_not_of(" \t") - begin + 1));
}

Building& building(void* user) { return *static_cast<Building*>(user); }

void on_vertex(void* user, double, double, double, double) {
  Building& b = building(user);
  const std::size_t at = 3 * b.vertices.size();
  if (at + 3 > b.coordinates.size()) return;  // read_obj sees that the numbers of vertices differ
  const double x = b.coordinates[at], y = b.coordinates[at + 1], z = b.coordinates[at + 2];
  b.vertices.push_back(b.up == 'y' ? Vec3(x, -z, y) : Vec3(x, y, z));
}

void on_face(void* user, tinyobj::index_t* indices, int count) {
  Building& b = building(user);
  auto& face = b.faces.emplace_back();
  for (int k = 0; k < count; ++k) {
    const long long index = indices[k].vertex_index;  // from 1, or negative: counted back from here
    face.push_back(index > 0 ? index - 1 : static_cast<long long>(b.vertices.size()) + index);
  }
  b.surfaces.push_back(b.builder.surface(b.object, b.group, b.material, ""));
  if (!b.looks) return;
  b.looks->material_names.push_back(b.material);
  for (int k = 0; k < count; ++k) {
    b.looks->corner(indices[k].texcoord_index, indices[k].normal_index);
  }
}

void on_texcoord(void* user, double u, double v, double) {
  building(user).looks->uv.emplace_back(u, 1 - v);  // v counts up from the picture's lower edge
}

void on_normal(void* user, double x, double y, double z) {
  Building& b = building(user);
  b.looks->normals.push_back(b.up == 'y' ? glm::vec3(x, -z, y) : glm::vec3(x, y, z));
}

// tinyobjloader asks for a library of materials; which one is all that is wanted here.
class Libraries : public tinyobj::MaterialReader {
 public:
  explicit Libraries(ObjLooks& looks) : looks_(looks) {}
  bool operator()(const std::string& name, std::vector<tinyobj::material_t>*,
                  std::map<std::string, int>*, std::string*, std::string*) override {
    looks_.libraries.push_back(name);
    return false;  // so that all names of the line come, whether one or a file with blanks is meant
  }

 private:
  ObjLooks& looks_;
};

void on_material(void* user, const char* name, int) { building(user).material = trimmed(name); }
void on_object(void* user, const char* name) { building(user).object = trimmed(name); }
void on_group(void* user, const char** names, int count) {
  std::string& group = building(user).group;
  group.clear();
  for (int k = 0; k < count; ++k) {
    if (k > 0) group += ' ';
    group += trimmed(names[k]);
  }
}

}  // namespace

Result<Model> read_obj(std::string_view text, const std::string& path, char up,
                       double metres_per_unit, const ReadOptions& options) {
  auto checked = check_obj_lines(text, path);
  if (!checked) return checked.error();
  ObjLines lines = std::move(checked).value();

  Building b;
  b.up = up;
  b.coordinates = std::move(lines.coordinates);
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = on_vertex;
  callbacks.index_cb = on_face;
  callbacks.usemtl_cb = on_material;
  callbacks.object_cb = on_object;
  callbacks.group_cb = on_group;
  std::optional<Libraries> libraries;
  if (options.appearance) {
    b.looks.emplace();
    callbacks.texcoord_cb = on_texcoord;
    callbacks.normal_cb = on_normal;
    libraries.emplace(*b.looks);
  }
  TextBuffer buffer(lines.text);
  std::istream stream(&buffer);
  std::string warnings, errors;
  const bool read = tinyobj::LoadObjWithCallback(
      stream, callbacks, &b, libraries ? &*libraries : nullptr, &warnings, &errors);
  if (!read || !errors.empty() || b.faces.size() != lines.face_line.size() ||
      b.vertices.size() != lines.vertices) {
    return Error{fmt::format("{}: tinyobjloader cannot read the file: {}.", path,
                             errors.empty() ? "faces or vertices are missing" : errors)};
  }

  Model& model = b.builder.model;
  model.report.path = path;
  model.report.format = "OBJ";
  model.scale = Vec3(metres_per_unit, metres_per_unit, metres_per_unit);
  if (b.looks) b.looks->begin(model);
  std::vector<std::vector<std::uint32_t>> ring(1);
  for (std::size_t f = 0; f < b.faces.size(); ++f) {
    ring[0].clear();
    for (const long long v : b.faces[f]) {
      if (v < 0 || v >= static_cast<long long>(b.vertices.size())) {
        return Error{
            fmt::format("{}: line {}: the face cannot be read.", path, lines.face_line[f])};
      }
      ring[0].push_back(b.builder.vertex(b.vertices[static_cast<std::size_t>(v)]));
    }
    b.builder.polygon(b.surfaces[f], lines.face_line[f], ring);
    if (b.looks) b.looks->face(model, f, ring[0].size());
  }
  warn(model.warnings, "Points and lines cast no shadow and were left out.",
       fmt::format("{}: line {}", path, lines.first_point_or_line), lines.points_and_lines);
  warn(model.warnings,
       "Free-form curves and surfaces were left out; export the model with polygons instead.",
       fmt::format("{}: line {}", path, lines.first_free_form), lines.free_form);
  warn(model.warnings,
       "Statements that are not known, or bring in another file (call), were left out.",
       fmt::format("{}: line {}: {}", path, lines.first_unknown, in_quotes(lines.unknown_keyword)),
       lines.unknown);

  std::set<std::pair<std::string_view, std::string_view>> objects;
  for (const Surface& s : model.surfaces) {
    objects.emplace(s.object, s.object.empty() ? std::string_view(s.group) : std::string_view());
  }
  model.report.objects = objects.size();
  model.report.surfaces = model.polygons.size();
  return std::move(model);
}

}  // namespace gnomon
