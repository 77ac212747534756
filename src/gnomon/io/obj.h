// OBJ, in double precision -> Model.
// Based on: Wavefront, Advanced Visualizer Manual, Appendix B1: Object Files (.obj), 1995.
#pragma once

#include <string>
#include <string_view>

#include <gnomon/core/result.h>
#include <gnomon/io/model.h>
#include <gnomon/io/read_options.h>

namespace gnomon {

// `up`: 'y' (x, y, z of the file become x, -z, y) or 'z' (kept). `metres_per_unit`: of the
// coordinates, > 0. `o` names the object, `g` the group (several names joined by a space), `usemtl`
// the material; .mtl files, texture coordinates and normals are read where options.appearance asks
// for them. A ModelPolygon's number is the face's line. Colours and
// weights after a vertex are ignored; points, lines and free-form geometry are left out with a
// warning. Errors (with the line): coordinates that are missing or not finite numbers, vertex
// indices that are no numbers, 0 or out of range, faces without corners.
Result<Model> read_obj(std::string_view text, const std::string& path, char up,
                       double metres_per_unit, const ReadOptions& options = {});

}  // namespace gnomon
