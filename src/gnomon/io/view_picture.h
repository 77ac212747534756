// view.png: the shadows of many instants laid over each other on the shaded model, seen by a
// camera.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/io/picture.h>
#include <gnomon/io/picture_shading.h>

namespace gnomon {

// What the camera sees, row-major, row 0 at the top, width * height entries each.
struct ViewSamples {
  int width = 0, height = 0;
  // Samples per pixel along each side: 2 gives smooth edges. Width and height are multiples of it.
  int downsample = 1;
  std::vector<std::uint16_t> shadows;  // instants at which the sample is in shadow, <= instants
  std::vector<std::uint8_t> valid;     // 1 where there is a sample; elsewhere the sky shows
  ViewShading shading;                 // of picture_shading.h; edge may be empty
  int instants = 0;                    // N: shadows laid over each other
};

// The words of the caption strip; UTF-8; empty ones are left out.
struct ViewCaption {
  std::string title;               // place or model names
  std::vector<std::string> lines;  // "18 September 2024, 09:00-17:00 Europe/Vienna, every hour"
  std::string software;            // "gnomon 0.1.0"
  std::string attribution;         // of the model
};

// Light that is left, red, green and blue in linear light, where `shadows` of `instants` shadows
// lie: each one takes the same share of the light, as panes of tinted glass do, and all of them
// together leave what the sky alone gives.
struct LightLeft {
  float r = 1, g = 1, b = 1;
};
LightLeft light_left(int shadows, int instants);

// The picture is (width / downsample) x (height / downsample) pixels and a caption strip below.
// Precondition: sizes as above, > 0.
Picture draw_view(const ViewSamples& samples, const ViewCaption& caption, int threads = 0);

// Draws and writes. Errors: as write_png.
Result<FileWritten> write_view_picture(const std::filesystem::path& path,
                                       const ViewSamples& samples, const ViewCaption& caption,
                                       int threads = 0);

}  // namespace gnomon
