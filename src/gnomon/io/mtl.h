// Materials of OBJ files (.mtl).
// Based on: Wavefront, Advanced Visualizer Manual, Appendix B2: Material Library File (.mtl), 1995.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include <gnomon/io/model_pictures.h>

namespace gnomon {

// Materials by their names: indices into ModelLooks::materials.
using MtlNames = std::map<std::string, std::uint32_t>;

// Adds the materials of a library that the OBJ names (mtllib). Kd, Ks, Ns, Ke, d, Tr, map_Kd,
// map_Bump, bump, norm, and map_d where it is the picture of map_Kd. Warnings: a library that is
// not beside the model, numbers that are none (the line), maps that are not read, bump maps that
// hold heights and not normals. Precondition: model.looks.
void read_mtl(const std::string& library, Model& model, ModelPictures& pictures, MtlNames& names);

// The same of the library's text.
void read_mtl_text(std::string_view text, const std::string& library, Model& model,
                   ModelPictures& pictures, MtlNames& names);

}  // namespace gnomon
