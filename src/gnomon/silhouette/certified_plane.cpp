#include <gnomon/silhouette/certified_plane.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

#include <gnomon/core/approx.h>

namespace gnomon {
namespace {

// Normals whose largest component is smaller may have lost bits to underflow.
constexpr double kSmallestNormal = 1e-250;
// Rounding of L' in double, of the few operations that it and its products take.
constexpr double kDoubleSlack = 0x1p-48;

}  // namespace

CertifiedPlane certified_plane(const TriMesh& mesh, std::uint32_t triangle, const Vec3& centre) {
  const Triangle& t = mesh.triangles[triangle];
  const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
  Approx u[3], v[3], d[3];
  for (int k = 0; k < 3; ++k) {
    u[k] = Approx(b[k]) - Approx(a[k]);
    v[k] = Approx(c[k]) - Approx(a[k]);
    d[k] = Approx(a[k]) - Approx(centre[k]);
  }
  const Approx n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                       u[0] * v[1] - u[1] * v[0]};
  const double largest =
      std::max({std::fabs(n[0].value), std::fabs(n[1].value), std::fabs(n[2].value)});
  CertifiedPlane out;
  if (!(largest >= kSmallestNormal)) {
    out.error.fill(std::numeric_limits<double>::infinity());
    return out;
  }
  double squares = 0;  // from 1 to 3
  for (const Approx& x : n) squares += (x.value / largest) * (x.value / largest);
  const Approx s(1 / (largest * std::sqrt(squares)));
  const Approx q[4] = {-(n[0] * s), -(n[1] * s), -(n[2] * s),
                       (n[0] * d[0] + n[1] * d[1] + n[2] * d[2]) * s};
  for (std::size_t k = 0; k < 4; ++k) {
    out.q[k] = q[k].value;
    out.error[k] = q[k].error;
  }
  return out;
}

DualLight dual_light(const Light& light, const Vec3& centre, double largest_w) {
  DualLight out;
  double size = std::fabs(light.w) * largest_w;
  for (int k = 0; k < 3; ++k) {
    out.exact[std::size_t(k)] = light[k] - light.w * centre[k];
    size += (std::fabs(light[k]) + std::fabs(light.w * centre[k])) * kLargestNormal;
  }
  out.exact[3] = light.w;
  // A power of two changes no sign and brings the largest component to between 1/2 and 1.
  double largest = 0;
  for (const double x : out.exact) largest = std::max(largest, std::fabs(x));
  int exponent = 0;
  std::frexp(largest, &exponent);
  out.factor = std::ldexp(1.0, -exponent);
  for (std::size_t k = 0; k < 4; ++k) {
    out.exact[k] = std::ldexp(out.exact[k], -exponent);
    out.l[k] = static_cast<float>(out.exact[k]);
  }
  // Components below float's smallest normal number are lost.
  out.slack = static_cast<float>(std::ldexp(size, -exponent) * kDoubleSlack +
                                 std::numeric_limits<float>::min() * (4 + largest_w));
  return out;
}

Vec3 dual_centre(const TriMesh& mesh) {
  if (mesh.positions.empty()) return Vec3(0.0);
  Vec3 lo = mesh.positions[0], hi = lo;
  for (const Vec3& p : mesh.positions) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  return Vec3(glm::vec3((lo + hi) * 0.5));
}

}  // namespace gnomon
