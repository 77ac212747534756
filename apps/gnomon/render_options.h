// Options for how shadows are drawn: the choices of gl/method.h by name.
#pragma once

#include <string>
#include <vector>

#include <gnomon/gl/context.h>
#include <gnomon/gl/renderer.h>
#include <gnomon/scene/scene.h>
#include <CLI/CLI.hpp>

#include "light_options.h"

namespace gnomon::app {

// Adds --method --count ... (group "Shadows"), which set `method`.
void add_method_options(CLI::App& command, gl::Method& method);

struct RenderLights {
  LightOptions one;                 // --date --at --tz
  std::vector<std::string> lights;  // --light X,Y,Z[,point|sun][,#rrggbb][,radius=M], repeated
  double soft = 0;                  // metres: each point light becomes a ball of lights
  int soft_lights = 12;
};
void add_render_lights(CLI::App& command, RenderLights& options);

struct ChosenLights {
  std::vector<gl::LightSource> lights;
  ChosenLight first;  // for captions and cameras
  Warnings warnings;
};
// Throws Failure, as choose_light().
ChosenLights choose_lights(const RenderLights& options, const Scene& scene);

}  // namespace gnomon::app
