#include <gnomon/gl/camera.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace gnomon::gl {
namespace {

// Rows of a map from homogeneous scene points to (column, row, depth) times a common scale. Of a
// camera: P - e = scale (q0 + column right + row down), depth = scale * (metres along the axis per
// unit of q). Of a parallel view: P = origin + column right + row down - depth * towards.
struct PixelFrame {
  Vec4 column, row, scale;  // dot products with a homogeneous point
  Vec4 depth;               // metres along the axis of view
  double axis = 1;          // length of q along the axis of view (1 m for a camera of ours)
};

Vec4 row4(const Vec3& xyz, const Vec4& from) {
  return {xyz.x, xyz.y, xyz.z, -glm::dot(xyz, Vec3(from))};
}

PixelFrame pixel_frame(const View& v) {
  PixelFrame f;
  const Vec3 right(v.right), down(v.down);
  const Vec3 away = glm::normalize(glm::cross(right, down));  // x right, y down: z away
  if (is_parallel(v)) {
    // columns of the basis: right, down, away from the eye
    const Vec3 towards = glm::normalize(Vec3(v.eye));
    const glm::dmat3 basis(right, down, -towards);
    const glm::dmat3 inverse = glm::inverse(basis);
    const glm::dmat3 rows = glm::transpose(inverse);
    f.column = row4(rows[0], v.origin);
    f.row = row4(rows[1], v.origin);
    f.scale = Vec4(0, 0, 0, 1);
    f.depth = row4(rows[2], v.origin);
    return f;
  }
  const Vec3 origin(v.origin);
  const glm::dmat3 basis(right, down, origin);
  const glm::dmat3 rows = glm::transpose(glm::inverse(basis));
  f.column = row4(rows[0], v.eye);
  f.row = row4(rows[1], v.eye);
  f.scale = row4(rows[2], v.eye);
  f.axis = std::fabs(glm::dot(origin, away));
  f.depth = f.scale * f.axis;
  return f;
}

glm::dmat4 from_rows(const Vec4& x, const Vec4& y, const Vec4& z, const Vec4& w) {
  return glm::transpose(glm::dmat4(x, y, z, w));
}

void complete(Camera& c) {
  const glm::dmat4 back = glm::inverse(c.clip);
  const Vec4 eye = back * Vec4(0, 0, -1, 0);  // a parallel view's eye is a direction
  c.eye = std::fabs(eye.w) > 1e-12 * glm::length(Vec3(eye)) ? eye / eye.w
                                                            : direction(glm::normalize(Vec3(eye)));
  // A pixel more on each side, so that the rounding of the matrix to float leaves nothing outside.
  const double x = 1 + 2.0 / c.width, y = 1 + 2.0 / c.height;
  const double corners[4][2] = {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
  for (int i = 0; i < 4; ++i) {
    const Vec4 p = back * Vec4(corners[i][0], corners[i][1], -1, 1);
    c.near_rectangle[i] = Vec3(p) / p.w;
  }
}

}  // namespace

Camera camera_of(const View& v, const DepthRange& range) {
  const PixelFrame f = pixel_frame(v);
  const Vec4 x = f.column * (2.0 / v.width) - f.scale;
  const Vec4 y = f.scale - f.row * (2.0 / v.height);
  const double n = range.near_plane, far = range.far_plane;
  Camera c;
  c.width = v.width;
  c.height = v.height;
  c.infinite = !is_parallel(v) && std::isinf(far);
  const Vec4 one(0, 0, 0, 1);
  if (is_parallel(v)) {
    c.clip = from_rows(x, y, (f.depth * 2.0 - one * (n + far)) / (far - n), one);
  } else {
    const Vec4 w = f.depth;  // metres along the axis
    const Vec4 z = c.infinite ? w - one * (2 * n)
                              : w * ((far + n) / (far - n)) - one * (2 * far * n / (far - n));
    c.clip = from_rows(x * f.axis, y * f.axis, z, w);
  }
  complete(c);
  c.eye = is_parallel(v) ? direction(glm::normalize(Vec3(v.eye))) : v.eye;
  return c;
}

Camera clip_space_camera(const Camera& first, const View& view, const DepthRange& range) {
  Camera c = camera_of(view, range);
  glm::dmat4 flip(1.0);
  flip[2][2] = -1;
  c.clip = c.clip * flip * first.clip;
  c.keep_inside = first.clip;
  complete(c);
  return c;
}

Result<Camera> camera_of(const glm::dmat4& clip, int width, int height) {
  const double det = glm::determinant(clip);
  if (!(std::fabs(det) > 0)) {
    return Error{"The matrix to clip space is singular (its determinant is 0 or not a number)."};
  }
  // Points of clip space with w = 1 have the reciprocal of their distance from the eye as w in the
  // scene. (A parallel view the other way round is one from the other side.)
  const glm::dmat4 back = glm::inverse(clip);
  const bool perspective = Vec3(glm::transpose(clip)[3]) != Vec3(0);
  if (perspective && (back * Vec4(0, 0, -1, 1)).w < (back * Vec4(0, 0, 1, 1)).w) {
    return Error{
        "The matrix to clip space has reversed depths (its far plane is nearer to the eye than its "
        "near plane): Gnomon's volumes take nearer depths to be less."};
  }
  Camera c;
  c.clip = clip;
  c.width = width;
  c.height = height;
  // The point at infinity straight ahead lies on the far plane: z = w there.
  const glm::dmat4 t = glm::transpose(clip);
  const Vec4 z = t[2], w = t[3];
  c.infinite = Vec3(z) == Vec3(w) && Vec3(w) != Vec3(0);
  complete(c);
  return c;
}

DepthRange depth_range(const Scene& scene, const View& view, bool infinite) {
  const PixelFrame f = pixel_frame(view);
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (!receives(scene, static_cast<std::uint32_t>(t))) continue;
    for (const std::uint32_t v : scene.mesh.triangles[t]) {
      const double d = glm::dot(f.depth, point(scene.mesh.positions[v]));
      lo = std::min(lo, d);
      hi = std::max(hi, d);
    }
  }
  if (!(lo <= hi)) return {1.0, infinite ? std::numeric_limits<double>::infinity() : 2.0};
  if (is_parallel(view)) {
    const double margin = (hi - lo) * kRangeMargin + 1.0;
    return {lo - margin, hi + margin};
  }
  // The near plane may touch the ball round the eye that holds nothing: whatever is seen lies at
  // least cos(angle to the corner) times its radius along the axis.
  const Vec3 eye(view.eye);
  double nearest = std::numeric_limits<double>::infinity();
  const auto segment = [&](const Vec3& a, const Vec3& b) {
    const Vec3 ab = b - a;
    const double s = std::clamp(glm::dot(eye - a, ab) / glm::dot(ab, ab), 0.0, 1.0);
    return glm::distance(eye, a + s * ab);
  };
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (!receives(scene, static_cast<std::uint32_t>(t))) continue;
    const Triangle& tri = scene.mesh.triangles[t];
    const Vec3 &a = scene.mesh.positions[tri[0]], &b = scene.mesh.positions[tri[1]],
               &c = scene.mesh.positions[tri[2]];
    if (std::max({glm::dot(f.depth, point(a)), glm::dot(f.depth, point(b)),
                  glm::dot(f.depth, point(c))}) <= 0) {
      continue;  // behind the eye
    }
    double distance = std::min({segment(a, b), segment(b, c), segment(c, a)});
    const Vec3 n = glm::cross(b - a, c - a);
    const double area = glm::length(n);
    if (area > 0) {
      const bool over = glm::dot(glm::cross(b - a, eye - a), n) >= 0 &&
                        glm::dot(glm::cross(c - b, eye - b), n) >= 0 &&
                        glm::dot(glm::cross(a - c, eye - c), n) >= 0;
      if (over) distance = std::min(distance, std::fabs(glm::dot(eye - a, n)) / area);
    }
    nearest = std::min(nearest, distance);
  }
  double cosine = 1;
  for (const double i : {0.0, double(view.width)}) {
    for (const double j : {0.0, double(view.height)}) {
      const Vec3 q = Vec3(view.origin) + i * Vec3(view.right) + j * Vec3(view.down);
      cosine = std::min(cosine, f.axis / glm::length(q));
    }
  }
  DepthRange range;
  hi = std::max(hi, 0.0);
  // An eye on a surface: something must be cut. A millionth of the depth is far below a pixel.
  range.near_plane =
      std::isfinite(nearest) ? std::max(nearest * cosine * (1 - kRangeMargin), hi * 1e-6) : 1.0;
  if (!(range.near_plane > 0)) range.near_plane = 1.0;
  if (!infinite) range.far_plane = std::max(hi * (1 + kRangeMargin), range.near_plane * 2);
  return range;
}

}  // namespace gnomon::gl
