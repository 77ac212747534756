// What kind of model a file is: by its content; by its name only where the content could be
// anything.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace gnomon {

enum class FileFormat {
  city_json,   // CityJSON, CityJSONSeq
  obj,         // Wavefront OBJ
  footprints,  // GeoJSON, GeoPackage, Shapefile, ...: footprint_layer.h
  raster,      // GeoTIFF, ...: surface_raster.h
  ifc,         // assimp_model.h for the geometry, ifc_place.h for the place
  assimp,      // glTF, STL, PLY, ...: assimp_model.h
};

// `start`: the first bytes of the file, some thousands where it has them. Nothing where no reader
// knows the file.
std::optional<FileFormat> format_of(const std::filesystem::path& path, std::string_view start);

// Formats whose coordinates usually are those of a map; the others' are local to the model.
inline bool is_georeferenced(FileFormat format) {
  return format == FileFormat::city_json || format == FileFormat::footprints ||
         format == FileFormat::raster;
}

// For messages: what gnomon reads.
inline constexpr std::string_view kFormatsRead =
    "CityJSON, CityJSONSeq, OBJ, IFC, glTF, STL, PLY, OFF, Collada, 3DS, FBX and MD2 models, "
    "footprints in "
    "GeoJSON, GeoPackage or Shapefile, and surface models in GeoTIFF";

}  // namespace gnomon
