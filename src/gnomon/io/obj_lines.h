// The lines of an OBJ file, checked: tinyobjloader reads a broken number as 0 and a missing
// coordinate too, does not look whether an index is in range, does not join continued lines and
// knows no line numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gnomon/core/result.h>

namespace gnomon {

struct ObjLines {
  std::string text;  // LF after each line, continued lines joined, a bare "g" as "g ", no other
                     // change of content
  std::vector<std::uint32_t> face_line;  // per f: its line in the file, from 1
  std::size_t vertices = 0;
  std::vector<double> coordinates;  // x, y, z of each v, the nearest doubles: tinyobjloader's own
                                    // conversion is often off by a last digit
  // Left out: how many, and the line of the first.
  std::size_t points_and_lines = 0, first_point_or_line = 0;
  std::size_t free_form = 0, first_free_form = 0;
  std::size_t unknown = 0, first_unknown = 0;
  std::string unknown_keyword;  // the first one, as in the file
};

// Errors as in read_obj; every index in the result leads to a vertex above or below its face.
Result<ObjLines> check_obj_lines(std::string_view text, const std::string& path);

}  // namespace gnomon
