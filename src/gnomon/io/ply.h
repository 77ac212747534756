// PLY, as text or binary, in double precision -> Model.
// Based on: G. Turk, The PLY Polygon File Format, 1994.
//
// Read here and not by Assimp, which keeps single precision and reads on across the ends of lines
// and elements where a file and its header do not agree.
#pragma once

#include <string>
#include <string_view>

#include <gnomon/core/result.h>
#include <gnomon/io/model.h>

namespace gnomon {

// `up`: 'y' or 'z' of the file. Elements "vertex" (properties x, y, z of any type), "face"
// (vertex_indices or vertex_index, polygons of any number of corners) and "tristrips" (strips ended
// by -1) are used, others and further properties are passed over; "edge" elements and vertices of
// files without faces are warned of. Errors (with line, or element of binary files): headers that
// are not understood, counts that the file has no room for, elements cut off, coordinates that are
// no numbers or, where a face uses them, not finite, indices out of range.
Result<Model> read_ply(std::string_view bytes, const std::string& path, char up,
                       double metres_per_unit);

}  // namespace gnomon
