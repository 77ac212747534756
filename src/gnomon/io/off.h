// OFF as text, in double precision -> Model.
// Based on: Geomview, "OFF Files", geomview.org/docs/html/OFF.html.
//
// Read here and not by Assimp, which keeps single precision, drops faces of more than 9 corners and
// moves indices that are out of range onto the last vertex.
#pragma once

#include <string>
#include <string_view>

#include <gnomon/core/result.h>
#include <gnomon/io/model.h>

namespace gnomon {

// `up`: 'y' or 'z' of the file. Headers [ST][C][N][4]OFF, one vertex and one face a line; normals,
// colours and texture coordinates are passed over. Faces of one or two corners are left out with a
// warning. Errors (with the line): counts that the file has no room for, fewer vertices or faces
// than counted, coordinates that are no numbers or, where a face uses them, not finite, indices out
// of range, binary OFF.
Result<Model> read_off(std::string_view text, const std::string& path, char up,
                       double metres_per_unit);

}  // namespace gnomon
