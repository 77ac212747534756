// Attribute values as OpenStreetMap's mappers write them, and tags packed into one attribute.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gnomon {

// A finite number with nothing but spaces around it: "12", "12.5", "-3", "1e-3", "12,5". A comma is
// a decimal one; "1,200" could be either and is none.
std::optional<double> parse_number(std::string_view text);

// A length in metres: a number alone, with "m", "metre(s)", "meter(s)", or in feet and inches:
// "40 ft", "40'", "12'6\"", "12 ft 6 in". Nothing for all else ("~12", "10-12", "12;15").
std::optional<double> parse_metres(std::string_view text);

using Tags = std::vector<std::pair<std::string, std::string>>;

// A JSON object ({"height": "12"}, as GeoJSON has nested tags) or the text of a PostgreSQL hstore
// ("height"=>"12", as GDAL's OSM driver writes other_tags). Members that are null are left
// out; objects and arrays stay as JSON, so that who looks for a number sees that there is none.
// Nothing where it is neither.
std::optional<Tags> parse_tags(std::string_view text);

}  // namespace gnomon
