// Options for what is looked at: a plan, or a camera.
#pragma once

#include <string>

#include <gnomon/scene/scene.h>
#include <gnomon/view/view.h>
#include <CLI/CLI.hpp>

namespace gnomon::app {

struct ViewOptions {
  std::string kind;    // "plan", "camera" or empty: plan unless --eye, --target or --ortho is given
  double pixel = 0;    // metres; 0: chosen
  std::string bounds;  // "x0,y0,x1,y1" in the model's CRS; empty: the model and a margin
  std::string eye, target;  // "x,y,z" in the model's CRS; empty: chosen
  double fov_deg = 35;      // vertical
  double ortho_height = 0;  // metres; > 0: parallel camera
  std::string size = "1600x1000";
};

void add_view_options(CLI::App& command, ViewOptions& options);

// The model's box in scene coordinates, without the ground.
struct Box {
  Vec3 lo, hi;
};
Box model_box(const Scene& scene);

std::optional<Bounds2> parse_bounds(const std::string& text);  // model CRS; throws Failure
bool wants_camera(const ViewOptions& options);

// The view that the options ask for, or a good one. `sun_azimuth`: radians clockwise from the
// scene's +y, where the sun is in the middle of the time: automatic cameras look from that side.
View make_plan(const Scene& scene, const ViewOptions& options);
View make_camera(const Scene& scene, const ViewOptions& options, double sun_azimuth,
                 int supersample);

}  // namespace gnomon::app
