// The header of a PLY file: which elements with which properties follow it, and how they are
// stored.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/core/warnings.h>

namespace gnomon {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };
enum class PlyStorage { kText, kLittleEndian, kBigEndian };

std::size_t bytes_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat;  // of the value, or of a list's items
  bool list = false;
  PlyType count_type = PlyType::kUint8;  // of a list's length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyStorage storage = PlyStorage::kText;
  std::vector<PlyElement> elements;
  std::size_t lines = 0;  // of the header, with end_header
  std::string_view body;  // what follows
};

// Unknown lines are left out with a warning. Errors name the line.
Result<PlyHeader> read_ply_header(std::string_view bytes, const std::string& path,
                                  Warnings& warnings);

}  // namespace gnomon
