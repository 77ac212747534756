// The parts of a summary.json that commands share.
#pragma once

#include <string>

#include <gnomon/core/warnings.h>
#include <gnomon/io/load_scene.h>
#include <gnomon/view/view.h>
#include <nlohmann/json.hpp>

#include "model_options.h"

namespace gnomon::app {

using Json = nlohmann::ordered_json;

Json text_or_null(const std::string& text);

// "inputs": models, --lod, --up ..., as given; a command adds its own options.
Json model_inputs_json(const ModelOptions& options);

Json site_json(const Site& site);

// "scene": what was read, and where it stands.
Json scene_json(const LoadedScene& loaded);

// "view": `origin` is the scene's, for the bounds in the model's coordinates.
Json view_json(const View& view, const Vec3& origin);

Json warnings_json(const Warnings& warnings);

}  // namespace gnomon::app
