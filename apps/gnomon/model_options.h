// Options for models, their place, their ground and who casts and receives: the same in every
// command.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gnomon/io/load_scene.h>
#include <CLI/CLI.hpp>

namespace gnomon::app {

struct ModelOptions {
  std::vector<std::filesystem::path> models;
  LoadOptions load;
};

// Adds MODEL... (required) and, in the group "Model", --lod --up --unit --north --crs --site
// --time --animation --ground --cast --no-cast --receive, and groups for footprints and surface
// models. --up --unit --north --crs --site --time --animation take [FILE=]VALUE, for one file or
// for all, and may be repeated; so may the last three, which take one pattern each. `options` must
// outlive the parsing.
void add_model_options(CLI::App& command, ModelOptions& options);

// The scene, with a line of progress on the terminal. `bounds`: the ground reaches at least there
// (coordinates of the scene's CRS). Failure where load_scene() has an error.
LoadedScene read_models(const ModelOptions& options, bool quiet,
                        std::optional<Bounds2> bounds = {});

// Names of the models for a picture's title: "vienna, towers" for vienna.city.json and towers.obj.
std::string title_of(const ModelOptions& options);

}  // namespace gnomon::app
