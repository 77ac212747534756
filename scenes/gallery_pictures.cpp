// The papers' figures that can be made from our scenes: gallery_pictures FOLDER. See
// scripts/gallery.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gnomon/gl/context.h>
#include <gnomon/gl/renderer.h>
#include <gnomon/io/png.h>
#include <scenes/hard_cases.h>
#include <scenes/paper_scenes.h>

namespace gnomon {
namespace {

constexpr int kWidth = 640, kHeight = 480;

[[noreturn]] void fail(const std::string& why) {
  std::fprintf(stderr, "gallery_pictures: %s\n", why.c_str());
  std::exit(1);
}

template <typename T>
T take(Result<T> result) {
  if (!result) fail(result.error().message);
  return std::move(result).value();
}

struct Studio {
  std::filesystem::path folder;
  gl::Capabilities capabilities = take(gl::find_capabilities());

  gl::Renderer renderer_of(const Scene& scene) const {
    gl::Renderer renderer = take(gl::Renderer::create(capabilities));
    renderer.add_scene(scene);
    return renderer;
  }

  void draw(gl::Renderer& renderer, const std::string& name, const gl::Camera& camera,
            const std::vector<gl::LightSource>& lights, const gl::FrameOptions& options) const {
    const gl::Image image = take(renderer.render(camera, lights, options));
    take(write_png(folder / (name + ".png"),
                   picture_of_rgba(image.width, image.height, image.rgba)));
    std::printf("  %s.png\n", name.c_str());
  }
};

gl::LightSource lamp(const Light& light, const Vec3& colour = Vec3(0.8)) {
  gl::LightSource source;
  source.light = light;
  source.colour = colour;
  return source;
}

// Volumes as the papers show them: to infinity, edges pink, lamps marked.
gl::FrameOptions seen_through() {
  gl::FrameOptions options;
  options.method.reach = gl::Reach::infinite;
  options.overlay.volumes = options.overlay.silhouettes = options.overlay.lights = true;
  return options;
}

// Everitt and Kilgard, Figures 2, 3 and 5: from the eye, from beside it, and in its clip space.
void three_views(const Studio& studio, const scenes::HardCase& c, const std::string& figure,
                 const Vec3& beside, const Vec3& target) {
  gl::Renderer renderer = studio.renderer_of(c.scene);
  gl::DepthRange range = gl::depth_range(c.scene, c.view, true);
  if (c.near_plane > 0) range.near_plane = c.near_plane;
  const gl::Camera eye = gl::camera_of(c.view, range);
  const std::vector<gl::LightSource> lights{lamp(c.light)};
  gl::FrameOptions plain;
  plain.overlay.lights = true;
  studio.draw(renderer, figure + "-eye", eye, lights, plain);
  studio.draw(renderer, figure + "-eye-volumes", eye, lights, seen_through());

  const View from = perspective_view(beside, target, {0, 0, 1}, 0.8, kWidth, kHeight);
  gl::Camera other = gl::camera_of(from, gl::depth_range(c.scene, from, true));
  plain.overlay.frustum = eye;
  studio.draw(renderer, figure + "-beside", other, lights, plain);
  other.keep_inside = eye.clip;
  gl::FrameOptions volumes = seen_through();
  volumes.overlay.frustum = eye;
  studio.draw(renderer, figure + "-beside-volumes", other, lights, volumes);

  // From the left, above and the eye's side of the cube.
  const View cube =
      perspective_view({-2.2, 1.7, 4.4}, {0, -0.1, 0}, {0, 1, 0}, 0.62, kWidth, kHeight);
  const gl::Camera clip = gl::clip_space_camera(eye, cube, {0.5});
  plain.method.count = volumes.method.count = gl::Count::near_cap;
  plain.method.reach = gl::Reach::infinite;
  studio.draw(renderer, figure + "-clip-space", clip, lights, plain);
  studio.draw(renderer, figure + "-clip-space-volumes", clip, lights, volumes);
}

const scenes::HardCase& find(const std::vector<scenes::HardCase>& cases, const std::string& name) {
  for (const scenes::HardCase& c : cases) {
    if (c.name == name) return c;
  }
  fail("there is no hard case '" + name + "'");
}

void near_caps(const Studio& studio, const std::vector<scenes::HardCase>& cases) {
  for (const char* name : {"figure-1-all-pixels", "figure-1-some-pixels", "figure-1-straddling"}) {
    const scenes::HardCase& c = find(cases, name);
    gl::Renderer renderer = studio.renderer_of(c.scene);
    gl::DepthRange range = gl::depth_range(c.scene, c.view, true);
    if (c.near_plane > 0) range.near_plane = c.near_plane;
    const gl::Camera camera = gl::camera_of(c.view, range);
    gl::FrameOptions options;
    studio.draw(renderer, std::string("003-") + name, camera, {lamp(c.light)}, options);
    options.method.count = gl::Count::z_pass;
    options.method.unchecked = true;
    studio.draw(renderer, std::string("003-") + name + "-zpass", camera, {lamp(c.light)}, options);
  }
}

void coloured_and_clustered(const Studio& studio) {
  const scenes::PaperScene s = scenes::figures_in_a_room();
  gl::Renderer renderer = studio.renderer_of(s.scene);
  const View view = scenes::view_of(s, kWidth, kHeight);
  const gl::Camera camera = gl::camera_of(view, gl::depth_range(s.scene, view, true));
  for (const int count : {3, 12}) {
    std::vector<gl::LightSource> lights;
    for (const scenes::Lamp& l : scenes::lamps_of_the_room(count, 0.1))
      lights.push_back(lamp(point(l.at), l.colour));
    gl::FrameOptions options;
    options.ambient = Vec3(0.15);
    studio.draw(renderer, "003-figure-4-" + std::to_string(count), camera, lights, options);
  }
}

void revisited(const Studio& studio) {
  const scenes::PaperScene s = scenes::convex_bodies();
  gl::Renderer renderer = studio.renderer_of(s.scene);
  const View view = scenes::view_of(s, kWidth, kHeight);
  const gl::Camera camera = gl::camera_of(view, gl::depth_range(s.scene, view, true));
  const scenes::Lamp l = scenes::lamp_on_its_round(0.2);
  const std::vector<gl::LightSource> lights{lamp(point(l.at), l.colour)};
  gl::FrameOptions options;
  options.method.mask = gl::MaskIn::alpha;
  for (const int part : {1, 2, 4}) {
    options.method.mask_scale = 1.0 / part;
    studio.draw(renderer, "000-figure-6-" + std::to_string(part), camera, lights, options);
  }
  options.method.mask_scale = 1;
  for (const gl::Shadows shadows :
       {gl::Shadows::black, gl::Shadows::ambient, gl::Shadows::attenuated}) {
    options.method.shadows = shadows;
    studio.draw(renderer, "000-table-1-" + std::string(gl::name_of(shadows)), camera, lights,
                options);
  }
  gl::FrameOptions counts;
  counts.overlay.counts = true;
  studio.draw(renderer, "000-counts", camera, lights, counts);
  gl::FrameOptions wires = seen_through();
  wires.overlay.edges = true;
  studio.draw(renderer, "000-wire-frame", camera, lights, wires);
}

void run(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const gl::HeadlessContext context = take(gl::HeadlessContext::create(gl::Api::opengl));
  const Studio studio{folder};
  const std::vector<scenes::HardCase> cases = scenes::hard_cases(kWidth, kHeight);
  revisited(studio);
  near_caps(studio, cases);
  three_views(studio, find(cases, "light-in-knot"), "003-figure-2", {14, -10, 9}, {0, 0, 1});
  three_views(studio, find(cases, "light-in-knot-near-eye"), "003-figure-3", {14, -10, 9},
              {0, 0, 1});
  three_views(studio, find(cases, "near-plane-cuts-volumes-of-sun"), "003-figure-5", {14, -10, 9},
              {0, 0, 1});
  coloured_and_clustered(studio);
}

}  // namespace
}  // namespace gnomon

int main(int count, char** words) {
  if (count != 2) {
    std::fprintf(stderr, "gallery_pictures FOLDER\n");
    return 2;
  }
  gnomon::run(words[1]);
}
