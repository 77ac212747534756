// Materials, textures, texture coordinates and normals of a glTF file -> ModelLooks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include <gnomon/io/gltf_file.h>
#include <gnomon/io/model.h>
#include <gnomon/io/model_pictures.h>

namespace gnomon {

// Of one primitive, per vertex.
struct GltfCorners {
  std::uint32_t material = kNoMaterial;
  std::vector<glm::vec2> uv;  // may be empty
};

// Nothing here is an error: what cannot be read or is not known is left out, with a warning.
class GltfLooks {
 public:
  // Both must outlive this. Sets model.looks.
  GltfLooks(const GltfFile& file, Model& model);

  // Of a primitive with `count` vertices; empty where it has none.
  std::vector<Vec3> normals(const nlohmann::json& attributes, std::size_t count,
                            const std::string& where);
  GltfCorners corners(const nlohmann::json& primitive, std::size_t count, const std::string& where);

 private:
  // Which texture coordinates a material's pictures want, and how they are changed (extension
  // KHR_texture_transform).
  struct Mapping {
    std::size_t set = 0;
    glm::dvec2 offset{0, 0}, scale{1, 1};
    double rotation = 0;
    friend bool operator==(const Mapping&, const Mapping&) = default;
  };
  struct Known {
    std::uint32_t material = kNoMaterial;
    bool textured = false;
    Mapping mapping;
  };

  const Known& material(std::size_t number);
  void add_pictures(const nlohmann::json& material, Material& m, Known& known);
  void add_metal(const nlohmann::json& material, Material& m);
  Mapping mapping_of(const nlohmann::json& info) const;
  // The texture of one of a material's members, -1 where there is none that can be had.
  int texture(const nlohmann::json* info, Known& known, const std::string& where);
  // Its picture's bytes and what to call them; nothing where there are none.
  Result<std::string> bytes_of(const nlohmann::json* image) const;
  const nlohmann::json* image_of(const nlohmann::json* texture, std::string& name) const;
  void warn_of(const char* what, const std::string& where);

  const GltfFile& f_;
  Model& model_;
  ModelPictures pictures_;
  std::unordered_map<std::size_t, Known> materials_;
};

// The look of the triangle that came into the model last. `of`: its corners in the primitive;
// `normals` as posed, y up; may be empty.
void add_look(Model& model, const GltfCorners& corners, const std::vector<Vec3>& normals,
              const std::uint32_t (&of)[3]);

}  // namespace gnomon
