// Mesh files by their extension -> Model: glTF, STL, PLY and OFF through readers of our own, which
// keep double precision and check what Assimp lets pass; Collada, FBX, IFC, 3DS, MD2 and others
// through Assimp.
#pragma once

#include <filesystem>

#include <gnomon/core/result.h>
#include <gnomon/io/model.h>
#include <gnomon/io/read_options.h>

namespace gnomon {

// True where the extension (of any case) is one that read_assimp reads (".glb", ".ply", ...); see
// assimp_formats.cpp for the list. Never .obj, .json, .jsonl, pictures and text formats.
bool is_assimp_file(const std::filesystem::path& path);

// Reads a file into local coordinates, z up, metres after Model::scale. `up`: 'y' (x, y, z of the
// file become x, -z, y) or 'z' (kept) of formats that do not say; 0: the usual one.
// `metres_per_unit`: of formats that do not say; 0: the usual one. Where the format says it, these
// are not used, with a warning.
//
//   format               up, where nothing is asked                   unit
//   glTF, GLB            y, by specification; true north is -z         metres
//   Collada (.dae .zae)  the file's <up_axis>                          the file's <unit>
//   FBX                  the file's axes                               the file's UnitScaleFactor
//   IFC                  z                                             the file's units
//   STL, PLY, OFF, SMD   z                                             1 m
//   3DS, MD2, MD3, MD5   z                                             1 m
//   3MF, AMF             z                                             1 mm
//   DirectX, LightWave, Blitz3D, MilkShape 3D   y                      1 m
//
// Whatever is up, the file's x becomes the scene's x (east); so -z (y up) or y (z up) is north of
// the scene's grid, and --north turns it.
//
// Surface::object is the node's name, nested ones as "parent/child"; of IFC the element's
// "IfcWall_<name>_<GUID>" alone. Surface::group is the mesh's name, of IFC the element's type
// ("IfcWall"). Animated models stand as they do at options.time, else as the file has them at rest
// (MD2: the first frame), with a warning. Points and lines are left out with a warning, and so are
// IFC spaces, openings and annotations. A file without faces gives a model without polygons. No
// other files than the model and the buffers of glTF are opened; with options.appearance, pictures
// beside the model too.
//
// Errors name file and element: what cannot be read, coordinates that are not finite, indices out
// of range, files that are cut off. Assimp's readers abort on some damaged files; each file is
// tried out in a forked process first (tried_apart.h), so that it becomes an error here.
Result<Model> read_assimp(const std::filesystem::path& path, char up, double metres_per_unit,
                          const ReadOptions& options = {});

}  // namespace gnomon
