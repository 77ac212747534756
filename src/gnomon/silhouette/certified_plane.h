// The plane of a triangle as a point of dual space, and how wrong it is: what every fast silhouette
// is found with, and why none is ever wrong.
//
// Notation: c a centre, L the light, L' = (L.xyz - L.w c, L.w) the same light with c as its origin.
// The dual point of triangle (A,B,C) is q = s (-n, n.(A-c)) with n = (B-A) x (C-A) and a positive s
// that makes |q.xyz| about 1. Then L'.q = s |A; B; C; L|: its sign is the light side.
#pragma once

#include <array>

#include <gnomon/core/vec.h>
#include <gnomon/mesh/tri_mesh.h>

namespace gnomon {

struct CertifiedPlane {
  std::array<double, 4> q{};
  std::array<double, 4> error{};  // |q[k] - exact| <= error[k]; infinity where nothing is known
};

CertifiedPlane certified_plane(const TriMesh& mesh, std::uint32_t triangle, const Vec3& centre);

// The light seen from a centre, times a positive number that makes its largest component about 1;
// and what rounding in double can change of L'.q for a dual point with |q.xyz| <= kLargestNormal
// and |q.w| <= largest_w. That of `l` to float comes on top.
struct DualLight {
  double factor = 1;              // that number, a power of two
  std::array<double, 4> exact{};  // rounded in double
  std::array<float, 4> l{};
  float slack = 0;
};
inline constexpr double kLargestNormal = 1.001;
DualLight dual_light(const Light& light, const Vec3& centre, double largest_w);

// The middle of the mesh's box, in numbers that float holds.
Vec3 dual_centre(const TriMesh& mesh);

}  // namespace gnomon
