// A scene as glTF 2.0, for viewers.
// Based on: Khronos Group, glTF 2.0 Specification, 2.0.1, 2021.
#pragma once

#include <filesystem>
#include <string>

#include <gnomon/core/result.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/scene/scene.h>

namespace gnomon {

enum class GltfForm {
  binary,   // .glb: one file of two chunks
  embedded  // .gltf: JSON, the buffer as base64 in it
};

struct GltfWritten {
  FileWritten file;
  std::size_t objects = 0;
  // Largest distance between a vertex and what the file's single precision keeps of it, metres.
  double largest_rounding = 0;
};

// y up (x east, y up, z south), metres, relative to frame.origin. A node and mesh for each object,
// in it a primitive for each surface; double-sided materials in the clay tones of camera pictures,
// one for each semantic surface, material or group. No normals: the specification has viewers
// compute flat ones, which is what such models need. asset.extras: crs, origin, true_north_deg,
// place, axes; a primitive's extras: type, semantic, material, casts, receives; a node's: type, and
// whether any of its surfaces casts or receives. Names need not be UTF-8; in the file they are.
// Errors: as write_text_file; more than 4 GiB, which the binary form cannot have.
Result<GltfWritten> write_gltf(const std::filesystem::path& path, const Scene& scene, GltfForm form,
                               const std::string& software);

}  // namespace gnomon
