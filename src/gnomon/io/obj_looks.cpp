#include <fmt/format.h>
#include <gnomon/io/obj_looks.h>
#include <gnomon/io/read_text.h>

namespace gnomon {
namespace {

long long from_zero(long long index, std::size_t count) {
  return index > 0 ? index - 1 : index < 0 ? static_cast<long long>(count) + index : -1;
}

}  // namespace

void ObjLooks::corner(long long texcoord, long long normal) {
  corners_.push_back({from_zero(texcoord, uv.size()), from_zero(normal, normals.size())});
}

void ObjLooks::begin(Model& model) {
  model.looks.emplace();
  ModelPictures pictures(model);
  // The name of one file may have blanks in it, and several names are divided by them.
  std::string all;
  for (const std::string& name : libraries) all += (all.empty() ? "" : " ") + name;
  if (libraries.size() > 1 && read_beside_model(model.report.path, all)) libraries = {all};
  for (const std::string& name : libraries) read_mtl(name, model, pictures, materials_);
}

void ObjLooks::face(Model& model, std::size_t f, std::size_t corners) {
  std::uint32_t material = kNoMaterial;
  if (const std::string& name = material_names[f]; !name.empty()) {
    const auto at = materials_.find(name);
    if (at != materials_.end()) {
      material = at->second;
    } else if (!materials_.empty()) {
      warn(model.warnings, "Faces name materials that are in no library of the file.",
           fmt::format("{}: {}", model.report.path, in_quotes(name, 200)));
    }
  }
  std::vector<glm::vec2> at_uv;
  std::vector<glm::vec3> at_normals;
  for (std::size_t k = 0; k < corners; ++k) {
    const Corner& c = corners_[next_++];
    if (c.uv >= 0 && c.uv < static_cast<long long>(uv.size())) {
      at_uv.resize(corners, glm::vec2(0));
      at_uv[k] = uv[static_cast<std::size_t>(c.uv)];
    } else if (c.uv >= 0) {
      warn(model.warnings, "Corners name texture coordinates (vt) that are not in the file.",
           fmt::format("{}: line {}", model.report.path, model.polygons.back().number));
    }
    if (c.normal >= 0 && c.normal < static_cast<long long>(normals.size())) {
      at_normals.resize(corners, glm::vec3(0));
      at_normals[k] = normals[static_cast<std::size_t>(c.normal)];
    } else if (c.normal >= 0) {
      warn(model.warnings, "Corners name normals (vn) that are not in the file.",
           fmt::format("{}: line {}", model.report.path, model.polygons.back().number));
    }
  }
  add_look(model, material, at_uv, at_normals);
}

}  // namespace gnomon
