// Which feature of a GeoJSON file has coordinates that are none: GDAL reads all of them at once and
// does not say.
#pragma once

#include <string>
#include <string_view>

namespace gnomon {

// "feature 2 (id way/7)", counted from 1: the first whose coordinates are not lists of numbers. In
// a text sequence "line 2 (id way/7)", where its feature begins, or is no JSON. Empty where there
// is none, or the text is no GeoJSON with features.
std::string first_bad_feature(std::string_view json);

}  // namespace gnomon
