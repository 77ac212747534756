#include <gnomon/silhouette/vector_silhouette.h>

#include <algorithm>
#include <memory>

#include <gnomon/core/parallel.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gnomon/silhouette/vector_silhouette.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gnomon {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kBlock = 2048;  // edges whose sums stay in the first-level cache
constexpr std::size_t kLanesMax = 16;

// What an incidence adds to its edge's sum: the triangle's side, and minus it.
void SignSides(const std::int8_t* sides, std::size_t n, std::int8_t* signs) {
  const hn::CappedTag<std::int8_t, 64> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t t = 0;
  for (; t + lanes <= n; t += lanes) {
    const auto side = hn::LoadU(d, sides + t);
    hn::StoreInterleaved2(side, hn::Neg(side), d, signs + 2 * t);
  }
  for (; t < n; ++t) {
    signs[2 * t] = sides[t];
    signs[2 * t + 1] = static_cast<std::int8_t>(-sides[t]);
  }
}

// Writes the numbers k < n, a multiple of the lanes, for which is(k) is true of its lane, and
// returns how many; room for kLanesMax more is needed.
template <class Is>
HWY_INLINE std::size_t Collect(std::size_t n, std::uint32_t* out, const Is& is) {
  const hn::CappedTag<std::uint32_t, kLanesMax> d;
  const std::size_t lanes = hn::Lanes(d);
  auto k = hn::Iota(d, 0);
  const auto step = hn::Set(d, static_cast<std::uint32_t>(lanes));
  std::size_t found = 0;
  for (std::size_t i = 0; i < n; i += lanes, k = hn::Add(k, step)) {
    const auto mask = is(d, i);
    // Compressing straight into memory is slow on some processors.
    hn::StoreU(hn::Compress(k, mask), d, out + found);
    found += hn::CountTrue(d, mask);
  }
  return found;
}

void FindSilhouette(Silhouette& out, const EdgeTable& edges, const std::int8_t* signs,
                    std::size_t begin, std::size_t end) {
  HWY_ALIGN std::int32_t sum[kBlock];
  HWY_ALIGN std::uint32_t index[kBlock + kLanesMax];
  const std::size_t lanes = hn::Lanes(hn::CappedTag<std::uint32_t, kLanesMax>());
  const std::uint32_t* incidence = edges.incidence.data();
  const std::size_t last = edges.vertices.size() - 1;
  for (std::size_t base = begin; base < end; base += kBlock) {
    const std::size_t n = std::min(kBlock, end - base);
    // Of the table's last edge a second triangle must not be looked for.
    const std::size_t whole = std::min(n, last - base) / lanes * lanes;
    const std::uint32_t* first = edges.first.data() + base;
    const auto add_all = [&](std::size_t k) {
      std::int32_t m = 0;
      for (std::uint32_t i = first[k]; i < first[k + 1]; ++i) m += signs[incidence[i]];
      sum[k] = m;
    };
    // Most edges have two triangles: all are added up as if they had, without a branch; then the
    // others.
    for (std::size_t k = 0; k < whole; ++k) {
      const std::size_t i = first[k];
      sum[k] = signs[incidence[i]] + signs[incidence[i + 1]];
    }
    const std::size_t others = Collect(whole, index, [&](const auto d, std::size_t k) HWY_ATTR {
      return hn::Ne(hn::Sub(hn::LoadU(d, first + k + 1), hn::LoadU(d, first + k)), hn::Set(d, 2));
    });
    for (std::size_t i = 0; i < others; ++i) add_all(index[i]);
    for (std::size_t k = whole; k < n; ++k) add_all(k);

    std::size_t found = Collect(whole, index, [&](const auto d, std::size_t k) HWY_ATTR {
      return hn::Ne(hn::BitCast(d, hn::Load(hn::RebindToSigned<decltype(d)>(), sum + k)),
                    hn::Zero(d));
    });
    for (std::size_t k = whole; k < n; ++k) {
      if (sum[k] != 0) index[found++] = static_cast<std::uint32_t>(k);
    }
    const std::size_t size = out.size();
    out.resize(size + found);
    const auto* vertices = edges.vertices.data() + base;
    SilhouetteEdge* to = out.data() + size;
    for (std::size_t i = 0; i < found; ++i) {
      const std::uint32_t k = index[i];
      to[i] = {vertices[k][0], vertices[k][1], sum[k]};
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon {

HWY_EXPORT(SignSides);
HWY_EXPORT(FindSilhouette);

void find_silhouette_in_vectors(Silhouette& out, const EdgeTable& edges,
                                const std::vector<std::int8_t>& sides, int threads) {
  out.clear();
  const std::size_t n = edges.vertices.size();
  if (n == 0) return;
  // Edges that one thread takes at a time: some ten microseconds' worth.
  constexpr std::size_t kChunk = 8192;
  const auto signs = std::make_unique_for_overwrite<std::int8_t[]>(2 * sides.size());
  HWY_DYNAMIC_DISPATCH(SignSides)(sides.data(), sides.size(), signs.get());
  const std::size_t chunks = (n + kChunk - 1) / kChunk;
  if (threads == 1 || chunks == 1) {
    HWY_DYNAMIC_DISPATCH(FindSilhouette)(out, edges, signs.get(), 0, n);
    return;
  }
  std::vector<Silhouette> parts(chunks);
  parallel_for(static_cast<int>(chunks), threads, [&](int c) {
    const std::size_t begin = static_cast<std::size_t>(c) * kChunk;
    Silhouette& part = parts[static_cast<std::size_t>(c)];
    part.reserve(kChunk / 3);
    HWY_DYNAMIC_DISPATCH(FindSilhouette)
    (part, edges, signs.get(), begin, std::min(n, begin + kChunk));
  });
  std::size_t total = 0;
  for (const Silhouette& part : parts) total += part.size();
  out.reserve(total);
  for (const Silhouette& part : parts) out.insert(out.end(), part.begin(), part.end());
}

}  // namespace gnomon
#endif
