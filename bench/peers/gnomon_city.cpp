// The box city drawn by our own renderer, timed: the same frames as irrlicht_city.cpp's.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gnomon/gl/context.h>
#include <gnomon/gl/renderer.h>
#include <gnomon/io/png.h>
#include <gnomon/view/view.h>

#include "city_frames.h"
#include "city_view.h"

namespace gnomon::bench {
namespace {

struct Options : FrameCommand {
  std::string shadows = "auto";
  std::string count = "auto";
  std::string only;
};

template <class T>
T there(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(result).value();
}

class City {
 public:
  explicit City(const Options& o)
      : context_(there(gl::HeadlessContext::create())),
        capabilities_(there(gl::find_capabilities())),
        renderer_(there(gl::Renderer::create(capabilities_))) {
    renderer_.add_scene(scenes::box_city());
    const CityCamera c;
    const View view = perspective_view(c.eye, c.target, c.up, c.fov, o.size, o.size);
    camera_ = gl::camera_of(view, {.near_plane = c.near_plane});
    frame_.ambient = Vec3(kAmbient);
    frame_.background = Vec3(0);
    if (o.shadows == "attenuated") shadows_ = gl::Shadows::attenuated;
    if (o.count == "zpass") frame_.method.count = gl::Count::z_pass;
    if (o.count == "zfail") frame_.method.count = gl::Count::z_fail;
  }

  void show(bool shadows) { shown_ = shadows ? shadows_ : gl::Shadows::none; }

  // From a lamp and a camera to the whole picture.
  FrameTime frame(const Vec3& lamp) {
    const FrameWatch watch;
    draw(lamp);
    renderer_.finish();
    return watch.read();
  }

  // Three bytes a pixel, row 0 at the top.
  std::vector<std::uint8_t> picture(bool shadows, const Vec3& lamp) {
    show(shadows);
    draw(lamp);
    const gl::Image image = renderer_.read();
    std::vector<std::uint8_t> rgb;
    for (std::size_t k = 0; k < image.rgba.size(); k += 4)
      rgb.insert(rgb.end(), {image.rgba[k], image.rgba[k + 1], image.rgba[k + 2]});
    return rgb;
  }

  const gl::FrameStats& stats() const { return stats_; }  // of the last frame
  std::string gl_renderer() const { return capabilities_.renderer; }

 private:
  void draw(const Vec3& lamp) {
    frame_.method.shadows = shown_;
    const gl::LightSource light{point(lamp), Vec3(1 - kAmbient), {1, 0, 0}, 0};
    stats_ = there(renderer_.draw(camera_, {&light, 1}, frame_));
  }

  gl::HeadlessContext context_;
  gl::Capabilities capabilities_;
  gl::Renderer renderer_;
  gl::Shadows shadows_ = gl::Shadows::automatic, shown_ = shadows_;
  gl::Camera camera_;
  gl::FrameOptions frame_;
  gl::FrameStats stats_;
};

// The still lamp, but for a thousandth of a millimetre from frame to frame, so that its volumes are
// made anew in each.
Vec3 trembling_lamp(int frame) { return kLamp + Vec3(0, 0, frame % 2 == 0 ? 0 : 1e-6); }

std::vector<FrameCase> measure(City& city, const Options& o) {
  const auto show = [&](bool shadows) { return [&city, shadows] { city.show(shadows); }; };
  const auto still = [](int) { return kLamp; };
  std::vector<FrameCase> cases = {{"no shadows", show(false), still},
                                  {"lamp still, volumes kept", show(true), still},
                                  {"lamp still", show(true), trembling_lamp},
                                  {"lamp moving", show(true), moving_lamp}};
  if (!o.only.empty()) std::erase_if(cases, [&](const FrameCase& c) { return c.name != o.only; });
  measure(cases, o.rounds, o.frames, [&](const Vec3& lamp) { return city.frame(lamp); });
  return cases;
}

void write_picture(const std::vector<std::uint8_t>& rgb, int size, const std::string& path) {
  Picture picture{size, size, {}};
  for (std::size_t k = 0; k < rgb.size(); k += 3)
    picture.pixels.push_back({rgb[k], rgb[k + 1], rgb[k + 2]});
  there(write_png(path, picture));
}

int run(const Options& o) {
  City city(o);
  if (!o.picture.empty()) {
    const Vec3 lamp = o.picture_frame < 0 ? kLamp : moving_lamp(o.picture_frame);
    write_picture(city.picture(true, lamp), o.size, o.picture);
  }
  const auto check = [&](const Vec3& lamp) {
    return check_city(city.picture(true, lamp), city.picture(false, lamp), o.size, lamp);
  };
  const FrameChecks checks{check(kLamp), check(trembling_lamp(1)), check(moving_lamp(kMovedFrame))};
  city.picture(true, kLamp);  // for its method
  const std::string what = fmt::format("{}, {}", gl::name_of(city.stats().method.count),
                                       gl::name_of(city.stats().method.shadows));
  const std::string method = gl::describe(city.stats().method);
  const std::vector<FrameCase> cases = measure(city, o);
  fmt::print("| {} | Gnomon | {} |{}\n", o.size, what, to_columns(cases, checks));
  if (!o.json.empty()) {
    nlohmann::ordered_json results = {{"program", "Gnomon"},
                                      {"gl_renderer", city.gl_renderer()},
                                      {"size", o.size},
                                      {"method", method}};
    add_json(results, cases, checks);
    std::ofstream out(o.json);
    out << results.dump(1) << std::endl;
    if (!out) throw std::runtime_error("Cannot write " + o.json);
  }
  return 0;
}

}  // namespace
}  // namespace gnomon::bench

int main(int argc, char** argv) {
  gnomon::bench::Options o;
  CLI::App app{
      "The box city by Gnomon's renderer: a row of a Markdown table (picture's size, median, least "
      "and processor's milliseconds per frame)"};
  gnomon::bench::add_options(app, o);
  app.add_option("--shadows", o.shadows, "What a shadow is in the picture")
      ->check(CLI::IsMember({"auto", "attenuated"}))
      ->capture_default_str();
  app.add_option("--count", o.count, "Counting")
      ->check(CLI::IsMember({"auto", "zpass", "zfail"}))
      ->capture_default_str();
  app.add_option("--only", o.only, "Time this case alone, e.g. \"lamp moving\"");
  CLI11_PARSE(app, argc, argv);
  try {
    return gnomon::bench::run(o);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_gnomon_city: %s\n", e.what());
    return 1;
  }
}
