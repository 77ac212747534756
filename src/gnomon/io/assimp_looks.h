// Materials, pictures and texture coordinates of a scene that Assimp has read -> ModelLooks.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <gnomon/io/model.h>
#include <gnomon/io/model_pictures.h>

struct aiMaterial;
struct aiMesh;
struct aiScene;

namespace gnomon {

// Nothing here is an error: what cannot be had is left out, with a warning.
class AssimpLooks {
 public:
  // Both must outlive this. Sets model.looks.
  AssimpLooks(const aiScene& scene, Model& model);

  // Index into ModelLooks::materials, or kNoMaterial.
  std::uint32_t material(const aiMesh& mesh);
  // Per vertex of a mesh; empty where its material has no picture, or it no coordinates.
  std::vector<glm::vec2> uv(const aiMesh& mesh) const;

 private:
  struct Known {
    std::uint32_t material = kNoMaterial;
    unsigned uv_set = 0;
    bool textured = false;
  };
  int texture(const aiMaterial& from, int type, Known& known);

  const aiScene& scene_;
  Model& model_;
  ModelPictures pictures_;
  std::vector<std::optional<Known>> known_;  // per material of the scene
};

}  // namespace gnomon
