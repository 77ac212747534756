#include <gnomon/silhouette/vector_silhouette.h>

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gnomon/silhouette/vector_silhouette.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gnomon {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kLanesMax = 16;

// sides[t], read as a whole aligned word: `sides` is padded to words.
template <class V>
HWY_INLINE V Sides(const std::int32_t* sides, V triangle) {
  const hn::DFromV<V> d;
  const auto word = hn::GatherIndex(d, sides, hn::ShiftRight<2>(triangle));
  const auto byte = hn::And(triangle, hn::Set(d, 3));
  // To the top and down again, which keeps the sign.
  return hn::ShiftRight<24>(hn::Shl(word, hn::Sub(hn::Set(d, 24), hn::ShiftLeft<3>(byte))));
}

void FindSilhouette(Silhouette& out, const EdgeTable& edges, const std::int32_t* sides) {
  const hn::CappedTag<std::int32_t, kLanesMax> d;
  const std::size_t lanes = hn::Lanes(d), n = edges.vertices.size();
  const auto* bytes = reinterpret_cast<const std::int8_t*>(sides);
  const auto iota = hn::Iota(d, 0), one = hn::Set(d, 1), zero = hn::Zero(d);
  const auto twice = hn::ShiftLeft<1>(iota);
  const auto* first = reinterpret_cast<const std::int32_t*>(edges.first.data());
  const auto* incidence = reinterpret_cast<const std::int32_t*>(edges.incidence.data());
  HWY_ALIGN std::int32_t found[kLanesMax], multiplicity[kLanesMax];
  const auto alone = [&](std::size_t k) {
    std::int32_t m = 0;
    for (std::uint32_t i = edges.first[k]; i < edges.first[k + 1]; ++i) {
      const std::uint32_t at = edges.incidence[i];
      m += (at & 1) != 0 ? -bytes[at >> 1] : bytes[at >> 1];
    }
    if (m != 0) out.push_back({edges.vertices[k][0], edges.vertices[k][1], m});
  };
  std::size_t k = 0;
  for (; k + lanes < n; k += lanes) {
    // Nearly all edges have two triangles.
    const auto pairs = hn::Add(hn::Set(d, first[k]), twice);
    const bool regular = edges.first[k + lanes] - edges.first[k] == 2 * lanes &&
                         hn::AllTrue(d, hn::Eq(hn::LoadU(d, first + k), pairs));
    if (HWY_UNLIKELY(!regular)) {
      for (std::size_t i = 0; i < lanes; ++i) alone(k + i);
      continue;
    }
    hn::Vec<decltype(d)> a, b;
    hn::LoadInterleaved2(d, incidence + first[k], a, b);
    // Edges whose triangles run the same way add their sides, others subtract them.
    const auto side_a = Sides(sides, hn::ShiftRight<1>(a)),
               side_b = Sides(sides, hn::ShiftRight<1>(b));
    const auto back_a = hn::Sub(zero, hn::And(a, one)), back_b = hn::Sub(zero, hn::And(b, one));
    const auto m =
        hn::Add(hn::Sub(hn::Xor(side_a, back_a), back_a), hn::Sub(hn::Xor(side_b, back_b), back_b));
    const auto on = hn::Ne(m, zero);
    // Compressing straight into memory is slow on some processors.
    const std::size_t count = hn::CountTrue(d, on);
    hn::Store(hn::Compress(iota, on), d, found);
    hn::Store(hn::Compress(m, on), d, multiplicity);
    for (std::size_t i = 0; i < count; ++i) {
      const auto& v = edges.vertices[k + static_cast<std::size_t>(found[i])];
      out.push_back({v[0], v[1], multiplicity[i]});
    }
  }
  for (; k < n; ++k) alone(k);
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon {

HWY_EXPORT(FindSilhouette);

void find_silhouette_in_vectors(Silhouette& out, const EdgeTable& edges,
                                const std::vector<std::int8_t>& sides) {
  std::vector<std::int32_t> words(sides.size() / 4 + 1, 0);
  std::copy(sides.begin(), sides.end(), reinterpret_cast<std::int8_t*>(words.data()));
  out.clear();
  HWY_DYNAMIC_DISPATCH(FindSilhouette)(out, edges, words.data());
}

}  // namespace gnomon
#endif
