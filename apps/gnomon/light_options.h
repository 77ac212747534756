// Options for one light: an instant of the sun, or a light given as it is.
#pragma once

#include <string>

#include <gnomon/core/place.h>
#include <gnomon/core/vec.h>
#include <gnomon/core/warnings.h>
#include <gnomon/scene/scene.h>
#include <gnomon/sun/sun.h>
#include <CLI/CLI.hpp>

namespace gnomon::app {

struct LightOptions {
  std::string date, at, zone;  // an instant: local calendar and clock
  std::string light;           // or "X,Y,Z[,point|sun]"
};

// Adds --date, --at, --tz and --light (group "Light").
void add_light_options(CLI::App& command, LightOptions& options);

// Throws Failure where neither an instant nor a light is given, or both; to be called before models
// are read.
void check_light_options(const LightOptions& options);

enum class LightKind { instant, sun, point };

struct ChosenLight {
  LightKind kind = LightKind::instant;
  Light light{0, 0, 0, 0};  // scene coordinates
  Instant utc{};            // of an instant
  // Not of a point. Radians: from true north, clockwise; above the horizon, apparent.
  double azimuth = 0, altitude = 0;
  double altitude_geometric = 0;  // of an instant
  std::string words;              // "18 September 2024, 14:00 Europe/Vienna"
  Warnings warnings;
};

// Throws Failure: what cannot be read, coordinates beyond the limit, no place for the sun, a local
// time that does not exist, night (says when the sun is up).
ChosenLight choose_light(const LightOptions& options, const Scene& scene);

}  // namespace gnomon::app
