#include <gnomon/silhouette/light_sides.h>

#include <algorithm>

namespace gnomon {
namespace {

// |A; B; C; L| = n . (L.xyz - L.w A) up to the factor -1 of the row order, n = (B-A) x (C-A).
template <class T>
T plane_side(const T (&a)[3], const T (&b)[3], const T (&c)[3], const T (&l)[4]) {
  T u[3], v[3], d[3];
  for (int k = 0; k < 3; ++k) {
    u[k] = b[k] - a[k];
    v[k] = c[k] - a[k];
    d[k] = l[k] - l[3] * a[k];
  }
  return (u[1] * v[2] - u[2] * v[1]) * d[0] + (u[2] * v[0] - u[0] * v[2]) * d[1] +
         (u[0] * v[1] - u[1] * v[0]) * d[2];
}

}  // namespace

std::vector<std::int8_t> light_sides(const TriMesh& mesh, const Light& light, ExactStats* stats) {
  double largest[3] = {0, 0, 0};
  for (const Vec3& p : mesh.positions) {
    for (int k = 0; k < 3; ++k) largest[k] = std::max(largest[k], std::fabs(p[k]));
  }
  const Bound p[3] = {Bound(largest[0]), Bound(largest[1]), Bound(largest[2])};
  const Bound bound_of_light[4] = {Bound(light.x), Bound(light.y), Bound(light.z), Bound(light.w)};
  const double error = plane_side(p, p, p, bound_of_light).error + kUnderflowGuard;

  ExactStats local;
  std::vector<std::int8_t> sides(mesh.triangles.size());
  const double l[4] = {light.x, light.y, light.z, light.w};
  for (std::size_t t = 0; t < sides.size(); ++t) {
    const Vec3 &a = mesh.positions[mesh.triangles[t][0]], &b = mesh.positions[mesh.triangles[t][1]],
               &c = mesh.positions[mesh.triangles[t][2]];
    const double d = -plane_side<double>({a.x, a.y, a.z}, {b.x, b.y, b.z}, {c.x, c.y, c.z}, l);
    if (std::fabs(d) > error) {
      sides[t] = d > 0 ? 1 : -1;
    } else {
      sides[t] = static_cast<std::int8_t>(light_side(a, b, c, light, local));
    }
  }
  if (stats != nullptr) *stats += local;
  return sides;
}

}  // namespace gnomon
