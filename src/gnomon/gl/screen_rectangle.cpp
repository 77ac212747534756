#include <gnomon/gl/screen_rectangle.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace gnomon::gl {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kSlack = 1.001;  // far above rounding; it only makes rectangles larger

// First and last pixel of a coordinate -1 .. 1, and one more on each side.
struct Span {
  int first, end;
};
Span pixels(double lo, double hi, int size) {
  const auto pixel = [&](double x) { return (std::clamp(x, -1.0, 1.0) + 1) / 2 * size; };
  if (lo > 1 || hi < -1) return {0, 0};
  return {std::max(0, static_cast<int>(std::floor(pixel(lo))) - 1),
          std::min(size, static_cast<int>(std::ceil(pixel(hi))) + 1)};
}

}  // namespace

std::array<Vec3, 8> corners_of(const SceneBox& b) {
  std::array<Vec3, 8> out;
  for (int i = 0; i < 8; ++i) {
    out[i] = {(i & 1) != 0 ? b.hi.x : b.lo.x, (i & 2) != 0 ? b.hi.y : b.lo.y,
              (i & 4) != 0 ? b.hi.z : b.lo.z};
  }
  return out;
}

Rect rectangle_round(const Camera& camera, std::span<const Vec4> points) {
  std::array<Vec4, kMostPoints> before, behind;
  int n_before = 0, n_behind = 0;
  for (const Vec4& p : points) {
    const Vec4 clip = camera.clip * p;
    (clip.w > 0 ? before[n_before++] : behind[n_behind++]) = clip;
  }
  glm::dvec2 lo(kInf), hi(-kInf);
  for (int i = 0; i < n_before; ++i) {
    const Vec4& p = before[i];
    const glm::dvec2 on_screen = glm::dvec2(p) / p.w;
    lo = glm::min(lo, on_screen);
    hi = glm::max(hi, on_screen);
    // Towards a point behind the eye the picture leaves the screen, on the side where the segment
    // meets the eye's plane.
    for (int k = 0; k < n_behind; ++k) {
      const Vec4& q = behind[k];
      const glm::dvec2 side = glm::dvec2(q) * p.w - glm::dvec2(p) * q.w;
      for (int axis = 0; axis < 2; ++axis) {
        if (side[axis] <= 0) lo[axis] = -kInf;
        if (side[axis] >= 0) hi[axis] = kInf;
      }
    }
  }
  if (n_before == 0) return {0, 0, 0, 0};
  const Span x = pixels(lo.x, hi.x, camera.width), y = pixels(lo.y, hi.y, camera.height);
  if (x.first >= x.end || y.first >= y.end) return {0, 0, 0, 0};
  return {x.first, y.first, x.end - x.first, y.end - y.first};
}

Rect rectangle_round(const Camera& camera, const SceneBox& box) {
  std::array<Vec4, 8> points;
  const std::array<Vec3, 8> corners = corners_of(box);
  for (int i = 0; i < 8; ++i) points[i] = point(corners[i]);
  return rectangle_round(camera, points);
}

std::optional<Rect> shadow_rectangle(const Camera& camera, const Light& light,
                                     const SceneBox& caster, const SceneBox& receivers) {
  const bool lamp = light.w != 0;
  const Vec3 at = lamp ? Vec3(light) / light.w : -glm::normalize(Vec3(light));
  double reach = 0;
  if (lamp) {
    const double nearest = glm::distance(at, glm::clamp(at, caster.lo, caster.hi));
    if (!(nearest > 0)) return {};
    for (const Vec3& corner : corners_of(receivers))
      reach = std::max(reach, glm::distance(at, corner) / nearest);
    reach = std::max(1.0, reach * kSlack);
  } else {
    reach = kSlack *
            glm::distance(glm::min(caster.lo, receivers.lo), glm::max(caster.hi, receivers.hi));
  }
  std::array<Vec4, 16> hull;
  const std::array<Vec3, 8> corners = corners_of(caster);
  for (int i = 0; i < 8; ++i) {
    hull[i] = point(corners[i]);
    hull[8 + i] = point(lamp ? at + reach * (corners[i] - at) : corners[i] + reach * at);
  }
  return rectangle_round(camera, hull);
}

Rect endless_rectangle(const Camera& camera, const Light& light, const SceneBox& caster) {
  std::array<Vec4, 16> hull;
  const std::array<Vec3, 8> corners = corners_of(caster);
  for (int i = 0; i < 8; ++i) {
    hull[i] = point(corners[i]);
    hull[8 + i] = Vec4(corners[i] * light.w - Vec3(light), 0);
  }
  return rectangle_round(camera, hull);
}

Rect common(const Rect& a, const Rect& b) {
  const int x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  const int right = std::min(a.x + a.width, b.x + b.width);
  const int top = std::min(a.y + a.height, b.y + b.height);
  if (x >= right || y >= top) return {0, 0, 0, 0};
  return {x, y, right - x, top - y};
}

Rect scaled(const Rect& r, const Camera& camera, int width, int height) {
  constexpr int kMore = 2;
  const auto span = [](int first, int size, int of, int to) {
    const double k = double(to) / of;
    return Span{std::max(0, static_cast<int>(std::floor(first * k)) - kMore),
                std::min(to, static_cast<int>(std::ceil((first + size) * k)) + kMore)};
  };
  if (r.width == 0 || r.height == 0) return {0, 0, 0, 0};
  if (width == camera.width && height == camera.height) return r;
  const Span x = span(r.x, r.width, camera.width, width);
  const Span y = span(r.y, r.height, camera.height, height);
  return {x.first, y.first, x.end - x.first, y.end - y.first};
}

}  // namespace gnomon::gl
