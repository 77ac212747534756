// CityJSON 1.0, 1.1, 2.0 and CityJSONSeq -> Model.
// Based on: CityJSON Specifications 1.0.3, 1.1.3 and 2.0.1, cityjson.org/specs.
#pragma once

#include <string>
#include <string_view>

#include <gnomon/core/result.h>
#include <gnomon/io/model.h>
#include <gnomon/io/read_options.h>

namespace gnomon {

// Reads every geometry of surfaces, with holes, templates, semantic surfaces and material names.
// `lod`: take geometry of this level of detail ("2", "2.2"); empty: of each object the highest it
// has. Flat LoD 0 footprints are taken only where neither the object nor its parents and parts have
// more. A polygon that one object holds twice at the LoD taken counts once
// (FileReport::stored_twice); the first one that has a semantic surface is kept. The object's name
// is its id, parts are "parent/part". FileReport::surfaces is counted here, triangles are not. A
// file without any geometry of that LoD gives a model without polygons and the LoDs found in the
// report; the caller decides whether that is an error. Errors (with file, object, geometry): not
// JSON (line and column), not CityJSON, a version not known, wrong types, indices out of range,
// coordinates that are not finite numbers, a broken transform.
// With options.appearance, materials (not textures) of the first theme come with the polygons.
Result<Model> read_cityjson(std::string_view text, const std::string& path, const std::string& lod,
                            const ReadOptions& options = {});

}  // namespace gnomon
