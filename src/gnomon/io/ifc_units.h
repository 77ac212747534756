// Lengths in IFC files.
#pragma once

#include <optional>
#include <string_view>

#include <gnomon/io/step_file.h>

namespace gnomon {

struct IfcLengthUnit {
  double metres = 1;
  bool si = true;  // false: IfcConversionBasedUnit, such as feet
};

// The unit with this id; nothing where it is no length or cannot be read.
std::optional<IfcLengthUnit> ifc_length_unit(const StepFile& file, std::uint64_t id);

// Of a name as property sets have it: "METRE", "MILLIMETRE", "FOOT", "US SURVEY FOOT". Nothing
// where it is not known.
std::optional<double> ifc_length_unit_named(std::string_view name);

// The length unit of the project (IfcProject.UnitsInContext); nothing where it does not say.
std::optional<IfcLengthUnit> ifc_project_unit(const StepFile& file);

// The first IfcProject; null where there is none.
const StepInstance* ifc_project(const StepFile& file);

}  // namespace gnomon
