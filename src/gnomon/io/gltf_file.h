// A glTF 2.0 file in memory: its JSON, its buffers, and checked access to accessors.
#pragma once

#include <cstdint>
#include <optional>
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
// scaled. `type`: what it must be ("SCALAR", "VEC2", "VEC3", "VEC4", "MAT4"). Errors name the
// accessor: another type, reaching beyond its bufferView or that beyond its buffer.
Result<std::vector<double>> read_accessor(const GltfFile& file, const nlohmann::json* index,
                                          std::string_view type);

// The bytes of a bufferView. The error is why not, without a file: for a warning.
Result<std::string> read_buffer_view(const GltfFile& file, const nlohmann::json* index);

// Of "data:...;base64,..."; nothing if it is none.
std::optional<std::string> bytes_of_data_uri(std::string_view uri);

// "%20" becomes a blank.
std::string percent_decoded(std::string_view uri);

}  // namespace gnomon
