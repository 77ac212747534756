#include <gnomon/view/view.h>

#include <cmath>

#include <glm/geometric.hpp>

#include <gnomon/core/exact.h>

namespace gnomon {
namespace {

// Bounds given as decimal numbers divide a pixel size only up to rounding; a sliver of a millionth
// of a pixel adds no pixel.
constexpr double kPixelSlack = 1e-6;

int pixels(double length, double pixel) {
  return std::max(1, static_cast<int>(std::ceil(length / pixel - kPixelSlack)));
}

}  // namespace

View plan_view(const Bounds2& bounds, double pixel, double z) {
  View v;
  v.eye = Vec4(0, 0, 1, 0);
  v.origin = snapped(Vec4(bounds.x0, bounds.y1, z, 1));
  v.right = Vec4(pixel, 0, 0, 0);
  v.down = Vec4(0, -pixel, 0, 0);
  v.width = pixels(bounds.x1 - bounds.x0, pixel);
  v.height = pixels(bounds.y1 - bounds.y0, pixel);
  return v;
}

View perspective_view(const Vec3& eye, const Vec3& target, const Vec3& up, double vertical_fov,
                      int width, int height) {
  const Vec3 forward = glm::normalize(target - eye);
  const Vec3 right = glm::normalize(glm::cross(forward, up));
  const Vec3 top = glm::cross(right, forward);
  const double step = 2 * std::tan(vertical_fov / 2) / height;  // pixel size at distance 1
  View v;
  v.eye = snapped(point(eye));
  v.right = snapped(direction(right * step));
  v.down = snapped(direction(top * -step));
  v.origin = snapped(direction(forward - right * (step * width / 2) + top * (step * height / 2)));
  v.width = width;
  v.height = height;
  return v;
}

View orthographic_view(const Vec3& eye, const Vec3& target, const Vec3& up, double height_m,
                       int width, int height) {
  const Vec3 forward = glm::normalize(target - eye);
  const Vec3 right = glm::normalize(glm::cross(forward, up));
  const Vec3 top = glm::cross(right, forward);
  const double step = height_m / height;
  View v;
  v.eye = snapped(direction(-forward));
  v.right = snapped(direction(right * step));
  v.down = snapped(direction(top * -step));
  v.origin = snapped(point(target - right * (step * width / 2) + top * (step * height / 2)));
  v.width = width;
  v.height = height;
  return v;
}

}  // namespace gnomon
