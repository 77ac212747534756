// check_engine PICTURE.ppm FRAME: 0 where the example's picture has shadow where our own renderer's
// mask of the same frame, drawn without a window, has it.
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>

#include <gnomon/gl/context.h>
#include <gnomon/gl/renderer.h>

#include "things.h"

namespace gl = gnomon::gl;

// The same shaders and triangles, but other framebuffers and float matrices in two programs: a
// pixel whose centre lies on a shadow's edge to the last bit may differ. One in ten thousand.
constexpr int kOneIn = 10000;
// The example's ambient light alone, 0.25 of 255; where the lamp reaches it adds at least 0.12.
constexpr int kAmbient = 64, kLit = 64 + 20;

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  std::ifstream in(argv[1], std::ios::binary);
  std::string magic;
  int width = 0, height = 0, most = 0;
  in >> magic >> width >> height >> most;
  in.get();
  std::string rgb(std::size_t(width) * std::size_t(height) * 3, '\0');
  if (!in.read(rgb.data(), std::streamsize(rgb.size())) || magic != "P6") {
    std::cerr << argv[1] << " is no picture\n";
    return 1;
  }
  const int frame = std::atoi(argv[2]);
  const gl::HeadlessContext context = gl::HeadlessContext::create().value();
  gl::Renderer renderer = gl::Renderer::create(gl::find_capabilities().value()).value();
  bool first = true;
  for (const Thing& thing : things()) {
    renderer.add_instance(renderer.add_mesh(thing.mesh), first ? flight_of(frame) : thing.place);
    first = false;
  }
  const gl::Camera camera = gl::camera_of(view_matrix(width, height), width, height).value();
  const gnomon::ShadowMask mask = renderer.mask(camera, lamp_of(frame), {}).value();
  int shadow = 0, lit = 0, wrong = 0;
  for (std::size_t k = 0; k < mask.state.size(); ++k) {
    if (mask.state[k] == gnomon::ShadowMask::kNoSample) continue;
    const int grey = static_cast<unsigned char>(rgb[3 * k]);
    const bool dark = grey <= kAmbient, bright = grey >= kLit;
    (mask.state[k] == gnomon::ShadowMask::kShadow ? shadow : lit) += 1;
    wrong += mask.state[k] == gnomon::ShadowMask::kShadow ? !dark : !bright;
  }
  std::cout << "frame " << frame << ": " << shadow << " pixels in shadow, " << lit << " lit, "
            << wrong << " otherwise\n";
  return wrong * kOneIn <= shadow + lit && shadow > 1000 && lit > 1000 ? 0 : 1;
}
