// What every reader promises, whatever the file.
#pragma once

#include <gnomon/core/result.h>
#include <gnomon/core/warnings.h>
#include <gnomon/io/model.h>

#include <stdexcept>
#include <string>

namespace gnomon::fuzz {

struct Finding : std::logic_error {
  using std::logic_error::logic_error;
};

// Throws Finding with `promise` where `kept` is false.
void require(bool kept, const std::string& promise);

// Names the file, is one line and not empty.
void check_message(const Error& error, const std::string& path);
void check_warnings(const Warnings& warnings);

// Indices in range, rings that are not empty, coordinates that are finite. Then what load_scene
// does with a model: its polygons become triangles, and these are welded, where there are few
// enough of them for a fuzzer.
void check_model(const Model& model);

// Both for what a reader returns.
void check(const Result<Model>& read, const std::string& path);

}  // namespace gnomon::fuzz
