// Pictures of all hard cases: hard_case_pictures FOLDER [WIDTH [NAME]]. See scripts/hard-cases.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gnomon/gl/context.h>
#include <gnomon/gl/renderer.h>
#include <gnomon/io/png.h>
#include <gnomon/shadow/cast_shadows.h>
#include <scenes/hard_cases.h>

namespace gnomon {
namespace {

[[noreturn]] void fail(const std::string& why) {
  std::fprintf(stderr, "hard_case_pictures: %s\n", why.c_str());
  std::exit(1);
}

template <typename T>
T take(Result<T> result) {
  if (!result) fail(result.error().message);
  return std::move(result).value();
}

Picture picture_of(const gl::Image& image) {
  return picture_of_rgba(image.width, image.height, image.rgba);
}

Rgb shade_of(std::uint8_t state) {
  const std::uint8_t grey = state == ShadowMask::kLit      ? 255
                            : state == ShadowMask::kShadow ? 60
                                                           : 128;
  return {grey, grey, grey};
}

// The mask in greys; in red where it is dark and should not be, in blue where it is lit and should
// not be.
Picture picture_of(const ShadowMask& mask, const ShadowMask& exact) {
  Picture out{mask.width, mask.height, {}};
  for (std::size_t i = 0; i < mask.state.size(); ++i) {
    const bool dark = mask.state[i] == ShadowMask::kShadow;
    out.pixels.push_back(mask.state[i] == exact.state[i] ? shade_of(mask.state[i])
                         : dark                          ? Rgb{220, 40, 30}
                                                         : Rgb{40, 90, 230});
  }
  return out;
}

// Of every case the picture, the mask, the volumes, and z-pass where it is refused.
void draw(const scenes::HardCase& c, const std::filesystem::path& folder) {
  gl::Renderer renderer = take(gl::Renderer::create(take(gl::find_capabilities())));
  renderer.add_scene(c.scene);
  gl::DepthRange range = gl::depth_range(c.scene, c.view, !is_parallel(c.view));
  if (c.near_plane > 0) range.near_plane = c.near_plane;
  const gl::Camera camera = gl::camera_of(c.view, range);
  gl::LightSource light;
  light.light = c.light;
  const auto write = [&](const std::string& what, const Picture& picture) {
    take(write_png(folder / (c.name + "-" + what + ".png"), picture));
  };
  gl::FrameOptions options;
  gl::FrameStats stats;
  write("picture", picture_of(take(renderer.render(camera, {&light, 1}, options, &stats))));
  options.overlay.volumes = options.overlay.silhouettes = options.overlay.lights = true;
  write("volumes", picture_of(take(renderer.render(camera, {&light, 1}, options))));
  const ShadowMask exact = cast_shadows(c.scene, c.light, c.view);
  write("mask", picture_of(take(renderer.mask(camera, c.light, {})), exact));
  gl::Method z_pass;
  z_pass.count = gl::Count::z_pass;
  const bool refused = !renderer.mask(camera, c.light, z_pass);
  if (refused) {
    z_pass.unchecked = true;
    write("z-pass", picture_of(take(renderer.mask(camera, c.light, z_pass)), exact));
  }
  std::printf("%s: %s\n  %d volumes z-pass, %d z-fail%s\n", c.name.c_str(), c.sentence.c_str(),
              stats.z_pass_volumes, stats.z_fail_volumes,
              refused ? "; z-pass alone is refused" : "");
}

void run(const std::filesystem::path& folder, int width, const std::string& name) {
  std::filesystem::create_directories(folder);
  const gl::HeadlessContext context = take(gl::HeadlessContext::create(gl::Api::opengl));
  for (const scenes::HardCase& c : scenes::hard_cases(width, width * 3 / 4)) {
    if (name.empty() || c.name == name) draw(c, folder);
  }
}

}  // namespace
}  // namespace gnomon

int main(int count, char** words) {
  const int width = count > 2 ? std::atoi(words[2]) : 640;
  if (count < 2 || width < 4 || width > 8192) {
    std::fprintf(stderr, "hard_case_pictures FOLDER [WIDTH [NAME]]\n");
    return 2;
  }
  gnomon::run(words[1], width, count > 3 ? words[3] : "");
}
