// Materials of CityJSON's "appearance" -> ModelLooks. Textures are not read.
#pragma once

#include <cstdint>

#include <gnomon/io/cityjson_objects.h>

namespace gnomon::cityjson {

// Index into ModelLooks::materials; equal materials (as features of a CityJSONSeq repeat them) are
// one. ambientIntensity and isSmooth are not used; what it does not say is as Material has it.
// Values that are no numbers in [0, 1] are left out, with a warning. Precondition: model.looks.
std::uint32_t material_of(Reading& reading, const Json& material);

}  // namespace gnomon::cityjson
