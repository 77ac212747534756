// Options for what is looked at: a plan, or a camera.
#pragma once

#include <optional>
#include <string>

#include <gnomon/scene/scene.h>
#include <gnomon/view/view.h>
#include <CLI/CLI.hpp>

#include "shadow_reach.h"

namespace gnomon::app {

struct ViewOptions {
  std::string kind;    // "plan", "camera" or empty: plan unless --eye, --target or --ortho is given
  double pixel = 0;    // metres; 0: chosen
  std::string bounds;  // "x0,y0,x1,y1" in the model's CRS; empty: the model and its shadows
  std::string eye, target;  // "x,y,z" in the model's CRS; empty: chosen
  double fov_deg = 35;      // vertical
  double ortho_height = 0;  // metres; > 0: parallel camera
  std::string size = "1600x1000";
};

void add_view_options(CLI::App& command, ViewOptions& options);
void add_camera_options(CLI::App& command, ViewOptions& options);  // of these, the camera's

// The model's box in scene coordinates, without the ground.
struct Box {
  Vec3 lo, hi;
};
Box model_box(const Scene& scene);

// Azimuth in the scene's grid, radians, from the model to the light: automatic cameras look from
// that side.
double light_azimuth(const Scene& scene, const Light& light);

// The legend's word for what the map leaves out: surfaces that do not receive, or none at all.
std::string without_sample(const Scene& scene);

std::optional<Bounds2> parse_bounds(const std::string& text);  // model CRS; throws Failure
bool wants_camera(const ViewOptions& options);

// The view that the options ask for, or a good one. `sun_azimuth`: radians clockwise from the
// scene's +y, where the sun is in the middle of the time: automatic cameras look from that side.
// `reach`: the default plan of few buildings holds shadows as long; empty: a margin of up to three
// heights.
View make_plan(const Scene& scene, const ViewOptions& options,
               const std::optional<ShadowReach>& reach = {});
View make_camera(const Scene& scene, const ViewOptions& options, double sun_azimuth,
                 int supersample);

}  // namespace gnomon::app
