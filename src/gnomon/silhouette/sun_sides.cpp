#include <gnomon/silhouette/sun_sides.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gnomon/core/approx.h>
#include <gnomon/core/parallel.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gnomon/silhouette/sun_sides.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gnomon {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Writes sides[0 .. n) and appends to `unsure` the triangles of which they are a guess.
void SunSides(const SunPlanes& p, const std::array<float, 3>& light, std::size_t n,
              std::int8_t* sides, std::vector<std::uint32_t>& unsure) {
  // Components of normal and light are at most 1 (and a rounding) and wrong by 2^-24 each, the
  // normal's also by `error`: in three products 3 error + 6 * 2^-24; rounding of products and sums
  // 9 * 2^-24. Rounded up.
  constexpr float kRounding = 0x1p-19f;
  const hn::ScalableTag<float> f;
  const hn::Rebind<std::int32_t, decltype(f)> i32;
  const hn::Rebind<std::int8_t, decltype(f)> i8;
  const std::size_t lanes = hn::Lanes(f);
  const auto x = hn::Set(f, light[0]), y = hn::Set(f, light[1]), z = hn::Set(f, light[2]);
  const auto rounding = hn::Set(f, kRounding), four = hn::Set(f, 4.0f), zero = hn::Zero(f);
  const auto one = hn::Set(i32, 1), minus_one = hn::Set(i32, -1);
  std::size_t t = 0;
  for (; t + lanes <= n; t += lanes) {
    const auto dot = hn::Add(
        hn::Add(hn::Mul(hn::LoadU(f, p.x.data() + t), x), hn::Mul(hn::LoadU(f, p.y.data() + t), y)),
        hn::Mul(hn::LoadU(f, p.z.data() + t), z));
    const auto bound = hn::Add(hn::Mul(hn::LoadU(f, p.error.data() + t), four), rounding);
    const auto behind = hn::RebindMask(i32, hn::Lt(dot, zero));
    hn::StoreU(hn::DemoteTo(i8, hn::IfThenElse(behind, one, minus_one)), i8, sides + t);
    if (HWY_UNLIKELY(!hn::AllTrue(f, hn::Gt(hn::Abs(dot), bound)))) {
      for (std::size_t k = t; k < t + lanes; ++k) {
        const float d = (p.x[k] * light[0] + p.y[k] * light[1]) + p.z[k] * light[2];
        if (!(std::fabs(d) > p.error[k] * 4 + kRounding))
          unsure.push_back(static_cast<std::uint32_t>(k));
      }
    }
  }
  for (; t < n; ++t) unsure.push_back(static_cast<std::uint32_t>(t));
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon {

HWY_EXPORT(SunSides);

namespace {

// Components of (b - a) x (c - a).
template <class T>
std::array<T, 3> normal(const std::array<T, 3>& a, const std::array<T, 3>& b,
                        const std::array<T, 3>& c) {
  std::array<T, 3> u, v;
  for (std::size_t k = 0; k < 3; ++k) {
    u[k] = b[k] - a[k];
    v[k] = c[k] - a[k];
  }
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

}  // namespace

SunPlanes sun_planes(const TriMesh& mesh, int threads) {
  const std::size_t n = mesh.triangles.size();
  SunPlanes p;
  p.x.resize(n);
  p.y.resize(n);
  p.z.resize(n);
  p.error.resize(n);
  std::array<double, 3> largest{0, 0, 0};
  for (const Vec3& at : mesh.positions) {
    for (int k = 0; k < 3; ++k)
      largest[static_cast<std::size_t>(k)] =
          std::max(largest[static_cast<std::size_t>(k)], std::fabs(at[k]));
  }
  const std::array<Bound, 3> bound{Bound(largest[0]), Bound(largest[1]), Bound(largest[2])};
  double error = kUnderflowGuard;
  for (const Bound& b : normal(bound, bound, bound)) error = std::max(error, b.error);

  constexpr std::size_t kChunk = 16384;
  parallel_for(static_cast<int>((n + kChunk - 1) / kChunk), threads, [&](int chunk) {
    const std::size_t begin = static_cast<std::size_t>(chunk) * kChunk;
    for (std::size_t t = begin; t < std::min(n, begin + kChunk); ++t) {
      std::array<std::array<double, 3>, 3> corner;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& at = mesh.positions[mesh.triangles[t][k]];
        corner[k] = {at.x, at.y, at.z};
      }
      const std::array<double, 3> q = normal(corner[0], corner[1], corner[2]);
      const double size = std::max({std::fabs(q[0]), std::fabs(q[1]), std::fabs(q[2])});
      // Far below the numbers that light_sides() trusts, nothing is known.
      const bool known = size > 1e-200 && size < 1e200;
      const double scale = known ? 1 / size : 0;
      p.x[t] = static_cast<float>(q[0] * scale);
      p.y[t] = static_cast<float>(q[1] * scale);
      p.z[t] = static_cast<float>(q[2] * scale);
      p.error[t] = known ? static_cast<float>(error * scale * (1 + 0x1p-20) + 1e-30)
                         : std::numeric_limits<float>::infinity();
    }
  });
  return p;
}

void sun_sides(std::vector<std::int8_t>& sides, const TriMesh& mesh, const SunPlanes& planes,
               const Light& light, ExactStats* stats) {
  sides.resize(mesh.triangles.size());
  const double size = std::max({std::fabs(light.x), std::fabs(light.y), std::fabs(light.z)});
  const std::array<float, 3> direction{static_cast<float>(light.x / size),
                                       static_cast<float>(light.y / size),
                                       static_cast<float>(light.z / size)};
  std::vector<std::uint32_t> unsure;
  HWY_DYNAMIC_DISPATCH(SunSides)(planes, direction, sides.size(), sides.data(), unsure);
  ExactStats local;
  for (const std::uint32_t t : unsure) {
    const Triangle& c = mesh.triangles[t];
    sides[t] = static_cast<std::int8_t>(
        light_side(mesh.positions[c[0]], mesh.positions[c[1]], mesh.positions[c[2]], light, local));
  }
  if (stats != nullptr) *stats += local;
}

}  // namespace gnomon
#endif
