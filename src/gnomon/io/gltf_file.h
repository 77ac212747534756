// A glTF 2.0 file in memory: its JSON, its buffers, and checked access to accessors.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/io/cityjson_access.h>

namespace gnomon {

struct GltfFile {
  std::string path;
  bool glb = false;
  nlohmann::json json;
  std::vector<std::string> buffers;  // bytes; at least as many as the JSON says
};

// `bytes`: of a .gltf or .glb file; `path` of it, beside which its buffers are. Errors: no JSON,
// not version 2, extensions that it cannot be read without, chunks and buffers that are missing or
// cut off, buffers named by anything but a relative path or data.
Result<GltfFile> open_gltf(std::string_view bytes, const std::string& path);

// All numbers of an accessor, element after element, sparse values put in and normalized ones
// scaled. `type`: what it must be ("SCALAR", "VEC3", "VEC4", "MAT4"). Errors name the accessor:
// another type, reaching beyond its bufferView or that beyond its buffer.
Result<std::vector<double>> read_accessor(const GltfFile& file, const nlohmann::json* index,
                                          std::string_view type);

}  // namespace gnomon
