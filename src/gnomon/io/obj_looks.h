// Looks of an OBJ while it is read: texture coordinates, normals and materials of its faces.
#pragma once

#include <string>
#include <vector>

#include <gnomon/io/mtl.h>

namespace gnomon {

struct ObjLooks {
  std::vector<std::string> libraries;       // words after mtllib
  std::vector<std::string> material_names;  // per face
  std::vector<glm::vec2> uv;                // vt, v counted downwards
  std::vector<glm::vec3> normals;           // vn, z up

  // The indices of a face's next corner, as the file has them: from 1, or negative, counted back
  // from here; 0: none.
  void corner(long long texcoord, long long normal);

  // Once all faces are here: reads the libraries.
  void begin(Model& model);
  // Hands over the look of face `f`, which came into the model last; faces in their order.
  void face(Model& model, std::size_t f, std::size_t corners);

 private:
  struct Corner {
    long long uv, normal;  // from 0; below 0: none
  };
  std::vector<Corner> corners_;
  std::size_t next_ = 0;
  MtlNames materials_;
};

}  // namespace gnomon
