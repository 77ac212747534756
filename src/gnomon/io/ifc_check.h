// What must hold before an IFC file is given to Assimp.
// Assimp 5.2.5 does not look at the schema that a file names: it takes each entity for one of
// IFC2x3 with the same name and leaves out what it does not know. It then crashes (not: reports)
// where it follows a reference to an entity that is missing or left out, as in most files of IFC4
// (IfcTriangulatedFaceSet, IfcIndexedPolyCurve), and on entities that refer to themselves, directly
// or over others. It reads a file that was cut off as far as it goes.
#pragma once

#include <optional>
#include <string_view>

#include <gnomon/core/result.h>
#include <gnomon/io/step_file.h>

namespace gnomon {

// The error that a user sees in place of the crash: not IFC, a schema before IFC2x3; references to
// entities that are missing or that IFC2x3 does not have (for IFC4: says to export as IFC2x3),
// entities that contain themselves. Nothing where Assimp can be called. A file of IFC4 passes where
// all that is referred to are entities of IFC2x3 (simple bodies do).
std::optional<Error> check_ifc(const StepFile& file);

// "IFC2X3" or "IFC4" as the file names it; empty where it is no IFC.
std::string_view ifc_schema(const StepFile& file);

extern const std::string_view kIfc2x3Names;  // separated by spaces

}  // namespace gnomon
