// A scene as OBJ, in double precision and in the coordinates of its CRS.
// Based on: Wavefront, Advanced Visualizer Manual, Appendix B1: Object Files (.obj), 1995.
#pragma once

#include <filesystem>
#include <string>

#include <gnomon/core/result.h>
#include <gnomon/core/warnings.h>
#include <gnomon/io/atomic_file.h>
#include <gnomon/scene/scene.h>

namespace gnomon {

struct ObjWritten {
  FileWritten obj, mtl;
  std::size_t objects = 0;
  // Largest |written coordinate - (scene coordinate + origin)|, metres: half a last digit of a
  // double as large as the CRS's coordinates.
  double largest_rounding = 0;
  Warnings warnings;
};

// z up, metres. Vertices are those of the mesh in its order, as scene coordinates + frame.origin in
// the shortest decimals that read back as the same doubles. Triangles object after object (`o`), in
// each surface after surface (`g` its group, `usemtl` its semantic surface, material or group),
// with the winding of the scene. Colours stand in a .mtl of the same stem beside it. Comments at
// the top name the CRS, origin, true north and `software`. Names lose what OBJ cannot carry (line
// breaks, backslashes), with a warning; so do vertices that rounding makes one. Errors: as
// write_text_file; a .mtl in that place that Gnomon did not write; more vertices than OBJ's readers
// count (2^31).
Result<ObjWritten> write_obj(const std::filesystem::path& path, const Scene& scene,
                             const std::string& software);

}  // namespace gnomon
