// What was read from one file.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace gnomon {

// What was read, per file, for inspect and summary.json.
struct FileReport {
  std::string path, format;  // "CityJSON 2.0", "CityJSONSeq 1.1", "OBJ", "glTF 2.0"
  std::string crs;           // as short_crs; empty where the file has none
  std::string axes;    // of local formats: which axis is up and what the unit is, and who says so
  std::string placed;  // how it came to its place in the scene, for people
  std::vector<std::string> lods;  // found in the file
  std::string lod_used;           // one, or "highest of each object"
  std::size_t objects = 0;        // that carry geometry
  std::size_t surfaces = 0;       // polygons taken
  std::size_t triangles = 0;      // before welding
  std::size_t stored_twice =
      0;  // polygons that the same object holds a second time at the same LoD; counted once
};

}  // namespace gnomon
