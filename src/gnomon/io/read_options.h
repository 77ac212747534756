// What a reader of one model is asked for beyond its triangles.
#pragma once

#include <optional>
#include <string>

namespace gnomon {

struct Rig;

struct ReadOptions {
  bool appearance = false;          // fill Model::looks
  std::optional<double> time = {};  // seconds; the model stands as its animation has it then
  std::string animation = {};       // its name, or its number from 0; empty: the first
  // The model stands at rest, Model::vertices[k] is Rig::points[k], and no two of them are one.
  // What is at `rig` is filled. Readers of formats that are never animated leave it as it is.
  Rig* rig = nullptr;
};

}  // namespace gnomon
