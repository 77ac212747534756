#include <gnomon/core/exact.h>

namespace gnomon {
namespace {

struct LightSide {
  const Vec3 &a, &b, &c;
  const Light& light;
  template <class T>
  T operator()(int, int l, int) const {
    return det4<T>(lift<T>(a), lift<T>(b), lift<T>(c), lift<T>(order_of(light, l)));
  }
};

}  // namespace

int light_side(const Vec3& a, const Vec3& b, const Vec3& c, const Light& light, ExactStats& stats) {
  const int sign =
      tie_sign({.eye = false, .light = true, .pixel = false}, stats, LightSide{a, b, c, light});
  return sign != 0 ? sign : -1;
}

bool zero_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  // The components of the normal are what lights at infinity along the axes see. Axis-parallel
  // triangles, common in buildings, have zero components: one that is certainly not zero is enough,
  // before any exact arithmetic.
  for (int axis = 1; axis <= 3; ++axis) {
    if (LightSide{a, b, c, Light(0.0)}.operator()<Approx>(0, axis, 0).certain()) return false;
  }
  ExactStats ignored;
  return tie_sign({.eye = false, .light = true, .pixel = false}, ignored,
                  LightSide{a, b, c, Light(1, 0, 0, 0)}) == 0;
}

}  // namespace gnomon
