// Booleans, lists and objects among the attributes of GeoJSON: GDAL turns true into the number 1
// where other features have numbers, and all of an attribute into lists where one feature has one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

// `json` with each true, false, list and object that is the value of a member of one of these names
// (in lower case, sorted; those of the file in any case) in quotes: {"Height": [5, "6"]} ->
// {"Height": "[5, \"6\"]"}. The members that GeoJSON itself has ("properties", ...) stay. Empty
// where there is none. Text that is no JSON may change otherwise.
std::string odd_values_as_text(std::string_view json, const std::vector<std::string>& names);

}  // namespace gnomon
