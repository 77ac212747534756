// Booleans among the attributes of GeoJSON, which GDAL turns into the numbers 0 and 1 where other
// features have numbers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

// `json` with each true and false that is the value of a member of one of these names (in lower
// case, sorted; those of the file in any case) in quotes: {"Height": true} -> {"Height": "true"}.
// Empty where there is none. Text that is no JSON may change otherwise.
std::string booleans_as_text(std::string_view json, const std::vector<std::string>& names);

}  // namespace gnomon
