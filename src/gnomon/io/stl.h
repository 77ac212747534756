// STL, as text in double precision or binary -> Model.
// Based on: 3D Systems, StereoLithography Interface Specification, 1989.
//
// Read here and not by Assimp, which keeps single precision of texts and passes over what it does
// not understand.
#pragma once

#include <string>
#include <string_view>

#include <gnomon/core/result.h>
#include <gnomon/io/model.h>

namespace gnomon {

// `up`: 'y' or 'z' of the file. Surface::object is the solid's name (text only). A file is binary
// if its size is what its count of triangles asks for, or if it is no text. Normals are not used.
// Errors: fewer bytes than counted, texts that end within a solid, facets without three vertices,
// coordinates that are no finite numbers.
Result<Model> read_stl(std::string_view bytes, const std::string& path, char up,
                       double metres_per_unit);

}  // namespace gnomon
