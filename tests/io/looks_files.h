// Pictures and models with looks, made for a test.
#pragma once

#include <gdal.h>
#include <gnomon/io/png.h>

#include <cpl_vsi.h>

#include <string>
#include <vector>

#include "load_files.h"

namespace gnomon::testing_files {

// 2 x 2: red, green / blue, white.
inline Picture four_colours() {
  return {2, 2, {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}}};
}
inline std::string png(const Picture& picture) { return encode_png(picture).value(); }

// Bytes of a file that GDAL's driver of that name makes of 8-bit bands, each row after row.
inline std::string picture_by_gdal(const char* driver, int width, int height,
                                   const std::vector<std::vector<std::uint8_t>>& bands) {
  GDALAllRegister();
  const int n = static_cast<int>(bands.size());
  GDALDatasetH memory =
      GDALCreate(GDALGetDriverByName("MEM"), "", width, height, n, GDT_Byte, nullptr);
  for (int b = 0; b < n; ++b) {
    std::vector<std::uint8_t> band = bands[static_cast<std::size_t>(b)];
    EXPECT_EQ(GDALRasterIO(GDALGetRasterBand(memory, b + 1), GF_Write, 0, 0, width, height,
                           band.data(), width, height, GDT_Byte, 0, 0),
              CE_None);
  }
  const char* path = "/vsimem/gnomon_test_picture";
  GDALDatasetH copy =
      GDALCreateCopy(GDALGetDriverByName(driver), path, memory, FALSE, nullptr, nullptr, nullptr);
  GDALClose(copy);
  GDALClose(memory);
  vsi_l_offset length = 0;
  GByte* bytes = VSIGetMemFileBuffer(path, &length, FALSE);
  std::string out(reinterpret_cast<const char*>(bytes), length);
  VSIUnlink(path);
  return out;
}

inline LoadOptions with_looks() {
  LoadOptions options = without_ground();
  options.appearance = true;
  return options;
}

inline const Material& material_of(const Scene& scene, std::size_t triangle) {
  return scene.appearance.materials.at(scene.appearance.material_of.at(triangle));
}

inline const Vec3& corner(const Scene& scene, std::size_t triangle, std::size_t c) {
  return scene.mesh.positions.at(scene.mesh.triangles.at(triangle)[c]);
}

}  // namespace gnomon::testing_files
