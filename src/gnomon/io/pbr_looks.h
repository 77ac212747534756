// Materials that state how metallic and rough they are -> the model of Blinn and Phong.
// Based on: Khronos Group, glTF 2.0 Specification, 2021, appendix B; Brian Karis, Specular BRDF
// Reference, 2013 (exponents of roughness); IEC 61966-2-1, 1999 (sRGB).
#pragma once

#include <gnomon/scene/appearance.h>

namespace gnomon {

// Of one channel, 0 (or less) to 1; beyond 1 the curve goes on.
double srgb_encoded(double linear);
double srgb_decoded(double encoded);

// Sets base_colour, specular and shininess. `base`: linear, 0 to 1.
//   exponent   n = 2 / roughness^4 - 2, at most kSharpest; a rough surface (1) has no highlight
//   reflected  F = 0.04 (1 - metallic) + base metallic, straight on
//   specular   min(1, F (n + 8) / 8), so that highlights of all exponents reflect as much light
//   base       base (1 - metallic / 2): metals scatter nothing, but would be black where there is
//              nothing around them to reflect
// Colours are encoded at the end.
void set_metallic_rough(Material& material, const Vec3& base, double metallic, double roughness);

inline constexpr double kSharpest = 1000;

}  // namespace gnomon
