// Map conversions of IFC files: as entities (IFC4) and as property sets (IFC2x3).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <gnomon/core/warnings.h>
#include <gnomon/io/ifc_place.h>
#include <gnomon/io/step_file.h>

namespace gnomon {

// The conversion of the file, in metres; `context`: id of the representation context that it should
// start from. Nothing where the file has none or it cannot be read (then with a warning).
std::optional<IfcMapConversion> ifc_map_conversion(const StepFile& file, std::uint64_t context,
                                                   double project_unit, Warnings& warnings);

// The name of a CRS as PROJ reads it: "EPSG:25832" of "epsg 25832", "25832" or an OGC URN; else
// the name as it is.
std::string ifc_crs(std::string_view name);

}  // namespace gnomon
