#include <gnomon/silhouette/light_planes.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <gnomon/core/parallel.h>
#include <gnomon/silhouette/certified_plane.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gnomon/silhouette/light_planes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gnomon {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kLanesMax = 16;  // what planes are padded to

// Writes sides[begin .. end) and appends to `unsure` the triangles of which they are a guess:
// those whose |dot product| is not above `slack`. Precondition: begin is a multiple of kLanesMax.
void PlaneSides(const LightPlanes& p, const std::array<float, 4>& light, float slack,
                std::size_t begin, std::size_t end, std::int8_t* sides,
                std::vector<std::uint32_t>& unsure) {
  const hn::CappedTag<float, kLanesMax> f;
  const hn::Rebind<std::int32_t, decltype(f)> i32;
  const hn::Rebind<std::int8_t, decltype(f)> i8;
  const std::size_t lanes = hn::Lanes(f);
  const auto x = hn::Set(f, light[0]), y = hn::Set(f, light[1]), z = hn::Set(f, light[2]),
             w = hn::Set(f, light[3]);
  const auto most = hn::Set(f, slack), zero = hn::Zero(f);
  const auto one = hn::Set(i32, 1), minus_one = hn::Set(i32, -1);
  HWY_ALIGN float distance[kLanesMax];
  HWY_ALIGN std::int8_t last[kLanesMax];
  for (std::size_t t = begin; t < end; t += lanes) {
    const auto dot = hn::Add(
        hn::Add(hn::Mul(hn::LoadU(f, p.x.data() + t), x), hn::Mul(hn::LoadU(f, p.y.data() + t), y)),
        hn::Add(hn::Mul(hn::LoadU(f, p.z.data() + t), z),
                hn::Mul(hn::LoadU(f, p.w.data() + t), w)));
    const auto before = hn::RebindMask(i32, hn::Gt(dot, zero));
    const auto side = hn::DemoteTo(i8, hn::IfThenElse(before, one, minus_one));
    const std::size_t n = std::min(lanes, end - t);
    if (HWY_LIKELY(n == lanes)) {
      hn::StoreU(side, i8, sides + t);
    } else {
      hn::StoreU(side, i8, last);
      std::copy_n(last, n, sides + t);
    }
    const auto size = hn::Abs(dot);
    if (HWY_UNLIKELY(!hn::AllTrue(f, hn::Gt(size, most)))) {
      hn::Store(size, f, distance);
      for (std::size_t k = 0; k < n; ++k) {
        if (!(distance[k] > slack)) unsure.push_back(static_cast<std::uint32_t>(t + k));
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon {

HWY_EXPORT(PlaneSides);

namespace {

// Triangles that one thread takes at a time: ten microseconds' worth of signs.
constexpr std::size_t kChunk = std::size_t{1} << 15;
constexpr std::size_t kPadding = 16;
static_assert(kChunk % kPadding == 0);

template <class F>
void for_each_chunk(std::size_t n, int threads, const F& f) {
  parallel_for(static_cast<int>((n + kChunk - 1) / kChunk), threads, [&](int chunk) {
    const std::size_t begin = static_cast<std::size_t>(chunk) * kChunk;
    f(static_cast<std::size_t>(chunk), begin, std::min(n, begin + kChunk));
  });
}

double largest(const Vec3& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

// Below it double may have lost bits of a normal to underflow.
constexpr double kSmallestNormal = 1e-250;
// A component of n is wrong by 2 U V (3 roundings of 2^-53, one for each of u, v and their product)
// and one of the difference, where U and V are the largest components of u = B - A and v = C - A:
// below U V 2^-50. With |n| at least this share of U V, that is 2^-27 of it. n.d, d = A - centre,
// D its largest component, is wrong by 3 D times that, by d's roundings and by those of the sums:
// below 8 D 2^-27 of |n|.
constexpr double kNeedle = 0x1p-23;
// Share of the magnitudes that a dot product is wrong by: plane and light rounded to float, a
// product and two sums are 5 times 2^-24, what is wrong with the plane is another at most.
constexpr double kRounding = 0x1p-21;

}  // namespace

LightPlanes light_planes(const TriMesh& mesh, int threads) {
  const std::size_t n = mesh.triangles.size(), padded = (n + kPadding - 1) / kPadding * kPadding;
  LightPlanes p;
  p.centre = dual_centre(mesh);
  for (std::vector<float>* v : {&p.x, &p.y, &p.z, &p.w}) v->resize(padded, 0.0F);
  for (const Vec3& at : mesh.positions) p.largest_w = std::max(p.largest_w, largest(at - p.centre));
  std::vector<double> largest_w((n + kChunk - 1) / kChunk, 0.0);
  for_each_chunk(n, threads, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& c = mesh.triangles[t];
      const Vec3& a = mesh.positions[c[0]];
      const Vec3 u = mesh.positions[c[1]] - a, v = mesh.positions[c[2]] - a, d = a - p.centre;
      const Vec3 normal{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
      const double size = largest(normal);
      if (!(size > kSmallestNormal && size >= largest(u) * largest(v) * kNeedle)) continue;
      const double scale = 1 / size;
      const double w = (normal.x * d.x + normal.y * d.y + normal.z * d.z) * scale;
      p.x[t] = static_cast<float>(-normal.x * scale);
      p.y[t] = static_cast<float>(-normal.y * scale);
      p.z[t] = static_cast<float>(-normal.z * scale);
      p.w[t] = static_cast<float>(w);
      largest_w[chunk] = std::max(largest_w[chunk], std::fabs(w));
    }
  });
  for (const double w : largest_w) p.largest_w = std::max(p.largest_w, w);
  return p;
}

void sides_from_planes(std::vector<std::int8_t>& sides, const TriMesh& mesh,
                       const LightPlanes& planes, const Light& light, int threads,
                       ExactStats* stats) {
  const std::size_t n = mesh.triangles.size();
  sides.resize(n);
  const DualLight dual = dual_light(light, planes.centre, planes.largest_w);
  double magnitude = std::fabs(dual.exact[3]) * planes.largest_w;
  for (std::size_t k = 0; k < 3; ++k) magnitude += std::fabs(dual.exact[k]);
  // The last term: components and products below float's smallest normal number.
  const float slack = static_cast<float>(
      (static_cast<double>(dual.slack) + magnitude * kRounding) * (1 + 0x1p-20) + 1e-30);
  std::vector<ExactStats> exact((n + kChunk - 1) / kChunk);
  for_each_chunk(n, threads, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> unsure;
    HWY_DYNAMIC_DISPATCH(PlaneSides)(planes, dual.l, slack, begin, end, sides.data(), unsure);
    for (const std::uint32_t t : unsure) {
      const Triangle& c = mesh.triangles[t];
      sides[t] = static_cast<std::int8_t>(light_side(mesh.positions[c[0]], mesh.positions[c[1]],
                                                     mesh.positions[c[2]], light, exact[chunk]));
    }
  });
  if (stats == nullptr) return;
  for (const ExactStats& e : exact) *stats += e;
}

}  // namespace gnomon
#endif
