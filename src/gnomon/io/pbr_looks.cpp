#include <gnomon/io/pbr_looks.h>

#include <algorithm>
#include <cmath>

namespace gnomon {

double srgb_encoded(double linear) {
  if (linear <= 0.0031308) return 12.92 * std::max(0.0, linear);
  return 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double srgb_decoded(double encoded) {
  if (encoded <= 0.04045) return std::max(0.0, encoded) / 12.92;
  return std::pow((encoded + 0.055) / 1.055, 2.4);
}

void set_metallic_rough(Material& material, const Vec3& base, double metallic, double roughness) {
  const double m = std::clamp(metallic, 0.0, 1.0), r = std::clamp(roughness, 0.0, 1.0);
  const double r4 = r * r * r * r;
  const double n = 2 <= (kSharpest + 2) * r4 ? 2 / r4 - 2 : kSharpest;
  material.shininess = n;
  for (int k = 0; k < 3; ++k) {
    const double reflected = 0.04 * (1 - m) + base[k] * m;
    material.base_colour[k] = srgb_encoded(base[k] * (1 - m / 2));
    material.specular[k] = srgb_encoded(std::min(1.0, reflected * (n + 8) / 8));
  }
}

}  // namespace gnomon
