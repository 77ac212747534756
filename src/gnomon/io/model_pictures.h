// The pictures that a model names: from files beside it, or from bytes that it holds.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include <gnomon/core/result.h>
#include <gnomon/io/model.h>

namespace gnomon {

struct PictureEdges {
  TextureEdge u = TextureEdge::repeat, v = TextureEdge::repeat;
  bool smooth = true;
};

// Reads each picture once. What cannot be had is left out with a warning, never an error.
class ModelPictures {
 public:
  // `model` must outlive this. Precondition: model.looks, and model.report.path.
  explicit ModelPictures(Model& model) : model_(model) {}

  // Index into ModelLooks::textures; -1 where there is none. `name`: a path relative to the model's
  // folder, with / or \. Where there is none, or it leads out of that folder, a file of the same
  // name beside the model is taken: exporters write the paths of their own machines.
  int file(const std::string& name, const PictureEdges& edges = {});
  // `name`: what a message calls it. `key`: equal for the same bytes alone.
  int bytes(std::string_view bytes, const std::string& name, const std::string& key,
            const PictureEdges& edges = {});
  // What is decoded already.
  int texels(Texture texture, const std::string& key, const PictureEdges& edges = {});

 private:
  int add(Result<Texture> texture, const std::string& name, const std::string& key,
          const PictureEdges& edges);
  Model& model_;
  std::map<std::string, int> known_;
};

// A file that a model names, by the same rules: its bytes. The error is why not: for a warning.
Result<std::string> read_beside_model(const std::string& model, const std::string& name);

}  // namespace gnomon
